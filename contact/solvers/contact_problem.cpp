// Problem: hold W, b and the row sets of one contact problem, and find which rows belong together.

#include <carom/contact/solvers/contact_problem.h>

#include <carom/contact/solvers/factor_products.h>
#include <carom/contact/solvers/planar_certificate.h>
#include <carom/core/numerics/accurate_dot.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace carom {

namespace {

// Whether the set depends on the impulse of another row.
bool bounded(const RowSet& set) { return set.kind != SetKind::half_line && set.kind != SetKind::interval; }

[[noreturn]] void refuse(int row, const char* what) {
  throw std::invalid_argument("contact problem, row " + std::to_string(row) + ": " + what);
}

// Whether P of this row cannot be negative, so that it can bound another one.
bool never_negative(const RowSet& set) {
  return set.kind == SetKind::half_line || (set.kind == SetKind::interval && set.lower >= 0.0);
}

void check(std::span<const RowSet> sets, int row) {
  const RowSet& set = sets[static_cast<std::size_t>(row)];
  if (set.kind == SetKind::interval && !(set.lower <= set.upper)) {
    refuse(row, "an interval needs lower <= upper");
  }
  if (!bounded(set)) return;
  if (!std::isfinite(set.coefficient)) refuse(row, "a coefficient is finite");
  if (set.coefficient < 0.0 && set.kind != SetKind::proportional) {
    refuse(row, "a coefficient of friction is not negative");
  }
  if (set.bound < 0 || set.bound >= row || !never_negative(sets[static_cast<std::size_t>(set.bound)])) {
    refuse(row, "a bounded row follows the row that bounds it, whose impulse is not negative");
  }
}

/// Whether a row and the next one are those of a contact in the plane: nearly all groups, seen at one look.
bool is_planar_contact(std::span<const RowSet> sets, int row) {
  constexpr double most = std::numeric_limits<double>::max();
  const auto first = static_cast<std::size_t>(row);
  if (first + 1 >= sets.size()) return false;
  const RowSet &normal = sets[first], &friction = sets[first + 1];
  return normal.kind == SetKind::half_line && friction.kind == SetKind::bounded_interval &&
         friction.bound == row && friction.coefficient >= 0.0 && friction.coefficient <= most;
}

}  // namespace

// Spans are made here: in the header each kind of them would be compiled anew by every program.
std::span<const double> ContactProblem::matrix() const { return w_; }
std::span<double> ContactProblem::matrix() { return w_; }
std::span<const double> ContactProblem::vector() const { return b_; }
std::span<double> ContactProblem::vector() { return b_; }
std::span<const RowSet> ContactProblem::sets() const { return sets_; }
std::span<RowSet> ContactProblem::sets() { return sets_; }
std::span<const RowGroup> ContactProblem::groups() const { return groups_; }

void ContactProblem::reset(int rows) {
  if (rows < 0) throw std::invalid_argument("contact problem: the number of rows is not negative");
  rows_ = rows;
  const auto n = static_cast<std::size_t>(rows);
  w_.assign(n * n, 0.0);
  b_.assign(n, 0.0);
  sets_.assign(n, RowSet{});
  groups_.clear();
  one_planar_contact_ = false;
  if (factored_) factors_.reset(0, 0);
  factored_ = false;
}

void ContactProblem::reset_factors(int rows, int slots) {
  if (rows < 0 || slots < 0) {
    throw std::invalid_argument("contact problem: the numbers of rows and slots are not negative");
  }
  resize_factors(rows);
  std::fill(b_.begin(), b_.end(), 0.0);
  std::fill(sets_.begin(), sets_.end(), RowSet{});
  factors_.reset(rows, slots);
}

void ContactProblem::resize_factors(int rows) {
  rows_ = rows;
  const auto n = static_cast<std::size_t>(rows);
  w_.clear();
  b_.resize(n);
  sets_.resize(n);
  groups_.clear();
  one_planar_contact_ = false;
  diagonal_.resize(n);  // group() writes it
  factors_.resize_rows(rows);
  factored_ = true;
}

