// Problem: the paper's LCP for any number of contacts, tangential impulses eliminated.

#include <carom/contact/solvers/lcp_forms.h>
#include <carom/contact/solvers/residual.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// a b - c d with an error of two roundings of the result.
double fused_difference(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

}  // namespace

void group_scales(const ContactProblem& problem, std::vector<double>& scale) {
  scale.assign(static_cast<std::size_t>(problem.rows()), 1.0);
  for (const RowGroup& group : problem.groups()) {
    const double trace = group_trace(problem, group);
    if (!(trace > 0.0) || !std::isfinite(trace)) continue;
    const double s = std::exp2(-std::floor(0.5 * std::log2(trace)));
    for (int i = group.first; i < group.first + group.size; ++i) scale[static_cast<std::size_t>(i)] = s;
  }
}

void couple_columns(const ContactProblem& problem, std::span<const double> scale,
                    std::vector<double>& coupled) {
  const std::size_t n = scale.size();
  coupled.resize(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      coupled[i * n + j] = scale[i] * problem.matrix()[i * n + j] * scale[j];
  }
  // Rows of one group have one scale, so that the factor stays what it is.
  for (std::size_t k = 0; k < n; ++k) {
    const RowSet& set = problem.sets()[k];
    if (set.kind != SetKind::proportional) continue;
    const auto bound = static_cast<std::size_t>(set.bound);
    for (std::size_t i = 0; i < n; ++i) {
      coupled[i * n + bound] = std::fma(set.coefficient, coupled[i * n + k], coupled[i * n + bound]);
    }
  }
}

bool PaperForm::classify(const ContactProblem& problem) {
  group_scales(problem, scale_);
  couple_columns(problem, scale_, coupled_);
  rows_.assign(scale_.size(), {});
  normal_.clear();
  eliminated_.clear();
  variables_ = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const RowSet& set = problem.sets()[i];
    Row& row = rows_[i];
    const bool below = std::isfinite(set.lower), above = std::isfinite(set.upper);
    if (set.kind == SetKind::bounded_disc) return false;
    if (set.kind == SetKind::proportional) continue;  // follows its normal row
    row.eliminated =
        set.kind == SetKind::bounded_interval || (set.kind == SetKind::interval && below == above);
    row.place = row.eliminated ? eliminated_.size() : normal_.size();
    (row.eliminated ? eliminated_ : normal_).push_back(i);
    if (!row.eliminated) {
      row.normal = variables_++;
      if (set.kind == SetKind::interval) {
        row.sign = below ? 1.0 : -1.0;
        row.offset = (below ? set.lower : set.upper) / scale_[i];
      }
    } else if (set.kind == SetKind::bounded_interval || below) {
      row.upper = variables_++;
      row.lower = variables_++;
    }
  }
  return true;
}

// W_TT^-1 and what follows from it; false where the block is singular.
bool PaperForm::eliminate(const ContactProblem& problem) {
  const std::size_t t = eliminated_.size(), n = normal_.size();
  inverse_.resize(t * t);
  transfer_.resize(t * n);
  shift_.resize(t);
  if (t == 0) return true;
  block_.resize(t * t);
  rhs_.resize(t);
  for (std::size_t i = 0; i < t; ++i) {
    for (std::size_t j = 0; j < t; ++j) block_[i * t + j] = w(eliminated_[i], eliminated_[j]);
  }
  qr_.factor(block_, t, t, elimination_threshold);
  if (qr_.rank() < t) return false;
  // block_ has been copied by the factorisation and serves as memory for one column from here on.
  const auto column = std::span(block_).first(t);
  for (std::size_t j = 0; j < t; ++j) {
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    rhs_[j] = 1.0;
    qr_.solve(rhs_, column);
    for (std::size_t i = 0; i < t; ++i) inverse_[i * t + j] = column[i];
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < t; ++i) rhs_[i] = w(eliminated_[i], normal_[j]);
    qr_.solve(rhs_, column);
    for (std::size_t i = 0; i < t; ++i) transfer_[i * n + j] = column[i];
  }
  for (std::size_t i = 0; i < t; ++i) {
    rhs_[i] = scale_[eliminated_[i]] * problem.vector()[eliminated_[i]];
    for (std::size_t j = 0; j < n; ++j) rhs_[i] += w(eliminated_[i], normal_[j]) * rows_[normal_[j]].offset;
  }
  qr_.solve(rhs_, shift_);
  return true;
}

// xi_N = (W_NN - W_NT W_TT^-1 W_TN) P_N + W_NT W_TT^-1 (chi2 - chi1) + b_N - W_NT W_TT^-1 b_T
void PaperForm::fill_normal_rows(const ContactProblem& problem, Lcp& lcp) {
  const std::size_t t = eliminated_.size(), n = normal_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = normal_[i];
    const Row& row = rows_[at];
    double q = scale_[at] * problem.vector()[at];
    for (std::size_t k = 0; k < t; ++k) q -= w(at, eliminated_[k]) * shift_[k];
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t other = normal_[j];
      double entry = w(at, other);
      if (t == 1) {
        // The paper's first entry, (1/m2 - m1 / Ibar^2), cancels badly as printed; this does not.
        const std::size_t e = eliminated_[0];
        entry = fused_difference(entry, w(e, e), w(at, e), w(e, other)) / w(e, e);
      } else {
        for (std::size_t k = 0; k < t; ++k) entry -= w(at, eliminated_[k]) * transfer_[k * n + j];
      }
      q += w(at, other) * rows_[other].offset;
      lcp.at(row.normal, rows_[other].normal) = row.sign * entry * rows_[other].sign;
    }
    for (std::size_t j = 0; j < t; ++j) {
      const Row& other = rows_[eliminated_[j]];
      if (other.upper < 0) continue;
      double entry = 0.0;
      for (std::size_t k = 0; k < t; ++k) entry += w(at, eliminated_[k]) * inverse_[k * t + j];
      lcp.at(row.normal, other.upper) = -row.sign * entry;
      lcp.at(row.normal, other.lower) = row.sign * entry;
    }
    lcp.q[static_cast<std::size_t>(row.normal)] = row.sign * q;
  }
}

