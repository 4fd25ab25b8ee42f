#pragma once

/// \file
/// The state of a model: a value.

#include <carom/core/export.h>
#include <carom/core/layout.h>

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace carom {

/// A view of numbers stored elsewhere (unaligned, so that it fits any vectorisation of the caller).
using VectorMap = Eigen::Map<Eigen::VectorXd>;
/// A view of constant numbers stored elsewhere.
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

/// Time and pointers to the numbers of a state, which evaluations read. Arrays are those of the whole model.
struct StateView {
  double time = 0.0;          ///< [s]
  const double* q = nullptr;  ///< coordinates [m, rad]
  const double* v = nullptr;  ///< velocities [m/s, rad/s]
  const double* z = nullptr;  ///< internal variables of elements
};

/// Time, coordinates q, velocities v and internal variables z of a model: a value.
class CAROM_API State {
public:
  /// A state of no model.
  State() = default;
  /// All numbers zero.
  explicit State(std::shared_ptr<const Layout> layout);

  double time = 0.0;      ///< [s]
  std::vector<double> q;  ///< coordinates, bodies in the order of assembly [m, rad]
  std::vector<double> v;  ///< velocities [m/s, rad/s]
  std::vector<double> z;  ///< internal variables of elements

  /// Position of the centre of mass [m], 2 or 3 numbers. Throws ModelError for a foreign identity.
  [[nodiscard]] ConstVectorMap position(BodyId body) const;
  [[nodiscard]] VectorMap position(BodyId body);
  /// Velocity of the centre of mass [m/s]. Throws as position().
  [[nodiscard]] ConstVectorMap velocity(BodyId body) const;
  [[nodiscard]] VectorMap velocity(BodyId body);
  /// Angle of a planar rigid body [rad]. Throws ModelError if the body has none.
  [[nodiscard]] double angle(BodyId body) const { return q[angle_index(body)]; }
  [[nodiscard]] double& angle(BodyId body) { return q[angle_index(body)]; }
  /// Spin of a planar rigid body [rad/s]. Throws as angle().
  [[nodiscard]] double spin(BodyId body) const { return v[spin_index(body)]; }
  [[nodiscard]] double& spin(BodyId body) { return v[spin_index(body)]; }

  /// Coordinate of a joint [rad, m], `to` relative to `from`, as defined by the joint. Throws ModelError for
  /// a joint that is not of this model or has none.
  [[nodiscard]] double coordinate(JointId joint) const;
  /// Rate of the coordinate of a joint [rad/s, m/s]. Throws as coordinate().
  [[nodiscard]] double rate(JointId joint) const;

  /// Internal variables of an element, in the order and units that it documents. Throws ModelError for an
  /// element that has none.
  [[nodiscard]] ConstVectorMap internal(ElementId element) const;
  [[nodiscard]] VectorMap internal(ElementId element);

  /// The map from identities to places. Null for a state of no model.
  [[nodiscard]] const std::shared_ptr<const Layout>& layout() const { return layout_; }
  /// View of the numbers, for evaluations.
  [[nodiscard]] StateView view() const { return {time, q.data(), v.data(), z.data()}; }

private:
  [[nodiscard]] BodySlot slot(BodyId body) const;
  [[nodiscard]] Index angle_index(BodyId body) const;
  [[nodiscard]] Index spin_index(BodyId body) const;

  std::shared_ptr<const Layout> layout_;
};

}  // namespace carom
