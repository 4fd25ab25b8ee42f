#pragma once

/// \file
/// Interface of a kind of force elements. Elements of one kind are stored together; every call is for the
/// elements of one component.

#include <carom/core/energy_term.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>
#include <carom/core/state.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

class Assembly;
struct GuardMotion;

/// State at which elements are evaluated.
struct CAROM_API EvaluationContext {
  /// \param component the elements belong to \param bodies for a field, those of the component that it acts
  /// on
  EvaluationContext(const Assembly& assembly, const StateView& state, const Evaluation& evaluation,
                    Index component, Range bodies = {});

  const Assembly& assembly;      ///< the model
  const Layout& layout;          ///< places of its bodies
  StateView state;               ///< the state
  const Evaluation& evaluation;  ///< its derived quantities; those of position are up to date
  Index component;               ///< the component the elements belong to
  Range reach;                   ///< all bodies of the component
  Range bodies;  ///< for a field, the bodies that it acts on; all of the component if empty. For
                 ///< a potential they may be uncoupled bodies of several components

  /// Throws the ModelError of an element that looks at a body outside its component.
  [[noreturn]] void refuse_unnamed(BodyId body) const;
  /// Throws the ModelError of a body without orientation, of which one was asked.
  [[noreturn]] void refuse_unoriented(BodyId body) const;
};

/// A step of time stepping for elements: its two ends and the middle (mean velocities and internal variables,
/// positions advanced by half the step).
struct StepContext {
  const EvaluationContext& start;
  const EvaluationContext& end;
  const EvaluationContext& middle;  ///< up to date only if some kind uses_middle()
  double step;                      ///< h [s]
};

/// One entry of the derivative of the loads of an element. Entries at the same place add up.
struct LoadDerivative {
  Index row = 0;             ///< velocity coordinate the load acts on
  Index column = 0;          ///< velocity coordinate along which position or velocity changes
  double by_position = 0.0;  ///< d load / d position along that coordinate
  double by_velocity = 0.0;  ///< d load / d velocity
};

/// All elements of one kind.
class CAROM_API ForceKind {
public:
  virtual ~ForceKind() = default;

