#pragma once

/// \file
/// Guards of elements along the motion: numbers whose changes of sign are kinks or jumps of loads
/// (ForceKind::guards), with what is needed to find every change of sign within a step.

#include <carom/core/element_view.h>

#include <cmath>

namespace carom {

/// A guard g at one time of a motion. Unit of g: that of the element, best metres.
struct GuardMotion {
  double value = 0.0;   ///< g
  double first = 0.0;   ///< dg/dt
  double second = 0.0;  ///< d^2g/dt^2
  /// Bound of |d^6g/dt^6| as far as it comes from the turning of bodies, with the accelerations and angular
  /// accelerations of the bodies as they are now. 0 where g is a polynomial of degree 5 or less of the
  /// coordinates and these are polynomials of degree 2: of particles in free flight, say, their distance
  /// squared.
  double sixth = 0.0;
};

/// The motion at an element: positions, velocities and accelerations of its ends.
template <int D>
class ElementMotion : public ElementView<D> {
public:
  /// \param acceleration of all velocity coordinates [m/s^2, rad/s^2] \param internal as in ElementView
  ElementMotion(const EvaluationContext& context, const double* acceleration, const double* internal)
      : ElementView<D>(context, internal), acceleration_(acceleration) {}

  /// Acceleration of an end [m/s^2].
  [[nodiscard]] Vec<D> acceleration(const End<D>& end) const {
    const Attachment<D> at = this->attach(end);
    if (at.q == none) return filled<D>(0.0);
    Vec<D> result = Eigen::Map<const Vec<D>>(acceleration_ + at.v);
    if constexpr (Space<D>::has_orientation) {
      if (at.rotation != none) {
        const Vec<D> lever = at.lever(this->context().evaluation);
        result += Space<D>::lever_velocity(acceleration_ + at.v + D, lever) +
                  Space<D>::centripetal(this->context().state.v + at.v + D, lever);
      }
    }
    return result;
  }
  /// A rate W [1/s] such that the k-th derivative in time of the lever of an end, from the centre of mass to
  /// the end, is at most W^k times its length, k up to 6, at the present angular acceleration. With the spin
  /// w and the angular acceleration a: the derivatives of exp(i angle) are Bell's polynomials of w and a, the
  /// sixth w^6 + 15 w^4 a + 45 w^2 a^2 + 15 a^3; all are below (w + 1.6 sqrt(a))^k. 0 without a lever.
  [[nodiscard]] double turning(const End<D>& end) const {
    constexpr double of_acceleration = 1.6;  // at least 15^(1/6), 3^(1/4)
    if constexpr (Space<D>::has_orientation) {
      const Attachment<D> at = this->attach(end);
      if (at.q != none && at.rotation != none) {
        return std::abs(this->context().state.v[at.v + D]) +
               of_acceleration * std::sqrt(std::abs(acceleration_[at.v + D]));
      }
    }
    return 0.0;
  }

private:
  const double* acceleration_;
};

}  // namespace carom
