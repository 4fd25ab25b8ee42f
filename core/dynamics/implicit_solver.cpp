// Problem: solve with the matrix of a linearised step, sparse as the graph of the couplings.

#include <carom/core/difference_derivatives.h>
#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/numerics/pivoting_lu.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>

namespace carom {

struct ImplicitSolver::Factors {
  using Matrix = Eigen::SparseMatrix<double>;

  const Assembly* assembly = nullptr;
  Index component = none;
  Range v;
  std::vector<LoadDerivative> entries;
  std::vector<Eigen::Triplet<double>> triplets;
  Matrix matrix;
  Eigen::SimplicialLDLT<Matrix> factors;

  // With joints.
  Index rows = 0;
  Matrix bordered_matrix;
  PivotingLu bordered;

  void append_masses();
  void make_definite(std::ptrdiff_t first_mass);
  [[nodiscard]] bool surround(const Border& joints);
};

/// Factors A with the rows of the joints. One that follows from others, whose pivot would vanish, is given a
/// small one: which of the answers for such rows comes out makes no difference to the bodies. The others get
/// none: beside the mass of a light body it would be a large one for a heavy body.
bool ImplicitSolver::Factors::surround(const Border& joints) {
  // Against the row's own diagonal in G M^-1 G^T: small even where stiff couplings make G A^-1 G^T smaller.
  constexpr double least_pivot = 1e-13;
  // Pivots of rows that, but for rounding and some way from where they were factored, may follow from others.
  constexpr double doubtful_pivot = 1e-6;
  const auto index = [&](Index i) { return static_cast<int>(i - v.begin); };
  const auto size = static_cast<int>(v.size());
  rows = static_cast<Index>(joints.held.size());
  triplets.clear();
  for (int column = 0; column < size; ++column) {
    for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
      triplets.emplace_back(static_cast<int>(entry.row()), column, entry.value());
      if (entry.row() != column) triplets.emplace_back(column, static_cast<int>(entry.row()), entry.value());
    }
  }
  for (Index i = 0; i < rows; ++i) {
    const JointRow held = joints.held.row(i), pushing = joints.pushing.row(i);
    const int place = size + static_cast<int>(i);
    double diagonal = 0.0;
    for (int b = 0; b < held.bodies; ++b) {
      const JointRow::Block& block = held.blocks[static_cast<std::size_t>(b)];
      const JointRow::Block& across = pushing.blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        const double number = block.jacobian[static_cast<std::size_t>(c)];
        const int column = index(block.v) + c;
        triplets.emplace_back(place, column, number);
        triplets.emplace_back(column, place, across.jacobian[static_cast<std::size_t>(c)]);
        diagonal += number * number / matrix.coeff(column, column);
      }
    }
    const bool may_follow = joints.held.factors().pivot(i) < doubtful_pivot;
    triplets.emplace_back(place, place, may_follow ? -least_pivot * diagonal : 0.0);
  }
  for (const MatrixNumber& of : joints.of_reactions) {
    triplets.emplace_back(index(of.row), index(of.column), -of.number);
  }
  for (const MatrixNumber& of : joints.of_conditions) {
    triplets.emplace_back(size + static_cast<int>(of.row), index(of.column), of.number);
  }
  const int all = size + static_cast<int>(rows);
  bordered_matrix.resize(all, all);
  bordered_matrix.setFromTriplets(triplets.begin(), triplets.end());
  bordered.isSymmetric(true);  // its pattern
  bordered.analyzePattern(bordered_matrix);
  bordered.factorize(bordered_matrix);
  return bordered.info() == Eigen::Success;
}

/// Appends the mass matrix, lower triangle.
void ImplicitSolver::Factors::append_masses() {
  std::vector<double> unit, image;
  assembly->for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
    const Index size = kind.v_size();
    unit.assign(size, 0.0);
    image.resize(size);
    for (Index slot = slots.begin; slot < slots.end; ++slot, first += size) {
      for (Index column = 0; column < size; ++column) {
        unit[column] = 1.0;
        kind.apply_mass({slot, slot + 1}, unit.data(), image.data());
        unit[column] = 0.0;
        for (Index row = column; row < size; ++row) {
          triplets.emplace_back(static_cast<int>(first + row - v.begin),
                                static_cast<int>(first + column - v.begin), image[row]);
        }
      }
    }
  });
}

