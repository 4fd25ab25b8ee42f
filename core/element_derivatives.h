#pragma once

/// \file
/// Derivatives of the loads of a force element by positions and velocities. An element gives those of forces
/// at points and of torques on bodies; the rotation of the levers with the bodies is added here.

#include <carom/core/element_view.h>
#include <carom/core/end.h>
#include <carom/core/force_kind.h>

#include <array>
#include <type_traits>
#include <vector>

namespace carom {

/// Collects the derivatives of the total load of one element (all causes together). Repeated calls add.
template <int D>
class ElementDerivatives {
public:
  ElementDerivatives(const ElementView<D>& view, std::vector<LoadDerivative>& out)
      : view_(&view), out_(&out) {}

  /// The force `force` [N] at an end, which changes by `by_position` [N/m] times a displacement of that end
  /// and `by_velocity` [N s/m] times a change of its velocity. Needed for a constant force too: its lever
  /// turns with the body if the end is not the centre of mass.
  void force(const End<D>& end, const Vec<D>& force, const Mat<D>& by_position, const Mat<D>& by_velocity) {
    const Point point(*view_, view_->attach(end));
    Motions motions;
    motions.add(point, 1.0);
    add(motions, by_position, by_velocity);
    add_turning_lever(point, force);
  }

  /// The force `force` [N] at the end `to` and the opposite at the end `from`, with changes by the distance
  /// from `from` to `to` (`by_distance` [N/m]) and by its rate (`by_rate` [N s/m]).
  void opposite_forces(const End<D>& from, const End<D>& to, const Vec<D>& force, const Mat<D>& by_distance,
                       const Mat<D>& by_rate) {
    opposite_forces(view_->attach(from), view_->attach(to), force, by_distance, by_rate);
  }
  /// The force `force` [N] at the end `to` and the opposite at the end `from`, whose places in the arrays are
  /// known, with changes by the distance from `from` to `to` (`by_distance` [N/m]) and by its rate (`by_rate`
  /// [N s/m]).
  void opposite_forces(const Attachment<D>& from, const Attachment<D>& to, const Vec<D>& force,
                       const Mat<D>& by_distance, const Mat<D>& by_rate) {
    const Point start(*view_, from), end(*view_, to);
    Motions motions;
    motions.add(start, -1.0);
    motions.add(end, 1.0);
    add(motions, by_distance, by_rate);
    add_turning_lever(start, -force);
    add_turning_lever(end, force);
  }

  /// A torque on the planar rigid body `to` and the opposite on `from` (either may be `ground`), which
  /// changes by `by_angle` [N m/rad] times the angle of `to` relative to `from` and `by_rate` [N m s/rad]
  /// times its rate.
  void opposite_torques(BodyId from, BodyId to, double by_angle, double by_rate) requires(D == 2) {
    const std::array<BodyId, 2> bodies{from, to};
    for (const BodyId row : bodies) {
      for (const BodyId column : bodies) {
        if (row == ground || column == ground) continue;
        const double sign = row == column ? 1.0 : -1.0;
        entry(view_->oriented(row).v + D, view_->oriented(column).v + D, sign * by_angle, sign * by_rate);
      }
    }
  }

  /// Any other derivative: of the load on velocity coordinate `row` along velocity coordinate `column`
  /// (BodySlot::v of the assembly's layout and following).
  void entry(Index row, Index column, double by_position, double by_velocity) {
    out_->push_back({row, column, by_position, by_velocity});
  }

private:
  // An end in motion.
  struct Point {
    Point(const ElementView<D>& view, const Attachment<D>& attachment)
        : at(attachment), lever(attachment.lever(view.context().evaluation)) {
      if constexpr (Space<D>::has_orientation) {
        if (turns()) spin = view.context().state.v[at.v + D];
      }
    }
    [[nodiscard]] bool turns() const { return at.q != none && at.rotation != none; }

    Attachment<D> at;
    Vec<D> lever;
    double spin = 0.0;
  };

  // Velocity coordinates that move the ends: `path` is d(end)/d(coordinate), with the sign that the end has
  // in the load, `turn` the change of the end's velocity with an angle.
  struct Motion {
    Index v = 0;
    Vec<D> path, turn;
  };
  struct Motions {
    void add(const Point& point, double sign) {
      if (point.at.q == none) return;
      for (int i = 0; i < D; ++i) {
        list[size++] = {point.at.v + static_cast<Index>(i), sign * Vec<D>::Unit(i), Vec<D>::Zero()};
      }
      if constexpr (Space<D>::has_orientation) {
        if (!point.turns()) return;
        const double one = 1.0;
        list[size++] = {point.at.v + D, sign * Space<D>::lever_velocity(&one, point.lever),
                        -sign * point.spin * point.lever};
      }
    }
    static constexpr std::size_t most =
        2 * (static_cast<std::size_t>(D) + 1);  // of two ends with an angle each
    std::array<Motion, most> list;
    std::size_t size = 0;
  };

  void add(const Motions& motions, const Mat<D>& by_position, const Mat<D>& by_velocity) {
    for (std::size_t c = 0; c < motions.size; ++c) {
      const Motion& column = motions.list[c];
      const Vec<D> moved = by_position * column.path + by_velocity * column.turn;
      const Vec<D> faster = by_velocity * column.path;
      for (std::size_t r = 0; r < motions.size; ++r) {
        const Motion& row = motions.list[r];
        entry(row.v, column.v, row.path.dot(moved), row.path.dot(faster));
      }
    }
  }

  // d(r x f)/d(angle) at constant f is -r.f.
  void add_turning_lever(const Point& point, const Vec<D>& force) {
    if (point.turns()) entry(point.at.v + D, point.at.v + D, -point.lever.dot(force), 0.0);
  }

  // LoadDerivative, by a name that depends on D: programs that call nothing here do not compile the list.
  using Entry = std::conditional_t<(D > 0), LoadDerivative, void>;

  const ElementView<D>* view_;
  std::vector<Entry>* out_;
};

}  // namespace carom
