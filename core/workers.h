#pragma once

/// \file
/// Threads for loops over parts of a component. The result of a loop must not depend on which thread computes
/// which part, so it is the same bit for bit for any number of threads.

#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/ids.h>

#include <memory>

namespace carom {

/// A number of threads. One needs nothing; more need a library built with oneTBB.
class CAROM_API Workers {
public:
  /// The thread that calls, alone.
  Workers() = default;
  /// \param threads at least 1
  explicit Workers(int threads);

  /// True if the library was built with oneTBB.
  [[nodiscard]] static bool several_available();

  /// Calls f(0), ..., f(count - 1), each once: on several threads in any order, on one in this order. What f
  /// throws is thrown here.
  template <class F>
  void for_each(Index count, F&& f) const {
    if (!arena_ || count <= 1) {
      for (Index i = 0; i < count; ++i) f(i);
      return;
    }
    run(count, FunctionRef<void(Index)>(f));
  }

private:
  struct Arena;

  void run(Index count, FunctionRef<void(Index)> function) const;

  std::shared_ptr<Arena> arena_;  // null for one thread
};

}  // namespace carom