/// Diagonal of W, which solvers read most, traces of its blocks, and pairs of rows. Checks on the way that
/// rows of a group have the same slots.
void ContactProblem::group_factors() {
  const int slots = static_cast<int>(factors_.slots());
  factors_.largest_trace = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const RowGroup& group : groups_) {
    const auto first = static_cast<std::size_t>(group.first);
    if (group.size > 2) refuse(group.first, "a contact in factors has one friction row");
    ResponseFactors::Row* const rows = factors_.rows.data() + first;
    const std::array<int, 3>& shared = rows[0].slot;
    if (std::max(std::max(shared[0], shared[1]), shared[2]) >= slots)
      refuse(group.first, "a slot that is none");
    rows[0].paired = group.size == 2 && share_slots(rows[0], rows[1]) ? slots_of(rows[0]) : 0;
    if (rows[0].paired == 2 && sets_[first + 1].kind == SetKind::bounded_interval &&
        !factors_.any_bound()) {  // the usual case, without loops
      const std::array<double, 2> both = diagonal_of_both(factors_, rows);
      diagonal_[first] = both[0];
      diagonal_[first + 1] = both[1];
      factors_.largest_trace = larger_magnitude(factors_.largest_trace, both[0] + both[1]);
      least = std::min(least, std::min(both[0], both[1]));
      continue;
    }
    if (group.size == 2 && rows[0].paired == 0) rows[1].paired = 0;
    double trace = 0.0;
    for (std::size_t row = first; row < first + static_cast<std::size_t>(group.size); ++row) {
      const std::array<int, 3>& slot = factors_.rows[row].slot;
      if (slot[0] != shared[0] || slot[1] != shared[1] || slot[2] != shared[2])
        refuse(static_cast<int>(row), "rows of a contact have the same slots");
      if (sets_[row].kind == SetKind::bounded_disc)
        refuse(static_cast<int>(row), "no disc in a problem in factors");
      diagonal_[row] = factors_.diagonal(row);
      least = std::min(least, diagonal_[row]);
      trace += diagonal_[row];
    }
    factors_.largest_trace = larger_magnitude(factors_.largest_trace, trace);
  }
  factors_.any_held = !(least > 0.0);
}

ContactProblem ContactProblem::dense() const {
  if (!factored_) return *this;
  ContactProblem made;
  made.reset(rows_);
  const auto n = static_cast<std::size_t>(rows_);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) made.w_[i * n + j] = factors_.entry(std::max(i, j), std::min(i, j));
  }
  made.b_ = b_;
  made.sets_ = sets_;
  made.groups_ = groups_;
  made.one_planar_contact_ = rows_ == 2 && groups_.size() == 1 && is_planar_contact(sets_, 0);
  return made;
}

void ContactProblem::group() {
  groups_.clear();
  one_planar_contact_ = !factored_ && rows_ == 2 && is_planar_contact(sets_, 0);
  groups_.reserve(static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row) {
    if (is_planar_contact(sets_, row)) {
      groups_.push_back({row++, 2});
      continue;
    }
    check(sets_, row);
    const RowSet& set = sets_[static_cast<std::size_t>(row)];
    if (!bounded(set)) {
      groups_.push_back({row, 1});
      continue;
    }
    if (groups_.empty() || set.bound != groups_.back().first) {
      refuse(row, "friction rows stand directly behind the row that bounds them");
    }
    ++groups_.back().size;
    if (set.kind != SetKind::bounded_disc) continue;
    // A disc takes two rows with one description.
    if (++row == rows_) refuse(row - 1, "a disc takes two rows");
    const RowSet& second = sets_[static_cast<std::size_t>(row)];
    if (second.kind != SetKind::bounded_disc || second.bound != set.bound ||
        std::abs(second.coefficient - set.coefficient) > 0.0) {
      refuse(row, "both rows of a disc carry the same description");
    }
    ++groups_.back().size;
  }
  if (factored_) group_factors();
}

void ContactProblem::velocities(std::span<const double> impulse, std::span<double> xi,
                                std::vector<double>& velocity) const {
  if (!factored_) return velocities(impulse, xi);
  factors_.respond(impulse, velocity);
  along_all_rows(factors_, velocity, b_, xi);
}

void ContactProblem::velocities(std::span<const double> impulse, std::span<double> xi) const {
  if (factored_) {
    std::vector<double> velocity;
    return velocities(impulse, xi, velocity);
  }
  const auto n = static_cast<std::size_t>(rows_);
  for (std::size_t i = 0; i < n; ++i) xi[i] = accurate_dot(std::span(w_).subspan(i * n, n), impulse, b_[i]);
}

bool has_discs(const ContactProblem& problem) {
  return std::ranges::any_of(problem.sets(),
                             [](const RowSet& set) { return set.kind == SetKind::bounded_disc; });
}

}  // namespace carom
