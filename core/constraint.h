#pragma once

/// \file
/// A constraint that pushes or rubs: which features meet, how deep, and the map from the velocities of its
/// bodies to the velocities along its rows.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/surface.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace carom {

class RowStore;
class SingleConstraint;

/// One feature of something that can touch.
struct FeatureKey {
  /// Owner of the feature.
  enum class Owner : std::uint8_t {
    body,      ///< a body that touches at its centre
    shape,     ///< a shape of a body
    obstacle,  ///< a shape on ground
    joint      ///< a limit of a joint, or friction in one
  };

  Owner owner = Owner::body;  ///< what it belongs to
  Index serial = none;        ///< serial number of the owner
  Index feature = 0;          ///< number of the feature within its owner
  friend auto operator<=>(const FeatureKey&, const FeatureKey&) = default;
  friend bool operator==(const FeatureKey& one, const FeatureKey& other) {  // compared often: no branches
    const Index owners = static_cast<Index>(one.owner) ^ static_cast<Index>(other.owner);
    return (owners | (one.serial ^ other.serial) | (one.feature ^ other.feature)) == 0;
  }
};

/// Identity of a constraint: two features, the lesser first. Of a limit of a joint, and of friction in one,
/// both are that of the joint. It keys reports, modes and warm starts and survives edits and checkpoints.
struct ConstraintKey {
  FeatureKey a;  ///< feature of a body or shape, or of a joint
  FeatureKey b;  ///< feature of the other body, of what is fixed to the ground, or of the same joint

  /// True of a limit of a joint and of friction in one, which have no place where features touch.
  [[nodiscard]] bool is_of_joint() const { return a.owner == FeatureKey::Owner::joint; }
  friend auto operator<=>(const ConstraintKey&, const ConstraintKey&) = default;
};

/// State of one planar contact after its problem is solved.
enum class ContactMode : std::uint8_t {
  open,           ///< no impulse
  stick,          ///< mean tangential velocity zero
  slip_positive,  ///< mean tangential velocity > 0, friction -mu P_n
  slip_negative,  ///< mean tangential velocity < 0, friction +mu P_n
  slip            ///< slipping in the plane of a spatial contact
};

/// Name of a mode: "open", "stick", "slip+", "slip-", "slip".
[[nodiscard]] CAROM_API std::string_view to_string(ContactMode mode);

/// A constraint of one to three bodies at one configuration, against each other or against what is fixed to
/// the ground, without the numbers of its rows. The normal row comes first, if there is one, with P_n >= 0;
/// the others are tangential, with |P_t| <= friction times a bound. Who makes a constraint says how many rows
/// of which kind there are, and whose force the bound is:
/// - a contact has one normal row, and one tangential row in the plane or two in space, bounded by its own
/// P_n;
/// - a limit of a joint has a normal row alone;
/// - friction in a joint has a tangential row alone, bounded by a given number, OfJoint::friction_bound;
/// - rolling resistance has a tangential row alone, along a spin, bounded by P_n of the contact that it is
///   attached to.
///
/// The normal of a contact points from `b` of the key towards `a`; its tangent in the plane is the normal
/// turned clockwise.
struct ConstraintHead {
  static constexpr int max_rows = 3;
  static constexpr int max_bodies = 3;

  /// Columns of one body.
  struct Block {
    Index body = none;  ///< in the order of assembly
    Index v = 0;        ///< its first velocity
    int columns = 0;    ///< its velocities
  };

  /// Numbers of a limit of a joint, and of friction in one; the length of rolling resistance, which is along
  /// a spin, too.
  struct OfJoint {
    double friction_bound = 0.0;  ///< of friction: `friction` times it is the largest force, or impulse [N]
    /// Factor of the coordinate, so that all rows have lengths: 1 where it is one; else an arm [m], with
    /// which velocities along the row are those of places on bodies. The moment of a force along the row is
    /// the force times it.
    double length = 1.0;
    Index source = none;  ///< of a limit and of friction in a joint: its number in the detector
  };

  // Numbers that the problem of a contact reads come first and close together: many contacts are read in
  // turn.
  std::uint8_t normals = 1;  ///< number of normal rows: 1, or 0 where all rows are tangential
  /// 1 of a constraint that is attached to the one before it in every list, else 0: its tangential row is
  /// bounded by the normal force of that one, in whose group of the contact problem and record it is.
  std::uint8_t attached = 0;
  int rows = 0;                                         ///< of a contact 2 in the plane, 3 in space
  int bodies = 0;                                       ///< blocks in use
  std::array<Block, std::size_t{max_bodies}> blocks{};  ///< bodies whose velocities have columns
  /// The coefficient of friction that acts: law.friction_at() the sliding speed found, in time stepping
  /// law.sticking_friction() where it stuck in the step before.
  double friction = 0.0;
  Surface law;  ///< coefficients
  /// Normal velocity with which it may approach at the end of a time step, beyond its law [m/s]: of a lasting
  /// contact that turning has opened, and of one that couplings open and draw back. Else 0.
  double allowed_approach = 0.0;
  std::array<double, static_cast<std::size_t>(max_rows)>
      surface_velocity{};  ///< of the moving ground shape where it is touched, along the rows [m/s]
  /// Velocity of the same place of the ground shape at the end of a time step, along the rows; else the same
  /// as surface_velocity [m/s].
  std::array<double, static_cast<std::size_t>(max_rows)> surface_velocity_after{};

