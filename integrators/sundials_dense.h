#pragma once

/// \file
/// A dense matrix and the solution of linear equations with it, for CVODE, by Eigen: those of SUNDIALS are
/// compiled without optimisation in common packages.

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <cstddef>

namespace carom {

/// Makes an n by n matrix, stored by columns without gaps. Null if it cannot. Free with SUNMatDestroy().
[[nodiscard]] SUNMatrix make_dense_matrix(std::size_t n, SUNContext context);

/// Makes a solver by LU decomposition with partial pivoting. Null if it cannot. Free with SUNLinSolFree().
[[nodiscard]] SUNLinearSolver make_dense_solver(std::size_t n, SUNContext context);

}  // namespace carom
