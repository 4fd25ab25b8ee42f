#pragma once

/// \file
/// A reference to something that can be called, without a copy of it and without memory.

#include <type_traits>
#include <utility>

namespace carom {

template <class Signature>
class FunctionRef;

/// Refers to a function object that outlives it, or to nothing.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
  /// Nothing: false, not to be called.
  FunctionRef() = default;
  /// \param function what is called; only referred to
  template <class F>
    requires(!std::is_same_v<std::remove_cv_t<F>, FunctionRef>)
  FunctionRef(F& function)  // NOLINT(google-explicit-constructor): a parameter that takes any lambda
      : function_(const_cast<void*>(static_cast<const void*>(&function))),
        call_([](void* called, Arguments... arguments) -> Result {
          return (*static_cast<F*>(called))(std::forward<Arguments>(arguments)...);
        }) {}

  /// True if it refers to anything.
  explicit operator bool() const { return call_ != nullptr; }
  /// Calls the function.
  Result operator()(Arguments... arguments) const {
    return call_(function_, std::forward<Arguments>(arguments)...);
  }

private:
  void* function_ = nullptr;
  Result (*call_)(void*, Arguments...) = nullptr;
};

}  // namespace carom
