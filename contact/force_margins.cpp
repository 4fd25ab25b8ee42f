// Problem: margins of forces that closed contacts leave open.

#include <carom/contact/force_margins.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Margin where nothing can come to an end: friction in joints that slips [N].
constexpr double unbounded_margin = 1.0;

// Of the largest number of a null vector: rounding. A margin that rises by rounding along a vector which
// wedges contacts would let their forces grow without bound until it is positive.
constexpr double no_slope = 1e-10;

// Of a multiplier of the margin, all of which sum to 1: rounding.
constexpr double no_part = 1e-9;

/// Sets numbers of a null vector to zero that are its rounding.
void remove_rounding(std::span<double> vector) {
  double largest = 0.0;
  for (const double number : vector) largest = std::max(largest, std::abs(number));
  for (double& number : vector) {
    if (std::abs(number) <= no_slope * largest) number = 0.0;
  }
}

/// A sum of which nothing is left but rounding is zero.
double sum_of_slopes(double a, double b) {
  const double sum = a + b;
  return std::abs(sum) <= no_slope * (std::abs(a) + std::abs(b)) ? 0.0 : sum;
}

/// Adds a multiple of a null vector to the forces of contacts.
void add_along(std::span<ActiveContact> contacts, double shift, const double* vector) {
  for (ActiveContact& contact : contacts) {
    contact.normal += shift * vector[0];
    for (std::size_t k = 0; k < contact.tangential.size(); ++k)
      contact.tangential[k] += shift * vector[1 + k];
    vector += numbers_of_force;
  }
}

/// Lines of a contact in the plane: normal force, and both edges of friction, or of the moment, where it
/// sticks.
std::size_t lines_of(const ActiveContact& contact) {
  return std::size_t{contact.at.normals} + (contact.sticks() ? 2U : 0U);
}

}  // namespace

void ForceMargins::clear() {
  count_ = 0;
  vectors_.clear();
  numbers_.clear();
}

void ForceMargins::add(std::size_t first, std::size_t last, std::span<const ContactPivot::Row> rows,
                       const FullPivoting& factors) {
  if (count_ == groups_.size()) groups_.emplace_back();
  Group& group = groups_[count_++];
  group.first = first;
  group.last = last;
  group.rows.assign(rows.begin(), rows.end());
  group.factors = factors;
}

void ForceMargins::find_vectors(std::span<const ActiveContact> contacts) {
  if (!vectors_.empty()) return;
  for (std::size_t i = 0; i < count_; ++i) append_vectors(contacts, groups_[i]);
}

void ForceMargins::append_vectors(std::span<const ActiveContact> contacts, const Group& of) {
  const auto& [first, last, rows, factors] = of;
  for (std::size_t free = factors.rank(); free < factors.size(); ++free) {
    factors.null_vector(free, work_);
    vectors_.push_back({first, last, numbers_.size()});
    numbers_.resize(numbers_.size() + numbers_of_force * (last - first), 0.0);
    double* const vector = numbers_.data() + vectors_.back().begin;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double* const of_contact = vector + numbers_of_force * (rows[i].contact - first);
      of_contact[rows[i].tangent ? 1 : 0] = work_[i];
    }
    for (std::size_t i = first; i < last; ++i) {
      const ActiveContact& contact = contacts[i];
      double* const of_contact = vector + numbers_of_force * (i - first);
      if (contact.at.attached) of_contact[0] = vector[numbers_of_force * (i - 1 - first)];
      if (contact.sticks()) continue;
      for_tangents(contact.at, [&](std::size_t k, int) {
        of_contact[1 + k] = contact.friction_ratio(k) * of_contact[0];
      });
    }
    remove_rounding({vector, numbers_of_force * (last - first)});
  }
}

/// Margins of contacts as lines along a null vector; null: as they are.
void ForceMargins::collect(std::span<const ActiveContact> contacts, const double* vector) {
  lines_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ActiveContact& c = contacts[i];
    const double dn = vector ? vector[numbers_of_force * i] : 0.0;
    const double dt = vector ? vector[numbers_of_force * i + 1] : 0.0;
    if (c.at.normals > 0) lines_.push_back({c.normal, dn});
    if (!c.sticks()) continue;
    const double scale = c.margin_scale();
    for (const double side : {-1.0, 1.0}) {
      lines_.push_back({scale * (c.friction * c.normal + side * c.tangential[0]),
                        scale * sum_of_slopes(c.friction * dn, side * dt)});
    }
  }
}

