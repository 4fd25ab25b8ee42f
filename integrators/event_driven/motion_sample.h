#pragma once

/// \file
/// One state (t, y) of a clock group, evaluated; stages of an event and the search for events read it.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/core/assembly.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/state.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom {

/// Forces that accelerations follow from; reactions of joints are among them always.
enum class Forces : std::uint8_t { without_contact, all };

/// One state of a group, with positions, loads and accelerations there. Arrays are over the whole model;
/// those numbers hold that are of the group. SmoothMotion::sample() fills it. The rows of joints and the
/// forces of closed contacts of a motion belong to the sample that it made last.
struct CAROM_API MotionSample {
  /// Memory for any group of a model.
  explicit MotionSample(const Assembly& assembly);
  /// Notes from now on by component at which time its bodies were placed (Evaluation::placed_at). Needed
  /// where bodies touch each other: then others than those of the group are looked at.
  void note_places(std::size_t components);

  State state;                                ///< time and unknowns
  Evaluation evaluation;                      ///< positions and loads
  GroundPlaces places;                        ///< at the time of the state
  std::vector<double> dissipative, external;  ///< loads by cause; empty where no element books any [N, N m]
  std::vector<double> acceleration;           ///< with the reactions asked for
  bool has_forces = true;                     ///< false where no forces keep the closed contacts

  /// Loads of all causes, without reactions [N, N m].
  [[nodiscard]] std::vector<double>& loads() { return all_causes_.empty() ? evaluation.force : all_causes_; }
  [[nodiscard]] const std::vector<double>& loads() const {
    return all_causes_.empty() ? evaluation.force : all_causes_;
  }

  /// The state.
  [[nodiscard]] StateView view() const { return state.view(); }
  /// The motion of bodies, as a look at a path.
  [[nodiscard]] PathSample on_path() const { return {view(), acceleration.data(), evaluation, places}; }
  /// Configuration that joints are evaluated at.
  [[nodiscard]] JointView joint_view() const { return {state.view(), evaluation.rotation.data()}; }

private:
  std::vector<double> all_causes_;  // empty where there is one
};

}  // namespace carom
