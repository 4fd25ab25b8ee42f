#pragma once

/// \file
/// Finds the contacts of bodies with obstacles: all pairs of a rounded point and an obstacle whose gap is
/// closed (Johansson 1999, section 4: violated contacts take part in a step).

#include <carom/contact/detection/lasting_contacts.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/discontinuity.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// A feature of a body and an obstacle, wherever they stand; or a stop of a joint, or friction in one.
struct ContactPair {
  Index body = none;      ///< in the order of assembly
  Index feature = none;   ///< of the detector; `none` where the body touches at its centre
  Index material = none;  ///< row of the detector's table of laws
  Index obstacle = none;  ///< of the detector; `none` of a stop
  Index stop = none;      ///< of the detector, or friction in a joint; `none` of an obstacle
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

/// Where the moving obstacles of a detector are at one time. A workspace that Detector::place() fills.
class ObstaclePlaces {
public:
  /// The time; NaN before it was ever filled [s].
  [[nodiscard]] double time() const { return time_; }

private:
  friend class Detector;
  double time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<GroundMotion> motions_;  // of the obstacles that move, in the detector's order
};

/// Features of the bodies of an assembly and the laws they obey.
class CAROM_API Detector {
public:
  /// Bodies that a joint binds, in the order of assembly; `none` behind the last.
  using JointBodies = std::array<Index, std::size_t{Constraint::max_bodies}>;

  /// Throws ModelError where a feature and an obstacle have no contact law.
  explicit Detector(const Assembly& assembly);

  /// True if an obstacle moves.
  [[nodiscard]] bool has_moving_obstacles() const { return moving_ > 0; }
  /// Says where the moving obstacles are at a time; does nothing if `places` already says so for this
  /// detector. Throws SolverError, naming the obstacle, where a prescribed motion is not finite.
  void place(double time, ObstaclePlaces& places) const;
  /// Demands that no moving obstacle jumps between two times: places `before` and `after`, both of this
  /// detector. Throws SolverError naming the obstacle, the time, and by how much it jumps (core/law_jump.h).
  void demand_continuous(const ObstaclePlaces& before, const ObstaclePlaces& after) const;
  /// Times at which motions of obstacles have jumps or kinks, in the order of obstacles. Made at each call.
  [[nodiscard]] std::vector<Discontinuity> breaks() const;

  /// Appends the contacts of one component whose gap is <= `margin` [m], ordered by body, then feature, then
  /// obstacle. The position group of `evaluation` must be up to date. Places obstacles by itself.
  void find(Index component, const StateView& state, const Evaluation& evaluation, double margin,
            std::vector<Constraint>& out) const;
  /// Likewise with the obstacles at `places`, which must be of the state's time.
  /// \param after obstacles at the end of the step that begins with the state, for
  /// Constraint::surface_velocity_after; null: no time passes
  /// \param lasting contacts of the step before, found also where turning may have opened them; null: none
  void find(Index component, const StateView& state, const Evaluation& evaluation,
            const ObstaclePlaces& places, const ObstaclePlaces* after, double margin,
            std::vector<Constraint>& out, const LastingContacts* lasting = nullptr) const;
  /// Says which contacts of a step turning may have opened. \param contacts of the step, as
  /// Companion::modes \param step length of a step that gaps may come from [s]
  void remember(std::span<const std::pair<ConstraintKey, ContactMode>> contacts, double step,
                LastingContacts& out) const;

  /// All pairs of one component, in the order of find(). Made at each call.
  [[nodiscard]] std::vector<ContactPair> pairs(Index component) const;
  /// Friction in the joints of one component. Made at each call.
  [[nodiscard]] std::vector<ContactPair> rubbing(Index component) const;
  /// Appends it as contacts, whose `friction_bound` has the constant part of the bound. Sets nothing of the
  /// past.
  void find_joint_friction(Index component, const StateView& state, const Evaluation& evaluation,
                           std::vector<Constraint>& out) const;
  /// True if there is any in a component.
  [[nodiscard]] bool has_dry_friction(Index component) const {
    return !of_component_[component].rubbing.empty();
  }
  /// Brings the row of friction in a joint to a configuration, and its drift.
  void update_friction_rows(const JointView& at, Constraint& contact) const;
  /// The contact of a pair, whatever its gap. The position group of `evaluation` must be up to date. Places
  /// its obstacle by itself.
  void contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
               Constraint& out) const;
  /// Likewise with the obstacles at `places`, which must be of the state's time.
  void contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
               const ObstaclePlaces& places, Constraint& out) const;

  /// True if some surface takes more to slip than to slide.
  [[nodiscard]] bool has_static_friction() const { return has_static_friction_; }

  /// True if the obstacle of a pair moves.
  [[nodiscard]] bool moves(const ContactPair& pair) const {
    return pair.stop == none && obstacles_[pair.obstacle].moving != none;
  }

  /// True if find() looks at the rotations of bodies: a feature stands off a centre of mass.
  [[nodiscard]] bool needs_rotations() const;

  /// As contact_name() of the assembly's system.
  [[nodiscard]] std::string name(const ConstraintKey& key) const;

