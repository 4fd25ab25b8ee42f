// Problem: how a group's rates change with its unknowns, for the implicit method. The equations of motion
//
//     M a = f + G^T l + D p,   G a + drift = 0,   N a + drift = 0
//
// with the multipliers l of joints and p of contacts are differentiated as they stand: nothing is eliminated,
// so that the result is as sparse as the model.

#include <carom/core/difference_derivatives.h>
#include <carom/integrators/event_driven/motion_jacobian.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {

namespace {

constexpr std::size_t most_columns = 9;  // of three bodies in the plane
using OfContact = std::array<double, most_columns>;

/// Row of a contact along which a force acts: a normal one with what follows from it, friction and the moment
/// against rolling.
OfContact direction(std::span<const ActiveContact> contacts, const ContactPivot::Row& force) {
  const ActiveContact& contact = contacts[force.contact];
  OfContact result{};
  const auto add_row = [&](double factor, const double* row) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.at.columns()); ++i) {
      result[i] += factor * row[i];
    }
  };
  add_row(1.0, contact.at.row(force.tangent ? contact.at.tangent_row() : 0));
  if (force.tangent) return result;
  for_tangents(contact.at, [&](std::size_t k, int row) {
    if (const double ratio = contact.friction_ratio(k); ratio != 0.0) add_row(ratio, contact.at.row(row));
  });
  if (force.contact + 1 == contacts.size() || !contacts[force.contact + 1].at.attached) return result;
  const ActiveContact& rolling = contacts[force.contact + 1];
  for_tangents(rolling.at,
               [&](std::size_t k, int row) { add_row(rolling.friction_ratio(k), rolling.at.row(row)); });
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

MotionJacobian::MotionJacobian(const GroupModel& model, JointReactions& reactions, ActiveSet& active,
                               MotionMemory& memory)
    : model_(&model), reactions_(&reactions), active_(&active), memory_(&memory) {}

void MotionJacobian::append(MotionSample& sample, std::vector<RateDerivative>& out) {
  const Assembly& assembly = *model_->assembly;
  // Masses are diagonal in the velocities (JointConstraints).
  std::vector<double>&ones = memory_->closure.of_position, &masses = memory_->closure.of_velocity;
  derivatives_.clear();
  for (const auto& part : model_->parts()) {
    const Range v = part.ranges.v;
    std::fill(ones.begin() + v.begin, ones.begin() + v.end, 1.0);
    assembly.for_bodies(part.component, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
      kind.apply_mass(slots, ones.data() + first, masses.data() + first);
    });
    for (Index i = v.begin; i < v.end; ++i) {
      out.push_back({.row = unknown(i), .column = unknown(i), .of_rate = masses[i]});
    }
    append_derivatives({assembly, sample.view(), sample.evaluation, part.component}, derivatives_);
  }
  for (const LoadDerivative& entry : derivatives_) {
    out.push_back({unknown(entry.row), unknown(entry.column), 0.0, entry.by_velocity, entry.by_position});
  }
  for (const auto& part : model_->parts()) {
    if (!part.ranges.z.empty()) differentiate_internals(sample, part, out);
  }
  auto multiplier = static_cast<Index>(model_->unknowns.size());
  differentiate_joints(sample, out, multiplier);
  differentiate_contacts(sample, out, multiplier);
}

