#pragma once

// A model whose bodies go from where they are described under constant accelerations, as a path; and where
// their outlines are then, by closed forms.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/state_path.h>
#include <carom/core/assembly.h>

#include "tests/contact/detection/convex_reference.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <utility>
#include <vector>

namespace carom_test {

/// Leaves no pair out.
inline constexpr auto every_pair = [](const carom::ContactPair&) { return true; };

struct MovedModel {
  /// \param given accelerations, over all velocities; those that are left out are zero
  MovedModel(carom::System system, double span, std::vector<double> given = {}, double begin = 0.0)
      : assembly(std::move(system)),
        detector(assembly),
        acceleration(std::move(given)),
        start(assembly.initial_state()),
        path(assembly, detector) {
    acceleration.resize(start.v.size(), 0.0);
    start.time = begin;
    end = at(begin + span);
    for (const double a : acceleration) change.push_back(span * a);
    path.set(start, end, change.data());
  }
  /// The state at a time.
  [[nodiscard]] carom::State at(double time) const {
    carom::State out = start;
    out.time = time;
    const double t = time - start.time;
    for (const carom::BodySlot slot : assembly.layout()->bodies()) {
      for (carom::Index i = 0; i < slot.v_size; ++i) {
        const double v = start.v[slot.v + i], a = acceleration[slot.v + i];
        out.q[slot.q + i] += t * (v + 0.5 * t * a);
        out.v[slot.v + i] += t * a;
      }
    }
    return out;
  }

  carom::Assembly assembly;
  carom::Detector detector;
  std::vector<double> acceleration, change;  // change of velocities over the path
  carom::State start, end;
  carom::StatePath path;
};

/// An outline of a body where it is in a state.
inline OwnedOutline body_outline(const MovedModel& model, carom::Index outline, const carom::State& at) {
  const carom::Outlines& all = model.detector.outlines();
  const carom::BodyOutline& of = all.of_bodies().list()[outline];
  const carom::BodySlot slot = all.slots()[of.body];
  const carom::ConvexOutline described = all.of_bodies().described(of);
  const OwnedOutline own{{described.vertices.begin(), described.vertices.end()}, described.radius};
  const double angle = slot.v_size > 2 ? at.q[slot.q + 2] : 0.0;
  return own.moved(angle, {at.q[slot.q], at.q[slot.q + 1]});
}

/// A convex outline on ground where it is at a time.
inline OwnedOutline ground_outline(const MovedModel& model, carom::Index on_ground, double time) {
  const carom::Outlines& all = model.detector.outlines();
  const carom::ConvexOutline described = all.on_ground().view(on_ground);
  const OwnedOutline own{{described.vertices.begin(), described.vertices.end()}, described.radius};
  const carom::Index shape = all.on_ground().outlines()[on_ground].shape;
  if (!all.shapes().moves(shape)) return own;
  const carom::GroundMotion motion = all.shapes().motion(shape, time);
  return own.moved(motion.angle, {motion.point[0], motion.point[1]});
}

/// Adds a body whose only shape is an outline around its centre of mass.
inline carom::BodyId add_outline(carom::System& system, const OwnedOutline& outline,
                                 const carom::planar::RigidBody& body) {
  using namespace carom::planar;
  const carom::BodyId id = system.add(body);
  const std::vector<carom::Vec<2>>& vertices = outline.vertices;
  if (vertices.size() == 1 && outline.radius > 0.0) {
    system.add(Disc{.body = id, .radius = outline.radius, .centre = vertices[0]});
  } else if (vertices.size() == 1) {
    system.add(Point{.body = id, .position = vertices[0]});
  } else if (vertices.size() == 2) {
    system.add(Segment{.body = id, .from = vertices[0], .to = vertices[1], .radius = outline.radius});
  } else {
    system.add(Polygon{.body = id, .vertices = vertices, .radius = outline.radius});
  }
  return id;
}

/// Accelerations of all bodies of the plane, by size [m/s^2, rad/s^2].
inline std::vector<double> random_accelerations(Random& random, int bodies, double size) {
  std::vector<double> out;
  for (int i = 0; i < 3 * bodies; ++i) out.push_back(random.uniform(-size, size));
  return out;
}

}  // namespace carom_test
