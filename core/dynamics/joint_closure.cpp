#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/dynamics/open_joints.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Gaps and velocities this small against the coordinates and velocities are rounding of a few terms.
constexpr double rounding = 16.0 * epsilon;

// Gaps that may be left where steps shrink no more: rounding of a poor matrix.
constexpr double accepted = 1e-11;

// Newton's method from a start that is roughly right; more steps than this do not come to an end.
constexpr int most_steps = 60;

double largest(const std::vector<double>& numbers, Range range, double least) {
  double size = least;
  for (Index i = range.begin; i < range.end; ++i) size = std::max(size, std::abs(numbers[i]));
  return size;
}

/// Joints whose rows take part in the dependence of one row on others.
std::vector<JointId> partners(const JointConstraints& joints, std::size_t row,
                              std::span<const double> vector) {
  // Against the row itself; the rest is rounding.
  constexpr double takes_part = 1e-6;
  std::vector<JointId> found;
  for (std::size_t i = 0; i < vector.size(); ++i) {
    const JointId joint = joints.joint(i);
    if (joint == joints.joint(row) || std::abs(vector[i]) <= takes_part * std::abs(vector[row])) continue;
    // Rows of a joint follow one another.
    if (found.empty() || found.back() != joint) found.push_back(joint);
  }
  return found;
}

std::vector<JointId> partners(JointConstraints& joints, std::size_t row) {
  std::vector<double> vector;
  joints.factors().dependence(row, vector);
  return partners(joints, row, vector);
}

[[noreturn]] void refuse(const Assembly& assembly, JointConstraints& joints, std::size_t row, double off,
                         const char* what, const char* unit) {
  const System& system = assembly.system();
  const JointId joint = joints.joint(row);
  std::string message = system.name(joint) + ": " + what + ", it is off by " + to_text(off) + " " + unit;
  bool first = true;
  if (joints.factors().pivot(row) < dependent_pivot) {
    for (const JointId other : partners(joints, row)) {
      message += (first ? "; contradicted by " : ", ") + system.name(other);
      first = false;
    }
  }
  message += "; allowed: joints that can be closed together";
  throw ModelError(message);
}

/// Throws the error of friction bound by forces of a joint that are not unique.
[[noreturn]] void fail_unique_pressure(const System& system, JointId friction, double coefficient,
                                       JointId bearing, const std::vector<JointId>& redundant) {
  std::string message = system.name(friction) + ": coefficient is " + to_text(coefficient) +
                        ", and forces of " + system.name(bearing) + " are not unique: redundant are";
  for (const JointId joint : redundant) {
    message += (joint == redundant.front() ? " " : ", ") + system.name(joint);
  }
  throw ModelError(message + "; allowed: a constant bound, or joints none of which follows from others");
}

/// Calls f(friction, coefficient, bearing) for dry friction that forces of a joint bound.
template <class F>
void for_pressed_friction(const Assembly& assembly, Index component, F&& f) {
  for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly.joint_kinds()[k];
    if (kind.friction_rows() == 0) continue;
    const Range range = assembly.joints(component, k);
    for (Index slot = range.begin; slot < range.end; ++slot) {
      const double coefficient = kind.dry_friction(slot).coefficient;
      if (coefficient != 0.0) f(assembly.joint_id(k, slot), coefficient, kind.on_joint(slot));
    }
  }
}

/// Rows that follow from others.
std::vector<std::size_t> redundant_rows(const JointConstraints& joints) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < joints.size(); ++row) {
    if (joints.factors().pivot(row) < dependent_pivot) rows.push_back(row);
  }
  return rows;
}

