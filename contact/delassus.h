#pragma once

/// \file
/// The matrix of a contact problem (Delassus), W = H B H^T: H the rows of constraints, B the response of the
/// bodies to impulses. It is made here only, from any response (core/dynamics/body_response.h), and goes back
/// to the bodies as B H^T P.

#include <carom/contact/tangent_direction.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// A row of a constraint, and the column along which its impulse acts: that row, multiples of the tangential
/// ones (of a contact that slips: the edge of its cone of friction), and a moment about the contact (of one
/// that rolls: the bound of its rolling resistance).
struct ImpulseDirection {
  const Constraint* constraint = nullptr;  ///< must outlive the matrix
  int row = 0;                             ///< of the constraint
  TangentDirection::Numbers ratios{};      ///< of the tangential rows in the column
  double lever = 0.0;  ///< moment on the first body, and against the second, by the impulse [m]
};

/// W with the responses that it is made of, row by row: dense where all columns reach the same bodies (one
/// body, or those that joints or a linearised step bind), else each over the bodies that it reaches. Keeps
/// its memory.
class CAROM_API Delassus {
public:
  /// Takes the responses of the bodies to unit impulses along the columns. \param directions must outlive it
  void build(std::span<const ImpulseDirection> directions, BodyResponse& response);
  /// Takes the response of the body of one planar contact, the usual impact, and writes W at once: true where
  /// the contact has one body, which turns and which nothing couples to others. Otherwise false, and nothing
  /// is made. \param directions both rows of one constraint, as they are
  /// \param matrix out: W, as write_symmetric() gives it
  [[nodiscard]] bool build_of_one_contact(std::span<const ImpulseDirection> directions,
                                          const BodyResponse& response, double* matrix);

  /// Number of rows.
  [[nodiscard]] std::size_t size() const { return directions_.size(); }
  /// Writes W, symmetric, row-major: the lower triangle, mirrored; rows and columns of what is held are zero.
  /// Without ratios and levers only. \param matrix size() * size() numbers
  void write_symmetric(double* matrix) const;
  /// Writes W, row-major, with its columns as they are. \param matrix size() * size() numbers
  void write(double* matrix) const;
  /// x += scale B D^T P. \param x velocities of all bodies
  void add_response(std::span<const double> impulses, double* x, double scale = 1.0) const;
  /// Calls f(reach, answer) for the velocities that a unit impulse along a column changes: some that begin
  /// with the first of a reach, a number for each. Not of factors.
  template <class F>
  void for_reaches(std::size_t column, F&& f) const {
    if (!common_.empty()) return f(common_, responses_.data() + column * common_.size());
    for (const Part& part : parts(column)) f(part.v, responses_.data() + part.begin);
  }
  /// True if columns act by other loads than their rows (BodyResponse::take_loads()).
  [[nodiscard]] bool has_other_loads() const { return !loads_.empty(); }
  /// Velocities that it may write, from the first one of all bodies on.
  [[nodiscard]] Index reach_end() const;

private:
  static constexpr auto no_part = static_cast<std::size_t>(-1);
  // Response of one reach to a column.
  struct Part {
    Range v;
    std::size_t begin = 0;  // of its numbers
    Index body = none;      // one of those that reach there
    std::size_t column = 0;
    std::size_t before = no_part;  // of an earlier column that reaches there
  };
  [[nodiscard]] int build_of_one_body(const BodyResponse& response);
  [[nodiscard]] bool find_common_reach(BodyResponse& response);
  void lay_out(BodyResponse& response);
  void add_parts(std::size_t column, BodyResponse& response, std::size_t& numbers);
  void write_column(std::size_t j);
  void answer(Index body, Range v, std::size_t begin, std::size_t columns, char* held,
              BodyResponse& response);
  [[nodiscard]] std::span<const Part> parts(std::size_t column) const;
  [[nodiscard]] const Part* part_of(std::size_t column, Index v) const;
  [[nodiscard]] double entry(std::size_t i, std::size_t j) const;
  void write_entries(bool lower, double* matrix) const;
  void write_by_parts(bool lower, double* matrix) const;

  std::span<const ImpulseDirection> directions_;
  int velocities_of_one_ = 0;            // of the only body, which answers for itself; else 0
  Range common_;                         // velocities that all columns reach, empty if there are none
  std::vector<std::size_t> first_part_;  // by column, and an end; where there is no common reach
  std::vector<Part> parts_;
  std::vector<std::size_t> last_part_;  // by velocity that a reach begins with: the last part there
  std::vector<double> responses_;
  std::vector<double> loads_;  // columns as they act, by the same places; empty where they act as they are
  std::vector<char> held_;     // by column
};

}  // namespace carom
