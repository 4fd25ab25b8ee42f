// Problem: how a component's rates change with its unknowns, for the implicit method. The equations of motion
//
//     M a = f + G^T l + D p,   G a + drift = 0,   N a + drift = 0
//
// with the multipliers l of joints and p of contacts are differentiated as they stand: nothing is eliminated,
// so that the result is as sparse as the model.

#include <carom/core/difference_derivatives.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {

namespace {

constexpr std::size_t most_columns = Constraint::max_columns;
using OfContact = std::array<double, most_columns>;

/// Row of a contact along which a force acts.
OfContact direction(const ActiveContact& contact, bool tangent) {
  OfContact result{};
  const double ratio = tangent ? 0.0 : -contact.slip_sign() * contact.friction;
  for (std::size_t i = 0; i < most_columns; ++i) {
    result[i] = contact.at.row(tangent ? contact.at.tangent_row() : 0)[i];
    if (ratio != 0.0) result[i] += ratio * contact.at.row(1)[i];
  }
  return result;
}

/// Velocities that a contact moves.
std::size_t columns_of(const Constraint& contact, std::array<Index, most_columns>& out) {
  std::size_t count = 0;
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    for (int i = 0; i < block.columns; ++i) out[count++] = block.v + static_cast<Index>(i);
  }
  return count;
}

/// The body that a velocity belongs to.
BodySlot body_of(const Assembly& assembly, const Component& component, Index v) {
  Index first = component.bodies.begin, last = component.bodies.end;
  while (last - first > 1) {
    const Index middle = first + (last - first) / 2;
    (assembly.layout()->bodies()[middle].v <= v ? first : last) = middle;
  }
  return assembly.layout()->bodies()[first];
}

}  // namespace

void SmoothMotion::jacobian(double time, const double* y, std::vector<RateDerivative>& out) {
  MotionWorkspace& work = *work_;
  const Assembly& assembly = *assembly_;
  evaluate(time, y, true);
  const Range v = assembly.components()[component_].v;
  // Masses are diagonal in the velocities (JointConstraints).
  std::fill(work.of_position.begin() + v.begin, work.of_position.begin() + v.end, 1.0);
  assembly.for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_mass(slots, work.of_position.data() + at, work.of_velocity.data() + at);
  });
  const auto number = [this](Index at) { return static_cast<Index>(unknown(at)); };
  for (Index i = v.begin; i < v.end; ++i) {
    out.push_back({.row = number(i), .column = number(i), .of_rate = work.of_velocity[i]});
  }
  derivatives_.clear();
  append_derivatives({assembly, work.trial.view(), work.evaluation, component_}, derivatives_);
  for (const LoadDerivative& entry : derivatives_) {
    out.push_back({number(entry.row), number(entry.column), 0.0, entry.by_velocity, entry.by_position});
  }
  differentiate_internals(out);
  auto multiplier = static_cast<Index>(size_);
  differentiate_joints(out, multiplier);
  differentiate_contacts(out, multiplier);
}

/// By central differences: elements tell no derivatives of what goes on inside.
void SmoothMotion::differentiate_internals(std::vector<RateDerivative>& out) {
  if (z_size_ == 0) return;
  const Assembly& assembly = *assembly_;
  const auto z = [&](Index at) {
    return static_cast<Index>(q_size_ + v_size_) + (at - assembly.components()[component_].z.begin);
  };
  const auto v = [this](Index at) { return static_cast<Index>(unknown(at)); };
  DifferenceDerivatives differences({assembly, work_->trial.view(), work_->evaluation, component_});
  InternalDerivatives found;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *assembly.force_kinds()[kind];
    if (force.internal_size() == 0) continue;
    const Range elements = assembly.elements(component_, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      const Index first = assembly.layout()->internal(assembly.element_id(kind, element)).first;
      differences.append_internal(force, element, {first, first + force.internal_size()}, found);
    }
  }
  for (const LoadDerivative& entry : found.rates) {
    out.push_back({z(entry.row), v(entry.column), 0.0, entry.by_velocity, entry.by_position});
  }
  for (const LoadDerivative& entry : found.loads_by_z) {
    out.push_back({.row = v(entry.row), .column = z(entry.column), .of_state = entry.by_position});
  }
  for (const LoadDerivative& entry : found.rates_by_z) {
    out.push_back(
        {z(entry.row), z(entry.column), entry.row == entry.column ? 1.0 : 0.0, entry.by_position, 0.0});
  }
}

