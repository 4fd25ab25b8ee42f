// Problem: (I - gamma df/dy) x = b, dense, some times with one matrix.

#include <carom/integrators/sundials_dense.h>

#include <Eigen/LU>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <memory>

namespace carom {

namespace {

using MatrixMap = Eigen::Map<Eigen::MatrixXd>;

MatrixMap numbers(SUNMatrix matrix) { return {SM_DATA_D(matrix), SM_ROWS_D(matrix), SM_COLUMNS_D(matrix)}; }

using Decomposition = Eigen::PartialPivLU<Eigen::MatrixXd>;

Decomposition& decomposition(SUNLinearSolver solver) { return *static_cast<Decomposition*>(solver->content); }

}  // namespace

SUNMatrix make_dense_matrix(std::size_t n, SUNContext context) {
  const auto rows = static_cast<sunindextype>(n);
  SUNMatrix matrix = SUNDenseMatrix(rows, rows, context);
  if (matrix == nullptr) return nullptr;
  auto& ops = *matrix->ops;
  ops.clone = [](SUNMatrix from) {
    return make_dense_matrix(static_cast<std::size_t>(SM_ROWS_D(from)), from->sunctx);
  };
  ops.copy = [](SUNMatrix from, SUNMatrix to) {
    numbers(to) = numbers(from);
    return 0;
  };
  ops.scaleaddi = [](sunrealtype c, SUNMatrix a) {
    numbers(a) *= c;
    numbers(a).diagonal().array() += 1.0;
    return 0;
  };
  return matrix;
}

SUNLinearSolver make_dense_solver(std::size_t n, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->content = std::make_unique<Decomposition>(static_cast<Eigen::Index>(n)).release();
  auto& ops = *solver->ops;
  ops.gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  ops.setup = [](SUNLinearSolver self, SUNMatrix matrix) {
    const auto& factors = decomposition(self).compute(numbers(matrix)).matrixLU();
    const bool regular = factors.allFinite() && factors.diagonal().cwiseAbs().minCoeff() > 0.0;
    return regular ? 0 : 1;  // 1: perhaps with another gamma
  };
  ops.solve = [](SUNLinearSolver self, SUNMatrix, N_Vector x, N_Vector b, sunrealtype) {
    const Eigen::Map<const Eigen::VectorXd> right(NV_DATA_S(b), NV_LENGTH_S(b));
    Eigen::Map<Eigen::VectorXd>(NV_DATA_S(x), NV_LENGTH_S(x)) = decomposition(self).solve(right);
    return 0;
  };
  ops.free = [](SUNLinearSolver self) {
    std::unique_ptr<Decomposition>(&decomposition(self)).reset();
    self->content = nullptr;
    SUNLinSolFreeEmpty(self);
    return 0;
  };
  return solver;
}

}  // namespace carom
