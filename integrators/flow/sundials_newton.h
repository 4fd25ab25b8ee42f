#pragma once

/// \file
/// The matrix of CVODE's implicit steps and the solution of its equations, by our own factors.

#include <carom/integrators/flow/newton_matrix.h>

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

namespace carom {

/// The matrix as SUNDIALS sees it. Null if it cannot be made. Free with SUNMatDestroy(), before `matrix`.
[[nodiscard]] SUNMatrix make_newton_matrix(NewtonMatrix& matrix, SUNContext context);
/// Newton matrix behind it.
[[nodiscard]] NewtonMatrix& newton_matrix(SUNMatrix matrix);
/// A solver by the factors of that matrix, which whoever fills it makes. Null if it cannot be made. Free with
/// SUNLinSolFree().
[[nodiscard]] SUNLinearSolver make_newton_solver(NewtonMatrix& matrix, SUNContext context);

}  // namespace carom
