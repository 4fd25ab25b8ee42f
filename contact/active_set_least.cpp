// Problem: forces that closed contacts leave open, chosen so that they depend continuously on the state, or
// so that they are as far as possible from the end of the modes.

#include <carom/contact/active_set.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace carom {

namespace {

// A line of the law that is violated by less, in parts of the forces, is kept.
constexpr double kept = 1e-13;

// Slope of the unknown by which lines give way: the square, times the multipliers, is what they give way by
// where they need not.
constexpr double yield = 1e-5;

// Of a multiplier of the margin, all of which sum to 1: rounding.
constexpr double no_part = 1e-9;

}  // namespace

/// Null vector of the matrix last factorised that belongs to one of its free columns, into work_.
void ActiveSet::find_null_vector(std::size_t free) {
  const std::size_t n = rows_.size();
  const auto entry = [&](std::size_t i, std::size_t j) {
    return matrix_[row_order_[i] * n + column_order_[j]];
  };
  work_.assign(n, 0.0);
  work_[column_order_[free]] = 1.0;
  for (std::size_t i = rank_; i-- > 0;) {
    double sum = -entry(i, free);
    for (std::size_t j = i + 1; j < rank_; ++j) sum -= entry(i, j) * work_[column_order_[j]];
    work_[column_order_[i]] = sum / entry(i, i);
  }
}

/// Forces of least norm: those of the basic solution without their part along the null vectors, and those of
/// least norm that the law of contact allows where these are not allowed. Which rows elimination takes for
/// dependent is a matter of rounding; this solution does not depend on it. It does not jump where contacts
/// change their mode either: there the law leaves the same forces in both modes.
void ActiveSet::take_least(std::size_t first, std::size_t last) {
  const std::size_t n = rows_.size();
  orthonormal_.clear();
  // The friction of a contact that slips is part of the force too.
  const auto dot = [&](const double* a, const double* b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const ActiveContact& contact = contacts_[rows_[i].contact];
      const double ratio = contact.sticks() ? 0.0 : contact.friction;
      sum += (1.0 + ratio * ratio) * a[i] * b[i];
    }
    return sum;
  };
  for (std::size_t free = rank_; free < n; ++free) {
    find_null_vector(free);
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
    const double along = dot(unknown_.data(), orthonormal_.data() + at);
    for (std::size_t i = 0; i < n; ++i) unknown_[i] -= along * orthonormal_[at + i];
  }
  take_allowed(first, last);
}

/// Lines a + S x + yield z >= 0 of the law, x along the orthonormal null vectors: normal forces, and
/// distances from the edges of friction where contacts stick.
void ActiveSet::collect_lines(std::size_t first, std::size_t last) {
  const std::size_t n = rows_.size(), vectors = orthonormal_.size() / n;
  lines_at_.clear();
  slopes_.clear();
  std::size_t normal = n, row = 0;  // rows of the contact at hand
  for (std::size_t i = first; i < last; ++i) {
    const ActiveContact& contact = contacts_[i];
    const bool has_dry_friction = contact.at.has_dry_friction();
    if (!has_dry_friction) {
      normal = row++;
      lines_at_.push_back(unknown_[normal]);
      for (std::size_t k = 0; k < vectors; ++k) slopes_.push_back(orthonormal_[k * n + normal]);
      slopes_.push_back(yield);
    }
    if (!contact.sticks()) continue;
    const std::size_t tangent = row++;
    const double pressed = has_dry_friction ? contact.at.friction_bound : unknown_[normal];
    for (const double side : {-1.0, 1.0}) {
      lines_at_.push_back(contact.friction * pressed + side * unknown_[tangent]);
      for (std::size_t k = 0; k < vectors; ++k) {
        const double* const vector = orthonormal_.data() + k * n;
        slopes_.push_back((has_dry_friction ? 0.0 : contact.friction * vector[normal]) +
                          side * vector[tangent]);
      }
      slopes_.push_back(yield);
    }
  }
}

