#pragma once

/// \file
/// Receives the loads of a force element on its bodies, by cause.

#include <carom/core/element_view.h>
#include <carom/core/end.h>
#include <carom/core/force_kind.h>

namespace carom {

/// Receives the loads of an element, by cause (see Loads).
template <int D>
class ElementLoads {
public:
  ElementLoads(const ElementView<D>& view, const Loads& loads) : view_(&view), loads_(loads) {}
  /// Loads over a step, which act at the mean of the levers at both its ends.
  ElementLoads(const ElementStep<D>& step, const Loads& loads)
      : view_(&step.start), other_(&step.end), loads_(loads) {}

  /// A force at an end that is minus the gradient of potential() [N].
  void conservative(const End<D>& end, const Vec<D>& force) { add(loads_.conservative, end, force); }
  /// A dissipative force: its work is never positive [N].
  void dissipative(const End<D>& end, const Vec<D>& force) { add(loads_.dissipative, end, force); }
  /// A prescribed force [N].
  void external(const End<D>& end, const Vec<D>& force) { add(loads_.external, end, force); }
  /// A torque on a planar rigid body that is minus the gradient of potential() [N m].
  void conservative_torque(BodyId body, double torque) { add(loads_.conservative, body, torque); }
  /// A dissipative torque on a planar rigid body: its work is never positive [N m].
  void dissipative_torque(BodyId body, double torque) { add(loads_.dissipative, body, torque); }
  /// A prescribed torque on a planar rigid body [N m].
  void external_torque(BodyId body, double torque) { add(loads_.external, body, torque); }

private:
  void add(double* load, const End<D>& end, const Vec<D>& force) const {
    const Attachment<D> at = view_->attach(end);
    Vec<D> lever = at.lever(view_->context().evaluation);
    if (other_ != nullptr) lever = 0.5 * (lever + at.lever(other_->context().evaluation));
    at.add_force(load, lever, force);
  }
  void add(double* load, BodyId body, double torque) const {
    if (body != ground) load[view_->oriented(body).v + D] += torque;
  }

  const ElementView<D>* view_;
  const ElementView<D>* other_ = nullptr;
  Loads loads_;
};

}  // namespace carom
