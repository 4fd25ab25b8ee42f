#pragma once

/// \file
/// The order in which stages and blocks of a sweep come. With the same blocks, and sums in the same order,
/// the bits do not depend on it:
///
///   staged     stage by stage, each over all blocks: where something comes between bodies and their loads
///   streamed   block by block: bodies are moved just before their loads are evaluated, while their numbers
///              are at hand (Assembly::blocks(), runs())
///   fused      two streamed sweeps in one pass, the second following the first as closely as it can; sums of
///              loads are rounded differently
///   local      sweeps of the blocks around contacts alone, where these are few, as a better first guess
///
/// Threads share blocks, or runs of them.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/numerics/fixed_point.h>
#include <carom/core/workers.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/sweep_stages.h>

#include <span>
#include <vector>

namespace carom {

/// Loads of an iterate that are known after a pass.
enum class LoadsKnown : std::uint8_t { total, by_cause };

/// Runs sweeps. Keeps memory only.
class CAROM_API SweepSchedule {
public:
  /// \param any_iterated whether the loads of any component of the model change
  SweepSchedule(const Assembly& assembly, const TimeStepping& options, bool any_iterated);

  /// True if a sweep that was preceded by so many may be fused with the next.
  [[nodiscard]] bool may_fuse(const SweepStages& stages, int sweeps, int expected) const;

  /// Guesses the loads of all blocks.
  void guess(const SweepStages& stages) const;
  /// Moves the bodies of all blocks.
  void move(const SweepStages& stages) const;
  /// The loads that the guess led to become the guess, of all blocks.
  void improve(const SweepStages& stages) const;
  /// A task for some bodies, called for one range after the other.
  using BodyTask = FunctionRef<void(Range bodies)>;
  /// A question about some bodies.
  using BodyQuestion = FunctionRef<bool(Range bodies)>;
  /// Bodies that are looked at together: does any touch?
  static constexpr Index piece_size = 64;
  /// Bodies of which some do, whose contacts are found, solved and booked together: their problems fit into
  /// the nearest cache.
  static constexpr Index touching_size = 8;
  /// Calls f(piece) for pieces of a range, one after the other.
  template <class F>
  static void for_pieces(Range all, Index size, F&& f) {
    for (Index first = all.begin; first < all.end; first += size) {
      f(Range{first, std::min(first + size, all.end)});
    }
  }
  /// The step of bodies under constant loads, part by part, and its account. \param before,after called
  /// before and after some bodies move, whose numbers are at hand meanwhile: a piece, or a few parts of each
  /// thread; without `before` all; or nothing \param touch false if surely none of them touches: then they
  /// are a large piece
  void run(const ConstantStages& stages, BodyTask before = {}, BodyTask after = {},
           BodyQuestion touch = {}) const;
  /// Loads that the iterate leads to; the change that another sweep would make, if asked for.
  void evaluate(const SweepStages& stages, LoadsKnown asked, bool with_changes);
  /// One sweep, block by block, and its loads. \param guessing whether it begins with a guess
  void stream(const SweepStages& stages, bool guessing, LoadsKnown asked);
  /// Two sweeps in one pass, and the loads by cause of the second; of the first changes only. A block whose
  /// loads are not finite is left as the first sweep made it.
  void fuse(const SweepStages& stages, bool guessing);
  /// Sweeps around contacts alone.
  struct LocalSweeps {
    int made = 0;
    bool contract = false;  ///< local sweeps contract; false: all blocks are guessed anew
  };
  /// Guesses the loads on blocks with contacts by sweeps of these blocks alone, where they are few, for the
  /// fixed-point iteration. \param again goes on from the last call
  LocalSweeps presolve(const SweepStages& stages, Iteration iteration, double tolerance, bool again);

  /// Change that another sweep would make, the largest over all blocks.
  [[nodiscard]] SweepChange change(const SweepStages& stages) const { return largest(changes_, stages); }
  /// Change that another sweep would make, the largest over all blocks, after the first of two fused sweeps.
  [[nodiscard]] SweepChange earlier_change(const SweepStages& stages) const {
    return largest(earlier_changes_, stages);
  }

private:
  /// Calls f(block, its place in the component), shared out to the threads.
  template <class F>
  void for_blocks(const SweepStages& stages, F&& f) const {
    const Range blocks = stages.blocks();
    workers_.for_each(blocks.size(), [&](Index part) { f(assembly_->blocks()[blocks.begin + part], part); });
  }
  void evaluate(const SweepStages& stages, LoadsKnown asked, bool with_changes, BlockTask first);
  [[nodiscard]] SweepChange largest(const std::vector<SweepChange>& changes, const SweepStages& stages) const;
  LocalSweeps presolve_around_contacts(const SweepStages& stages, double tolerance);
  [[nodiscard]] bool surround_upset(Index blocks);
  void sweep_upset(const SweepStages& stages);

  const Assembly* assembly_;
  Index threads_;
  Workers workers_;
  bool any_iterated_;
  std::vector<SweepChange> changes_, earlier_changes_;  // by block of a component; of the sweep before
  enum Local : std::uint8_t { untouched, guessed, swept };
  std::vector<std::uint8_t> local_;  // by block of a component: Local, of presolve()
  Surroundings upset_;               // blocks around contacts
};

}  // namespace carom