void SmoothMotion::differentiate_joints(std::vector<RateDerivative>& out, Index& multiplier) {
  if (joints_.empty()) return;
  MotionWorkspace& work = *work_;
  const std::span<const double> forces = joint_multipliers();
  const JointView at{work.trial.view(), work.evaluation.rotation.data()};
  std::array<JointRowDerivative, std::size_t{JointKind::most_rows}> changes;
  row_multipliers_.assign(joints_.size(), none);
  constexpr auto most = static_cast<std::size_t>(JointRowDerivative::most);
  for (std::size_t joint = 0; joint < joints_.joints(); ++joint) {
    joints_.derivatives(at, joint, changes.data());
    std::array<Index, most> columns{};
    std::array<double, most> jacobian{};
    std::array<JointRowDerivative::Numbers, most> stiffness{};
    std::size_t count = 0;
    for (Index r = joints_.first_row(joint); r < joints_.first_row(joint + 1); ++r) {
      // What follows from other rows has no force; the motion does not need it.
      if (!(joints_.factors().pivot(r) > dependent_pivot)) continue;
      const JointRowDerivative& change = changes[r - joints_.first_row(joint)];
      const JointRow row = joints_.row(r);
      count = 0;
      for (int b = 0; b < row.bodies; ++b) {
        const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
        for (int c = 0; c < block.columns; ++c, ++count) {
          columns[count] = static_cast<Index>(unknown(block.v + static_cast<Index>(c)));
          jacobian[count] = block.jacobian[static_cast<std::size_t>(c)];
        }
      }
      for (std::size_t j = 0; j < count; ++j) {
        double bent = change.drift_by_position[j];
        for (std::size_t i = 0; i < count; ++i) {
          const Index v =
              assembly_->components()[component_].v.begin + (columns[i] - static_cast<Index>(q_size_));
          bent += change.jacobian[i][j] * work.acceleration[v];
          stiffness[i][j] += forces[r] * change.jacobian[i][j];
        }
        out.push_back({multiplier, columns[j], jacobian[j], -change.drift_by_velocity[j], -bent});
        out.push_back({.row = columns[j], .column = multiplier, .of_state = jacobian[j]});
      }
      row_multipliers_[r] = multiplier++;
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (stiffness[i][j] == 0.0) continue;  // most are: points hold bodies without turning them
        out.push_back({.row = columns[i], .column = columns[j], .of_integral = stiffness[i][j]});
      }
    }
  }
}

/// By central differences: the shapes of obstacles and laws of friction know no derivatives.
SmoothMotion::ContactChange SmoothMotion::change_of(const ActiveContact& contact) {
  MotionWorkspace& work = *work_;
  ContactChange change;
  change.count = columns_of(contact.at, change.columns);
  Constraint moved;
  const auto look = [&](OfContact& load, std::array<double, 2>& rows) {
    detector_->contact(contact.pair, work.trial.view(), work.evaluation, work.places, moved);
    const double slip = -contact.slip_sign() * contact.friction_at(moved, work.trial.v.data());
    const double tangential = contact.sticks() ? contact.tangential : slip * contact.normal;
    for (std::size_t i = 0; i < change.count; ++i) {
      load[i] = tangential * moved.row(moved.tangent_row())[i];
      if (!moved.has_dry_friction()) load[i] += contact.normal * moved.row(0)[i];
    }
    rows = {moved.normal_acceleration(work.acceleration.data()),
            moved.tangential_acceleration(work.acceleration.data())};
  };
  const auto difference = [&](double step, const auto& move, OfContact& load, std::array<double, 2>& rows) {
    OfContact load_behind{};
    std::array<double, 2> rows_behind{};
    move(step);
    look(load, rows);
    move(-step);
    look(load_behind, rows_behind);
    move(0.0);
    for (std::size_t i = 0; i < change.count; ++i) load[i] = (load[i] - load_behind[i]) / (2.0 * step);
    for (std::size_t i = 0; i < 2; ++i) rows[i] = (rows[i] - rows_behind[i]) / (2.0 * step);
  };
  const Assembly& assembly = *assembly_;
  const Component& all = assembly.components()[component_];
  for (std::size_t c = 0; c < change.count; ++c) {
    const Index v = change.columns[c];
    const BodySlot body = body_of(assembly, all, v);
    double& position = work.trial.q[all.q.begin + (v - all.v.begin)];
    double& velocity = work.trial.v[v];
    const double q = position, speed = velocity;
    const auto move = [&](double step) {
      position = q + step;
      if (body.rotation == none) return;
      assembly.body_kinds()[body.kind]->rotations({body.slot, body.slot + 1}, work.trial.q.data() + body.q,
                                                  work.evaluation.rotation.data() + body.rotation);
    };
    difference(difference_step, move, change.load_by_position[c], change.row_by_position[c]);
    difference(
        difference_step * std::max(1.0, std::abs(speed)), [&](double step) { velocity = speed + step; },
        change.load_by_velocity[c], change.row_by_velocity[c]);
  }
  for (std::size_t i = 0; i < change.count; ++i) {
    change.columns[i] = static_cast<Index>(unknown(change.columns[i]));
  }
  return change;
}

