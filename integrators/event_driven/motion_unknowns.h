#pragma once

/// \file
/// Unknowns of the smooth motion of a clock group and their places: q of all its components, then v, then z,
/// then works.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Works that are integrated along.
enum class WorkLine : std::uint8_t { dashpot, sliding, external, joint_friction, rolling };
/// Number of them. Behind those of all motions, friction is integrated where joints have dry friction, and
/// both where contacts resist rolling.
inline constexpr Index work_lines = 5;

/// Places of the unknowns of one clock group.
class CAROM_API MotionUnknowns {
public:
  /// One component: its numbers in those of the model, and the places of the first of them among the
  /// unknowns.
  struct Part {
    Index component = 0;      ///< its number in the model
    const Component& ranges;  ///< of the model
    std::size_t q = 0;        ///< place of its first coordinate
    std::size_t v = 0;        ///< place of its first velocity
    std::size_t z = 0;        ///< place of its first internal variable
  };

  /// \param assembly must outlive it \param components of the assembly, ascending \param works number of
  /// works that are integrated: the first lines
  MotionUnknowns(const Assembly& assembly, std::span<const Index> components, Index works);

  /// The components, ascending.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] std::size_t size() const { return size_; }      ///< number of all
  [[nodiscard]] std::size_t q_size() const { return q_size_; }  ///< number of coordinates; v begins behind
  [[nodiscard]] std::size_t v_size() const { return v_size_; }  ///< number of velocities
  [[nodiscard]] std::size_t z_begin() const { return q_size_ + v_size_; }  ///< place of the first of z
  [[nodiscard]] std::size_t z_size() const { return z_size_; }             ///< number of internal variables
  [[nodiscard]] Index work_count() const { return works_; }                ///< number of works
  /// True if a work is integrated.
  [[nodiscard]] bool has_work(WorkLine line) const { return static_cast<Index>(line) < works_; }
  /// Place of a work.
  [[nodiscard]] std::size_t work_place(WorkLine line) const {
    return q_size_ + v_size_ + z_size_ + static_cast<std::size_t>(line);
  }
  /// The part that a velocity of the model belongs to, which must be one of the group's.
  [[nodiscard]] const Part& part_of(Index v) const;
  /// Place of a velocity of the model that is one of the group's.
  [[nodiscard]] std::size_t of_velocity(Index v) const {
    const Part& part = part_of(v);
    return part.v + (v - part.ranges.v.begin);
  }
  /// The velocity of the model at a place of the unknowns.
  [[nodiscard]] Index velocity_at(std::size_t place) const;

  /// Reads the unknowns off a state, works 0.
  void gather(const State& state, std::span<double> y) const;
  /// Writes the unknowns into a state.
  void scatter(std::span<const double> y, State& state) const;
  /// Copies velocities, or what is like them, between an array over the model and their places: for all
  /// components f(range of the model, place among the group's velocities).
  template <class F>
  void for_velocities(F&& f) const {
    for (const Part& part : parts_) f(part.ranges.v, part.v - q_size_);
  }

private:
  std::vector<Part> parts_;
  Index works_;
  std::size_t q_size_ = 0, v_size_ = 0, z_size_ = 0, size_ = 0;
};

}  // namespace carom
