// Problem: which rows of a contact problem change places in a mirror, and what is left of it then.

#include <carom/contact/solvers/mirror_fold.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Numbers that differ by no more, in parts of the largest there, are the same but for rounding, which impacts
// amplify and differences of large velocities leave. It decides no more than which of several answers is
// taken: each is polished and judged as one of the problem itself.
constexpr double same_in_mirror = 1e-6;

/// Sign of a row in the mirror: a normal impulse stays, sliding and rolling turn round.
double sign_in_mirror(const RowGroup& group, int row) { return row == group.first ? 1.0 : -1.0; }

bool have_image_sets(const RowSet& one, const RowSet& other) {
  if (one.kind != other.kind) return false;
  const double coefficient = one.kind == SetKind::proportional ? -other.coefficient : other.coefficient;
  return one.kind == SetKind::half_line || !(std::abs(one.coefficient - coefficient) > 0.0);
}

}  // namespace

bool MirrorFold::is_foldable(const ContactProblem& problem) const {
  return !problem.is_factored() && problem.groups().size() > 1 &&
         std::ranges::none_of(problem.sets(), [](const RowSet& set) {
           return set.kind == SetKind::interval || set.kind == SetKind::bounded_disc;
         });
}

/// True if the block of W of two groups is the image of that of two others.
bool MirrorFold::have_image_of(const ContactProblem& problem, const RowGroup& one, const RowGroup& from,
                               const RowGroup& other, const RowGroup& to) const {
  for (int i = 0; i < one.size; ++i) {
    for (int j = 0; j < from.size; ++j) {
      const int row = one.first + i, column = from.first + j;
      const double sign = sign_in_mirror(one, row) * sign_in_mirror(from, column);
      const double size = std::sqrt(problem.w(row, row) * problem.w(column, column));
      const double image = sign * problem.w(other.first + i, to.first + j);
      if (!(std::abs(problem.w(row, column) - image) <= same_in_mirror * size)) return false;
    }
  }
  return true;
}

/// True if one group may be the image of another, as far as images are known.
bool MirrorFold::are_images(const ContactProblem& problem, std::size_t one, std::size_t other) const {
  const RowGroup &a = problem.groups()[one], &b = problem.groups()[other];
  if (a.size != b.size) return false;
  for (int i = 0; i < a.size; ++i) {
    const auto row = static_cast<std::size_t>(a.first + i), image = static_cast<std::size_t>(b.first + i);
    const double differs = problem.vector()[row] - sign_in_mirror(a, a.first + i) * problem.vector()[image];
    if (!(std::abs(differs) <= same_in_mirror * largest_)) return false;
    if (!have_image_sets(problem.sets()[row], problem.sets()[image])) return false;
  }
  if (!have_image_of(problem, a, a, b, b) || !have_image_of(problem, a, b, b, a)) return false;
  for (std::size_t k = 0; k < one; ++k) {
    const RowGroup &known = problem.groups()[k],
                   &image = problem.groups()[static_cast<std::size_t>(image_[k])];
    if (!have_image_of(problem, a, known, b, image)) return false;
    if (!have_image_of(problem, b, known, a, image)) return false;
  }
  return true;
}

bool MirrorFold::find(const ContactProblem& problem) {
  if (!is_foldable(problem)) return false;
  largest_ = 0.0;
  for (const double velocity : problem.vector()) largest_ = std::max(largest_, std::abs(velocity));
  const std::size_t count = problem.groups().size();
  image_.assign(count, -1);
  bool any = false;  // contact that is not its own image
  for (std::size_t one = 0; one < count; ++one) {
    for (std::size_t other = one + 1; other < count && image_[one] < 0; ++other) {
      if (image_[other] >= 0 || !are_images(problem, one, other)) continue;
      image_[one] = static_cast<int>(other);
      image_[other] = static_cast<int>(one);
      any = true;
    }
    if (image_[one] >= 0) continue;
    if (!are_images(problem, one, one)) return false;
    image_[one] = static_cast<int>(one);
  }
  if (any) fold(problem);
  return any;
}

void MirrorFold::add_rows(const RowGroup& own, const RowGroup& image) {
  const int size = own.first == image.first ? 1 : own.size;
  for (int i = 0; i < size; ++i)
    rows_.push_back({own.first + i, image.first + i, sign_in_mirror(own, own.first + i)});
}

/// Makes the problem of one half, E^T W E and E^T b.
void MirrorFold::fold(const ContactProblem& problem) {
  rows_.clear();
  for (std::size_t one = 0; one < image_.size(); ++one) {
    const auto other = static_cast<std::size_t>(image_[one]);
    if (other >= one) add_rows(problem.groups()[one], problem.groups()[other]);
  }
  half_.reset(static_cast<int>(rows_.size()));
  const auto w_of = [&](int row, const Row& column) {
    const double own = problem.w(row, column.own);
    return column.image == column.own ? own : own + column.sign * problem.w(row, column.image);
  };
  int normal = 0;
  for (int i = 0; i < half_.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Row& row = rows_[at];
    const auto own = static_cast<std::size_t>(row.own), image = static_cast<std::size_t>(row.image);
    const bool is_own_image = row.image == row.own;
    half_.vector()[at] = problem.vector()[own] + (is_own_image ? 0.0 : row.sign * problem.vector()[image]);
    for (int j = 0; j < half_.rows(); ++j) {
      const Row& column = rows_[static_cast<std::size_t>(j)];
      half_.w(i, j) = w_of(row.own, column) + (is_own_image ? 0.0 : row.sign * w_of(row.image, column));
    }
    RowSet& set = half_.sets()[at];
    set = problem.sets()[own];
    if (set.kind == SetKind::half_line) normal = i;
    if (set.kind != SetKind::half_line) set.bound = normal;
  }
  half_.group();
}

void MirrorFold::unfold(std::span<const double> half, std::span<double> impulse) const {
  std::ranges::fill(impulse, 0.0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    impulse[static_cast<std::size_t>(row.image)] = row.sign * half[i];
    impulse[static_cast<std::size_t>(row.own)] = half[i];
  }
}

}  // namespace carom
