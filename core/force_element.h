#pragma once

/// \file
/// The door for users' force elements: a struct with a few functions becomes a part of a system.
///
///     struct Magnet {
///       static constexpr Role role = Role::force;
///       static constexpr int dimension = 2;
///       BodyId body;
///       double strength = 0.0;
///       std::vector<BodyId> bodies() const { return {body}; }                   // ground may be among them
///       void loads(const ElementView<2>& at, ElementLoads<2>& out) const {      // say what each load is
///         out.conservative(body, -strength * at.position(body));
///       }
///       double potential(const ElementView<2>& at) const {                      // of the conservative part
///         return 0.5 * strength * at.position(body).squaredNorm();
///       }
///       void check(const PartCheck& check) const { check.positive(strength, "strength", "N/m"); }  //
///       optional void fingerprint(Fingerprint& print) const { print.add(strength); } // optional
///     };
///
/// An element may look at and push only bodies that it names in bodies(). Its potential is booked as
/// `potential` unless it says `static constexpr StoredEnergy stored = StoredEnergy::elastic;`. Without
/// fingerprint() a checkpoint cannot tell it from one with other parameters.

#include <carom/core/assembly.h>
#include <carom/core/end.h>
#include <carom/core/force_kind.h>
#include <carom/core/part_check.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

/// What an element sees: time, positions and velocities of ends. Shapes: D numbers, SI units.
template <int D>
class ElementView {
public:
  explicit ElementView(const EvaluationContext& context) : context_(&context) {}

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

  /// Places of an end in the arrays. Throws ModelError for a body outside the element's island, and for a
  /// point off the centre of a body without orientation.
  [[nodiscard]] Attachment<D> attach(const End<D>& end) const {
    if (end.body != ground && slot(end.body).rotation == none && !end.point.isZero(0.0))
      refuse_orientation(end.body);
    return {end, *context_->assembly.layout()};
  }
  /// Slot of a body that must have an orientation. Throws ModelError otherwise.
  [[nodiscard]] const BodySlot& oriented(BodyId body) const {
    const BodySlot& place = slot(body);
    if (place.rotation == none) refuse_orientation(body);
    return place;
  }
  /// The context it looks at.
  [[nodiscard]] const EvaluationContext& context() const { return *context_; }

private:
  [[nodiscard]] const BodySlot& slot(BodyId body) const {
    const Layout& layout = *context_->assembly.layout();
    const Index index = layout.index(body);
    const Range island = context_->assembly.islands()[context_->island].bodies;
    if (index < island.begin || index >= island.end) {
      throw ModelError("force element: acts on or looks at " + context_->assembly.system().name(body) +
                       ", which it does not name; allowed: a body among its bodies()");
    }
    return layout.bodies()[index];
  }
  [[noreturn]] void refuse_orientation(BodyId body) const {
    throw ModelError(context_->assembly.system().name(body) + ": has no orientation; allowed: a rigid body");
  }

  const EvaluationContext* context_;
};

/// Where an element books its loads, by cause (see Loads).
template <int D>
class ElementLoads {
public:
  ElementLoads(const ElementView<D>& view, const Loads& loads) : view_(&view), loads_(loads) {}

  /// A force at an end that is minus the gradient of potential() [N].
  void conservative(const End<D>& end, const Vec<D>& force) { add(loads_.conservative, end, force); }
  /// A force that only takes energy out [N].
  void dissipative(const End<D>& end, const Vec<D>& force) { add(loads_.dissipative, end, force); }
  /// A prescribed force [N].
  void external(const End<D>& end, const Vec<D>& force) { add(loads_.external, end, force); }
  /// Torques on a planar rigid body, likewise [N m].
  void conservative_torque(BodyId body, double torque) { add(loads_.conservative, body, torque); }
  void dissipative_torque(BodyId body, double torque) { add(loads_.dissipative, body, torque); }
  void external_torque(BodyId body, double torque) { add(loads_.external, body, torque); }

private:
  void add(double* load, const End<D>& end, const Vec<D>& force) const {
    const Attachment<D> at = view_->attach(end);
    at.add_force(load, at.lever(view_->context().evaluation), force);
  }
  void add(double* load, BodyId body, double torque) const {
    if (body != ground) load[view_->oriented(body).v + D] += torque;
  }

  const ElementView<D>* view_;
  Loads loads_;
};

/// The kind that stores elements without a kind of their own and calls their functions.
template <class P>
class ForceElementKind final : public ForceKind {
public:
  static constexpr int D = P::dimension;

  static constexpr int part_dimension() { return D; }
  static constexpr std::string_view part_label() {
    if constexpr (requires { P::label; }) {
      return P::label;
    } else {
      return "force element";
    }
  }

  /// Checks and stores an element.
  void add(const P& part, const PartCheck& check) {
    // Its own check first: it knows the names of its ends.
    if constexpr (requires { part.check(check); }) part.check(check);
    const std::vector<BodyId> bodies = part.bodies();
    if (bodies.empty()) check.refuse("number of bodies", "0", "at least one");
    bool only_ground = true;
    for (const BodyId body : bodies) {
      check.body(body, "body", true);
      only_ground = only_ground && body == ground;
    }
    if (only_ground) check.refuse("body", "ground", "at least one body of this system");
    parts_.push_back(part);
  }

  [[nodiscard]] std::unique_ptr<ForceKind> clone() const override {
    return std::make_unique<ForceElementKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                    const Layout&) const override {
    auto copy = std::make_unique<ForceElementKind>();
    for (const Index slot : order) copy->parts_.push_back(parts_[slot]);
    return copy;
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  void ends(Index element, std::vector<BodyId>& out) const override {
    const std::vector<BodyId> bodies = parts_[element].bodies();
    out.insert(out.end(), bodies.begin(), bodies.end());
  }
  [[nodiscard]] StoredEnergy stored_as() const override {
    if constexpr (requires { P::stored; }) {
      return P::stored;
    } else {
      return StoredEnergy::potential;
    }
  }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override {
    const ElementView<D> view(at);
    ElementLoads<D> out(view, loads);
    for (Index i = elements.begin; i < elements.end; ++i) parts_[i].loads(view, out);
  }
  [[nodiscard]] double potential(const EvaluationContext& at, Range elements) const override {
    double sum = 0.0;
    if constexpr (requires(const P& part, const ElementView<D>& view) { part.potential(view); }) {
      const ElementView<D> view(at);
      for (Index i = elements.begin; i < elements.end; ++i) sum += parts_[i].potential(view);
    }
    return sum;
  }
  void fingerprint(Fingerprint& print) const override {
    for (const P& part : parts_) {
      const std::vector<BodyId> bodies = part.bodies();
      print.add(std::uint64_t{bodies.size()});
      for (const BodyId body : bodies) print.add(std::uint64_t{body.serial});
      if constexpr (requires { part.fingerprint(print); }) part.fingerprint(print);
    }
  }

private:
  std::vector<P> parts_;
};

}  // namespace carom