/// Joints, by serial, with a row that takes part in a mixture of all dependences, in which shares without a
/// pattern leave none out: one solution instead of one for each redundant row.
std::set<Index> redundant_joints(JointConstraints& joints, std::span<const std::size_t> redundant) {
  constexpr double takes_part = 1e-8, golden = 0.6180339887498949;
  std::vector<double> shares(joints.size(), 0.0), vector;
  for (std::size_t k = 0; k < redundant.size(); ++k) {
    const double multiple = golden * static_cast<double>(k + 1);
    shares[redundant[k]] = 1.0 + multiple - std::floor(multiple);
  }
  joints.factors().dependence(shares, vector);
  std::set<Index> found;
  for (std::size_t row = 0; row < vector.size(); ++row) {
    if (std::abs(vector[row]) > takes_part) found.insert(joints.joint(row).serial);
  }
  return found;
}

/// Demands that forces of joints which bound friction are unique.
void demand_unique_pressure(const Assembly& assembly, Index component, JointConstraints& joints) {
  std::set<Index> bearings;
  for_pressed_friction(assembly, component,
                       [&](JointId, double, JointId bearing) { bearings.insert(bearing.serial); });
  if (bearings.empty()) return;
  const std::vector<std::size_t> redundant = redundant_rows(joints);
  if (redundant.empty()) return;
  std::erase_if(bearings, [all = redundant_joints(joints, redundant)](Index bearing) {
    return !all.contains(bearing);
  });
  if (bearings.empty()) return;
  for_pressed_friction(assembly, component, [&](JointId friction, double coefficient, JointId bearing) {
    if (!bearings.contains(bearing.serial)) return;
    for (const std::size_t row : redundant) {
      std::vector<JointId> all = partners(joints, row);
      all.push_back(joints.joint(row));
      if (std::find(all.begin(), all.end(), bearing) == all.end()) continue;
      fail_unique_pressure(assembly.system(), friction, coefficient, bearing, all);
    }
  });
}

/// The row that is furthest off.
std::size_t worst_row(std::span<const double> off) {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < off.size(); ++i) {
    if (!(std::abs(off[i]) <= std::abs(off[worst]))) worst = i;
  }
  return worst;
}

/// Numbers over the whole model that components share: made for each they would cost the square of their
/// number.
struct ClosureWork {
  explicit ClosureWork(const Assembly& assembly, const State& state)
      : lengths(assembly.length_scales()),
        evaluation(make_evaluation(assembly)),
        start(state.q),
        before(state.v),
        change(state.v.size(), 0.0),
        moved(state.q.size(), 0.0) {}
  std::vector<double> lengths;
  Evaluation evaluation;
  std::vector<double> start, before;  // q and v as they were
  std::vector<double> change, moved;
};

/// Joints of a component with the bodies that keep their places fixed.
JointConstraints constraints_of(const Assembly& assembly, Index component) {
  JointConstraints joints(assembly, component);
  if (joints.empty()) return joints;
  const Layout& layout = *assembly.layout();
  const Range bodies = assembly.components()[component].bodies;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    const BodySlot slot = layout.bodies()[body];
    if (assembly.system().keeps_place(layout.id(body))) joints.fix({slot.v, slot.v + slot.v_size});
  }
  return joints;
}

/// Closes the gaps by Newton's method. Throws ModelError. \param open joints that were open, to be added to
void close_gaps(const Assembly& assembly, Index component, JointConstraints& joints, ClosureWork& work,
                State& state, std::vector<OpenJoint>& open) {
  const Component& range = assembly.components()[component];
  std::vector<double> off(joints.size());
  std::vector<double>&change = work.change, &moved = work.moved;
  double best = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    evaluate_positions(assembly, component, state.view(), work.evaluation);
    const JointView at{state.view(), work.evaluation.rotation.data()};
    joints.update_and_factor(at);
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = joints.gaps()[i];
    const std::size_t worst = worst_row(off);
    const double left = std::abs(off[worst]), size = largest(state.q, range.q, 1.0);
    if (left <= rounding * size) break;
    const bool stalls = !(left < 0.5 * best) && left <= accepted * size;
    if (stalls) break;
    if (step == 0) list_open_joints(assembly, component, joints, state, at, work.lengths, open);
    if (step == most_steps || !std::isfinite(left)) {
      refuse(assembly, joints, worst, off[worst], "cannot be closed", "m or rad");
    }
    best = std::min(best, left);
    std::fill(change.begin() + range.v.begin, change.begin() + range.v.end, 0.0);
    joints.project(JointLevel::displacement, change.data());
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
      kind.advance(slots, state.q.data() + q, change.data() + v, moved.data() + q);
    });
    std::copy(moved.begin() + range.q.begin, moved.begin() + range.q.end, state.q.begin() + range.q.begin);
  }
}

