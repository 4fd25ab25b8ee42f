#include <carom/joints/constraint_part_table.h>
#include <carom/joints/joint.h>

namespace carom::planar {

CompositeJoints::CompositeJoints(std::string_view label, Index row_count, bool with_coordinate)
    : label_(label),
      row_count_(row_count),
      with_coordinate_(with_coordinate),
      table_(new ConstraintPartTable) {}
CompositeJoints::CompositeJoints(const CompositeJoints& other)
    : JointKind(other),
      label_(other.label_),
      row_count_(other.row_count_),
      with_coordinate_(other.with_coordinate_),
      table_(new ConstraintPartTable(*other.table_)) {}
CompositeJoints::~CompositeJoints() = default;

void CompositeJoints::store(const PartCheck& check, const std::vector<ConstraintPart>& constraints) {
  check_constraint_parts(check, constraints, row_count_ + (with_coordinate_ ? 1 : 0));
  table_->add(constraints);
}
void CompositeJoints::take(const CompositeJoints& from, std::span<const Index> order, const Layout& layout) {
  *table_ = from.table_->arranged(order, layout);
}

void CompositeJoints::remove(Index slot) { table_->erase(slot); }
Index CompositeJoints::size() const { return table_->size(); }
void CompositeJoints::ends(Index joint, std::vector<BodyId>& out) const { table_->ends(joint, out); }
void CompositeJoints::pattern(Index joint, JointRow* out) const {
  for (Index row = 0; row < row_count_; ++row) table_->pattern(joint, out[row]);
}
void CompositeJoints::evaluate(const JointView& at, Index joint, JointRow* out) const {
  for (Index row = 0; row < row_count_; ++row) table_->evaluate(at, joint, row, out[row]);
}
void CompositeJoints::evaluate_all(const JointView& at, Range joints, JointNumbers out) const {
  table_->evaluate(at, joints, row_count_, out);
}
void CompositeJoints::derivatives(const JointView& at, Index joint, JointRowDerivative* out) const {
  for (Index row = 0; row < row_count_; ++row) table_->derivatives(at, joint, row, out[row]);
}
void CompositeJoints::coordinate(const JointView& at, Index joint, JointRow& out) const {
  if (with_coordinate_) table_->evaluate(at, joint, row_count_, out);
}
void CompositeJoints::coordinate_derivatives(const JointView& at, Index joint,
                                             JointRowDerivative& out) const {
  if (with_coordinate_) table_->derivatives(at, joint, row_count_, out);
}
void CompositeJoints::coordinate_pattern(Index joint, JointRow& out) const {
  if (with_coordinate_) table_->pattern(joint, out);
}
JointReaction CompositeJoints::reaction(const JointView& at, Index joint, const double* multipliers) const {
  return table_->reaction(at, joint, row_count_, multipliers);
}
std::optional<JointPlaces> CompositeJoints::places(const JointView& at, Index joint) const {
  // Angles alone have no points.
  if (table_->constraint(joint, 0).form == ConstraintPart::Form::angles) return std::nullopt;
  return table_->places(at, joint);
}
void CompositeJoints::fingerprint(Fingerprint& print) const { table_->fingerprint(print); }

}  // namespace carom::planar
