#pragma once

/// \file
/// The type of a part as a registry sees it.

#include <memory>
#include <string_view>
#include <typeinfo>

namespace carom {

class PartCheck;

/// The type of a part as its role sees it: what a registry needs of it, without templates that every program
/// would compile anew. `K` is the interface of the role.
template <class K>
struct PartType {
  const std::type_info* kind;  ///< of the parts
  std::string_view label;      ///< of a part
  int dimension;               ///< of a part, 0: any
  std::unique_ptr<K> (*make_kind)();
  /// Stores a part of this type in its kind. Throws ModelError.
  void (*store)(K& of_type, const void* part, const PartCheck& check);

  /// Type of a part whose kind is `Concrete`.
  template <class Concrete, class Description>
  [[nodiscard]] static PartType of() {
    return {&typeid(Concrete), Concrete::part_label(), Concrete::part_dimension(),
            []() -> std::unique_ptr<K> { return std::make_unique<Concrete>(); },
            [](K& of_type, const void* part, const PartCheck& check) {
              static_cast<Concrete&>(of_type).add(*static_cast<const Description*>(part), check);
            }};
  }
};

}  // namespace carom