  ConstraintKey key;  ///< identity
  double gap = 0.0;   ///< negative where violated [m]
  OfJoint of_joint;   ///< of a limit of a joint, of friction in one, of rolling resistance
  std::array<double, static_cast<std::size_t>(max_rows)>
      drift{};  ///< rate of the velocities along the rows at constant velocities of the bodies [m/s^2]

  /// Number of tangential rows: 0 of a limit.
  [[nodiscard]] int tangents() const { return rows - normals; }
  /// Row along which it may stick: the first tangential one. Of a limit, that of zeros behind its own.
  [[nodiscard]] int tangent_row() const { return normals; }
  /// True if its tangential row is bounded by a given force, OfJoint::friction_bound, and not by the normal
  /// force of a constraint.
  [[nodiscard]] bool has_given_bound() const { return normals + attached == 0; }
  /// Restitution along a row.
  [[nodiscard]] double restitution(int i) const {
    return i >= normals ? law.tangential_restitution : law.normal_restitution;
  }
  /// Makes it an impact without rebound. Rolling resistance is a constraint of its own.
  void remove_restitution() { law.normal_restitution = law.tangential_restitution = 0.0; }
  /// Its first body.
  [[nodiscard]] Index body() const { return blocks[0].body; }
  /// Appends a body, before the rows are. \param v first of its velocities \param width their number
  void add_body(Index body, Index v, int width) {
    blocks[static_cast<std::size_t>(bodies++)] = {body, v, width};
  }
  /// Forgets all bodies.
  void clear_bodies() {
    bodies = 0;
    blocks = {};
  }
  /// Number of columns of all bodies: numbers of a row.
  [[nodiscard]] int columns() const { return blocks[0].columns + blocks[1].columns + blocks[2].columns; }
  /// Makes it as by default. Room for rows stays.
  void clear() { *this = {}; }
  /// Makes it ready for a contact, whatever it was: what not every contact writes is as made by default. Key,
  /// law, friction and gap are to be written, bodies and rows to be added.
  void start_contact() {
    if (rows == 1) return clear();                           // it was no contact
    drift = surface_velocity = surface_velocity_after = {};  // of a contact the rest is as made by default
    allowed_approach = 0.0;
    clear_bodies();
  }
  /// True if its rows turn: velocities along them change although those of the bodies do not. \param step of
  /// how long [s] \param negligible motion by that over the step that does not count [m]
  [[nodiscard]] bool turns(double step, double negligible) const {
    const double all = std::abs(drift[0]) + std::abs(drift[1]) + std::abs(drift[2]);
    return !(step * step * all <= negligible);
  }
  /// Makes a constraint of a time step that of its first part. \param part 0 to 1: share of the step
  void shorten(double part) {
    for (std::size_t i = 0; i < surface_velocity.size(); ++i) {
      surface_velocity_after[i] =
          surface_velocity[i] + part * (surface_velocity_after[i] - surface_velocity[i]);
    }
  }
};

/// Where the numbers of the rows of one constraint stand. It is moved only.
struct RowRoom {
  double* first = nullptr;    ///< the first number
  std::size_t size = 0;       ///< so many numbers have room
  RowStore* store = nullptr;  ///< of the set; null of a single constraint

  RowRoom() = default;
  /// No room yet, of a set.
  explicit RowRoom(RowStore* of_set) : store(of_set) {}
  /// Leaves the other one without room.
  RowRoom(RowRoom&& other) noexcept { swap(other); }
  /// Both exchange their room, so that none is lost when members of a set change places.
  RowRoom& operator=(RowRoom&& other) noexcept {
    swap(other);
    return *this;
  }
  ~RowRoom() = default;

private:
  void swap(RowRoom& other) {
    assert(size == 0 || store != nullptr);  // that of a single constraint is within it
    assert(other.size == 0 || other.store != nullptr);
    std::swap(first, other.first);
    std::swap(size, other.size);
    std::swap(store, other.store);
  }
};

/// A constraint with its rows. It stands in a set, which holds the numbers of the rows of all (ConstraintSet,
/// core/constraint_set.h), or alone (SingleConstraint); nothing else copies one, and what is moved stays in
/// the same set.
class Constraint : public ConstraintHead {
public:
  /// A constraint of a set. \param store of the set, which must outlive it
  explicit Constraint(RowStore& store) : room_(&store) {}
  Constraint(SingleConstraint&&) = delete;  // its room is within it
  Constraint& operator=(SingleConstraint&&) = delete;

