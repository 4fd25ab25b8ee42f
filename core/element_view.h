#pragma once

/// \file
/// Access to the state for a user's force element.

#include <carom/core/end.h>
#include <carom/core/force_kind.h>

namespace carom {

/// Access of an element to time, positions and velocities of its ends: vectors of D numbers, SI units.
template <int D>
class ElementView {
public:
  /// \param internal first internal variable of the element, null if it has none
  explicit ElementView(const EvaluationContext& context, const double* internal = nullptr)
      : context_(&context), internal_(internal) {}

  /// Time [s].
  [[nodiscard]] double time() const { return context_->state.time; }
  /// Position of an end [m].
  [[nodiscard]] Vec<D> position(const End<D>& end) const {
    const Attachment<D> at = attach(end);
    return at.position(context_->state, at.lever(context_->evaluation));
  }
  /// Velocity of an end [m/s].
  [[nodiscard]] Vec<D> velocity(const End<D>& end) const {
    const Attachment<D> at = attach(end);
    return at.velocity(context_->state, at.lever(context_->evaluation));
  }
  /// Angle of a planar rigid body [rad].
  [[nodiscard]] double angle(BodyId body) const requires(D == 2) {
    return context_->state.q[oriented(body).q + D];
  }
  /// Spin of a planar rigid body [rad/s].
  [[nodiscard]] double spin(BodyId body) const requires(D == 2) {
    return context_->state.v[oriented(body).v + D];
  }

  /// Internal variables of the element, as many as its internal_size.
  [[nodiscard]] const double* internal() const { return internal_; }

  /// Places of an end in the arrays. Throws ModelError for a body outside the element's component, and for a
  /// point off the centre of a body without orientation.
  [[nodiscard]] Attachment<D> attach(const End<D>& end) const {
    if (end.body != ground && slot(end.body).rotation == none && !end.point.isZero(0.0))
      context_->refuse_unoriented(end.body);
    return {end, context_->layout};
  }
  /// Slot of a body that must have an orientation. Throws ModelError otherwise.
  [[nodiscard]] BodySlot oriented(BodyId body) const {
    const BodySlot& place = slot(body);
    if (place.rotation == none) context_->refuse_unoriented(body);
    return place;
  }
  /// The context of the evaluation.
  [[nodiscard]] const EvaluationContext& context() const { return *context_; }

private:
  [[nodiscard]] BodySlot slot(BodyId body) const {
    const Index index = context_->layout.index(body);
    if (index < context_->reach.begin || index >= context_->reach.end) context_->refuse_unnamed(body);
    return context_->layout.bodies()[index];
  }

  const EvaluationContext* context_;
  const double* internal_;
};

/// Access of an element to a step of time stepping.
template <int D>
struct ElementStep {
  ElementView<D> start;   ///< at its start
  ElementView<D> end;     ///< at its end
  ElementView<D> middle;  ///< in the middle: mean velocities, positions advanced by half the step
  double step = 0.0;      ///< h [s]
};

}  // namespace carom
