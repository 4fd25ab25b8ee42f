// Problem: facts of a group's bodies, elements, joints and shapes on ground, looked up once.

#include <carom/core/dynamics/force_directions.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/integrators/event_driven/group_model.h>

#include <algorithm>

namespace carom {

namespace {

/// The rolling resistance of pairs that have some, behind each.
void add_rolling(const Detector& detector, std::vector<ContactPair>& pairs) {
  if (!resists_rolling(detector)) return;
  std::vector<ContactPair> with_rolling;
  with_rolling.reserve(2 * pairs.size());
  for (const ContactPair& pair : pairs) {
    with_rolling.push_back(pair);
    if (!resists_rolling(detector, pair)) continue;
    with_rolling.push_back(pair);
    with_rolling.back().rolling = true;
  }
  pairs.swap(with_rolling);
}

/// Pairs that may touch, those of one mechanism together, then those of two bodies.
std::vector<ContactPair> pairs_of(const Assembly& assembly, const Detector& detector,
                                  const GroupComponents& group, const GroupJoints& joints) {
  std::vector<ContactPair> all;
  for (const Index component : group.components) {
    std::vector<ContactPair> pairs = detector.pairs(component);
    if (!joints.empty()) {
      detector.joints().append_friction(component, pairs);
      std::stable_sort(pairs.begin(), pairs.end(), [&](const ContactPair& a, const ContactPair& b) {
        return assembly.mechanism(a.body) < assembly.mechanism(b.body);
      });
    }
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  all.insert(all.end(), group.body_pairs.begin(), group.body_pairs.end());
  add_rolling(detector, all);
  return all;
}

std::vector<BodyPairBound> bounds_of(const Detector& detector, const std::vector<ContactPair>& pairs) {
  std::vector<BodyPairBound> bounds;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].has_outline()) continue;
    bounds.push_back(bound_of_pair(detector.outlines(), pairs[i]));
    bounds.back().pair = i;
  }
  return bounds;
}

bool has_joint_friction(const Detector& detector, const GroupComponents& group) {
  return std::any_of(group.components.begin(), group.components.end(),
                     [&](Index component) { return detector.joints().has_friction(component); });
}

/// Works that are integrated along in the motion of a group.
Index works_of(const Detector& detector, const GroupComponents& group) {
  if (resists_rolling(detector)) return work_lines;
  const auto in_joints = static_cast<Index>(WorkLine::joint_friction);
  return has_joint_friction(detector, group) ? in_joints + 1 : in_joints;
}

void add_load_traits(const Assembly& assembly, Index component, LoadTraits& traits) {
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    if (assembly.elements(component, kind).empty()) continue;
    const ForceKind& elements = *assembly.force_kinds()[kind];
    traits.books_dissipative = traits.books_dissipative || elements.books_dissipative();
    traits.books_external = traits.books_external || elements.books_external();
    traits.depends_on_time = traits.depends_on_time || elements.depends_on_time();
    traits.needs_rotations = traits.needs_rotations || elements.needs_rotations();
    traits.are_constant = traits.are_constant && elements.is_constant() && !elements.books_external() &&
                          !elements.books_dissipative() && !elements.depends_on_time();
  }
}

/// Discontinuities of the joints and force elements of a component.
void add_discontinuities(const Assembly& assembly, Index component, std::vector<Discontinuity>& all) {
  std::vector<double> times;
  const auto add = [&](const auto& kind, Range parts, auto&& discontinuity_of) {
    for (Index part = parts.begin; part < parts.end; ++part) {
      times.clear();
      kind.discontinuity_times(part, times);
      for (const double time : times) all.push_back(discontinuity_of(time, part));
    }
  };
  for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
    add(*assembly.joint_kinds()[k], assembly.joints(component, k), [&](double time, Index joint) {
      return Discontinuity{.time = time, .joint = assembly.joint_id(k, joint)};
    });
  }
  for (Index k = 0; k < assembly.force_kinds().size(); ++k) {
    add(*assembly.force_kinds()[k], assembly.elements(component, k), [&](double time, Index element) {
      return Discontinuity{.time = time, .element = assembly.element_id(k, element)};
    });
  }
}