private:
  // A point of a shape.
  struct Feature {
    Index body;      // in the order of assembly
    Index material;  // row of the law table
    FeatureKey key;
    std::array<double, 3> centre;
    double radius;
  };
  // Neighbouring bodies of one kind and component that touch at their centres.
  struct Centres {
    Range bodies;
    Index material;
  };
  // Features of one component that can touch: ranges of centres_ and features_.
  struct Touching {
    Range centres, features, stops, rubbing;
  };
  // A unilateral row of a joint, or friction in one (`which`: none).
  struct Stop {
    const JointKind* kind;
    Index slot, which;
    Index serial;
    JointBodies bodies;  // that it binds
  };
  struct Obstacle {
    const GroundShapeKind* kind;
    Index slot;
    Index serial;
    Index moving;  // its place among those that move; `none`: at rest
  };
  // Question to find().
  struct Query {
    const StateView& state;
    const Evaluation& evaluation;
    const ObstaclePlaces* places;  // null where nothing moves
    const ObstaclePlaces* after;   // null where no time passes
    double margin;
    const LastingContacts* lasting;  // null where there are none
  };

  void collect_obstacles();
  void collect_features();
  [[nodiscard]] Index row_of(MaterialId material);
  void collect_centres();
  void make_law_table();
  void collect_stops();
  void collect_rubbing();
  // Calls f(kind, slot, serial, the bodies) for joints of one component that limit or rub.
  template <class F>
  void for_joints(Index component, F&& f) const;
  // Writes the contact of a stop or of friction.
  void make_stop(Index number, const StateView& state, const Evaluation& evaluation, Constraint& out) const;
  [[nodiscard]] Feature centre_of(const BodySlot& body, Index place, Index material) const;
  [[nodiscard]] GroundMotion motion(const Obstacle& obstacle, double time) const;
  template <int D>
  void add(const BodySlot& body, const Feature& feature, const Query& query,
           std::vector<Constraint>& out) const;
  // Position of the centre of a feature from its body's centre of mass.
  template <int D>
  [[nodiscard]] static Vec<D> arm(const BodySlot& body, const Feature& feature, const Evaluation& evaluation);
  template <int D>
  void fill(const BodySlot& body, const Feature& feature, Index obstacle, const Gap& gap, const Vec<D>& arm,
            const StateView& state, Constraint& out) const;
  // Terms of the motion of the obstacle. `after` may be null.
  static void fill_motion(const BodySlot& body, double radius, const Vec<2>& arm, const StateView& state,
                          const GroundMotion& motion, const GroundMotion* after, Constraint& out);
  // Whether an open contact lasts. `turning`: bound on its drift by turning.
  [[nodiscard]] static bool lasts(const Query& query, const ConstraintKey& key, double gap, double turning);
  // Share of the obstacle's motion in that bound.
  [[nodiscard]] static double turning_of(const BodySlot& body, const Vec<2>& arm, const StateView& state,
                                         const GroundMotion& motion, double above);
  // Friction where it depends on the speed of sliding.
  static void set_friction(const StateView& state, Constraint& contact);
  void make_contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                    const GroundMotion* motion, Constraint& out) const;
  void find(Index component, const Query& query, std::vector<Constraint>& out) const;
  template <int D>
  void find_in(Index component, const Query& query, std::vector<Constraint>& out) const;

  const Assembly* assembly_;
  std::vector<Obstacle> obstacles_;
  Index moving_ = 0;               // obstacles that move
  std::vector<Centres> centres_;   // ordered by body
  std::vector<Feature> features_;  // ordered by body
  std::vector<Stop> stops_;        // by component, then friction by component
  std::vector<Touching> of_component_;
  std::vector<MaterialId> materials_;  // rows of the law table
  std::vector<Surface> laws_;          // row-major: material, obstacle
  bool has_static_friction_ = false;   // any of them
};

}  // namespace carom
