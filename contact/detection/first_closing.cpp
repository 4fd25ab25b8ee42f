// Problem: the first closing of a gap whose rate may have kinks.

#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/core/numerics/fall_search.h>
#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Of two discs around their centres of mass without a contact: d = |c_a - c_b|.
StepPolynomial::End gap_of_discs(const BodyPairBound& bound, const PathSample& at) {
  const double *const q = at.state.q, *const v = at.state.v, *const a = at.acceleration;
  const double x = q[bound.a.q] - q[bound.b.q], y = q[bound.a.q + 1] - q[bound.b.q + 1];
  const double u = v[bound.a.v] - v[bound.b.v], w = v[bound.a.v + 1] - v[bound.b.v + 1];
  const double b = a[bound.a.v] - a[bound.b.v], c = a[bound.a.v + 1] - a[bound.b.v + 1];
  const double distance = std::sqrt(x * x + y * y), rate = (x * u + y * w) / distance;
  const double across = (x * w - y * u) / distance;
  return {distance - bound.rounding, rate, (across * across + x * b + y * c) / distance};
}

/// The gap of a vertex and an outline at one time, smooth as long as the nearest feature stays the same.
struct FeatureLook {
  QuantityLook gap;
  Index feature = none;
  double margin = 0.0;  // within which the gap is smooth [m]
  double turn = 0.0;    // how fast the two sides turn [rad/s]
};

/// How fast both sides of a pair turn, together [rad/s].
double turn_of(const PairGap& of, const PathSample& at) {
  const auto spin_of = [&](const BodySlot& body) {
    return body.v_size > 2 ? std::abs(at.state.v[body.v + 2]) : 0.0;
  };
  return spin_of(of.bound->a) + (of.bound->on_ground ? 0.0 : spin_of(of.bound->b));
}

/// The first closing of a gap that is no polynomial: intervals in which the nearest feature may change, or in
/// which bodies turn far, are halved, unless a bound of the rate, which holds for the margins too, shows that
/// the gap does not close in them. Where bodies rest on each other at the border of two features for the
/// whole step, no interval would end that: there a gap that hardly moves counts as smooth, and looks are
/// counted.
class KinkedSearch {
public:
  KinkedSearch(PairPath& path, PathLook how, const PairGap& pair, const FallRule& rule, double until)
      : path_(&path), how_(how), pair_(&pair), rule_(rule), until_(until) {}

  [[nodiscard]] double first(double begin, double end) { return between(look(begin), look(end), 0); }

private:
  [[nodiscard]] FeatureLook look(double time) {
    ++looks_;
    const PathSample at = path_->sample(time, how_);
    FeatureLook out;
    out.gap = {time, gap_in(*pair_, at), 0.0};
    out.turn = turn_of(*pair_, at);
    if (pair_->bound->round) {
      out.margin = std::numeric_limits<double>::infinity();
      return out;
    }
    const OutlinePair outlines =
        pair_->detector.outlines().outline_pair(pair_->pair, at.state, at.evaluation, at.places);
    const FeatureRegions regions(outlines);
    // So has ground that a vertex has come through, or whose depth ends: beyond it the gap is positive again.
    has_two_sides_ = outlines.chain || (outlines.is_sharp() && FeatureRegions::is_flat(outlines.outline));
    out.feature = regions.nearest();
    out.margin = regions.clearance(out.feature);
    return out;
  }
  [[nodiscard]] double between(const FeatureLook& from, const FeatureLook& to, int depth) {
    constexpr int deepest = 30;
    constexpr double far = 1.0;  // a polynomial of degree 5 follows less to 1e-5 of an arm [rad]
    const double begin = from.gap.time, end = to.gap.time, way = rule_.fastest * (end - begin);
    // Straight through such a side the gap falls to 0, or below, and is as far above 0 behind it.
    const double closed = has_two_sides_ ? rule_.raise : -rule_.raise;
    if (!(begin < until_) || from.gap.at.value + to.gap.at.value - way > 2.0 * closed) return never;
    const bool smooth = from.feature == to.feature && from.margin + to.margin > way &&
                        std::max(from.turn, to.turn) * (end - begin) <= far;
    if (smooth || depth == deepest || looks_ > most_looks || hardly_moves(from.gap, to.gap)) {
      QuantityOf gap([&](double time) {
        return smoothed({time, gap_in(*pair_, path_->sample(time, how_)), 0.0});
      });
      FallRule rule = rule_;
      if (is_smoothed()) rule.fastest = std::numeric_limits<double>::infinity();
      return FallSearch(gap, rule, until_).first(smoothed(from.gap), smoothed(to.gap));
    }
    const FeatureLook middle = look(begin + 0.5 * (end - begin));
    const double first = between(from, middle, depth + 1);
    return first < never ? first : between(middle, to, depth + 1);
  }