// psi1 = hi - P_T and psi2 = P_T - lo, hi = -lo = mu P_n for friction.
void PaperForm::fill_friction_rows(const ContactProblem& problem, Lcp& lcp) {
  const std::size_t t = eliminated_.size(), n = normal_.size();
  for (std::size_t i = 0; i < t; ++i) {
    const std::size_t at = eliminated_[i];
    const Row& row = rows_[at];
    if (row.upper < 0) continue;
    for (std::size_t j = 0; j < n; ++j) {
      const Row& other = rows_[normal_[j]];
      lcp.at(row.upper, other.normal) += other.sign * transfer_[i * n + j];
      lcp.at(row.lower, other.normal) -= other.sign * transfer_[i * n + j];
    }
    for (std::size_t j = 0; j < t; ++j) {
      const Row& other = rows_[eliminated_[j]];
      if (other.upper < 0) continue;
      const double entry = inverse_[i * t + j];
      lcp.at(row.upper, other.upper) = entry;
      lcp.at(row.upper, other.lower) = -entry;
      lcp.at(row.lower, other.upper) = -entry;
      lcp.at(row.lower, other.lower) = entry;
    }
    double& q_upper = lcp.q[static_cast<std::size_t>(row.upper)];
    double& q_lower = lcp.q[static_cast<std::size_t>(row.lower)];
    q_upper = shift_[i];
    q_lower = -shift_[i];
    const RowSet& set = problem.sets()[at];
    if (set.kind == SetKind::interval) {
      q_upper += set.upper / scale_[at];
      q_lower -= set.lower / scale_[at];
      continue;
    }
    // The bounding row is never eliminated unless it is a two-sided interval, which classify() refuses.
    const Row& bound = rows_[static_cast<std::size_t>(set.bound)];
    lcp.at(row.upper, bound.normal) += set.coefficient * bound.sign;
    lcp.at(row.lower, bound.normal) += set.coefficient * bound.sign;
    q_upper += set.coefficient * bound.offset;
    q_lower += set.coefficient * bound.offset;
  }
}

bool PaperForm::build(const ContactProblem& problem, Lcp& lcp) {
  if (!classify(problem)) return false;
  for (const RowSet& set : problem.sets()) {
    const bool follows = set.kind == SetKind::bounded_interval || set.kind == SetKind::proportional;
    if (follows && rows_[static_cast<std::size_t>(set.bound)].eliminated) return false;
  }
  if (!eliminate(problem)) return false;
  lcp.reset(variables_);
  fill_normal_rows(problem, lcp);
  fill_friction_rows(problem, lcp);
  return true;
}

void PaperForm::impulses(const ContactProblem& problem, std::span<const double> z,
                         std::span<double> impulse) {
  const std::size_t t = eliminated_.size(), n = normal_.size();
  const auto value = [&](int variable) { return variable < 0 ? 0.0 : z[static_cast<std::size_t>(variable)]; };
  for (const std::size_t i : normal_) {
    impulse[i] = scale_[i] * (rows_[i].offset + rows_[i].sign * value(rows_[i].normal));
  }
  for (std::size_t i = 0; i < t; ++i) {
    const std::size_t at = eliminated_[i];
    const RowSet& set = problem.sets()[at];
    double lower = set.lower, upper = set.upper;
    if (set.kind == SetKind::bounded_interval) {
      upper = set.coefficient * impulse[static_cast<std::size_t>(set.bound)];
      lower = -upper;
    }
    // A row that moves stands at its bound; one that does not comes from the eliminated equations.
    if (value(rows_[at].upper) > 0.0) {
      impulse[at] = upper;
    } else if (value(rows_[at].lower) > 0.0) {
      impulse[at] = lower;
    } else {
      double p = -shift_[i];
      for (std::size_t j = 0; j < n; ++j) {
        p -= transfer_[i * n + j] * rows_[normal_[j]].sign * value(rows_[normal_[j]].normal);
      }
      for (std::size_t j = 0; j < t; ++j) {
        const Row& other = rows_[eliminated_[j]];
        p += inverse_[i * t + j] * (value(other.lower) - value(other.upper));
      }
      impulse[at] = std::clamp(scale_[at] * p, lower, upper);
    }
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const RowSet& set = problem.sets()[i];
    if (set.kind == SetKind::proportional) {
      impulse[i] = set.coefficient * impulse[static_cast<std::size_t>(set.bound)];
    }
  }
}

}  // namespace carom
