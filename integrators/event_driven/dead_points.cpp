// Problem: in which direction does a slider leave its dead point?

#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/numerics/full_pivoting.h>
#include <carom/integrators/event_driven/dead_points.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace carom {

namespace {

// The response of bodies along a row that joints leave is rounding below this part of it.
constexpr double held_fast = 1e-12;
// Rounding of what is looked at a moment later, against the speeds then.
constexpr double rounding_ahead = 1e-9;
// How far the motion is followed: turns [rad], and ways against the size of the mechanism. Short against all
// that bends, long against rounding.
constexpr double far_enough = 1e-2;

/// Response of the bodies of a constraint along its row of friction, were there no joints.
double own_response(const Assembly& assembly, const Constraint& contact) {
  constexpr std::size_t most_columns = 6;
  double sum = 0.0;
  const double* row = contact.row(contact.tangent_row());
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    std::array<double, most_columns> moved{};
    assembly.for_bodies(Range{block.body, block.body + 1},
                        [&](const BodyKind& kind, Range slots, Index, Index, Index) {
                          kind.apply_inverse_mass(slots, row, moved.data());
                        });
    for (int i = 0; i < block.columns; ++i) sum += row[i] * moved[static_cast<std::size_t>(i)];
    row += block.columns;
  }
  return sum;
}

/// True of a candidate that stays closed and pushes along a normal.
bool presses(const Candidate& candidate) {
  return candidate.mode != ContactMode::open && candidate.at.normals > 0;
}

/// Responses along rows of a problem where the normals of what is closed hold, besides the joints: a slider
/// that stands on a floor could turn, were it not for the floor.
class ResponseOnFloors {
public:
  ResponseOnFloors(const ModeDecision& made, std::span<const Candidate> candidates)
      : problem_(made.problem()) {
    for (std::size_t c = 0; c < made.taking_part().size(); ++c) {
      if (presses(candidates[made.taking_part()[c]])) normals_.push_back(problem_.first_row(c));
    }
  }

  /// Response along a row; by joints alone where very many contacts press.
  [[nodiscard]] double along(int row) {
    constexpr std::size_t most = 32;
    const double response = problem_.problem().w(row, row);
    const std::size_t n = normals_.size();
    if (n == 0 || n > most) return response;
    right_.resize(n);
    for (std::size_t i = 0; i < n; ++i) right_[i] = problem_.problem().w(normals_[i], row);
    if (!(is_factored_ ? factors_.solve_again(right_) : factor())) return response;
    double left = response;
    for (std::size_t i = 0; i < n; ++i) left -= problem_.problem().w(row, normals_[i]) * right_[i];
    return left;
  }

private:
  [[nodiscard]] bool factor() {
    constexpr double dependent = 1e-11;
    const std::size_t n = normals_.size();
    factors_.reset(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        factors_.matrix()[i * n + j] = problem_.problem().w(normals_[i], normals_[j]);
    }
    is_factored_ = factors_.solve(dependent, right_);
    return is_factored_;
  }

  const IslandProblem& problem_;
  std::vector<int> normals_;  // rows
  FullPivoting factors_;
  std::vector<double> right_;
  bool is_factored_ = false;
};

/// One candidate and the mechanism around it, a moment later.
class LookAhead {
public:
  /// \param candidates those beside the contact, with their modes
  LookAhead(const Constraint& contact, const ContactPair& pair, const double* acceleration,
            const EventInstant& at, std::span<const Candidate> candidates)
      : contact_(contact),
        pair_(pair),
        candidates_(candidates),
        at_(at),
        model_(at.motion.model()),
        lengths_(at.motion.memory().closure.lengths),
        acceleration_(acceleration, acceleration + lengths_.size()),
        velocity_(at.now.state.v),
        change_(lengths_.size(), 0.0),
        trial_(at.now.state),
        evaluation_(at.now.evaluation) {
    for (int b = 0; b < contact.bodies; ++b) {
      const Index of = model_.assembly->component_of(contact.blocks[static_cast<std::size_t>(b)].body);
      if (components_.empty() || components_.front() != of) components_.push_back(of);
    }
    for_coordinates([&](Index i) {
      speed_ = std::max(speed_, std::abs(velocity_[i]) * lengths_[i]);
      gains_ = std::max(gains_, std::abs(acceleration_[i]) * lengths_[i]);
    });
    find_extent();
  }

