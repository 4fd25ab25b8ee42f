#pragma once

/// \file
/// Contacts that share bodies are one problem. This makes that problem from the contacts and the velocities
/// before and without impulses, and applies its answer:
///     W = H M^-1 H^T,   b = H v_free + E H v^-,   v^+ = v_free + M^-1 H^T P,
/// to b in normal direction Constraint::allowed_approach is added.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

namespace carom {

/// One contact problem with its way back to the bodies. Reuse it: its memory is kept.
class CAROM_API ContactCluster {
public:
  /// Takes contacts that share bodies, and the velocities v^- before the step or impact (all velocities).
  void build(const Assembly& assembly, std::span<const Constraint> contacts, const double* velocity_before);
  /// Replaces W by H A^-1 H^T, where the bodies answer an impulse together: A is positive definite over the
  /// velocities `v`, `solve` overwrites numbers over them by A^-1 times them. Of a matrix that is only nearly
  /// symmetric W takes one half; that is good enough for set_velocity().
  void couple(Range v, const std::function<void(double*)>& solve);
  /// Likewise where joints bind the bodies, which must have been located.
  void couple(JointConstraints& joints);
  /// Likewise for impulses that act with the answer of the joints, C P, C = K H^T from couple(joints):
  /// W = C^T M A^-1 M C. \param mass p = M x
  void couple_again(const std::function<void(const double* x, double* p)>& mass,
                    const std::function<void(double*)>& solve);
  /// Takes note of another Constraint::friction_bound of friction in a joint.
  void press(std::size_t contact);
  /// Makes a planar contact slip whatever its tangential velocity: P_t = ratio P_n.
  void slide(std::size_t contact, double ratio);
  /// Makes b from the velocities that the step would end with if no contact acted, against those of the
  /// obstacles then (Constraint::velocity_after).
  void set_free_velocity(const double* velocity_free);
  /// Likewise from velocities to which the impulses at hand have led: they remain the answer if they are one.
  void set_velocity(const double* velocity);
  /// Solves. The report says whether impulses() may be used. Solving several contacts again since build()
  /// keeps to the modes of the answer before as long as they are those of a solution: an iteration around it
  /// could not settle if it jumped between several, and the solvers are spared. Only they can tell that there
  /// are several solutions; the report keeps to their word.
  [[nodiscard]] const ContactReport& solve(SolverChain& chain);
  /// Replaces the answer, and its modes, by another solution of the problem.
  void set_impulses(std::span<const double> impulses);
  /// Sets all impulses to zero.
  void forget_impulses() { std::fill(impulse_.begin(), impulse_.end(), 0.0); }
  /// Adds M^-1 H^T P to the velocities.
  void apply(double* velocity) const;
  /// Adds `scale` A^-1 H^T P to the velocities, A as given to couple().
  void apply_coupled(double* velocity, double scale = 1.0) const;
  /// Adds `scale` H^T P to the loads.
  void add_loads(double scale, double* load) const;

  /// Work of the impulses on what moves the obstacles of one contact, P.(w^- + w^+)/2 with the obstacle's
  /// velocities w before and after: what enters as external work [J].
  [[nodiscard]] double obstacle_work(std::size_t contact) const;

  /// The problem.
  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  /// The contacts, in the order of build().
  [[nodiscard]] std::span<const Constraint> contacts() const { return contacts_; }
  /// Velocities gamma^- of all rows [m/s].
  [[nodiscard]] std::span<const double> before() const { return before_; }
  /// Impulses of all rows [N s].
  [[nodiscard]] std::span<const double> impulses() const { return impulse_; }
  /// Modes of the contacts.
  [[nodiscard]] std::span<const ContactMode> modes() const { return modes_; }
  /// True if the last solution has other modes than the one before it since build().
  [[nodiscard]] bool changed_modes() const { return changed_modes_; }
  /// Report of the last solution.
  [[nodiscard]] const ContactReport& report() const { return report_; }
  /// Place of row 0 of a contact, the others behind it; of friction in a joint only the row behind is there.
  [[nodiscard]] int first_row(std::size_t contact) const { return first_row_[contact]; }

private:
  [[nodiscard]] bool keep_modes();

  std::span<const Constraint> contacts_;
  ContactProblem problem_;
  std::vector<int> first_row_;
  std::vector<double> slides_;  // by contact: of friction in a joint the ratio given to slide(), or 0
  std::vector<double> before_, restitution_, impulse_;
  std::vector<double> response_;  // M^-1 H^T, one row of max_columns numbers per contact row
  Range coupled_range_;
  std::vector<double> coupled_;  // A^-1 H^T, one row over coupled_range_ per contact row
  std::vector<double> loads_;    // likewise, M C
  std::vector<ContactMode> modes_;
  ContactReport report_;
  NewtonPolish polish_;
  std::vector<double> kept_impulse_, xi_, kept_xi_;
  std::vector<ContactMode> kept_modes_;
  bool solved_ = false;  // since build()
  bool changed_modes_ = false;
};

}  // namespace carom