/// Doubles the masses, which begin at a triplet, until the matrix is definite.
void ImplicitSolver::Factors::make_definite(std::ptrdiff_t first_mass) {
  // Loads that give way as much as this (a spring pushed together, against turning aside) are not followed to
  // where they lead: the correction becomes shorter instead. Doubled: some 50 times are the whole range of
  // numbers that a step can need.
  constexpr int most_additions = 60;
  const auto definite = [&] {
    return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0.0;
  };
  for (int i = 0; i < most_additions && !definite(); ++i) {
    for (auto mass = triplets.begin() + first_mass; mass != triplets.end(); ++mass) {
      *mass = {mass->row(), mass->col(), 2.0 * mass->value()};
    }
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factors.factorize(matrix);
  }
}

ImplicitSolver::ImplicitSolver() : factors_(std::make_unique<Factors>()) {}
ImplicitSolver::~ImplicitSolver() = default;
ImplicitSolver::ImplicitSolver(ImplicitSolver&&) noexcept = default;
ImplicitSolver& ImplicitSolver::operator=(ImplicitSolver&&) noexcept = default;

ImplicitSolver::Outcome ImplicitSolver::factor(const Assembly& assembly, Index component,
                                               const StateView& state, const Evaluation& evaluation,
                                               double step, const Border* joints, bool make_definite) {
  Factors& self = *factors_;
  self.assembly = &assembly;
  self.component = component;
  self.v = assembly.components()[component].v;
  self.entries.clear();
  append_derivatives({assembly, state, evaluation, component}, self.entries);

  const auto index = [&](Index i) { return static_cast<int>(i - self.v.begin); };
  self.triplets.clear();
  for (const LoadDerivative& entry : self.entries) {
    // Half to each side of the diagonal; LDLT reads the lower triangle.
    const double value = -0.5 * (0.5 * step * entry.by_velocity + 0.25 * step * step * entry.by_position);
    const int row = index(entry.row), column = index(entry.column);
    if (row == column) {
      self.triplets.emplace_back(row, column, 2.0 * value);
    } else {
      self.triplets.emplace_back(std::max(row, column), std::min(row, column), value);
    }
  }
  const auto first_mass = static_cast<std::ptrdiff_t>(self.triplets.size());
  self.append_masses();
  const auto size = static_cast<Eigen::Index>(self.v.size());
  self.matrix.resize(size, size);
  self.matrix.setFromTriplets(self.triplets.begin(), self.triplets.end());
  // The pattern is that of the graph; an element may leave out entries at times, so it is looked at again.
  self.factors.analyzePattern(self.matrix);
  self.factors.factorize(self.matrix);
  if (make_definite) self.make_definite(first_mass);
  if (self.factors.info() != Eigen::Success) return Outcome::singular;
  self.rows = 0;
  if (joints != nullptr && !self.surround(*joints)) return Outcome::singular;
  return self.factors.vectorD().minCoeff() > 0.0 ? Outcome::definite : Outcome::indefinite;
}

void ImplicitSolver::solve(double* f, const double* r, double* l) const {
  const auto size = static_cast<Eigen::Index>(factors_->v.size());
  Eigen::Map<Eigen::VectorXd> map(f, size);
  if (factors_->rows == 0) {
    const Eigen::VectorXd solution = factors_->factors.solve(map);
    map = solution;
    return;
  }
  Eigen::VectorXd right(size + static_cast<Eigen::Index>(factors_->rows));
  right.head(size) = map;
  for (Index i = 0; i < factors_->rows; ++i) {
    right[size + static_cast<Eigen::Index>(i)] = r == nullptr ? 0.0 : -r[i];
  }
  const Eigen::VectorXd solution = factors_->bordered.solve(right);
  map = solution.head(size);
  if (l == nullptr) return;
  for (Index i = 0; i < factors_->rows; ++i) l[i] = -solution[size + static_cast<Eigen::Index>(i)];
}

void ImplicitSolver::subtract_matrix(const double* v, double* p) const {
  const auto size = static_cast<Eigen::Index>(factors_->v.size());
  const Eigen::Map<const Eigen::VectorXd> of(v + factors_->v.begin, size);
  Eigen::Map<Eigen::VectorXd> from(p + factors_->v.begin, size);
  from -= factors_->matrix.selfadjointView<Eigen::Lower>() * of;
}

void ImplicitSolver::add_stiffness_times(double scale, const double* v, double* y) const {
  for (const LoadDerivative& entry : factors_->entries) {
    y[entry.row] += scale * entry.by_position * v[entry.column];
  }
}

void ImplicitSolver::apply_mass(const double* v, double* p) const {
  factors_->assembly->for_bodies(factors_->component,
                                 [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
                                   kind.apply_mass(slots, v + first, p + first);
                                 });
}

}  // namespace carom
