#include <carom/core/difference_derivatives.h>
#include <carom/core/force_kind.h>

namespace carom {

void ForceKind::derivatives(const EvaluationContext& at, Index element,
                            std::vector<LoadDerivative>& out) const {
  difference_derivatives(*this, at, element, out);
}

}  // namespace carom
