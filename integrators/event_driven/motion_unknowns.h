#pragma once

/// \file
/// Unknowns of the smooth motion of one component and their places: q, v, z, then works.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace carom {

/// Works that are integrated along.
enum class WorkLine : std::uint8_t { dashpot, sliding, external, joint_friction };
/// Number of them; the last is integrated where joints have dry friction only.
inline constexpr Index work_lines = 4;

/// Places of the unknowns of one component.
class CAROM_API MotionUnknowns {
public:
  /// \param component must outlive it \param works number of works that are integrated: the first lines
  MotionUnknowns(const Component& component, Index works);

  [[nodiscard]] std::size_t size() const { return size_; }      ///< number of all
  [[nodiscard]] std::size_t q_size() const { return q_size_; }  ///< number of coordinates; v begins behind
  [[nodiscard]] std::size_t v_size() const { return v_size_; }  ///< number of velocities
  [[nodiscard]] std::size_t z_begin() const { return q_size_ + v_size_; }  ///< place of the first of z
  [[nodiscard]] std::size_t z_size() const { return z_size_; }             ///< number of internal variables
  [[nodiscard]] Index work_count() const { return works_; }                ///< number of works
  /// Place of a work.
  [[nodiscard]] std::size_t work_place(WorkLine line) const {
    return q_size_ + v_size_ + z_size_ + static_cast<std::size_t>(line);
  }
  /// Place of a velocity of the model that is one of the component's.
  [[nodiscard]] std::size_t of_velocity(Index v) const { return q_size_ + (v - component_->v.begin); }

  /// Reads the unknowns off a state, works 0.
  void gather(const State& state, std::span<double> y) const;
  /// Writes them into a state.
  void scatter(std::span<const double> y, State& state) const;

private:
  const Component* component_;
  Index works_;
  std::size_t q_size_, v_size_, z_size_, size_;
};

}  // namespace carom
