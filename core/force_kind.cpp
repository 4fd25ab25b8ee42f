#include <carom/core/assembly.h>
#include <carom/core/difference_derivatives.h>
#include <carom/core/errors.h>
#include <carom/core/force_kind.h>

namespace carom {

EvaluationContext::EvaluationContext(const Assembly& of, const StateView& at, const Evaluation& derived,
                                     Index within, Range of_field)
    : assembly(of),
      layout(*of.layout()),
      state(at),
      evaluation(derived),
      component(within),
      reach(of.components()[within].bodies),
      bodies(of_field) {}

void EvaluationContext::refuse_unnamed(BodyId body) const {
  throw ModelError("force element: acts on or looks at " + assembly.system().name(body) +
                   ", which it does not name; allowed: a body among its bodies()");
}

void EvaluationContext::refuse_unoriented(BodyId body) const {
  throw ModelError(assembly.system().name(body) + ": has no orientation; allowed: a rigid body");
}

void ForceKind::derivatives(const EvaluationContext& at, Index element,
                            std::vector<LoadDerivative>& out) const {
  difference_derivatives(*this, at, element, out);
}

}  // namespace carom