/// By central differences: elements tell no derivatives of what goes on inside.
void MotionJacobian::differentiate_internals(const MotionSample& sample, const MotionUnknowns::Part& part,
                                             std::vector<RateDerivative>& out) {
  const Assembly& assembly = *model_->assembly;
  const auto z = [&](Index at) { return static_cast<Index>(part.z) + (at - part.ranges.z.begin); };
  const auto v = [this](Index at) { return unknown(at); };
  DifferenceDerivatives differences({assembly, sample.view(), sample.evaluation, part.component});
  InternalDerivatives found;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *assembly.force_kinds()[kind];
    if (force.internal_size() == 0) continue;
    const Range elements = assembly.elements(part.component, kind);
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

void MotionJacobian::differentiate_joints(const MotionSample& sample, std::vector<RateDerivative>& out,
                                          Index& multiplier) {
  const GroupJoints& joints = reactions_->rows();
  if (joints.empty()) return;
  const std::span<const double> forces = reactions_->multipliers(sample, active_->list());
  joint_forces_.assign(forces.begin(), forces.end());
  row_multipliers_.assign(joints.size(), none);
  for (const GroupJoints::Part& part : joints.parts()) {
    differentiate_joints(sample, *part.joints, part.first_row, out, multiplier);
  }
}

void MotionJacobian::differentiate_joints(const MotionSample& sample, const JointConstraints& joints,
                                          std::size_t first_row, std::vector<RateDerivative>& out,
                                          Index& multiplier) {
  std::array<JointRowDerivative, std::size_t{JointKind::most_rows}> changes;
  constexpr auto most = static_cast<std::size_t>(JointRowDerivative::most);
  for (std::size_t joint = 0; joint < joints.pattern().size(); ++joint) {
    joints.pattern().derivatives(sample.joint_view(), joint, changes.data());
    std::array<Index, most> columns{};
    std::array<double, most> jacobian{};
    std::array<JointRowDerivative::Numbers, most> stiffness{};
    std::size_t count = 0;
    for (Index r = joints.pattern().first_row(joint); r < joints.pattern().first_row(joint + 1); ++r) {
      // A row that follows from others has no force; the motion does not need it.
      if (!(joints.factors().pivot(r) > dependent_pivot)) continue;
      const JointRowDerivative& change = changes[r - joints.pattern().first_row(joint)];
      const JointRow row = joints.row(r);
      count = 0;
      for (int b = 0; b < row.bodies; ++b) {
        const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
        for (int c = 0; c < block.columns; ++c, ++count) {
          columns[count] = unknown(block.v + static_cast<Index>(c));
          jacobian[count] = block.jacobian[static_cast<std::size_t>(c)];
        }
      }
      for (std::size_t j = 0; j < count; ++j) {
        double bent = change.drift_by_position[j];
        for (std::size_t i = 0; i < count; ++i) {
          bent += change.jacobian[i][j] * sample.acceleration[model_->unknowns.velocity_at(columns[i])];
          stiffness[i][j] += joint_forces_[first_row + r] * change.jacobian[i][j];
        }
        out.push_back({multiplier, columns[j], jacobian[j], -change.drift_by_velocity[j], -bent});
        out.push_back({.row = columns[j], .column = multiplier, .of_state = jacobian[j]});
      }
      row_multipliers_[first_row + r] = multiplier++;
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (stiffness[i][j] == 0.0) continue;  // most are: points hold bodies without turning them
        out.push_back({.row = columns[i], .column = columns[j], .of_integral = stiffness[i][j]});
      }
    }
  }
}

/// By central differences: shapes on ground and laws of friction know no derivatives.
MotionJacobian::ContactChange MotionJacobian::change_of(MotionSample& sample, const ActiveContact& contact) {
  ContactChange change;
  change.count = columns_of(contact.at, change.columns);
  SingleConstraint moved;
  const auto sample_at = [&](OfContact& load, std::array<double, 2>& rows) {
    if (contact.feature != none) {
      moved = contact.at;
      follow(*model_->detector, contact.pair, contact.feature, sample.view(), sample.evaluation,
             sample.places, moved);
    } else {
      model_->detector->contact(contact.pair, sample.view(), sample.evaluation, sample.places, moved);
    }
    const TangentDirection slip = contact.slip_direction();
    const double friction = contact.friction_at(moved, sample.state.v.data());
    for (std::size_t i = 0; i < change.count; ++i) {
      load[i] = 0.0;
      for_tangents(moved, [&](std::size_t k, int row) {
        const double force = contact.sticks() ? contact.tangential[k] : -slip[k] * friction * contact.normal;
        load[i] += force * moved.row(row)[i];
      });
      if (moved.normals > 0) load[i] += contact.normal * moved.row(0)[i];
    }
    rows = {moved.normal_acceleration(sample.acceleration.data()),
            moved.tangential_acceleration(sample.acceleration.data())};
  };
  const auto difference = [&](double step, const auto& move, OfContact& load, std::array<double, 2>& rows) {
    OfContact load_behind{};
    std::array<double, 2> rows_behind{};
    move(step);
    sample_at(load, rows);
    move(-step);
    sample_at(load_behind, rows_behind);
    move(0.0);
    for (std::size_t i = 0; i < change.count; ++i) load[i] = (load[i] - load_behind[i]) / (2.0 * step);
    for (std::size_t i = 0; i < 2; ++i) rows[i] = (rows[i] - rows_behind[i]) / (2.0 * step);
  };
  const Assembly& assembly = *model_->assembly;
  for (std::size_t c = 0; c < change.count; ++c) {
    const Index v = change.columns[c];
    const Component& all = model_->unknowns.part_of(v).ranges;
    const BodySlot body = body_of(assembly, all, v);
    double& position = sample.state.q[all.q.begin + (v - all.v.begin)];
    double& velocity = sample.state.v[v];
    const double q = position, speed = velocity;
    const auto move = [&](double step) {
      position = q + step;
      if (body.rotation == none) return;
      assembly.body_kinds()[body.kind]->rotations({body.slot, body.slot + 1}, sample.state.q.data() + body.q,
                                                  sample.evaluation.rotation.data() + body.rotation);
    };
    difference(difference_step, move, change.load_by_position[c], change.row_by_position[c]);
    difference(
        difference_step * std::max(1.0, std::abs(speed)), [&](double step) { velocity = speed + step; },
        change.load_by_velocity[c], change.row_by_velocity[c]);
  }
  for (std::size_t i = 0; i < change.count; ++i) {
    change.columns[i] = unknown(change.columns[i]);
  }
  return change;
}