/// Wedged contacts have no largest margin: one as large as the forces is enough.
void ForceMargins::bound_wedged(std::span<const ActiveContact> contacts) {
  const auto rises = [](const Line& line) { return line.slope > 0.0; };
  const auto falls = [](const Line& line) { return line.slope < 0.0; };
  if (std::any_of(lines_.begin(), lines_.end(), rises) && std::any_of(lines_.begin(), lines_.end(), falls)) {
    return;
  }
  double size = 0.0;
  for (const ActiveContact& contact : contacts) {
    size += std::abs(contact.normal) + contact.tangential_force();
  }
  lines_.push_back({size, 0.0});
}

double ForceMargins::least_at(double shift) const {
  double value = std::numeric_limits<double>::infinity();
  for (const Line& line : lines_) value = std::min(value, line.at + shift * line.slope);
  return value;
}

double ForceMargins::least(std::span<const ActiveContact> contacts) {
  collect(contacts, nullptr);
  return lines_.empty() ? unbounded_margin : least_at(0.0);
}

void ForceMargins::distribute(std::span<ActiveContact> contacts, bool mark) {
  find_vectors(contacts);
  for (std::size_t at = 0; at < vectors_.size();) {
    std::size_t next = at + 1;
    while (next < vectors_.size() && vectors_[next].first == vectors_[at].first) ++next;
    const std::span<ActiveContact> group =
        contacts.subspan(vectors_[at].first, vectors_[at].last - vectors_[at].first);
    // A single vector leads to the largest margin; one after the other several lead to a good one.
    if (!(next > at + 1 && follow_all(group, at, next, mark))) {
      for (std::size_t vector = at; vector < next; ++vector) follow(group, vectors_[vector]);
    }
    at = next;
  }
}

/// Makes the margin largest along one vector.
void ForceMargins::follow(std::span<ActiveContact> contacts, const NullVector& of) {
  const double* const vector = numbers_.data() + of.begin;
  collect(contacts, vector);
  bound_wedged(contacts);
  double best_shift = 0.0, best = least_at(0.0);
  for (const Line& a : lines_) {
    for (const Line& b : lines_) {
      if (!(a.slope >= 0.0 && b.slope <= 0.0 && a.slope > b.slope)) continue;
      const double shift = (b.at - a.at) / (a.slope - b.slope);
      const double value = least_at(shift);
      if (value > best) {
        best = value;
        best_shift = shift;
      }
    }
  }
  add_along(contacts, best_shift, vector);
}

/// States lines a_i + s_i x over the margins of a group, x along its vectors [from, to).
void ForceMargins::state_lines(std::span<const ActiveContact> contacts, std::size_t from, std::size_t to) {
  program_.start(to - from);
  const auto line = [&](double at, const auto& slope) {
    const std::span<double> slopes = program_.add(at);
    for (std::size_t k = 0; k < slopes.size(); ++k)
      slopes[k] = slope(numbers_.data() + vectors_[from + k].begin);
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ActiveContact& c = contacts[i];
    const std::size_t at = numbers_of_force * i;
    if (c.at.normals > 0) line(c.normal, [&](const double* vector) { return vector[at]; });
    if (!c.sticks()) continue;
    const double scale = c.margin_scale();
    for (const double side : {-1.0, 1.0}) {
      line(scale * (c.friction * c.normal + side * c.tangential[0]), [&](const double* vector) {
        return scale * sum_of_slopes(c.friction * vector[at], side * vector[at + 1]);
      });
    }
  }
}

/// Makes the margin of a group largest over all its vectors [from, to) at once. Wedged contacts have no
/// largest margin: one as large as the forces is large enough.
bool ForceMargins::follow_all(std::span<ActiveContact> contacts, std::size_t from, std::size_t to,
                              bool mark) {
  double size = 0.0;
  for (const ActiveContact& c : contacts) size += std::abs(c.normal) + c.tangential_force();
  if (!(size > 0.0) || !std::isfinite(size)) return false;
  state_lines(contacts, from, to);
  if (!program_.solve(size)) return false;
  // Lines with a positive number are at the least in every solution; others may be at it in this one only.
  auto begin = program_.multipliers().begin();
  for (std::size_t i = 0; mark && i < contacts.size(); ++i) {
    const auto end = begin + static_cast<std::ptrdiff_t>(lines_of(contacts[i]));
    contacts[i].sets_margin = std::any_of(begin, end, [](double number) { return number > no_part; });
    begin = end;
  }
  for (std::size_t k = 0; k < to - from; ++k) {
    const double shift = program_.x()[k];
    add_along(contacts, shift, numbers_.data() + vectors_[from + k].begin);
  }
  return true;
}

}  // namespace carom
