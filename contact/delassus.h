#pragma once

/// \file
/// The matrix of a contact problem (Delassus), W = H B H^T: H the rows of constraints, B the response of the
/// bodies to impulses. It is made here only, from any response (core/dynamics/body_response.h), and goes back
/// to the bodies as B H^T P.

#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// A row of a constraint, and the column along which its impulse acts: that row, and a multiple of the first
/// tangential one (of a contact that slips: the edge of its cone of friction).
struct ImpulseDirection {
  const Constraint* constraint = nullptr;  ///< must outlive the matrix
  int row = 0;                             ///< of the constraint
  double ratio = 0.0;                      ///< of the first tangential row in the column
};

/// W with the responses that it is made of, row by row, each over the bodies that it reaches. Keeps its
/// memory.
class CAROM_API Delassus {
public:
  /// Takes the responses of the bodies to unit impulses along the columns. \param directions must outlive it
  void build(std::span<const ImpulseDirection> directions, BodyResponse& response);

  /// Number of rows.
  [[nodiscard]] std::size_t size() const { return directions_.size(); }
  /// Row i times the response to column j.
  [[nodiscard]] double entry(std::size_t i, std::size_t j) const;
  /// True if an impulse along a column moves nothing: joints hold it fast.
  [[nodiscard]] bool is_held(std::size_t j) const { return columns_[j].held; }
  /// Writes W, symmetric, row-major: the lower triangle, mirrored; rows and columns of what is held are zero.
  /// Without ratios only. \param matrix size() * size() numbers
  void write_symmetric(double* matrix) const;
  /// Writes W with its columns as they are. \param matrix likewise
  void write(double* matrix) const;
  /// x += scale B D^T P. \param x velocities of all bodies
  void add_response(std::span<const double> impulses, double* x, double scale = 1.0) const;
  /// The same of one column.
  void add_response(std::size_t column, double impulse, double* x) const;

private:
  // Response to a column, over one range for each of the reaches of its bodies.
  struct Column {
    std::size_t first_part = 0;
    bool held = false;
  };
  struct Part {
    Range v;
    std::size_t begin = 0;  // of its numbers
    Index body = none;      // one of those that reach there
  };
  void lay_out(BodyResponse& response);
  void add_parts(const Constraint& constraint, BodyResponse& response, std::size_t& numbers);
  void write_column(std::size_t j);
  [[nodiscard]] const Part* part_of(std::size_t column, Index v) const;
  [[nodiscard]] double product(const Constraint& at, int row, std::size_t j) const;

  std::span<const ImpulseDirection> directions_;
  std::vector<Column> columns_;  // and an end
  std::vector<Part> parts_;
  std::vector<double> responses_;
  std::vector<double> loads_;  // columns as they act, by the same places; empty where they act as they are
};

}  // namespace carom
