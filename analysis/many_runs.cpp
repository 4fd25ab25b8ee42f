// Problem: make many runs on several threads, whatever some of them throw.

#include <carom/analysis/many_runs.h>
#include <carom/core/errors.h>
#include <carom/core/workers.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace carom {

namespace {

/// The exception that is being handled.
RunFailure failure_of(std::size_t run) {
  RunFailure made{run, {}, std::current_exception()};
  try {
    throw;
  } catch (const std::exception& error) {
    made.message = error.what();
  } catch (...) {  // has no text
  }
  return made;
}

}  // namespace

std::vector<RunFailure> for_each_run(std::size_t count, int threads,
                                     const std::function<void(std::size_t)>& f) {
  const auto refuse = [&](const char* allowed) {
    throw ModelError("for_each_run: threads is " + std::to_string(threads) + "; allowed: " + allowed);
  };
  if (threads < 1) refuse("at least 1");
  if (threads > 1 && !Workers::several_available()) {
    refuse("1, for the library was built without oneTBB (CAROM_WITH_TBB)");
  }
  if (count > std::size_t{none}) {
    throw ModelError("for_each_run: there are " + std::to_string(count) + " runs; allowed: at most " +
                     std::to_string(none));
  }
  std::vector<RunFailure> failures;
  std::mutex taken;
  Workers(threads).for_each(static_cast<Index>(count), [&](Index run) {
    try {
      f(run);
    } catch (...) {
      RunFailure failure = failure_of(run);
      const std::lock_guard lock(taken);
      failures.push_back(std::move(failure));
    }
  });
  std::sort(failures.begin(), failures.end(),
            [](const RunFailure& a, const RunFailure& b) { return a.run < b.run; });
  return failures;
}

}  // namespace carom
