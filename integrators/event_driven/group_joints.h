#pragma once

/// \file
/// Joints of the components of a clock group: rows and multipliers of all, component after component.

#include <carom/contact/friction_bounds.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// The joints of several components. Each component answers for itself: no joint binds two of them.
class CAROM_API GroupJoints {
public:
  /// The joints of one component that has some.
  struct Part {
    Index component;           ///< of the assembly
    std::size_t first_row;     ///< among those of the group
    JointConstraints* joints;  ///< its constraints
  };

  /// \param assembly must outlive it \param components ascending
  GroupJoints(const Assembly& assembly, std::span<const Index> components);
  GroupJoints(const GroupJoints&) = delete;
  GroupJoints& operator=(const GroupJoints&) = delete;

  [[nodiscard]] bool empty() const { return parts_.empty(); }           ///< true if there are no joints
  [[nodiscard]] std::size_t size() const { return rows_; }              ///< number of rows
  [[nodiscard]] std::span<const Part> parts() const { return parts_; }  ///< components with joints, ascending
  /// The constraints of each of these.
  [[nodiscard]] std::span<JointConstraints* const> list() const { return list_; }
  /// True if a row depends on time.
  [[nodiscard]] bool depends_on_time() const;
  /// Brings the rows to a configuration and factorises.
  void update_and_factor(const JointView& at);
  /// Makes numbers of the bodies obey the constraints. \param x over all velocities \param multipliers out,
  /// sized as the rows; may be null
  void project(JointLevel level, double* x, double* multipliers = nullptr);
  /// x becomes M^-1 x over the components that have joints.
  void apply_inverse_mass(double* x) const;
  /// Rate of a row.
  [[nodiscard]] double rate(std::size_t row) const;
  /// The joint of a row.
  [[nodiscard]] JointId joint(std::size_t row) const;
  /// Answer of all bodies of the group to impulses.
  [[nodiscard]] ComponentsResponse& response() { return response_; }

private:
  [[nodiscard]] const Part& part_of(std::size_t row) const;

  std::vector<JointConstraints> joints_;
  std::vector<JointConstraints*> list_;  // of them
  std::vector<Part> parts_;
  std::size_t rows_ = 0;
  ComponentsResponse response_;
};

/// Components as far as joints bind them. Groups without joints share one of no component.
struct CAROM_API BoundComponents {
  /// \param assembly must outlive it \param of ascending
  BoundComponents(const Assembly& assembly, std::span<const Index> of);

  std::vector<Index> components;
  GroupJoints rows;
  FrictionBounds bounds;  ///< of friction in joints that follow from forces
};

}  // namespace carom
