#pragma once

/// \file
/// The interface for users' force elements: a struct with a few functions becomes a part of a system.
///
///     struct Magnet {
///       static constexpr Role role = Role::force;
///       static constexpr int dimension = 2;
///       BodyId body;
///       double strength = 0.0;
///       std::vector<BodyId> bodies() const { return {body}; }                   // ground may be among them
///       void loads(const ElementView<2>& at, ElementLoads<2>& out) const {      // loads by cause
///         out.conservative(body, -strength * at.position(body));
///       }
///       double potential(const ElementView<2>& at) const {                      // of the conservative part
///         return 0.5 * strength * at.position(body).squaredNorm();
///       }
///       void check(const PartCheck& check) const { check.positive(strength, "strength", "N/m"); }
///       void fingerprint(Fingerprint& print) const { print.add(strength); }  // as check(), optional
///     };
///
/// Optional, for the rule `energy_momentum`: `void mean_loads(const ElementStep<D>&, ElementLoads<D>&)
/// const`, loads over a step; the work of their conservative part is exactly the decrease of the potential.
/// Without it the loads in the middle of the step are used.
///
/// Optional internal variables, which follow a differential equation:
///
///       static constexpr int internal_size = 1;
///       void initial_internal(double* z) const;                              // optional, zero without
///       void internal_rates(const ElementView<D>& at, double* rates) const;  // dz/dt, z in at.internal()
///       double internal_loss_rate(const ElementView<D>& at) const;           // optional [W]
///       void advance_internal(const ElementStep<D>& step, double* z) const;  // optional: by closed form
///       double internal_loss(const ElementStep<D>& step) const;              // optional [J]
///
/// Optional, for the event-driven mode (see ForceKind):
///
///       static constexpr bool depends_on_time = false;  // loads do not depend on time; else true
///       std::vector<double> breaks{};                   // when laws of time jump: finite, ascending [s]
///       static constexpr int guard_size = 1;            // values whose change of sign is a switching
///                                                       // point: a kink or jump of the loads
///       void guards(const ElementView<D>& at, double* out) const;
///       void guard_motion(const ElementMotion<D>& at, GuardMotion* out) const;  // optional: the same with
///                                                       // derivatives (guard_motion.h); then none is missed
///
/// Optional: `bool lacks_direction(const ElementView<D>& at, double fastest) const`, whether there is a force
/// whose direction is not determined (ForceKind::first_without_direction); no run begins there.
///
/// An element may read and load only bodies that it names in bodies(). Its potential is booked as
/// `potential` unless it has `static constexpr StoredEnergy stored = StoredEnergy::elastic;`. Without
/// fingerprint() a checkpoint cannot distinguish it from one with other parameters.
///
/// Optional derivatives of the loads by positions and velocities (element_derivatives.h):
///
///       void derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
///         out.force(body, -strength * at.position(body), -strength * Mat<2>::Identity(), Mat<2>::Zero());
///       }
///
/// Without them they are computed by differences, with many evaluations and half of the digits.

#include <carom/core/element_derivatives.h>
#include <carom/core/element_loads.h>
#include <carom/core/element_view.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/core/guard_motion.h>
#include <carom/core/internal_step.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

/// Elements without their own kind: all that does not depend on their type.
class CAROM_API ForceElements : public ForceKind {
public:
  void place_internal(std::span<const Index> first) override;

protected:
  /// Demands bodies of this system, or ground, one of them a body. Throws ModelError.
  static void check_bodies(const PartCheck& check, const std::vector<BodyId>& bodies);
  /// Appends bodies.
  static void append(const std::vector<BodyId>& bodies, std::vector<BodyId>& out);
  /// Adds the number of bodies and who they are.
  static void add_bodies(Fingerprint& print, const std::vector<BodyId>& bodies);

  std::vector<Index> internal_;  ///< first internal variable of each element, empty if they have none
};

/// The kind that stores elements without their own kind and calls their functions.
template <class P>
class ForceElementKind final : public ForceElements {
public:
  static constexpr int D = P::dimension;