/// Where lines are violated, the least x with which none is. A last unknown, z, lets all lines give way
/// together, at a price: where the law allows no forces (behind the end of the modes) x depends continuously
/// on the state, too.
void ActiveSet::take_allowed(std::size_t first, std::size_t last) {
  const std::size_t n = rows_.size(), vectors = orthonormal_.size() / n;
  collect_lines(first, last);
  double size = 0.0;
  for (const double force : unknown_) size += std::abs(force);
  const auto allowed = [&](double line) { return line >= -kept * size; };
  if (!std::isfinite(size) || std::all_of(lines_at_.begin(), lines_at_.end(), allowed)) return;
  work_.assign(vectors + 1, 0.0);
  least_distance_.solve(lines_at_, slopes_, kept * size, work_);
  // Behind the end of the modes multipliers are large, and with them rounding, until lines are moved there.
  for (double& line : lines_at_) line += yield * work_[vectors];
  least_distance_.solve(lines_at_, slopes_, kept * size, work_);
  for (std::size_t k = 0; k < vectors; ++k) {
    for (std::size_t i = 0; i < n; ++i) unknown_[i] += work_[k] * orthonormal_[k * n + i];
  }
}

/// Makes the margin of a group largest over all its vectors [from, to) at once. With x along the vectors,
/// lines a_i + s_i x over the margins, and t = the least of them, the linear program
///
///     largest t' >= 0,   a_i + s_i (x+ - x-) >= t' + a_least,   t' + a_least <= bound,   x+, x- >= 0
///
/// as a complementarity problem. What wedges has no largest margin: `bound` is one that is large enough.
bool ActiveSet::distribute_forces(std::size_t from, std::size_t to) {
  const std::size_t first = spreads_[from].first, last = spreads_[from].last;
  const int vectors = static_cast<int>(to - from), top = 2 * vectors;
  int lines = 0;
  double least = std::numeric_limits<double>::infinity(), size = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const ActiveContact& c = contacts_[i];
    lines += (c.at.has_dry_friction() ? 0 : 1) + (c.sticks() ? 2 : 0);
    size += std::abs(c.normal) + std::abs(c.tangential);
    if (!c.at.has_dry_friction()) least = std::min(least, c.normal);
    if (c.sticks()) least = std::min(least, c.friction * c.normal - std::abs(c.tangential));
  }
  if (!(size > 0.0) || !std::isfinite(size)) return false;
  lcp_.reset(top + 1 + lines + 1);
  int row = top + 1;
  const auto line = [&](double at, const auto& slope) {
    lcp_.q[static_cast<std::size_t>(row)] = at - least;
    for (int k = 0; k < vectors; ++k) {
      const double s = slope(null_.data() + spreads_[from + static_cast<std::size_t>(k)].vector);
      lcp_.at(row, k) = s;
      lcp_.at(row, vectors + k) = -s;
      lcp_.at(k, row) = -s;
      lcp_.at(vectors + k, row) = s;
    }
    lcp_.at(row, top) = -1.0;
    lcp_.at(top, row) = 1.0;
    ++row;
  };
  for (std::size_t i = first; i < last; ++i) {
    const ActiveContact& c = contacts_[i];
    const std::size_t at = 2 * (i - first);
    if (!c.at.has_dry_friction()) line(c.normal, [&](const double* vector) { return vector[at]; });
    if (!c.sticks()) continue;
    for (const double side : {-1.0, 1.0}) {
      line(c.friction * c.normal + side * c.tangential,
           [&](const double* vector) { return c.friction * vector[at] + side * vector[at + 1]; });
    }
  }
  line(size, [](const double*) { return 0.0; });
  lcp_.q[static_cast<std::size_t>(top)] = -1.0;
  work_.assign(static_cast<std::size_t>(lcp_.size), 0.0);
  if (lemke_.solve(lcp_, work_).status != LcpStatus::solved) return false;
  // Lines with a positive number are at the least in every solution; others may be at it in this one only.
  for (std::size_t i = first, at = static_cast<std::size_t>(top) + 1; least_ && i < last; ++i) {
    const std::size_t of_contact =
        (contacts_[i].at.has_dry_friction() ? 0U : 1U) + (contacts_[i].sticks() ? 2U : 0U);
    const auto begin = work_.begin() + static_cast<std::ptrdiff_t>(at);
    contacts_[i].sets_margin = std::any_of(begin, begin + static_cast<std::ptrdiff_t>(of_contact),
                                           [](double number) { return number > no_part; });
    at += of_contact;
  }
  for (int k = 0; k < vectors; ++k) {
    const double shift = work_[static_cast<std::size_t>(k)] - work_[static_cast<std::size_t>(vectors + k)];
    const double* const vector = null_.data() + spreads_[from + static_cast<std::size_t>(k)].vector;
    for (std::size_t i = first; i < last; ++i) {
      contacts_[i].normal += shift * vector[2 * (i - first)];
      contacts_[i].tangential += shift * vector[2 * (i - first) + 1];
    }
  }
  return true;
}

}  // namespace carom