/// Of friction that slips in a joint and is bound by the joint's force: by central differences.
void SmoothMotion::differentiate_pressure(const ActiveContact& contact, std::vector<RateDerivative>& out) {
  const Range rows = pressure_.rows(contact.at);
  if (rows.empty()) return;
  std::vector<double>& forces = work_->multipliers;
  double largest = 0.0;
  for (Index row = rows.begin; row < rows.end; ++row) largest = std::max(largest, std::abs(forces[row]));
  if (largest == 0.0) return;  // a cone's tip
  const JointView at{work_->trial.view(), work_->evaluation.rotation.data()};
  std::array<Index, most_columns> columns{};
  const std::size_t count = columns_of(contact.at, columns);
  const auto pressed = [&](double& force, double value) {
    force = value;
    Constraint moved = contact.at;
    pressure_.take(forces.data(), 1.0);
    pressure_.press(moved, at);
    return moved.friction_bound;
  };
  for (Index row = rows.begin; row < rows.end; ++row) {
    if (row_multipliers_[row] == none) continue;
    const double force = forces[row];
    const double slope =
        difference_quotient([&](double value) { return pressed(forces[row], value); }, force, largest);
    forces[row] = force;
    for (std::size_t i = 0; i < count; ++i) {
      const double load =
          -contact.slip_sign() * contact.friction * slope * contact.at.row(contact.at.tangent_row())[i];
      const auto moved = static_cast<Index>(unknown(columns[i]));
      out.push_back({.row = moved, .column = row_multipliers_[row], .of_state = load});
    }
  }
}

void SmoothMotion::differentiate_contacts(std::vector<RateDerivative>& out, Index& multiplier) {
  const std::vector<ActiveContact>& contacts = active_.list();
  contact_changes_.clear();
  for (const ActiveContact& contact : contacts) {
    const ContactChange& change = contact_changes_.emplace_back(change_of(contact));
    if (!contact.sticks()) differentiate_pressure(contact, out);
    for (std::size_t i = 0; i < change.count; ++i) {
      for (std::size_t j = 0; j < change.count; ++j) {
        out.push_back({change.columns[i], change.columns[j], 0.0, change.load_by_velocity[j][i],
                       change.load_by_position[j][i]});
      }
    }
  }
  for (const auto& [equation, force] : active_.pivots()) {
    const ContactChange& held = contact_changes_[equation.contact];
    const std::size_t row = equation.tangent ? 1 : 0;
    const Constraint& at = contacts[equation.contact].at;
    for (std::size_t j = 0; j < held.count; ++j) {
      out.push_back({multiplier, held.columns[j], at.row(equation.tangent ? at.tangent_row() : 0)[j],
                     -held.row_by_velocity[j][row], -held.row_by_position[j][row]});
    }
    const ContactChange& pushed = contact_changes_[force.contact];
    const OfContact along = direction(contacts[force.contact], force.tangent);
    for (std::size_t i = 0; i < pushed.count; ++i) {
      out.push_back({.row = pushed.columns[i], .column = multiplier, .of_state = along[i]});
    }
    ++multiplier;
  }
}

}  // namespace carom
