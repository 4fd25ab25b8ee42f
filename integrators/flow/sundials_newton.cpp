#include <carom/integrators/flow/sundials_newton.h>

#include <nvector/nvector_serial.h>

namespace carom {

SUNMatrix make_newton_matrix(NewtonMatrix& matrix, SUNContext context) {
  SUNMatrix made = SUNMatNewEmpty(context);
  if (made == nullptr) return nullptr;
  made->content = &matrix;
  made->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
  made->ops->destroy = [](SUNMatrix self) {
    self->content = nullptr;  // is not ours
    SUNMatFreeEmpty(self);
  };
  return made;
}

NewtonMatrix& newton_matrix(SUNMatrix matrix) { return *static_cast<NewtonMatrix*>(matrix->content); }

SUNLinearSolver make_newton_solver(NewtonMatrix& matrix, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->content = &matrix;
  auto& ops = *solver->ops;
  ops.gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  ops.setup = [](SUNLinearSolver, SUNMatrix) { return 0; };
  ops.solve = [](SUNLinearSolver self, SUNMatrix, N_Vector x, N_Vector b, sunrealtype) {
    static_cast<NewtonMatrix*>(self->content)->solve(NV_DATA_S(b), NV_DATA_S(x));
    return 0;
  };
  ops.free = [](SUNLinearSolver self) {
    self->content = nullptr;  // is not ours
    SUNLinSolFreeEmpty(self);
    return 0;
  };
  return solver;
}

}  // namespace carom
