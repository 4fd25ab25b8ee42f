// Problem: an LCP that exists for every contact problem without discs, singular W included.

#include <carom/contact/solvers/lcp_forms.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool CopositiveForm::classify(const ContactProblem& problem) {
  group_scales(problem, scale_);
  rows_.assign(scale_.size(), {});
  variables_ = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const RowSet& set = problem.sets()[i];
    Row& row = rows_[i];
    switch (set.kind) {
      case SetKind::bounded_disc:
        return false;
      case SetKind::proportional:
        break;  // follows its normal row: no variable
      case SetKind::half_line:
        row.plus = variables_++;
        break;
      case SetKind::bounded_interval:
        if (!(set.coefficient > 0.0)) break;  // P = 0: no variable
        row.plus = variables_++;
        row.minus = variables_++;
        row.slack = variables_++;
        break;
      case SetKind::interval: {
        const bool below = std::isfinite(set.lower), above = std::isfinite(set.upper);
        if (below) row.offset = set.lower / scale_[i];
        if (!below && above) row.offset = set.upper / scale_[i];
        if (below && above && !(set.lower < set.upper)) break;  // P is given: no variable
        if (below || !above) row.plus = variables_++;
        if (!below) row.minus = variables_++;
        if (below && above) row.slack = variables_++;
        break;
      }
    }
  }
  return true;
}

bool CopositiveForm::build(const ContactProblem& problem, Lcp& lcp) {
  if (!classify(problem)) return false;
  couple_columns(problem, scale_, coupled_);
  lcp.reset(variables_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const RowSet& set = problem.sets()[i];

    // xi' = W' P' + b', once with each sign.
    double q = scale_[i] * problem.vector()[i];
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const Row& other = rows_[j];
      const double w = coupled_[i * rows_.size() + j];
      q += w * other.offset;
      if (row.plus >= 0 && other.plus >= 0) lcp.at(row.plus, other.plus) = w;
      if (row.plus >= 0 && other.minus >= 0) lcp.at(row.plus, other.minus) = -w;
      if (row.minus >= 0 && other.plus >= 0) lcp.at(row.minus, other.plus) = -w;
      if (row.minus >= 0 && other.minus >= 0) lcp.at(row.minus, other.minus) = w;
    }
    if (row.plus >= 0) lcp.q[static_cast<std::size_t>(row.plus)] = q;
    if (row.minus >= 0) lcp.q[static_cast<std::size_t>(row.minus)] = -q;
    if (row.slack < 0) continue;

    double& room = lcp.q[static_cast<std::size_t>(row.slack)];
    lcp.at(row.plus, row.slack) = 1.0;
    lcp.at(row.slack, row.plus) = -1.0;
    if (set.kind == SetKind::interval) {
      room = (set.upper - set.lower) / scale_[i];
      continue;
    }
    lcp.at(row.minus, row.slack) = 1.0;
    lcp.at(row.slack, row.minus) = -1.0;
    const Row& bound = rows_[static_cast<std::size_t>(set.bound)];
    room = set.coefficient * bound.offset;
    if (bound.plus >= 0) lcp.at(row.slack, bound.plus) = set.coefficient;
  }
  return true;
}

void CopositiveForm::impulses(const ContactProblem& problem, std::span<const double> z,
                              std::span<double> impulse) const {
  const auto value = [&](int variable) { return variable < 0 ? 0.0 : z[static_cast<std::size_t>(variable)]; };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    double p = scale_[i] * (row.offset + value(row.plus) - value(row.minus));
    const RowSet& set = problem.sets()[i];
    if (set.kind == SetKind::proportional) {
      p = set.coefficient * impulse[static_cast<std::size_t>(set.bound)];
    }
    if (set.kind == SetKind::bounded_interval) {
      const double limit = set.coefficient * impulse[static_cast<std::size_t>(set.bound)];
      // Sliding means the bound exactly; what refinement leaves beside it is rounding.
      p = value(row.slack) > 0.0 && p != 0.0 ? std::copysign(limit, p) : std::clamp(p, -limit, limit);
    }
    if (set.kind == SetKind::interval) p = std::clamp(p, set.lower, set.upper);
    impulse[i] = p;
  }
}

}  // namespace carom
