#include <carom/core/dynamics/joint_constraints.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

JointConstraints::JointConstraints(const Assembly& assembly, Index component)
    : v_(assembly.components()[component].v) {
  auto pattern = std::make_shared<const JointPattern>(assembly, component, factors_.by_masses());
  if (pattern->rows() == 0) return;
  jacobian_.assign(pattern->numbers(), 0.0);
  for (std::vector<double>* const numbers : {&gap_, &drift_, &right_}) numbers->assign(pattern->rows(), 0.0);
  if (pattern->depends_on_time()) rate_.assign(pattern->rows(), 0.0);
  pattern_ = std::move(pattern);
  // Masses of planar bodies, and of particles, are diagonal in the velocities.
  const std::vector<double> ones(v_.size(), 1.0);
  inverse_mass_.resize(v_.size());
  assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    kind.apply_inverse_mass(slots, ones.data() + (v - v_.begin), inverse_mass_.data() + (v - v_.begin));
  });
}

void JointConstraints::fix(Range velocities) {
  for (Index i = velocities.begin; i < velocities.end; ++i) inverse_mass_[i - v_.begin] = 0.0;
}

void JointConstraints::update(const JointView& at) {
  if (empty()) return;
  pattern_->evaluate(at, {jacobian_.data(), gap_.data(), rate_.empty() ? nullptr : rate_.data(), nullptr});
}

void JointConstraints::update_gaps(const JointView& at) {
  if (!empty()) pattern_->evaluate(at, {.gap = gap_.data()});
}

void JointConstraints::update_and_factor(const JointView& at) {
  if (empty()) return;
  pattern_->evaluate(at,
                     {jacobian_.data(), gap_.data(), rate_.empty() ? nullptr : rate_.data(), drift_.data()});
  factor();
}

void JointConstraints::factor() {
  if (empty()) return;
  factors_.factor(*pattern_, jacobian_.data(), inverse_mass_, v_.begin);
}

JointRow JointConstraints::row(std::size_t row) const {
  JointRow result = pattern_->row(row, jacobian_.data());
  result.gap = gap_[row];
  result.rate = rate(row);
  result.drift = drift_[row];
  return result;
}

void JointConstraints::residuals(JointLevel level, const double* x, double* out) const {
  const std::vector<double>* constants = nullptr;
  switch (level) {
    case JointLevel::displacement:
      constants = &gap_;
      break;
    case JointLevel::velocity:
      if (!rate_.empty()) constants = &rate_;
      break;
    case JointLevel::acceleration:
      constants = &drift_;
      break;
    case JointLevel::change:
      break;
  }
  if (constants != nullptr) {
    std::copy(constants->begin(), constants->end(), out);
  } else {
    std::fill_n(out, size(), 0.0);
  }
  pattern_->for_blocks(jacobian_.data(),
                       [&](Index row, auto rows, auto columns, Index v, const double* number, auto stride) {
                         for (Index i = 0; i < rows; ++i) {
                           double sum = 0.0;
                           for (Index c = 0; c < columns; ++c) sum += number[i * stride + c] * x[v + c];
                           out[row + i] += sum;
                         }
                       });
}

void JointConstraints::residuals_and_sizes(const double* x, double* out, double* sizes) const {
  for (std::size_t row = 0; row < size(); ++row) {
    out[row] = rate(row);
    sizes[row] = std::abs(out[row]);
  }
  pattern_->for_blocks(jacobian_.data(),
                       [&](Index row, auto rows, auto columns, Index v, const double* number, auto stride) {
                         for (Index i = 0; i < rows; ++i) {
                           double sum = 0.0, size = 0.0;
                           for (Index c = 0; c < columns; ++c) {
                             const double term = number[i * stride + c] * x[v + c];
                             sum += term;
                             size += std::abs(term);
                           }
                           out[row + i] += sum;
                           sizes[row + i] += size;
                         }
                       });
}

namespace {

/// Calls add(velocity, number of G^T l there).
template <class F>
void for_transposed(const JointPattern& pattern, const double* jacobian, const double* multipliers, F&& add) {
  pattern.for_blocks(jacobian,
                     [&](Index row, auto rows, auto columns, Index v, const double* number, auto stride) {
                       for (Index c = 0; c < columns; ++c) {
                         double sum = 0.0;
                         for (Index i = 0; i < rows; ++i)
                           sum += number[i * stride + c] * multipliers[row + i];
                         add(v + c, sum);
                       }
                     });
}

}  // namespace

void JointConstraints::add_transposed(const double* multipliers, double* x) const {
  for_transposed(*pattern_, jacobian_.data(), multipliers, [&](Index v, double sum) { x[v] += sum; });
}

namespace {

/// Corrects an answer of the factors until what it leaves does not shrink any more. \param left by row, work
/// \param find_left writes what the present answer leaves \param add takes the correction in `left`
template <class FindLeft, class Add>
void refine(JointFactors& factors, std::vector<double>& left, FindLeft&& find_left, Add&& add) {
  constexpr int most = 20;
  constexpr double shrinks = 0.5;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    find_left();
    double largest = 0.0;
    for (const double of_row : left) largest = std::max(largest, std::abs(of_row));
    if (largest == 0.0 || !(largest < shrinks * before)) return;
    before = largest;
    for (double& of_row : left) of_row = -of_row;
    factors.solve(left.data());
    add();
  }
}

}  // namespace

void JointConstraints::solve(double* r) {
  if (!factors_.is_inexact()) {
    for (std::size_t i = 0; i < size(); ++i) r[i] = -r[i];
    factors_.solve(r);
    return;
  }
  // G M^-1 G^T l is taken as G (M^-1 G^T l): in the product of the matrices light bodies hide heavy ones.
  given_.assign(r, r + size());
  std::fill_n(r, size(), 0.0);
  answer_.assign(v_.size(), 0.0);
  double* const x = answer_.data() - v_.begin;
  refine(
      factors_, right_,
      [&] {
        residuals(JointLevel::change, x, right_.data());
        for (std::size_t i = 0; i < size(); ++i) right_[i] += given_[i];
      },
      [&] {
        add_response(right_.data(), x);
        for (std::size_t i = 0; i < size(); ++i) r[i] += right_[i];
      });
}

void JointConstraints::add_response(const double* multipliers, double* x) const {
  const double* const inverse = inverse_mass_.data();
  for_transposed(*pattern_, jacobian_.data(), multipliers,
                 [&](Index v, double sum) { x[v] += inverse[v - v_.begin] * sum; });
}

void JointConstraints::apply_inverse_mass(double* x) const {
  for (Index i = v_.begin; i < v_.end; ++i) x[i] *= inverse_mass_[i - v_.begin];
}

void JointConstraints::project(JointLevel level, double* x, double* multipliers) {
  if (empty()) return;
  if (!factors_.is_inexact()) {
    residuals(level, x, right_.data());
    solve(right_.data());
    add_response(right_.data(), x);
    if (multipliers != nullptr) std::copy(right_.begin(), right_.end(), multipliers);
    return;
  }
  if (multipliers != nullptr) std::fill_n(multipliers, size(), 0.0);
  refine(
      factors_, right_, [&] { residuals(level, x, right_.data()); },
      [&] {
        add_response(right_.data(), x);
        if (multipliers == nullptr) return;
        for (std::size_t i = 0; i < size(); ++i) multipliers[i] += right_[i];
      });
}

}  // namespace carom