  /// Gives it rows of the bodies that it has; their numbers are to be written, all of them. Behind a single
  /// row stands one of zeros: a limit has no velocity along a tangent. \param count 1 to max_rows
  void start_rows(int count) {
    rows = count;
    const int width = columns(), placed = std::max(count, 2);
    if (const auto needed = static_cast<std::size_t>(placed * width); needed > room_.size) grow(needed);
    if (count < placed) std::fill_n(room_.first + width, width, 0.0);
  }
  /// Takes everything but its place from a constraint of any set.
  void take(const Constraint& other) {
    static_cast<ConstraintHead&>(*this) = other;
    take_rows(other);
  }
  /// Takes the numbers of the rows of a constraint that has as many, of the same bodies.
  void take_rows(const Constraint& other) {
    assert(columns() == other.columns());
    start_rows(other.rows);
    std::copy_n(other.room_.first, rows * columns(), room_.first);
  }
  /// Row i of the Jacobian, columns() numbers, block after block; the next one stands behind it.
  [[nodiscard]] const double* row(int i) const { return room_.first + columns() * i; }
  [[nodiscard]] double* row(int i) { return room_.first + columns() * i; }
  /// Row i times numbers of the bodies. \param numbers an array over all velocities
  [[nodiscard]] double times(int i, const double* numbers) const {
    double sum = 0.0;
    for_columns(i, [&](double h, Index v) { sum += h * numbers[v]; });
    return sum;
  }
  /// Adds row i, transposed, times a number. \param out an array over all velocities
  void add_transposed(int i, double factor, double* out) const {
    for_columns(i, [&](double h, Index v) { out[v] += factor * h; });
  }
  /// Velocity along row i: of the bodies, against the surface. \param velocities of all bodies
  [[nodiscard]] double velocity(int i, const double* velocities) const {
    return times(i, velocities) - surface_velocity[static_cast<std::size_t>(i)];
  }
  /// Sum of the magnitudes that the velocity along row i is the sum of [m/s]: what its rounding is to be
  /// measured with. \param velocities of all bodies
  [[nodiscard]] double speed(int i, const double* velocities) const {
    double sum = std::abs(surface_velocity[static_cast<std::size_t>(i)]);
    for_columns(i, [&](double h, Index v) { sum += std::abs(h * velocities[v]); });
    return sum;
  }
  /// Speed of sliding [m/s]. \param velocities of all bodies
  [[nodiscard]] double sliding_speed(const double* velocities) const {
    const double along = velocity(tangent_row(), velocities);
    return rows < 3 ? std::abs(along) : std::hypot(along, velocity(2, velocities));
  }
  /// Velocity along the normal; 0 of a row without one. \param velocities of all bodies
  [[nodiscard]] double normal_velocity(const double* velocities) const {
    return normals == 0 ? 0.0 : velocity(0, velocities);
  }
  /// Velocity along the tangent of the plane, or along the coordinate of the joint; 0 of a limit.
  [[nodiscard]] double tangential_velocity(const double* velocities) const {
    return velocity(tangent_row(), velocities);
  }
  /// Acceleration along the normal; 0 of a row without one. \param accelerations of all bodies
  [[nodiscard]] double normal_acceleration(const double* accelerations) const {
    return normals == 0 ? 0.0 : acceleration(0, accelerations);
  }
  /// Acceleration along the tangent of the plane, or along the coordinate of the joint; 0 of a limit.
  [[nodiscard]] double tangential_acceleration(const double* accelerations) const {
    return acceleration(tangent_row(), accelerations);
  }
  /// Velocity along row i after the time step or impact. \param velocities of all bodies, then
  [[nodiscard]] double velocity_after(int i, const double* velocities) const {
    return times(i, velocities) - surface_velocity_after[static_cast<std::size_t>(i)];
  }
  /// Rate of the velocity along row i. \param accelerations of all bodies
  [[nodiscard]] double acceleration(int i, const double* accelerations) const {
    return times(i, accelerations) + drift[static_cast<std::size_t>(i)];
  }

protected:
  /// A constraint without room for rows.
  Constraint() = default;
  /// Stands alone, with room of its own.
  void stand_alone(double* numbers, std::size_t count) {
    room_.first = numbers;
    room_.size = count;
  }

private:
  /// Calls f(number of row i, its place among all velocities).
  template <class F>
  void for_columns(int i, F&& f) const {
    constexpr int of_planar_body = 3;
    if (bodies == 1 && blocks[0].columns <= of_planar_body) {  // the usual case, without loops
      const int width = blocks[0].columns;
      const double* const h = room_.first + width * i;
      const Index v = blocks[0].v;
      f(h[0], v);
      f(h[1], v + 1);
      if (width == of_planar_body) f(h[2], v + 2);
      return;
    }
    const double* h = row(i);
    for (int b = 0; b < bodies; ++b) {
      const Block& block = blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) f(*h++, block.v + static_cast<Index>(c));
    }
  }

  CAROM_API void grow(std::size_t needed);

  RowRoom room_;
};

}  // namespace carom
