// Problem: forces that closed contacts leave open, chosen so that they depend continuously on the state.

#include <carom/contact/least_forces.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// A line of the law that is violated by less, in parts of the forces, is kept.
constexpr double kept = 1e-13;

// Slope of the unknown by which lines give way: the square, times the multipliers, is what they give way by
// where they need not.
constexpr double yield = 1e-5;

}  // namespace

void LeastForces::find(std::span<const ActiveContact> contacts, std::span<const ActiveContact> group,
                       std::span<const ContactPivot::Row> rows, const FullPivoting& factors,
                       std::vector<double>& forces) {
  const std::size_t n = rows.size();
  orthonormal_.clear();
  // The friction of a contact that slips is part of the force too.
  const auto dot = [&](const double* a, const double* b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const ActiveContact& contact = contacts[rows[i].contact];
      const double ratio = contact.sticks() ? 0.0 : contact.friction;
      sum += (1.0 + ratio * ratio) * a[i] * b[i];
    }
    return sum;
  };
  for (std::size_t free = factors.rank(); free < n; ++free) {
    factors.null_vector(free, work_);
    for (int pass = 0; pass < 2; ++pass) {  // the second for what rounding left
      for (std::size_t at = 0; at < orthonormal_.size(); at += n) {
        const double along = dot(work_.data(), orthonormal_.data() + at);
        for (std::size_t i = 0; i < n; ++i) work_[i] -= along * orthonormal_[at + i];
      }
    }
    const double length = std::sqrt(dot(work_.data(), work_.data()));
    for (std::size_t i = 0; i < n; ++i) orthonormal_.push_back(work_[i] / length);
  }
  for (std::size_t at = 0; at < orthonormal_.size(); at += n) {
    const double along = dot(forces.data(), orthonormal_.data() + at);
    for (std::size_t i = 0; i < n; ++i) forces[i] -= along * orthonormal_[at + i];
  }
  take_allowed(group, forces);
}

/// Lines a + S x + yield z >= 0 of the law, x along the orthonormal null vectors: normal forces, and
/// distances from the edges of friction where contacts stick.
void LeastForces::collect_lines(std::span<const ActiveContact> group, const std::vector<double>& forces) {
  const std::size_t n = forces.size(), vectors = orthonormal_.size() / n;
  lines_at_.clear();
  slopes_.clear();
  std::size_t normal = n, row = 0;  // rows of the present contact
  for (const ActiveContact& contact : group) {
    if (contact.at.normals > 0) {
      normal = row++;
      lines_at_.push_back(forces[normal]);
      for (std::size_t k = 0; k < vectors; ++k) slopes_.push_back(orthonormal_[k * n + normal]);
      slopes_.push_back(yield);
    }
    if (!contact.sticks()) continue;
    const std::size_t tangent = row++;
    const bool is_given = contact.at.has_given_bound();
    const double bound = is_given ? contact.at.of_joint.friction_bound : forces[normal];
    for (const double side : {-1.0, 1.0}) {
      lines_at_.push_back(contact.friction * bound + side * forces[tangent]);
      for (std::size_t k = 0; k < vectors; ++k) {
        const double* const vector = orthonormal_.data() + k * n;
        slopes_.push_back((is_given ? 0.0 : contact.friction * vector[normal]) + side * vector[tangent]);
      }
      slopes_.push_back(yield);
    }
  }
}

/// Where lines are violated, the least x with which none is. A last unknown, z, lets all lines give way
/// together, at a price: where the law allows no forces (behind the end of the modes) x depends continuously
/// on the state, too.
void LeastForces::take_allowed(std::span<const ActiveContact> group, std::vector<double>& forces) {
  const std::size_t n = forces.size(), vectors = orthonormal_.size() / n;
  collect_lines(group, forces);
  double size = 0.0;
  for (const double force : forces) size += std::abs(force);
  const auto allowed = [&](double line) { return line >= -kept * size; };
  if (!std::isfinite(size) || std::all_of(lines_at_.begin(), lines_at_.end(), allowed)) return;
  work_.assign(vectors + 1, 0.0);
  least_distance_.solve(lines_at_, slopes_, kept * size, work_);
  // Behind the end of the modes multipliers are large, and with them rounding, until lines are moved there.
  for (double& line : lines_at_) line += yield * work_[vectors];
  least_distance_.solve(lines_at_, slopes_, kept * size, work_);
  for (std::size_t k = 0; k < vectors; ++k) {
    for (std::size_t i = 0; i < n; ++i) forces[i] += work_[k] * orthonormal_[k * n + i];
  }
}

}  // namespace carom
