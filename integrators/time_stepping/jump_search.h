#pragma once

/// \file
/// Jumps of loads that depend on velocities, where bodies are hit within a step (LoadJumps). By one jump J at
/// the share t of the step the mean load over it is (F0 + F1 + (1 - 2 t) J)/2; mean loads follow the path and
/// have that already, but not before and behind the instant.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/located_motion.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// Finds jumps of loads at impacts within a step. Keeps memory.
class CAROM_API JumpSearch {
public:
  /// A component at an iterate.
  struct At {
    const StepInput& in;
    const StepRule& rule;
    Index component;
    std::span<const LocatedMotion* const> motions;  ///< of its bodies, ascending
    double tolerance;                               ///< of the iteration [m]
  };

  /// \param assembly must outlive it
  explicit JumpSearch(const Assembly& assembly) : assembly_(&assembly) {}

  /// Finds the jumps at the iterate. False if they move the bodies as those do that acted, but for less than
  /// the tolerance: then these stay. \param only_local does nothing unless few blocks are concerned; of the
  /// iterate loads are not asked then
  [[nodiscard]] bool update(const At& at, bool only_local, StepTrial& trial);

private:
  [[nodiscard]] bool surround_hit(const At& at);
  template <class F>
  void for_jumps(const At& at, F&& f) const;
  void evaluate(const At& at, const std::vector<double>& loads, StepTrial& trial);
  void add_up(const At& at, StepTrial& trial);
  template <class W, class F>
  void take_back(const At& at, const W& weight, const F& add, StepTrial& trial);
  static void show_end(const At& at, StepTrial& trial);
  void evaluate_at_end(const At& at, const StepTrial& trial, std::vector<double>& out) const;
  [[nodiscard]] double change(const At& at, const LoadJumps& acted);

  const Assembly* assembly_;
  Surroundings around_;                          // blocks on which loads may jump
  bool local_ = false;                           // these are few
  std::vector<double> jump_, correction_;        // as LoadJumps
  std::vector<double> loads_, before_, change_;  // at the end, before the instant at hand; by how much
  std::vector<double> instants_;                 // of impacts, as shares of the step
};

}  // namespace carom
