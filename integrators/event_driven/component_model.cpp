// Problem: facts of a component's bodies, elements, joints and shapes on ground, looked up once.

#include <carom/integrators/event_driven/component_model.h>

#include <algorithm>

namespace carom {

namespace {

/// Pairs that may touch, those of one mechanism together.
std::vector<ContactPair> pairs_of(const Assembly& assembly, const Detector& detector, Index component,
                                  const JointConstraints& joints) {
  std::vector<ContactPair> pairs = detector.pairs(component);
  if (joints.empty()) return pairs;
  const std::vector<ContactPair> dry_friction = detector.joint_friction(component);
  pairs.insert(pairs.end(), dry_friction.begin(), dry_friction.end());
  std::stable_sort(pairs.begin(), pairs.end(), [&](const ContactPair& a, const ContactPair& b) {
    return assembly.mechanism(a.body) < assembly.mechanism(b.body);
  });
  return pairs;
}

std::vector<Range> mechanisms_of(const Assembly& assembly, const std::vector<ContactPair>& pairs) {
  std::vector<Range> ranges;
  for (Index first = 0; first < pairs.size();) {
    Index last = first + 1;
    while (last < pairs.size() &&
           assembly.mechanism(pairs[last].body) == assembly.mechanism(pairs[first].body)) {
      ++last;
    }
    ranges.push_back({first, last});
    first = last;
  }
  return ranges;
}

LoadTraits load_traits(const Assembly& assembly, Index component, bool driven, bool ground_moves) {
  LoadTraits traits;
  traits.depends_on_time = driven || ground_moves;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    if (assembly.elements(component, kind).empty()) continue;
    const ForceKind& elements = *assembly.force_kinds()[kind];
    traits.books_dissipative = traits.books_dissipative || elements.books_dissipative();
    traits.books_external = traits.books_external || elements.books_external();
    traits.depends_on_time = traits.depends_on_time || elements.depends_on_time();
    traits.only_fields = traits.only_fields && elements.is_field() && !elements.books_dissipative() &&
                         !elements.depends_on_time();
  }
  return traits;
}

/// Discontinuities of the joints and force elements of a component, and of shapes on ground, in ascending
/// order.
std::vector<Discontinuity> discontinuities_of(const Assembly& assembly, Index component,
                                              const std::vector<Discontinuity>& of_obstacles) {
  std::vector<Discontinuity> all;
  std::vector<double> times;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const Range joints = assembly.joints(component, kind);
    for (Index joint = joints.begin; joint < joints.end; ++joint) {
      times.clear();
      assembly.joint_kinds()[kind]->discontinuity_times(joint, times);
      for (const double time : times) {
        all.push_back({.time = time, .joint = assembly.joint_id(kind, joint)});
      }
    }
  }
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(component, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      times.clear();
      assembly.force_kinds()[kind]->discontinuity_times(element, times);
      for (const double time : times) {
        all.push_back({.time = time, .element = assembly.element_id(kind, element)});
      }
    }
  }
  all.insert(all.end(), of_obstacles.begin(), of_obstacles.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Discontinuity& a, const Discontinuity& b) { return a.time < b.time; });
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Errors of works count relative to the mass, those of angles by the radius of gyration.
std::vector<double> tolerances_of(const Assembly& assembly, Index component, const MotionUnknowns& unknowns,
                                  double tolerance_of_places) {
  std::vector<double> tolerances(unknowns.size(), tolerance_of_places);
  double mass = 0.0;
  const Component& all = assembly.components()[component];
  assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    for (Index slot = slots.begin; slot < slots.end; ++slot) {
      mass += kind.mass(slot);
      const Index body = slot - slots.begin;
      for (Index i = 0; i < kind.v_size(); ++i) {
        const double tolerance = tolerance_of_places / kind.length_scale(slot, i);
        tolerances[unknowns.q_size() + (v - all.v.begin) + body * kind.v_size() + i] = tolerance;
        // Orientations come last in both and are measured alike in the plane.
        if (i < kind.q_size()) tolerances[(q - all.q.begin) + body * kind.q_size() + i] = tolerance;
      }
    }
  });
  for (Index i = 0; i < unknowns.work_count(); ++i) {
    tolerances[unknowns.size() - 1 - i] = mass * tolerance_of_places;
  }
  return tolerances;
}

}  // namespace

ComponentModel::ComponentModel(const Assembly& assembly_in, const Detector& detector_in, Index component,
                               const EventDriven& options_in, const JointConstraints& joints)
    : assembly(&assembly_in),
      detector(&detector_in),
      options(&options_in),
      index(component),
      unknowns(assembly->components()[component],
               detector->has_dry_friction(component) ? work_lines : work_lines - 1),
      pairs(pairs_of(*assembly, *detector, component, joints)),
      mechanisms(mechanisms_of(*assembly, pairs)),
      tolerances(tolerances_of(*assembly, component, unknowns, options->absolute_tolerance)) {
  const bool ground_moves = !pairs.empty() && detector->has_moving_ground();
  loads = load_traits(*assembly, component, joints.depends_on_time(), ground_moves);
  discontinuities = discontinuities_of(
      *assembly, component, ground_moves ? detector->discontinuities() : std::vector<Discontinuity>{});
}

double ComponentModel::kinetic_energy(const double* velocities) const {
  double sum = 0.0;
  assembly->for_bodies(index, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    sum += kind.kinetic_energy(slots, velocities + v);
  });
  return sum;
}

double ComponentModel::kinetic_energy_of_mechanism(Index body, const double* velocities) const {
  const auto of_body = [&](Index one) {
    const BodySlot slot = assembly->layout()->bodies()[one];
    return assembly->body_kinds()[slot.kind]->kinetic_energy({slot.slot, slot.slot + 1}, velocities + slot.v);
  };
  if (!assembly->is_jointed(body)) return of_body(body);
  double sum = 0.0;
  const Range bodies = ranges().bodies;
  for (Index other = bodies.begin; other < bodies.end; ++other) {
    if (assembly->mechanism(other) == assembly->mechanism(body)) sum += of_body(other);
  }
  return sum;
}

}  // namespace carom
