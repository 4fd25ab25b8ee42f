#include <carom/core/law_jump.h>
#include <carom/core/part_check.h>
#include <carom/core/run_error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace carom {

namespace {

/// How far differences of first order look to either side of a time, beside a break too [s].
constexpr double difference_reach = 7.0 / 4096.0;
/// Parts of an interval that are followed at once.
constexpr std::size_t most_parts = 8;
/// Rounding of times [s], relative for those beyond 1 s.
constexpr double resolution = 2.0 * std::numeric_limits<double>::epsilon();
/// Halvings after which an interval of any usual length is at the rounding of time.
constexpr int most_halvings = 80;
/// Parts over which the law moves less than this share of the whole way are given up: a jump that was felt
/// through velocities by differences has moved more.
constexpr double given_up_share = 0x1p-12;
/// A jump is this part, or more, of the change over an interval that is longer by the factor below.
constexpr double jump_share = 0.5, longer = 1024.0;

double norm(const std::array<double, 3>& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

double whole_turns_off(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// The motion between two points of a law, of the place or of the angle.
struct Change {
  double moved = 0.0;      // |x1 - x0|
  double missed = 0.0;     // |x1 - x0 - h (v0 + v1)/2|
  double way = 0.0;        // h (|v0| + |v1|)/2
  double bent = 0.0;       // h |v1 - v0|/2
  double magnitude = 0.0;  // of the larger of the two
  double rounding = 0.0;   // way within the rounding of time: where x is near 0 that of x is less

  [[nodiscard]] double resolved() const { return resolved_share * magnitude + rounding; }
  // A number that is none is not smooth.
  [[nodiscard]] bool smooth() const { return missed <= smooth_share * (moved + way) + resolved(); }
  [[nodiscard]] bool straight() const { return bent <= bent_share * way + resolved(); }
};

double rounding_of_time(double time) { return resolution * std::max(1.0, std::abs(time)); }

Change change_of_place(const LawPoint& a, const LawPoint& b) {
  const double half = 0.5 * (b.time - a.time);
  std::array<double, 3> moved{}, missed{}, bent{};
  for (std::size_t i = 0; i < 3; ++i) {
    moved[i] = b.place[i] - a.place[i];
    missed[i] = moved[i] - half * (a.velocity[i] + b.velocity[i]);
    bent[i] = half * (b.velocity[i] - a.velocity[i]);
  }
  const double faster = std::max(norm(a.velocity), norm(b.velocity));
  return {norm(moved),
          norm(missed),
          half * (norm(a.velocity) + norm(b.velocity)),
          norm(bent),
          std::max(norm(a.place), norm(b.place)),
          rounding_of_time(b.time) * faster};
}

Change change_of_angle(const LawPoint& a, const LawPoint& b) {
  const double half = 0.5 * (b.time - a.time), moved = b.angle - a.angle;
  return {std::abs(moved),
          std::abs(moved - half * (a.spin + b.spin)),
          half * (std::abs(a.spin) + std::abs(b.spin)),
          half * std::abs(b.spin - a.spin),
          std::max(std::abs(a.angle), std::abs(b.angle)),
          rounding_of_time(b.time) * std::max(std::abs(a.spin), std::abs(b.spin))};
}

/// Whole turns between two angles are no motion where the spin has none.
Change turn_between(const LawPoint& a, const LawPoint& b) {
  Change change = change_of_angle(a, b);
  if (change.way > std::numbers::pi) return change;
  change.moved = std::abs(whole_turns_off(change.moved));
  change.missed = std::abs(whole_turns_off(change.missed));
  return change;
}

Change seen_change(const LawPoint& a, const LawPoint& b, bool of_angle) {
  return of_angle ? turn_between(a, b) : change_of_place(a, b);
}

/// Simpson's rule through a third point in the middle tells a bent way from a jump.
bool smooth_by_three(const LawPoint& a, const LawPoint& middle, const LawPoint& b, bool of_angle) {
  const double sixth = (b.time - a.time) / 6.0;
  Change whole = seen_change(a, b, of_angle);
  if (of_angle) {
    whole.missed =
        std::abs(whole_turns_off(b.angle - a.angle - sixth * (a.spin + 4.0 * middle.spin + b.spin)));
    return whole.smooth();
  }
  std::array<double, 3> missed{};
  for (std::size_t i = 0; i < 3; ++i) {
    missed[i] = b.place[i] - a.place[i] - sixth * (a.velocity[i] + 4.0 * middle.velocity[i] + b.velocity[i]);
  }
  whole.missed = norm(missed);
  return whole.smooth();
}

/// One search, of the place or of the angle.
class Search {
public:
  Search(FunctionRef<LawPoint(double)> law, bool of_angle) : law_(law), of_angle_(of_angle) {}

  std::optional<LawJump> between(const LawPoint& from, const LawPoint& to) {
    const Change whole = change(from, to);
    least_ = std::max(given_up_share * std::max(whole.moved, whole.missed), whole.resolved());
    count_ = 0;
    take(from, to);
    for (int i = 0; i < most_halvings && count_ > 0; ++i) {
      const std::array<Part, most_parts> parts = parts_;
      const std::size_t count = std::exchange(count_, 0);
      for (std::size_t k = 0; k < count; ++k) {
        const LawPoint &a = parts[k].from, &b = parts[k].to;
        const double middle = a.time + 0.5 * (b.time - a.time);
        if (!(b.time - a.time > rounding_of_time(b.time))) {
          if (is_jump(a, b)) return LawJump{a.time, parts[k].change.moved, of_angle_};
          continue;
        }
        const LawPoint between = law_(middle);
        take(a, between);
        take(between, b);
      }
    }
    return std::nullopt;
  }

private:
  struct Part {
    LawPoint from, to;
    Change change;
  };

  [[nodiscard]] Change change(const LawPoint& a, const LawPoint& b) const {
    return of_angle_ ? change_of_angle(a, b) : change_of_place(a, b);
  }
  /// Keeps a part that may hold a jump, if it is among the roughest.
  void take(const LawPoint& a, const LawPoint& b) {
    const Change now = change(a, b);
    if (!(now.missed < std::numeric_limits<double>::infinity())) return;
    if (!(now.moved > least_)) return;
    // Differences make a jump look like a steep smooth motion over about their reach.
    const double length = b.time - a.time;
    const bool differs = length < difference_reach / 16.0 || length > 4.0 * difference_reach;
    if (differs && now.smooth()) return;
    std::size_t at = count_;
    if (count_ == most_parts) {
      const auto less = [](const Part& p, const Part& q) { return p.change.missed < q.change.missed; };
      at = static_cast<std::size_t>(std::min_element(parts_.begin(), parts_.end(), less) - parts_.begin());
      if (parts_[at].change.missed >= now.missed) return;
    } else {
      ++count_;
    }
    parts_[at] = {a, b, now};
  }
  [[nodiscard]] bool is_jump(const LawPoint& a, const LawPoint& b) {
    const double size = change(a, b).moved;
    // An angle may count whole turns anew where its spin is given: one by differences would feel them.
    if (of_angle_ && std::abs(whole_turns_off(size)) <= resolved_share) {
      const double felt = std::abs(a.spin - law_(a.time - 2.0 * difference_reach).spin);
      if (felt < 0.25 * size / difference_reach) return false;
    }
    const double around = 0.5 * longer * (b.time - a.time);
    const Change wide = change(law_(a.time - around), law_(b.time + around));
    return size > jump_share * wide.moved;
  }

  FunctionRef<LawPoint(double)> law_;
  bool of_angle_;
  double least_ = 0.0;
  std::array<Part, most_parts> parts_{};
  std::size_t count_ = 0;
};

/// True if ways from a time on, from an eighth of `length` [s] downwards, are missed by the rate as long as
/// they are told from rounding; how far off the rate is on the shortest of them.
bool misses_throughout(FunctionRef<LawPoint(double)> law, FalseRate& found, double length) {
  constexpr double shorter = 1.0 / 16.0, told = 10.0;
  const LawPoint from = law(found.time);
  bool looked = false;
  for (length *= 0.125;; length *= shorter) {
    const Change way = seen_change(from, law(found.time + length), found.of_angle);
    if (!(std::max(way.moved, way.way) > told * way.resolved())) return looked;
    if (way.smooth()) return false;
    looked = true;
    found.off = way.missed / length;
    if (length < rounding_of_time(found.time)) return looked;
  }
}

/// Throws the SolverError of a law. \param message behind the name of the part
[[noreturn]] void fail_law(const std::string& part, const std::string& message, double time) {
  SolverFailure failure;
  failure.time = time;
  failure.parts.push_back(part);
  throw RunError(part + ": " + message, std::move(failure));
}

std::string with_unit(double value, const char* unit) {
  return *unit == '\0' ? to_text(value) : to_text(value) + " " + unit;
}

}  // namespace

std::optional<FalseRate> find_false_rate(FunctionRef<LawPoint(double)> law, const LawPoint& from,
                                         const LawPoint& to) {
  for (const bool of_angle : {false, true}) {
    if (!(of_angle ? from.spin_given : from.velocity_given)) continue;
    FalseRate found{.of_angle = of_angle};
    const auto is_false_at = [&](double share) {
      found.time = from.time + share * (to.time - from.time);
      return misses_throughout(law, found, to.time - from.time);
    };
    constexpr std::array<double, 5> shares{0.1, 0.3, 0.5, 0.7, 0.9};
    if (std::all_of(shares.begin(), shares.end(), is_false_at)) return found;
  }
  return std::nullopt;
}

bool looks_smooth(const LawPoint& from, const LawPoint& to) {
  const Change place = change_of_place(from, to), turn = turn_between(from, to);
  return place.smooth() && place.straight() && turn.smooth() && turn.straight();
}

void PrescribedLaw::demand_continuous(const LawPoint& from, const LawPoint& to) const {
  if (looks_smooth(from, to)) return;
  if (const auto jump = find_jump(law_, from, to)) fail(*jump);
  if (const auto rate = find_false_rate(law_, from, to)) fail(*rate);
}

void PrescribedLaw::fail(const LawJump& jump) const {
  fail_law(part_(),
           std::string(jump.of_angle ? names_->angle : names_->place) +
               " jumps at t = " + to_text(jump.time) + " s, by " +
               with_unit(jump.size, jump.of_angle ? names_->unit_of_angle : names_->unit) +
               "; allowed: a continuous one (its rate may jump, at times listed in breaks)",
           jump.time);
}

void PrescribedLaw::fail(const FalseRate& found) const {
  fail_law(part_(),
           std::string(found.of_angle ? names_->spin : names_->velocity) + " at t = " + to_text(found.time) +
               " s is not the rate of " + (found.of_angle ? names_->angle : names_->place) + ", off by " +
               with_unit(found.off, found.of_angle ? names_->unit_of_spin : names_->unit_of_velocity) +
               "; allowed: its rate (it is computed where none is given)",
           found.time);
}

void fail_law_not_finite(const std::string& part, const std::string& quantity, double value, const char* unit,
                         double time) {
  fail_law(part,
           quantity + " at t = " + to_text(time) + " s is " + with_unit(value, unit) +
               "; allowed: a finite number",
           time);
}

std::optional<LawJump> find_jump(FunctionRef<LawPoint(double time)> law, const LawPoint& from,
                                 const LawPoint& to) {
  for (const bool of_angle : {false, true}) {
    const Change seen = seen_change(from, to, of_angle);
    if (seen.smooth()) {
      if (seen.straight()) continue;
      if (smooth_by_three(from, law(from.time + 0.5 * (to.time - from.time)), to, of_angle)) continue;
    }
    Search search(law, of_angle);
    if (const auto found = search.between(from, to)) return found;
    // Rates by differences are those of a jump before it comes.
    const LawPoint before = law(from.time - difference_reach), after = law(to.time + difference_reach);
    if (const auto found = search.between(before, from)) return found;
    if (const auto found = search.between(to, after)) return found;
  }
  return std::nullopt;
}

}  // namespace carom