  /// Members that a System needs of every kind (part.h).
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
    check_bodies(check, part.bodies());
    if constexpr (has_breaks) check.breaks(part.breaks, "breaks");
    parts_.push_back(part);
  }

  [[nodiscard]] std::unique_ptr<ForceKind> clone() const override {
    return std::make_unique<ForceElementKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                    const Layout&) const override {
    auto copy = std::make_unique<ForceElementKind>();
    copy->parts_.reserve(order.size());
    for (const Index slot : order) copy->parts_.push_back(parts_[slot]);
    return copy;
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  void ends(Index element, std::vector<BodyId>& out) const override { append(parts_[element].bodies(), out); }
  [[nodiscard]] StoredEnergy stored_as() const override {
    if constexpr (requires { P::stored; }) {
      return P::stored;
    } else {
      return StoredEnergy::potential;
    }
  }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override {
    for (Index i = elements.begin; i < elements.end; ++i) {
      const ElementView<D> element = view(at, i);
      ElementLoads<D> out(element, loads);
      parts_[i].loads(element, out);
    }
  }
  void evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const override {
    if constexpr (has_mean_loads) {
      for (Index i = elements.begin; i < elements.end; ++i) {
        const ElementStep<D> element = step(at, i);
        ElementLoads<D> out(element, loads);
        parts_[i].mean_loads(element, out);
      }
    } else {
      evaluate(at.middle, elements, loads);
    }
  }
  [[nodiscard]] bool uses_middle() const override { return !has_mean_loads || N > 0; }
  [[nodiscard]] double potential(const EvaluationContext& at, Range elements) const override {
    double sum = 0.0;
    if constexpr (requires(const P& part, const ElementView<D>& view) { part.potential(view); }) {
      for (Index i = elements.begin; i < elements.end; ++i) sum += parts_[i].potential(view(at, i));
    }
    return sum;
  }

  [[nodiscard]] Index internal_size() const override { return static_cast<Index>(N); }
  void initial_internal(Index element, double* z) const override {
    if constexpr (requires(const P& part) { part.initial_internal(z); }) {
      parts_[element].initial_internal(z);
    } else {
      std::fill(z, z + N, 0.0);
    }
  }
  void internal_rates(const EvaluationContext& at, Range elements, double* rates) const override {
    if constexpr (N > 0) {
      for (Index i = elements.begin; i < elements.end; ++i) {
        parts_[i].internal_rates(view(at, i), rates + internal_[i]);
      }
    }
  }
  [[nodiscard]] Index advance_internal(const StepContext& at, Range elements, double* z) const override {
    if constexpr (N > 0) {
      for (Index i = elements.begin; i < elements.end; ++i) {
        const ElementStep<D> element = step(at, i);
        double* const own = z + internal_[i];
        if constexpr (requires(const P& part) { part.advance_internal(element, own); }) {
          parts_[i].advance_internal(element, own);
          if (!std::all_of(own, own + N, [](double number) { return std::isfinite(number); })) return i;
        } else {
          std::array<double, static_cast<std::size_t>(N)> before{};
          parts_[i].internal_rates(element.start, before.data());
          const auto rates_at_end = [&](const double*, double* rates) {
            parts_[i].internal_rates(element.end, rates);
          };
          if (!advance_trapezoidal<N>(at.step, element.start.internal(), before.data(), rates_at_end, own))
            return i;
        }
      }
    }
    return elements.end;
  }
  [[nodiscard]] double internal_loss_rate(const EvaluationContext& at, Range elements) const override {
    double sum = 0.0;
    if constexpr (requires(const P& part, const ElementView<D>& element) {
                    part.internal_loss_rate(element);
                  }) {
      for (Index i = elements.begin; i < elements.end; ++i) sum += parts_[i].internal_loss_rate(view(at, i));
    }
    return sum;
  }
  [[nodiscard]] double internal_loss(const StepContext& at, Range elements) const override {
    if constexpr (requires(const P& part, const ElementStep<D>& element) { part.internal_loss(element); }) {
      double sum = 0.0;
      for (Index i = elements.begin; i < elements.end; ++i) sum += parts_[i].internal_loss(step(at, i));
      return sum;
    } else {
      return ForceKind::internal_loss(at, elements);
    }
  }
  [[nodiscard]] bool has_derivatives() const override { return gives_derivatives; }
  void derivatives(const EvaluationContext& at, Index element,
                   std::vector<LoadDerivative>& out) const override {
    if constexpr (gives_derivatives) {
      const ElementView<D> seen = view(at, element);
      ElementDerivatives<D> list(seen, out);
      parts_[element].derivatives(seen, list);
    } else {
      ForceKind::derivatives(at, element, out);
    }
  }
  [[nodiscard]] Index first_without_direction(const EvaluationContext& at, Range elements,
                                              double fastest) const override {
    if constexpr (requires(const P& part, const ElementView<D>& seen) {
                    part.lacks_direction(seen, fastest);
                  }) {
      for (Index i = elements.begin; i < elements.end; ++i) {
        if (parts_[i].lacks_direction(view(at, i), fastest)) return i;
      }
    }
    return elements.end;
  }
  [[nodiscard]] Index guard_size() const override { return static_cast<Index>(guard_count); }
  void guards(const EvaluationContext& at, Range elements, double* out) const override {
    if constexpr (guard_count > 0) {
      for (Index i = elements.begin; i < elements.end; ++i, out += guard_count) {
        parts_[i].guards(view(at, i), out);
      }
    }
  }
  [[nodiscard]] bool has_guard_motion() const override { return gives_guard_motion; }
  void guard_motion(const EvaluationContext& at, const double* acceleration, Range elements,
                    GuardMotion* out) const override {
    if constexpr (gives_guard_motion) {
      for (Index i = elements.begin; i < elements.end; ++i, out += guard_count) {
        const double* internal = nullptr;
        if constexpr (N > 0) internal = at.state.z + internal_[i];
        parts_[i].guard_motion(ElementMotion<D>(at, acceleration, internal), out);
      }
    }
  }
  void discontinuity_times(Index element, std::vector<double>& out) const override {
    if constexpr (has_breaks) {
      out.insert(out.end(), parts_[element].breaks.begin(), parts_[element].breaks.end());
    }
  }
  [[nodiscard]] bool depends_on_time() const override {
    if constexpr (requires { P::depends_on_time; }) {
      return P::depends_on_time;
    } else {
      return true;
    }
  }
  void fingerprint(Fingerprint& print) const override {
    for (const P& part : parts_) {
      add_bodies(print, part.bodies());
      if constexpr (requires { part.fingerprint(print); }) part.fingerprint(print);
      if constexpr (has_breaks) {
        if (!part.breaks.empty()) print.add(part.breaks);
      }
    }
  }

private:
  /// Internal variables of an element.
  static constexpr int N = [] {
    if constexpr (requires { P::internal_size; }) {
      return static_cast<int>(P::internal_size);
    } else {
      return 0;
    }
  }();
  /// Guards of an element.
  static constexpr int guard_count = [] {
    if constexpr (requires { P::guard_size; }) {
      return static_cast<int>(P::guard_size);
    } else {
      return 0;
    }
  }();
  static_assert(
      guard_count == 0 ||
          requires(const P& part, const ElementView<D>& view, double* out) { part.guards(view, out); },
      "an element with guard_size has guards()");
  static constexpr bool gives_guard_motion = guard_count > 0 &&
                                             requires(const P& part, const ElementMotion<D>& at,
                                                      GuardMotion* out) {
    part.guard_motion(at, out);
  };
  static constexpr bool has_breaks = requires(const P& part) { std::span<const double>(part.breaks); };
  static constexpr bool has_mean_loads =
      requires(const P& part, const ElementStep<D>& step, ElementLoads<D>& out) {
    part.mean_loads(step, out);
  };

  [[nodiscard]] ElementView<D> view(const EvaluationContext& at, Index element) const {
    if constexpr (N > 0) return ElementView<D>(at, at.state.z + internal_[element]);
    return ElementView<D>(at);
  }
  [[nodiscard]] ElementStep<D> step(const StepContext& at, Index element) const {
    return {view(at.start, element), view(at.end, element), view(at.middle, element), at.step};
  }

  static constexpr bool gives_derivatives =
      requires(const P& part, const ElementView<D>& view, ElementDerivatives<D>& list) {
    part.derivatives(view, list);
  };

  std::vector<P> parts_;
};

}  // namespace carom