/// Those of all components and of shapes on ground, in ascending order.
std::vector<Discontinuity> discontinuities_of(const Assembly& assembly, std::span<const Index> components,
                                              const std::vector<Discontinuity>& of_obstacles) {
  std::vector<Discontinuity> all;
  for (const Index component : components) add_discontinuities(assembly, component, all);
  all.insert(all.end(), of_obstacles.begin(), of_obstacles.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Discontinuity& a, const Discontinuity& b) { return a.time < b.time; });
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Errors of works count relative to the mass, those of angles by the radius of gyration.
std::vector<double> tolerances_of(const GroupModel& model, double tolerance_of_places) {
  const MotionUnknowns& unknowns = model.unknowns;
  std::vector<double> tolerances(unknowns.size(), tolerance_of_places);
  double mass = 0.0;
  model.for_bodies(
      [&](const BodyKind& kind, Range slots, Index q, Index v, const MotionUnknowns::Part& part) {
        for (Index slot = slots.begin; slot < slots.end; ++slot) {
          mass += kind.mass(slot);
          const Index body = slot - slots.begin;
          for (Index i = 0; i < kind.v_size(); ++i) {
            const double tolerance = tolerance_of_places / kind.length_scale(slot, i);
            tolerances[part.v + (v - part.ranges.v.begin) + body * kind.v_size() + i] = tolerance;
            // Orientations come last in both and are measured alike in the plane.
            if (i < kind.q_size()) {
              tolerances[part.q + (q - part.ranges.q.begin) + body * kind.q_size() + i] = tolerance;
            }
          }
        }
      });
  for (Index i = 0; i < unknowns.work_count(); ++i) {
    tolerances[unknowns.size() - 1 - i] = mass * tolerance_of_places;
  }
  return tolerances;
}

}  // namespace

GroupModel::GroupModel(const Assembly& assembly_in, const Detector& detector_in, const GroupComponents& group,
                       const EventDriven& options_in, const GroupJoints& joints)
    : assembly(&assembly_in),
      detector(&detector_in),
      options(&options_in),
      unknowns(assembly_in, group.components, works_of(detector_in, group)),
      pairs(pairs_of(assembly_in, detector_in, group, joints)),
      bounds(bounds_of(detector_in, pairs)),
      tolerances(
          std::make_shared<const std::vector<double>>(tolerances_of(*this, options->absolute_tolerance))) {
  if (!bounds.empty()) bound_places_.assign(pairs.size(), none);
  for (Index i = 0; i < bounds.size(); ++i) bound_places_[bounds[i].pair] = i;
  const bool ground_moves = !pairs.empty() && detector->has_moving_ground();
  loads.depends_on_time = joints.depends_on_time() || ground_moves;
  // Outlines are looked at in frames that turn with their bodies.
  loads.needs_rotations = !joints.empty() || !bounds.empty() || detector->needs_rotations();
  for (const Index component : group.components) add_load_traits(*assembly, component, loads);
  if (assembly->layout()->rotation_size() == 0) loads.needs_rotations = false;  // none of particles
  discontinuities =
      discontinuities_of(*assembly, group.components,
                         ground_moves ? detector->shapes().discontinuities() : std::vector<Discontinuity>{});
}

ElementId GroupModel::find_without_direction(const MotionSample& at, double speed) const {
  for (const MotionUnknowns::Part& part : parts()) {
    const ElementId found =
        carom::find_without_direction(*assembly, part.component, at.view(), at.evaluation, speed);
    if (found.valid()) return found;
  }
  return {};
}

std::string GroupModel::driven() const {
  std::vector<Index> components;
  for (const MotionUnknowns::Part& part : parts()) components.push_back(part.component);
  return driven_by(*assembly, components);
}

double GroupModel::kinetic_energy(const double* velocities) const {
  double sum = 0.0;
  for_bodies([&](const BodyKind& kind, Range slots, Index, Index v, const MotionUnknowns::Part&) {
    sum += kind.kinetic_energy(slots, velocities + v);
  });
  return sum;
}

}  // namespace carom