/// Brings the velocities onto the joints. Throws ModelError.
void close_velocities(const Assembly& assembly, Index component, JointConstraints& joints, State& state) {
  const Component& range = assembly.components()[component];
  std::vector<double> off(joints.size());
  const auto find_off = [&] { joints.residuals(JointLevel::velocity, state.v.data(), off.data()); };
  double speed = largest(state.v, range.v, 0.0);
  for (std::size_t i = 0; i < off.size(); ++i) speed = std::max(speed, std::abs(joints.rate(i)));
  find_off();
  if (std::abs(off[worst_row(off)]) <= rounding * speed) return;
  joints.project(JointLevel::velocity, state.v.data());
  joints.project(JointLevel::velocity, state.v.data());  // the rounding left
  find_off();
  const std::size_t worst = worst_row(off);
  const double left = off[worst];
  if (!(std::abs(left) <= 1e-9 * std::max(speed, 1.0))) {
    refuse(assembly, joints, worst, left, "cannot be kept closed", "m/s or rad/s");
  }
}

void close_component(const Assembly& assembly, Index component, ClosureWork& work, State& state,
                     JointClosure& closure) {
  JointConstraints joints = constraints_of(assembly, component);
  if (joints.empty()) return;
  close_gaps(assembly, component, joints, work, state, closure.open);
  demand_unique_pressure(assembly, component, joints);
  const Component& range = assembly.components()[component];
  const Layout& layout = *assembly.layout();
  const std::vector<double>&lengths = work.lengths, &start = work.start, &before = work.before;
  // Displacements of all bodies: coordinates of the plane, and of particles, are their own displacements.
  for (Index body = range.bodies.begin; body < range.bodies.end; ++body) {
    const BodySlot slot = layout.bodies()[body];
    for (Index i = 0; i < std::min(slot.q_size, slot.v_size); ++i) {
      closure.shift =
          std::max(closure.shift, std::abs(state.q[slot.q + i] - start[slot.q + i]) * lengths[slot.v + i]);
    }
  }
  close_velocities(assembly, component, joints, state);
  for (Index i = range.v.begin; i < range.v.end; ++i) {
    closure.change = std::max(closure.change, std::abs(state.v[i] - before[i]) * lengths[i]);
  }
}

}  // namespace

JointClosure close_joints(const Assembly& assembly, State& state) {
  check_sizes(assembly, state);
  JointClosure closure;
  if (assembly.joint_kinds().empty()) return closure;
  ClosureWork work(assembly, state);
  for (Index component = 0; component < assembly.components().size(); ++component) {
    close_component(assembly, component, work, state, closure);
  }
  return closure;
}

Mobility mobility(const Assembly& assembly, const State& state) {
  check_sizes(assembly, state);
  Mobility result;
  result.velocities = assembly.layout()->v_size();
  Evaluation evaluation = make_evaluation(assembly);
  for (Index component = 0; component < assembly.components().size(); ++component) {
    JointConstraints joints(assembly, component);
    if (joints.empty()) continue;
    evaluate_positions(assembly, component, state.view(), evaluation);
    joints.update_and_factor({state.view(), evaluation.rotation.data()});
    result.rows += static_cast<Index>(joints.size());
    for (std::size_t row = 0; row < joints.size(); ++row) {
      if (joints.factors().pivot(row) >= dependent_pivot) {
        ++result.independent_rows;
        continue;
      }
      result.redundant.push_back({joints.joint(row), partners(joints, row)});
    }
  }
  result.degrees_of_freedom = result.velocities - result.independent_rows;
  return result;
}

}  // namespace carom
