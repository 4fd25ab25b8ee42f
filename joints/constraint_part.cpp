#include <carom/joints/constraint_part.h>

#include <string>

namespace carom::planar {

void check_constraint_parts(const PartCheck& check, std::span<const ConstraintPart> constraints,
                            Index count) {
  if (constraints.size() != count)
    check.refuse("number of constraint parts", std::to_string(constraints.size()), std::to_string(count));
  const ConstraintPart* points = nullptr;
  for (const ConstraintPart& constraint : constraints) {
    const ConstraintPart& first = constraints.front();
    bool same = constraint.from.body == first.from.body && constraint.to.body == first.to.body &&
                constraint.carrier == first.carrier;
    if (constraint.form != ConstraintPart::Form::angles) {
      if (points == nullptr) points = &constraint;
      same = same && constraint.from.point == points->from.point && constraint.to.point == points->to.point;
    }
    if (!same) check.refuse("constraint parts", "between different ends", "all between the same two ends");
  }
}

}  // namespace carom::planar