/// Of friction that slips in a joint and is bound by the joint's force: by central differences.
void MotionJacobian::differentiate_friction_bound(const MotionSample& sample, const ActiveContact& contact,
                                                  std::vector<RateDerivative>& out) {
  FrictionBounds& bounds = reactions_->friction_bounds();
  const Range rows = bounds.rows(contact.at);
  if (rows.empty()) return;
  std::vector<double>& forces = joint_forces_;
  double largest = 0.0;
  for (Index row = rows.begin; row < rows.end; ++row) largest = std::max(largest, std::abs(forces[row]));
  if (largest == 0.0) return;  // a cone's tip
  std::array<Index, most_columns> columns{};
  const std::size_t count = columns_of(contact.at, columns);
  const auto bound_at = [&](double& force, double value) {
    force = value;
    SingleConstraint moved = contact.at;
    bounds.take(forces.data(), 1.0);
    bounds.update(moved, sample.joint_view());
    return moved.of_joint.friction_bound;
  };
  for (Index row = rows.begin; row < rows.end; ++row) {
    if (row_multipliers_[row] == none) continue;
    const double force = forces[row];
    const double slope =
        difference_quotient([&](double value) { return bound_at(forces[row], value); }, force, largest);
    forces[row] = force;
    for (std::size_t i = 0; i < count; ++i) {
      double load = 0.0;
      for_tangents(contact.at, [&](std::size_t k, int tangent) {
        load += contact.friction_ratio(k) * slope * contact.at.row(tangent)[i];
      });
      const auto moved = unknown(columns[i]);
      out.push_back({.row = moved, .column = row_multipliers_[row], .of_state = load});
    }
  }
}

void MotionJacobian::differentiate_contacts(MotionSample& sample, std::vector<RateDerivative>& out,
                                            Index& multiplier) {
  const std::vector<ActiveContact>& contacts = active_->list();
  contact_changes_.clear();
  for (const ActiveContact& contact : contacts) {
    const ContactChange& change = contact_changes_.emplace_back(change_of(sample, contact));
    if (!contact.sticks()) differentiate_friction_bound(sample, contact, out);
    for (std::size_t i = 0; i < change.count; ++i) {
      for (std::size_t j = 0; j < change.count; ++j) {
        out.push_back({change.columns[i], change.columns[j], 0.0, change.load_by_velocity[j][i],
                       change.load_by_position[j][i]});
      }
    }
  }
  for (const auto& [equation, force] : active_->pivots()) {
    const ContactChange& fixed = contact_changes_[equation.contact];
    const std::size_t row = equation.tangent ? 1 : 0;
    const Constraint& at = contacts[equation.contact].at;
    for (std::size_t j = 0; j < fixed.count; ++j) {
      out.push_back({multiplier, fixed.columns[j], at.row(equation.tangent ? at.tangent_row() : 0)[j],
                     -fixed.row_by_velocity[j][row], -fixed.row_by_position[j][row]});
    }
    const ContactChange& loaded = contact_changes_[force.contact];
    const OfContact along = direction(contacts, force);
    for (std::size_t i = 0; i < loaded.count; ++i) {
      out.push_back({.row = loaded.columns[i], .column = multiplier, .of_state = along[i]});
    }
    ++multiplier;
  }
}

}  // namespace carom
