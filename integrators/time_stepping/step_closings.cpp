// Problem: on the way of a step, which gap is the first to close, or to become too deep?

#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/step_closings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

namespace carom {

namespace {

// Depths, over that of points and bare segments, that a gap may be wrong by.
constexpr double roundings_of_depth = 1e3;

}  // namespace

StepClosings::StepClosings(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
                           StepContacts contacts)
    : assembly_(&assembly),
      detector_(&detector),
      of_contacts_(contacts != StepContacts::nothing),
      rounding_(gap_rounding(assembly, options)),
      capture_(CaptureRule::of(assembly, options)),
      levels_(detector, roundings_of_depth * rounding_,
              options.impacts == ImpactTimes::located ? Passages::of_far_sides : Passages::all),
      paths_(assembly, detector),
      pairs_(assembly, detector, contacts == StepContacts::all ? FlatPairs::all : FlatPairs::turning),
      depths_(detector) {}

/// Lists the contacts of a step, by pair or by key.
void StepClosings::list_acted(std::span<const std::pair<ConstraintKey, ContactMode>> modes) {
  acted_.clear();
  for (const auto& [key, mode] : modes) {
    const std::optional<ContactPair> pair = detector_->outlines().pair_of(key);
    Acted entry{none, none, key, acted_.size(), mode == ContactMode::open};
    if (pair) {
      entry.key = {};
      entry.feature = pair->feature;
      entry.outline = pair->outline;
    }
    acted_.push_back(entry);
  }
  std::sort(acted_.begin(), acted_.end(), [](const Acted& a, const Acted& b) {
    return a.name() < b.name() || (a.name() == b.name() && a.place < b.place);
  });
}

/// True if a contact acted up to the end of the way: of several entries of one the last says so.
bool StepClosings::acts(Index feature, Index outline, const ConstraintKey& key) const {
  const Acted of{feature, outline, key, 0, false};
  const auto behind = std::upper_bound(acted_.begin(), acted_.end(), of,
                                       [](const Acted& a, const Acted& b) { return a.name() < b.name(); });
  if (behind == acted_.begin()) return false;
  const Acted& last = *std::prev(behind);
  return last.name() == of.name() && !last.open;
}

/// How much nearer any two things may come on the path [m].
double StepClosings::most_approach() const {
  double most = 0.0, of_ground = 0.0;
  Index body = 0;
  for (const BodySlot slot : assembly_->layout()->bodies()) {
    double moved = std::hypot(paths_.path().displacement(slot.v), paths_.path().displacement(slot.v + 1));
    if (slot.v_size > 2) moved += levels_.reaches()[body] * std::abs(paths_.path().displacement(slot.v + 2));
    most = std::max(most, moved);
    ++body;
  }
  // Of ground twice what its speed at either end makes of it.
  const Outlines& outlines = detector_->outlines();
  for (const GroundOutline& outline : outlines.on_ground().outlines()) {
    for (const PathSample& at : {paths_.path().begin(), paths_.path().end()}) {
      const GroundMotion* const motion = outlines.shapes().motion(outline.shape, at.places);
      if (motion == nullptr) continue;
      of_ground = std::max(of_ground, std::hypot(motion->velocity[0], motion->velocity[1]) +
                                          outline.reach * std::abs(motion->spin));
    }
  }
  return 2.0 * (most + paths_.path().length() * of_ground);
}

StepClosing StepClosings::first(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes) {
  begin(way);
  while (found_.empty() && paths_.next()) search(way, closes, Keeps::first);
  return found_.empty() ? StepClosing{} : found_.front();
}

std::span<const StepClosing> StepClosings::all(const StepWay& way,
                                               FunctionRef<bool(const SweptPair&)> closes) {
  begin(way);
  while (paths_.next()) search(way, closes, Keeps::all);
  return found_;
}

void StepClosings::add_boxes(const StepWay& way, std::vector<Box<2>>& boxes) {
  const std::vector<BodyOutline>& outlines = detector_->outlines().of_bodies().list();
  paths_.begin(way, form());
  while (paths_.next()) {
    const std::span<const Box<2>> swept = pairs_.sweep(paths_.path(), way.bodies);
    for (std::size_t i = 0; i < swept.size(); ++i) {
      if (way.bodies.has(outlines[i].body)) boxes[i].extend(swept[i]);
    }
  }
}

void StepClosings::begin(const StepWay& way) {
  found_.clear();
  left_out_ = false;
  if (of_contacts_) list_acted(way.acted);
  paths_.begin(way, form());
}

/// Later closings than this are not kept.
double StepClosings::until(Keeps which) const {
  return which == Keeps::all || found_.empty() ? never : found_.front().time;
}

void StepClosings::keep(const StepClosing& closing, Keeps which) {
  if (which == Keeps::first) found_.clear();
  found_.push_back(closing);
}

/// True of a pair whose closings may be looked for, as far as that can be told without its contact.
bool StepClosings::looks_at(const StepWay& way, const ContactPair& pair) const {
  if (!way.bodies.has(pair.body) || (pair.other != none && !way.bodies.has(pair.other))) return false;
  if (way.flights.follow(pair)) return false;
  if (pair.has_outline() && acts(pair.feature, pair.outline, {})) return false;
  const auto lists = [&](const std::vector<ContactPair>& pairs) {
    return std::find(pairs.begin(), pairs.end(), pair) != pairs.end();
  };
  return !lists(aside_) && !lists(refuted_);
}

/// Searches the path for contacts that close: such as are open where it begins, and do not act on it.
void StepClosings::search_contacts(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes,
                                   Keeps which) {
  const auto looks = [&](const ContactPair& pair) { return looks_at(way, pair); };
  for (const SweptPair& pair : pairs_.find_pairs(paths_.path(), looks)) {
    if (!(pair.gap >= -rounding_)) continue;
    if (!pair.pair.has_outline() && acts(none, none, pair.key)) continue;
    StepClosing closing;
    closing.pair = pair;
    closing.key = pair.key;
    closing.body = pair.pair.body;
    closing.deep = -rounding_;
    if (!closes(pair)) {
      look_at_end(closing);
      left_out_ = left_out_ || (closing.gap < closing.deep && counts(closing, closing.rate));
    } else if (reaches(closing, until(which))) {
      keep(closing, which);
    }
  }
}

/// Searches the path.
void StepClosings::search(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes, Keeps which) {
  const double approach = most_approach();
  const bool of_depths = approach > levels_.thinnest();
  if (!of_contacts_ && !of_depths) return;
  const std::span<const NearOutlines> near = pairs_.find_outlines(paths_.path(), way.bodies);
  if (of_contacts_) search_contacts(way, closes, which);
  if (of_depths) search_depths(near, approach, which);
}

/// Searches the path for depths. Two outlines that come nearer by less than is allowed are passed over.
void StepClosings::search_depths(std::span<const NearOutlines> near, double approach, Keeps which) {
  constexpr double fine = 0.5;  // of the depth
  const std::vector<BodyOutline>& list = detector_->outlines().of_bodies().list();
  for (const NearOutlines& of : near) {
    const double allowed = levels_.allowed(of);
    if (!(approach > allowed)) continue;
    const double at_start = depths_.gap_at_begin(paths_.whole(), of);
    const double level = std::min(at_start, 0.0) - allowed;
    const double time = depths_.first(paths_.path(), of, level, fine * allowed, until(which));
    if (!(time < until(which))) continue;
    StepClosing passage;
    passage.time = time;
    passage.is_passage = true;
    passage.key = depths_.key_at_begin(paths_.path(), of);
    passage.body = list[of.a].body;
    keep(passage, which);
  }
}

/// True if a gap reaches its level on the path before a time.
bool StepClosings::reaches(StepClosing& closing, double until) {
  const SweptPair& of = closing.pair;
  const PathSample from = paths_.path().begin(), to = paths_.path().end();
  const double way = paths_.path().length() * of.fastest;
  if (of.gap - way > closing.deep) return false;
  const PairGap gap = of.gap_of(*detector_);
  const GapLook begin{from.state.time, true, gap_in(gap, from)};
  const GapLook end{to.state.time, true, gap_in(gap, to)};
  if (0.5 * (begin.gap.value + end.gap.value - way) > closing.deep) return false;
  // Corners that slide along each other tell their features apart to this.
  constexpr double of_corner = 0.1;
  ClosingRule rule;
  rule.level = closing.deep;
  rule.fine = std::max(rounding_, of_corner * detector_->outlines().on_ground().lengths().corner);
  rule.fastest = of.fastest;
  rule.sixth = of.sixth;
  rule.until = until;
  paths_.path().watch(of.moved_by());
  const double time = predict_closing(paths_.path(), gap, rule, begin, end, PathLook::exact);
  if (!(time < until)) return false;
  const StepPolynomial::End there = gap_in(gap, paths_.path().sample(time, PathLook::exact));
  const StepPolynomial::End last = gap_in(gap, paths_.whole().end());
  closing.gap = last.value;
  closing.rate = last.first;
  closing.dips = !(closing.gap < closing.deep);
  if (!counts(closing, there.first)) return false;
  const double aimed = time - (there.value - closing.aim()) / there.first;
  closing.time = there.first < 0.0 && aimed > begin.time ? std::min(aimed, time) : time;
  return true;
}

/// False of a contact that closes so slowly, and is open again or opens at the end of the way, that it is not
/// worth while. A corner that has slid along an edge of the other outline is not open there if the outlines
/// overlap.
bool StepClosings::counts(const StepClosing& closing, double rate) {
  const bool ends_open = !(closing.gap < closing.deep);
  if (ends_open) {
    const bool fast = capture_.is_fast(rate);
    if (fast || !closing.pair.pair.has_outline()) return fast;
    return depths_.gap_at_end(paths_.whole(), closing.pair.outlines) < closing.deep;
  }
  const bool recedes = !(closing.rate < 0.0);
  const double length = paths_.whole().end().state.time - paths_.path().begin().state.time;
  return !recedes || closing.pair.gap - closing.gap > capture_.capture_speed * length;
}

void StepClosings::look_at_end(StepClosing& closing) {
  const PathSample end = paths_.whole().end();
  SingleConstraint contact;
  detector_->contact(closing.pair.pair, end.state, end.evaluation, end.places, contact);
  closing.gap = contact.gap;
  closing.rate = contact.normal_velocity(end.state.v);
  closing.key = contact.key;
}

}  // namespace carom