  /// A copy.
  [[nodiscard]] virtual std::unique_ptr<ForceKind> clone() const = 0;
  /// A copy with the elements named by `order`, in that order, and their ends looked up in `layout`.
  [[nodiscard]] virtual std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                            const Layout& layout) const = 0;
  /// Removes an element; later ones move up.
  virtual void remove(Index slot) = 0;

  /// Name used in messages, e.g. "spring-damper".
  [[nodiscard]] virtual std::string_view label() const = 0;
  /// Dimension of the models it is for: 2 or 3, 0 if it fits both.
  [[nodiscard]] virtual int dimension() const = 0;
  /// Number of elements.
  [[nodiscard]] virtual Index size() const = 0;
  /// True if each element acts on every body (gravity); such elements join no components.
  [[nodiscard]] virtual bool is_field() const { return false; }
  /// True if evaluate() and potential() may be called for a part of a component at a time, with elements that
  /// act within it (a field: on EvaluationContext::bodies), and on several threads at once.
  [[nodiscard]] virtual bool works_in_parts() const { return !is_field(); }
  /// Appends the bodies an element acts on (ground included, nothing for a field).
  virtual void ends(Index element, std::vector<BodyId>& out) const = 0;
  /// The joint on whose coordinate an element acts (a motor), or an invalid identity.
  [[nodiscard]] virtual JointId on_joint(Index /*element*/) const { return {}; }
  /// True if elements may book external loads.
  [[nodiscard]] virtual bool books_external() const { return true; }
  /// True if elements may book dissipative loads.
  [[nodiscard]] virtual bool books_dissipative() const { return true; }
  /// True if elements use the rotations of bodies (Evaluation::rotation).
  [[nodiscard]] virtual bool needs_rotations() const { return true; }
  /// True if the load on a body is constant: it depends neither on its position nor on its velocity.
  [[nodiscard]] virtual bool is_constant() const { return false; }
  /// Form of energy that potential() counts as.
  [[nodiscard]] virtual StoredEnergy stored_as() const { return StoredEnergy::potential; }

  /// Adds the loads of a range of elements on the bodies of one component.
  virtual void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const = 0;
  /// Potential energy of a range of elements [J].
  [[nodiscard]] virtual double potential(const EvaluationContext& at, Range elements) const = 0;
  /// True if derivatives() is overridden by closed forms.
  [[nodiscard]] virtual bool has_derivatives() const { return false; }
  /// Appends the derivatives of the loads of one element. By central differences unless overridden; for many
  /// elements DifferenceDerivatives is cheaper.
  virtual void derivatives(const EvaluationContext& at, Index element,
                           std::vector<LoadDerivative>& out) const;
  /// evaluate() and potential() together, for kinds where that is cheaper.
  virtual double evaluate_with_potential(const EvaluationContext& at, Range elements,
                                         const Loads& loads) const {
    evaluate(at, elements, loads);
    return potential(at, elements);
  }

  /// Adds the mean loads of a range of elements over a step, for the rule `energy_momentum`: their work is
  /// exactly the decrease of the potentials. Unless overridden the loads in the middle of the step, exact to
  /// second order.
  virtual void evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const {
    evaluate(at.middle, elements, loads);
  }
  /// True if evaluate_mean() or internal_loss() uses the middle of the step.
  [[nodiscard]] virtual bool uses_middle() const { return true; }

  /// Internal variables of each element (State::z); elements of a kind have equally many.
  [[nodiscard]] virtual Index internal_size() const { return 0; }
  /// Sets where the internal variables of each element begin in State::z. Called once, on an arranged kind.
  virtual void place_internal(std::span<const Index> /*first*/) {}
  /// Writes the internal variables of an element at the start of a run.
  virtual void initial_internal(Index /*element*/, double* /*z*/) const {}
  /// Writes dz/dt of a range of elements into `rates`, an array over all of State::z.
  virtual void internal_rates(const EvaluationContext& /*at*/, Range /*elements*/, double* /*rates*/) const {}
  /// Writes the internal variables at the end of a step, `z` = `at.end.state.z`, by the trapezoidal rule
  /// for the given motion; `z` has a guess. Returns the first element for which that fails, elements.end if
  /// there is none.
  [[nodiscard]] virtual Index advance_internal(const StepContext& /*at*/, Range elements,
                                               double* /*z*/) const {
    return elements.end;
  }
  /// Power lost inside a range of elements, in addition to that of their loads [W].
  [[nodiscard]] virtual double internal_loss_rate(const EvaluationContext& /*at*/, Range /*elements*/) const {
    return 0.0;
  }
  /// Energy lost inside a range of elements over a step [J].
  [[nodiscard]] virtual double internal_loss(const StepContext& at, Range elements) const {
    return at.step * internal_loss_rate(at.middle, elements);
  }

  /// The first of a range of elements whose force has a size but no direction: it acts along the line between
  /// two ends that stand at one place, but for rounding, and does not vanish there. No motion follows from
  /// such a state. elements.end if there is none. Ends that part or pass faster than the last argument [m/s]
  /// give the line by themselves; infinity: none do.
  [[nodiscard]] virtual Index first_without_direction(const EvaluationContext& /*at*/, Range elements,
                                                      double /*fastest*/) const {
    return elements.end;
  }

  /// Number of switching values of each element, the same for all of a kind: at their changes of sign the
  /// loads have a kink or jump. For the event-driven mode.
  [[nodiscard]] virtual Index guard_size() const { return 0; }
  /// Writes the switching values of a range of elements, one element after the other.
  virtual void guards(const EvaluationContext& /*at*/, Range /*elements*/, double* /*out*/) const {}
  /// True if guard_motion() is overridden: no change of sign within a step is missed then, however long the
  /// step. Otherwise guards are known by values alone, and EventDriven::longest_step bounds the steps.
  [[nodiscard]] virtual bool has_guard_motion() const { return false; }
  /// Writes guards() with their derivatives along the motion; the second argument are the accelerations of
  /// all velocity coordinates.
  virtual void guard_motion(const EvaluationContext& /*at*/, const double* /*acceleration*/,
                            Range /*elements*/, GuardMotion* /*out*/) const {}
  /// Appends the times [s], ascending, at which the law of an element jumps or has a kink.
  virtual void discontinuity_times(Index /*element*/, std::vector<double>& /*out*/) const {}
  /// True if loads may depend on the time, other than by positions, velocities and internal variables.
  [[nodiscard]] virtual bool depends_on_time() const { return true; }

  /// Adds all data that distinguish the elements of this kind (except functions).
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
