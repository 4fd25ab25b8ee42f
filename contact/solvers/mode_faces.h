#pragma once

/// \file
/// Modes of the contacts of a small planar problem and boundaries of these, and the linear equations of each
/// combination of them.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Faces of the groups of one problem: each a mode, or a boundary of one. A choice names one for each group.
class CAROM_API ModeFaces {
public:
  /// Size of the equations of a choice.
  struct Size {
    std::size_t unknowns = 0;
    std::size_t equations = 0;
    bool pure = true;  ///< of modes only
  };

  /// Lists the faces of each group. False for a problem that cannot be enumerated (solution_list.h).
  bool build(const ContactProblem& problem);

  [[nodiscard]] std::size_t groups() const { return faces_.size(); }  ///< number of groups
  [[nodiscard]] std::size_t count(std::size_t group) const { return faces_[group].size(); }  ///< its faces
  /// Size of the equations of a choice.
  [[nodiscard]] Size size(std::span<const std::size_t> choice) const;
  /// Writes the equations of a choice, scaled by sqrt(rho) of their group so that masses drop out.
  void write_equations(const ContactProblem& problem, std::span<const std::size_t> choice,
                       std::span<const double> rho, std::vector<double>& system,
                       std::vector<double>& rhs) const;
  /// Writes the impulses that unknowns x of a choice stand for, without the given ones.
  void place(std::span<const std::size_t> choice, std::span<const double> x,
             std::span<double> impulses) const;
  /// Adds the given impulses of a choice.
  void add_offsets(std::span<const std::size_t> choice, std::span<double> impulses) const;

private:
  // One mode of one group, or a boundary of one: unknowns, equations, and the given impulse.
  struct Face {
    static constexpr std::size_t most_rows = 2;  // of friction: tangential, and against rolling
    double offset = 0.0;                         // given impulse of the first row
    bool carries = false;                        // that impulse is unknown
    std::array<bool, most_rows> free{};          // so are those of friction rows; else
    std::array<double, most_rows> slope{};       // they are as many times that of the first row
    std::array<bool, 1 + most_rows> vanishes{};  // rows whose xi vanishes
    bool pure = true;                            // a mode, not a boundary
  };
  bool add_contact(const ContactProblem& problem, const RowGroup& group, std::vector<Face>& faces) const;

  std::vector<RowGroup> groups_;
  std::vector<std::vector<Face>> faces_;
};

}  // namespace carom
