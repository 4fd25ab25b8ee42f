#pragma once

/// \file
/// Materials of a model and the laws of contact by pair of them.

#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>
#include <carom/core/surface.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom {

/// One side of a contact, as laws see it.
struct ContactSide {
  Index material = none;  ///< its material; `none`: it has none
  Index own = none;  ///< of a shape on ground: its serial number, under which it may have a law of its own
};

/// Laws of contact. That of a pair is the first there is of: the one set for its two materials, in either
/// order; the one of a shape on ground against everything, as if it were of a material of its own; the
/// default. There is no default unless one is set.
class CAROM_API SurfaceTable {
public:
  /// Laws set for two materials, the lesser number first.
  using Pairs = std::map<std::pair<Index, Index>, Surface>;

  /// Number of the material of that name, made if it is new.
  Index material(std::string_view name);
  /// Number of materials.
  [[nodiscard]] Index size() const { return static_cast<Index>(materials_.size()); }
  /// Name of a material.
  [[nodiscard]] const std::string& name(Index material) const { return materials_[material]; }

  /// Sets the law between two materials, whatever their order. The last one holds.
  void set(Index a, Index b, const Surface& law);
  /// Sets the law of a shape on ground against everything.
  void set_own(Index own, const Surface& law);
  /// Forgets it.
  void remove_own(Index own);
  /// Sets the law of all pairs that have no other.
  void set_default(const Surface& law) { default_ = law; }

  /// Law between two sides, the same in either order; null if there is none. One side at most has a law of
  /// its own.
  [[nodiscard]] const Surface* find(const ContactSide& a, const ContactSide& b) const;
  /// Laws set for two materials.
  [[nodiscard]] const Pairs& pairs() const { return pairs_; }
  /// Adds all laws; names of materials do not count.
  void fingerprint(Fingerprint& print) const;

private:
  [[nodiscard]] const Surface* find_own(Index own) const;

  std::vector<std::string> materials_;
  Pairs pairs_;
  std::map<Index, Surface> own_;
  std::optional<Surface> default_;
};

}  // namespace carom