  /// Direction of sliding a moment later, 0 if there is none. \param by_joints joints alone hold the contact
  [[nodiscard]] double slip(bool by_joints) {
    // An acceleration says where to. Solvers may see in a response of rounding, of either sign, forces that
    // stop it.
    const double along = contact_.tangential_acceleration(acceleration_.data());
    const double small = SlipDirections::no_acceleration * std::max(gains_, free_acceleration());
    if (std::abs(along) > small) return along;
    if (speed_ > at_.scales.speed_noise || gains_ > small) return slip_after(time_to_move());
    // Nothing moves yet: a driver may, or loads that change with time will.
    const double found = depends_on_time() ? slip_by_drivers() : 0.0;
    if (found != 0.0 || !model_.loads.depends_on_time || !by_joints) return found;
    return slip_anywhere();
  }

private:
  template <class F>
  void for_bodies(F&& f) const {
    for (const Index component : components_) {
      model_.assembly->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        f(kind, slots, q, v);
      });
    }
  }
  template <class F>
  void for_coordinates(F&& f) const {
    for (const Index component : components_) {
      const Range v = model_.assembly->components()[component].v;
      for (Index i = v.begin; i < v.end; ++i) f(i);
    }
  }

  /// Size of the mechanism: the largest distance of its bodies along an axis, and what these measure.
  void find_extent() {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    double lower[2] = {infinite, infinite}, upper[2] = {-infinite, -infinite};
    for (const Index component : components_) {
      const Range bodies = model_.assembly->components()[component].bodies;
      for (Index body = bodies.begin; body < bodies.end; ++body) {
        const BodySlot slot = model_.assembly->layout()->bodies()[body];
        for (Index k = 0; k < 2; ++k) {
          lower[k] = std::min(lower[k], trial_.q[slot.q + k]);
          upper[k] = std::max(upper[k], trial_.q[slot.q + k]);
        }
        if (slot.rotation != none) extent_ = std::max(extent_, lengths_[slot.v + 2]);
      }
    }
    extent_ = std::max({extent_, upper[0] - lower[0], upper[1] - lower[1]});
    if (!(extent_ > 0.0)) extent_ = 1.0;
  }

  /// Change of a coordinate against how far one looks: an angle, or a way in parts of the mechanism's size.
  [[nodiscard]] double size_of(Index i, double change) const {
    return std::abs(change) * (lengths_[i] == 1.0 ? 1.0 / extent_ : 1.0);
  }

  /// Largest acceleration of the bodies by their loads alone [m/s^2].
  [[nodiscard]] double free_acceleration() const {
    double largest = 0.0;
    std::vector<double> free(lengths_.size(), 0.0);
    for_bodies([&](const BodyKind& kind, Range slots, Index, Index v) {
      kind.apply_inverse_mass(slots, at_.now.loads().data() + v, free.data() + v);
    });
    for_coordinates([&](Index i) { largest = std::max(largest, std::abs(free[i]) * lengths_[i]); });
    return largest;
  }

  [[nodiscard]] bool depends_on_time() const {
    return std::any_of(components_.begin(), components_.end(), [&](Index component) {
      return JointConstraints(*model_.assembly, component).depends_on_time();
    });
  }

  /// Time up to which laws are looked at: they may jump behind it.
  [[nodiscard]] double horizon() const {
    double until = at_.time + model_.options->longest_step;
    for (const Discontinuity& jump : model_.discontinuities) {
      if (jump.time > at_.time) until = std::min(until, jump.time);
    }
    return until - at_.time;
  }

  /// Time in which some body moves far enough, at its velocity and acceleration.
  [[nodiscard]] double time_to_move() const {
    double time = horizon();
    for_coordinates([&](Index i) {
      const double speed = size_of(i, velocity_[i]), gain = size_of(i, acceleration_[i]);
      const double root = speed + std::sqrt(speed * speed + 2.0 * gain * far_enough);
      if (root > 0.0) time = std::min(time, 2.0 * far_enough / root);
    });
    return time;
  }

  /// Moves the mechanism for a time, on its joints. Returns how far.
  double move(double time) {
    constexpr int most_corrections = 6;
    trial_ = at_.now.state;
    trial_.time += time;
    std::vector<double> way(lengths_.size(), 0.0), place = trial_.q;
    for_coordinates([&](Index i) {
      change_[i] = time * (velocity_[i] + 0.5 * time * acceleration_[i]);
      trial_.v[i] = velocity_[i] + time * acceleration_[i];
    });
    for (int correction = 0;; ++correction) {
      for_coordinates([&](Index i) { way[i] += change_[i]; });
      for_bodies([&](const BodyKind& kind, Range slots, Index q, Index v) {
        kind.advance(slots, trial_.q.data() + q, change_.data() + v, place.data() + q);
      });
      trial_.q = place;
      for_coordinates([&](Index i) { change_[i] = 0.0; });
      for (const Index component : components_) {
        evaluate_positions(*model_.assembly, component, trial_.view(), evaluation_);
        JointConstraints joints(*model_.assembly, component);
        if (joints.empty()) continue;
        joints.update_and_factor({trial_.view(), evaluation_.rotation.data()});
        if (correction == most_corrections) joints.project(JointLevel::velocity, trial_.v.data());
        joints.project(JointLevel::displacement, change_.data());
      }
      if (correction == most_corrections) break;
    }
    double moved = 0.0;
    for_coordinates([&](Index i) { moved = std::max(moved, size_of(i, way[i])); });
    return moved;
  }

  /// Sliding velocity where move() has come to.
  [[nodiscard]] double slip_there() {
    GroundPlaces places;
    model_.detector->place(trial_.time, places);
    SingleConstraint there;
    model_.detector->contact(pair_, trial_.view(), evaluation_, places, there);
    if (there.tangents() == 0) return 0.0;
    const double slip = there.tangential_velocity(trial_.v.data());
    double speed = 0.0;
    for_coordinates([&](Index i) { speed = std::max(speed, std::abs(trial_.v[i]) * lengths_[i]); });
    if (!(std::abs(slip) > rounding_ahead * speed)) return 0.0;
    // Contacts that press would keep it from such a motion: a body in a corner stays there.
    constexpr double as_fast = 0.5;
    for (const Candidate& other : candidates_) {
      if (!presses(other)) continue;
      model_.detector->contact(other.pair, trial_.view(), evaluation_, places, there);
      if (std::abs(there.normal_velocity(trial_.v.data())) > as_fast * std::abs(slip)) return 0.0;
    }
    return slip;
  }

  [[nodiscard]] double slip_after(double time) {
    static_cast<void>(move(time));
    return slip_there();
  }

  /// Of a mechanism that drivers will move, as soon as they do.
  [[nodiscard]] double slip_by_drivers() {
    constexpr double first = 1e-6, growth = 4.0, far = 0.1;  // of far_enough
    for (double time = first; time <= horizon(); time *= growth) {
      if (move(time) >= far * far_enough) return slip_there();
    }
    return 0.0;
  }

  /// Of a mechanism that will move, where to is not known: the direction of any motion that joints allow. If
  /// it is the other one the slider turns round as soon as its velocity can be told from rounding.
  [[nodiscard]] double slip_anywhere() {
    constexpr double golden = 0.6180339887498949;
    for_coordinates([&](Index i) {
      const double multiple = golden * (i + 1);
      velocity_[i] = (multiple - std::floor(multiple) - 0.5) / lengths_[i];
      acceleration_[i] = 0.0;
    });
    for (const Index component : components_) {
      JointConstraints joints(*model_.assembly, component);
      if (joints.empty()) continue;
      joints.update_and_factor(at_.now.joint_view());
      joints.project(JointLevel::change, velocity_.data());
    }
    return slip_after(time_to_move());
  }

  const Constraint& contact_;
  const ContactPair& pair_;
  std::span<const Candidate> candidates_;
  const EventInstant& at_;
  const GroupModel& model_;
  const std::vector<double>& lengths_;
  std::vector<Index> components_;
  std::vector<double> acceleration_, velocity_, change_;
  State trial_;
  Evaluation evaluation_;
  double speed_ = 0.0, gains_ = 0.0;  // largest velocity [m/s] and acceleration [m/s^2] of a body
  double extent_ = 0.0;
};

}  // namespace

