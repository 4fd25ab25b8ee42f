#include <carom/core/workers.h>

#ifdef CAROM_HAS_TBB
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace carom {

#ifdef CAROM_HAS_TBB

struct Workers::Arena {
  explicit Arena(int threads) : arena(threads) {}

  oneapi::tbb::task_arena arena;
};

Workers::Workers(int threads) {
  if (threads > 1) arena_ = std::make_shared<Arena>(threads);
}

bool Workers::several_available() { return true; }

void Workers::run(Index count, FunctionRef<void(Index)> function) const {
  arena_->arena.execute([&] {
    oneapi::tbb::parallel_for(
        Index{0}, count, [&](Index i) { function(i); }, oneapi::tbb::simple_partitioner());
  });
}

#else

struct Workers::Arena {};

Workers::Workers(int) {}

bool Workers::several_available() { return false; }

void Workers::run(Index count, FunctionRef<void(Index)> function) const {
  for (Index i = 0; i < count; ++i) function(i);
}

#endif

}  // namespace carom
