#pragma once

/// \file
/// Contacts that stay closed for a while (docs/method.md, section 7). Their normals, and the tangents of
/// those that stick, are constraints on the accelerations; those that slip rub against their motion. With the
/// rows G of the constraints and the columns D along which their forces act (the normal turned into the cone
/// of friction where a contact slips) find lambda with
///
///     G a + drift = 0,   a = a_free + M^-1 D lambda.
///
/// Contacts of different bodies do not know of each other, unless joints bind the bodies together: a contact
/// then moves all that is bound, and M^-1 stands for what joints leave of it
/// (core/dynamics/joint_constraints.h).

#include <carom/contact/detection/detector.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/least_distance.h>
#include <carom/core/numerics/lemke.h>

#include <span>
#include <vector>

namespace carom {

/// A contact in a smooth phase.
struct ActiveContact {
  ContactPair pair;                       ///< what touches
  Index place = none;                     ///< of the pair in a list of all, where there is one
  ContactMode mode = ContactMode::stick;  ///< stick, slip+ or slip-
  bool frictionless = false;              ///< without friction: neither sticks nor cares which way it slips
  Constraint at;                             ///< at the present configuration
  double friction = 0.0;                  ///< coefficient: sliding where it slips, static where it sticks
  double normal = 0.0;                    ///< force; of friction in a joint Constraint::friction_bound [N]
  double tangential = 0.0;                ///< force; of friction in a joint along its coordinate [N, N m]
  /// False where forces were shared out and it is at its end by chance: others set the margin.
  bool sets_margin = true;

  /// True if the tangent is a constraint.
  [[nodiscard]] bool sticks() const { return mode == ContactMode::stick; }
  /// Sign of the sliding velocity, 0 if it sticks.
  [[nodiscard]] double slip_sign() const {
    return mode == ContactMode::slip_positive ? 1.0 : mode == ContactMode::slip_negative ? -1.0 : 0.0;
  }
  /// The coefficient of friction at a configuration and velocities of all bodies. A step may look beyond the
  /// end of sliding: the curve goes on smoothly there.
  [[nodiscard]] double friction_at(const Constraint& where, const double* velocities) const;
};

/// One of the equations that forces of closed contacts were found by, and the force that it was solved for.
struct ContactPivot {
  /// A direction of a contact.
  struct Row {
    std::size_t contact = 0;  ///< its place in the list
    bool tangent = false;     ///< the tangent if it sticks; else the normal
  };
  Row equation;  ///< whose acceleration vanishes
  Row force;     ///< that of a normal pushes in the direction of the cone of friction where the contact slips
};

/// How far the forces of the contacts of one body, or of bodies that joints bind, are from where their modes
/// end.
struct ForceMargin {
  std::size_t first = 0, last = 0;  ///< contacts
  double margin = 0.0;              ///< the least normal force or distance from the edge of a cone [N]
};

/// The closed contacts of one component, in the order of its pairs. Keeps memory only, but the contacts.
class CAROM_API ActiveSet {
public:
  /// Tells which joints bind the bodies; they must outlive it, and be located wherever forces are asked for.
  void bind(const Assembly& assembly, JointConstraints& joints);
  /// Of forces that are not unique the least in the sense of least squares that the law of contact allows, in
  /// place of any: for those who depend on them, since they are continuous, also where modes change.
  void ask_least() { least_ = true; }

  /// The contacts.
  [[nodiscard]] std::vector<ActiveContact>& list() { return contacts_; }
  [[nodiscard]] const std::vector<ActiveContact>& list() const { return contacts_; }

  /// Brings `at` and the coefficients of sliding contacts to a state.
  void update_and_factor(const Detector& detector, const StateView& state, const Evaluation& evaluation,
                         const ObstaclePlaces& places);
  /// Finds the forces and adds what they do to the accelerations. \param acceleration of all bodies, in:
  /// a_free False where no forces keep the constraints; the contacts' forces are then not finite.
  bool add_reactions(const Assembly& assembly, double* acceleration);
  /// How it found them. Constraints that follow from others are not among them, nor are forces that were
  /// left zero.
  [[nodiscard]] const std::vector<ContactPivot>& pivots() const { return pivots_; }
  /// Margins of the forces of the last add_reactions(), a number for every body that touches. Where forces
  /// are not unique (a brick that sticks at two corners), they are shared out so that the margin is largest.
  void margins(std::vector<ForceMargin>& out);

  /// Takes the gaps out of the positions, and what moves the constraints out of the velocities, by the
  /// smallest changes in the sense of the masses; both are added to changes of all velocity coordinates that
  /// are under way. False where there are none.
  bool corrections(const Assembly& assembly, const double* velocity, double* of_position,
                   double* of_velocity);

private:
  using Row = ContactPivot::Row;
  template <class F>
  void for_groups(F&& f);
  void lay_out(const Assembly& assembly, std::size_t first, std::size_t last, bool rubbing);
  void dry_friction(std::size_t first, std::size_t last, double* acceleration);
  bool solve();
  void find_null_vector(std::size_t free);
  void take_least(std::size_t first, std::size_t last);
  void collect_lines(std::size_t first, std::size_t last);
  void take_allowed(std::size_t first, std::size_t last);
  void spread(std::size_t first, std::size_t last);
  bool distribute_forces(std::size_t from, std::size_t to);

  [[nodiscard]] Index group(const ActiveContact& contact) const {
    return joints_ == nullptr ? contact.at.body() : assembly_->mechanism(contact.at.body());
  }

  std::vector<ActiveContact> contacts_;
  const Assembly* assembly_ = nullptr;
  JointConstraints* joints_ = nullptr;  // null where there are none
  Range span_;                          // velocities that the group at hand moves
  std::vector<double> full_;            // numbers over all velocities, of bound bodies
  std::vector<Row> rows_;               // of the group at hand
  std::vector<double> response_;        // M^-1 D, by row, over span_
  std::vector<double> matrix_;          // G M^-1 D, then its factors
  std::vector<double> unknown_;         // right side, then lambda
  std::vector<double> work_;
  std::vector<std::size_t> row_order_, column_order_;
  std::size_t rank_ = 0;
  bool least_ = false;
  std::vector<double> orthonormal_;        // null vectors, of take_least()
  std::vector<double> lines_at_, slopes_;  // margins without them and their slopes, line by line
  LeastDistance least_distance_;
  std::vector<ContactPivot> pivots_;
  std::vector<double> null_;  // null vectors of the systems last solved, by group
  struct Spread {
    std::size_t first = 0, last = 0;  // contacts
    std::size_t vector = 0;           // begin in null_: normal and tangential numbers of the contacts in turn
  };
  std::vector<Spread> spreads_;
  struct Line {
    double at = 0.0, slope = 0.0;  // a margin along a null vector
  };
  std::vector<Line> lines_;
  Lemke lemke_;  // shares out forces of more than one freedom
  Lcp lcp_;
};

}  // namespace carom