bool leave_dead_points(const ModeDecision& made, const EventInstant& at, std::span<Candidate> candidates) {
  if (at.motion.joints().rows().empty()) return false;
  const IslandProblem& problem = made.problem();
  const std::span<const std::size_t> taking_part = made.taking_part();
  ResponseOnFloors responses(made, candidates);
  bool any = false;
  for (std::size_t c = 0; c < taking_part.size(); ++c) {
    Candidate& candidate = candidates[taking_part[c]];
    const Constraint& contact = problem.constraints()[c];
    if (candidate.mode == ContactMode::open || candidate.slip != 0.0 || contact.attached) continue;
    if (candidate.frictionless || contact.tangents() == 0) continue;
    const int row = problem.first_row(c) + contact.tangent_row();
    const double own = own_response(*at.motion.model().assembly, contact);
    const bool by_joints = std::abs(problem.problem().w(row, row)) <= held_fast * own;
    if (!by_joints && !(std::abs(responses.along(row)) <= held_fast * own)) continue;
    const double slip =
        LookAhead(contact, candidate.pair, made.acceleration(), at, candidates).slip(by_joints);
    if (slip == 0.0 || candidate.mode == mode_by_sign(slip)) continue;
    candidate.slip = std::copysign(std::numeric_limits<double>::min(), slip);
    any = true;
  }
  return any;
}

}  // namespace carom