  /// Of two discs: without the kink that a distance has. It closes as the gap does, at another rate. Two
  /// points without rounding have a kink where they meet, and do not touch.
  [[nodiscard]] QuantityLook smoothed(QuantityLook look) const {
    if (is_smoothed()) look.at = smooth_gap(look.at, pair_->bound->rounding);
    return look;
  }
  [[nodiscard]] bool is_smoothed() const { return pair_->bound->round && pair_->bound->rounding > 0.0; }

  // True of a gap that moves by less than what counts as found, by its values and rates at two looks.
  [[nodiscard]] bool hardly_moves(const QuantityLook& from, const QuantityLook& to) const {
    const double rate = std::max(std::abs(from.at.first), std::abs(to.at.first));
    return std::abs(to.at.value - from.at.value) + rate * (to.time - from.time) <= rule_.fine;
  }

  static constexpr int most_looks = 10000;  // some hundred isolated kinks
  PairPath* path_;
  PathLook how_;
  const PairGap* pair_;
  FallRule rule_;
  double until_;
  bool has_two_sides_ = false;  // the outline can be passed through, and its gap is positive behind it
  int looks_ = 0;
};

/// True if values and the bound of the rate exclude a closing, and that the gap comes so near to zero that it
/// may be through a side behind which it is positive again.
bool is_excluded(const ClosingRule& rule, const GapLook& from, const GapLook& to) {
  const double way = rule.fastest * (to.time - from.time);
  return from.gap.value + to.gap.value - way > 2.0 * (rule.noise - rule.level);
}

}  // namespace

bool has_kinks(const BodyPairBound& bound) {
  // A side may turn about a point that is not its middle: the gap feels it.
  const bool feels_turns = bound.on_ground ? bound.lever > 0.0 : !bound.central;
  return !bound.round || feels_turns;
}

StepPolynomial::End gap_in(const PairGap& of, const PathSample& at) {
  if (of.bound != nullptr && of.bound->central) return gap_of_discs(*of.bound, at);
  SingleConstraint contact;
  of.detector.contact(of.pair, at.state, at.evaluation, at.places, contact);
  return {contact.gap, contact.normal_velocity(at.state.v), contact.normal_acceleration(at.acceleration)};
}

StepPolynomial::End smooth_gap(const StepPolynomial::End& gap, double rho) {
  const double part = (gap.value + rho) / rho;
  return {gap.value * (gap.value + 2.0 * rho) / (2.0 * rho), part * gap.first,
          part * gap.second + gap.first * gap.first / rho};
}

