#pragma once

/// \file
/// Owner of what only sources know of a class.

#include <utility>

namespace carom {

/// Owns an object whose type is incomplete in headers; null by default. Where an owner is made, destroyed or
/// assigned to, the type is complete. std::unique_ptr would do the same; a program that includes the library
/// would compile each one of it for 5 ms.
template <class T>
class Owner {
public:
  Owner() = default;
  /// Takes an object made by `new`.
  explicit Owner(T* object) : object_(object) {}
  Owner(Owner&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    const Owner before(std::exchange(object_, std::exchange(other.object_, nullptr)));
    return *this;
  }
  ~Owner() { delete object_; }

  /// The object; null if there is none.
  [[nodiscard]] T* get() const { return object_; }
  [[nodiscard]] T& operator*() const { return *object_; }
  [[nodiscard]] T* operator->() const { return object_; }

private:
  T* object_ = nullptr;
};

}  // namespace carom
