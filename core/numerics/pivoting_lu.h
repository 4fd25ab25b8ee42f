#pragma once

/// \file
/// L U of a sparse matrix with pivots off the diagonal where those on it are too small: Eigen's, in less
/// memory.

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace carom {

/// Eigen makes room for twenty times the numbers of the matrix before it factorises. Graphs of mechanisms
/// fill in little, and where they do not, Eigen makes more room.
class PivotingLu : public Eigen::SparseLU<Eigen::SparseMatrix<double>> {
public:
  PivotingLu() { m_perfv.fillfactor = 3; }
};

}  // namespace carom