double predict_closing(PairPath& path, const PairGap& of, const ClosingRule& how, const GapLook& from,
                       const GapLook& to, PathLook looks) {
  if (is_excluded(how, from, to)) return never;
  const BodyPairBound* const bound = of.bound;
  FallRule rule;
  rule.raise = how.noise - how.level;
  rule.fine = how.fine;
  rule.clear_falls = false;  // of several gaps the first is wanted
  constexpr int least_of_moving = 2;
  const bool moving = moves(of.detector, of.pair);
  if (moving) rule.least_depth = least_of_moving;
  if (bound != nullptr && has_kinks(*bound)) {
    rule.fastest = how.fastest;
    return KinkedSearch(path, looks, of, rule, how.until).first(from.time, to.time);
  }
  const bool smooth = bound != nullptr && bound->rounding > 0.0;
  // The error that turning makes of a flat boundary is bounded beforehand.
  const bool is_bounded = bound == nullptr ? !moving : bound->central && smooth;
  rule.measured = !(is_bounded && how.flies_freely);
  const auto look = [&](double time, const StepPolynomial::End& gap) -> QuantityLook {
    return {time, smooth ? smooth_gap(gap, bound->rounding) : gap, how.sixth};
  };
  QuantityOf gap([&](double time) { return look(time, gap_in(of, path.sample(time, looks))); });
  const auto at_end = [&](const GapLook& end) {
    return end.known ? look(end.time, end.gap) : gap.look(end.time);
  };
  const QuantityLook begin = at_end(from);
  return FallSearch(gap, rule, how.until).first(begin, at_end(to));
}

namespace {

/// Predictions and their places on the exact motion in turn. Where a closing that was predicted is none, the
/// path after it is searched anew. A step may be wrong far behind its own event, and what is interpolated in
/// front of it too: where that is not the exact motion, all is searched on that.
class ClosingOnPath {
public:
  ClosingOnPath(PairPath& path, const PairGap& of, const ClosingRule& rule)
      : path_(&path), of_(&of), rule_(rule) {}

  [[nodiscard]] double first(const GapLook& from, const GapLook& to, int halvings) {
    using Kind = ClosingRoot::Kind;
    const double predicted = predict_closing(*path_, *of_, rule_, from, to, looks_);
    if (!(predicted < never)) return never;
    // It may be between the last time before the end of the span and that end.
    const ClosingRoot root = locate_closing(*path_, *of_, rule_, from, to.time, true, predicted);
    if (root.kind == Kind::closes) return root.time;
    if (root.kind == Kind::misleads) {
      looks_ = PathLook::exact;
      rule_.misleading = never;
      const GapLook begin = look(from.time);
      rule_.level = std::min(0.0, begin.gap.value);
      return first(begin, look(to.time), halvings);
    }
    if (root.kind == Kind::touches) {
      if (lowers_level()) return first(from, to, halvings);
      if (!(root.rate >= 0.0 && root.time == from.time)) return root.time;
    }
    return behind(root.time, from, to, halvings);
  }

private:
  /// The gap opens at a time: what is before and behind it is searched by itself.
  [[nodiscard]] double behind(double time, const GapLook& from, const GapLook& to, int halvings) {
    constexpr int deepest = 20;
    if (halvings == deepest) return never;
    const bool progress = time > from.time && time < to.time;
    const double between = progress ? time : 0.5 * (from.time + to.time);
    if (!(between > from.time && between < to.time)) return never;
    const GapLook middle = look(between);
    if (!progress) {
      const double closing = first(from, middle, halvings + 1);
      if (closing < never) return closing;
    }
    return first(middle, to, halvings + 1);
  }
  /// True if the level was lowered, for a gap that does not fall where it reaches it.
  [[nodiscard]] bool lowers_level() {
    constexpr double growth = 4.0;
    if (!(lowered_ < rule_.contradiction)) return false;
    const double lowered = std::min(growth * std::max(lowered_, rule_.noise), rule_.contradiction);
    rule_.level -= lowered - lowered_;
    lowered_ = lowered;
    return true;
  }
  [[nodiscard]] GapLook look(double time) { return {time, true, gap_in(*of_, path_->sample(time, looks_))}; }

  PairPath* path_;
  const PairGap* of_;
  ClosingRule rule_;
  PathLook looks_ = PathLook::between;
  double lowered_ = 0.0;  // of the level, for gaps that do not fall [m]
};

}  // namespace

double first_closing(PairPath& path, const PairGap& of, const ClosingRule& rule, const GapLook& from,
                     const GapLook& to) {
  return ClosingOnPath(path, of, rule).first(from, to, 0);
}

}  // namespace carom
