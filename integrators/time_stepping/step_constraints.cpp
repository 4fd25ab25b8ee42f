// Problem: which constraints take part in a step, and which components they join.

#include <carom/contact/detection/rolling_resistance.h>
#include <carom/contact/impact_restitution.h>
#include <carom/core/numerics/fetch_ahead.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/kept_names.h>
#include <carom/integrators/time_stepping/step_constraints.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// True if bodies stand on the ground to rounding where contact lasts.
bool ends_at_rounding(const TimeStepping& options) {
  return options.impacts == ImpactTimes::located || options.project_gaps;
}

/// True if turning can open contacts: of a feature on an arm, on ground that moves or is curved, of two
/// bodies, of outlines, at limits (contact/detection/lasting_contacts.h).
bool turning_opens(const Detector& detector) {
  const GroundShapes& shapes = detector.shapes();
  bool curved = false;
  for (Index shape = 0; shape < shapes.size(); ++shape) {
    curved = curved || shapes.has_pieces(shape) || !shapes.is_flat(shape);
  }
  return curved || detector.needs_rotations() || detector.bodies_touch() || detector.has_moving_ground();
}

/// True if all contacts are those that PointContacts finds, as they are.
bool is_plain(const Detector& detector) {
  return centres_tell(detector) && !detector.has_static_friction() && !resists_rolling(detector);
}

/// True if some surface takes more to slip than to slide.
bool sticks(const Detector& detector) { return detector.law_facts().static_friction; }

/// Friction in joints takes the restitution of what approaches fastest in its island.
void share_restitution(std::span<const StepIsland> islands, const StepInput& in, double capture_speed) {
  for (const StepIsland& island : islands)
    share_impact_restitution(island.constraints, in.start.v.data(), capture_speed);
}

/// Lengths to which features are told apart: corners in one place to a thousand tolerances of the step.
FeatureLengths feature_lengths(const TimeStepping& options) {
  constexpr double most = 1e3;
  return options.tolerance > 0.0 ? FeatureLengths{.corner = most * options.tolerance} : FeatureLengths{};
}

}  // namespace

StepConstraints::StepConstraints(const Assembly& assembly, const TimeStepping& options)
    : detector_(assembly, feature_lengths(options)),
      rules_{options.capture_speed,
             gap_rounding(assembly, options),
             0.0,
             options.project_gaps && options.impacts != ImpactTimes::located,
             options.impacts == ImpactTimes::located,
             options.impacts == ImpactTimes::at_step_start || sticks(detector_),
             ends_at_rounding(options) || turning_opens(detector_) || sticks(detector_),
             is_plain(detector_)},
      islands_(assembly) {
  if (ends_at_rounding(options)) rules_.slack = rules_.rounding;
  // Without the contact that rounding opens a body at rest would fall for a step, and slide away although it
  // stuck.
  if (options.project_gaps || rules_.keeps_slow) rules_.margin = rules_.rounding;
}

void StepConstraints::allow_rounding(double step, bool pressed_open) {
  rules_.margin = rules_.rounding;
  rules_.keeps_slow = rules_.keeps_slow || pressed_open;
  // Where positions are known roughly only, impacts rebound all the same.
  rules_.slowest = std::min(rules_.rounding / step, rules_.capture_speed);
}

void StepConstraints::place_surfaces(const StepInput& in) {
  if (!detector_.has_moving_ground()) return;
  if (ground_.end.time() == in.start.time) std::swap(ground_.start, ground_.end);
  detector_.place(in.start.time, ground_.start);
  detector_.place(in.end_time, ground_.end);
  detector_.shapes().demand_continuous(ground_.start, ground_.end);
  detector_.shapes().list_jumps(in.start.time, in.end_time, ground_.jumps);
}

std::span<const GroundJump> StepConstraints::jumps_within(double begin, double end) const {
  const std::vector<GroundJump>& all = ground_.jumps;
  const auto is_later = [](double time, const GroundJump& jump) { return time < jump.time; };
  const auto first = std::upper_bound(all.begin(), all.end(), begin, is_later);
  return {first, std::upper_bound(first, all.end(), end, is_later)};
}

OpeningSlack StepConstraints::Rules::slack_of(double step) const {
  OpeningSlack openings{slack, slack};
  // Answers are wrong by more than rounding, and ground that is accelerated opens contacts by an error of the
  // step.
  if (keeps_slow) openings.of_pressed = std::max(slack, step * capture_speed);
  if (keeps_pressed) openings.of_pressed = std::numeric_limits<double>::infinity();
  return openings;
}

/// A gap was opened by the step before, which this one may be a small part of.
void StepConstraints::remember(const StepInput& in, double last_step) {
  if (rules_.plain && !rules_.turning) return;  // nobody asks
  if (in.companion.modes.empty() && lasting_.empty() && sticking_.empty()) return;
  if (rules_.turning) {
    const double step = std::max(in.step, last_step);
    detector_.remember(in.companion.modes, step, rules_.slack_of(step), lasting_);
  }
  if (!detector_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : in.companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

ContactQuery StepConstraints::query(const StepInput& in, const StepTrial& trial) const {
  const LastingContacts* const lasting = lasting_.empty() ? nullptr : &lasting_;
  return {in.start.view(), trial.at_start, ground_.start, &ground_.end, rules_.margin, lasting, {},
          in.bodies()};
}

/// Contacts that stuck in the last step have their static friction.
void StepConstraints::take_sticking(std::span<Constraint> found) const {
  if (!detector_.has_static_friction()) return;
  for (Constraint& contact : found) {
    if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
    contact.friction = contact.law.sticking_friction();
  }
}

/// True of a contact that parts and does not act. One that is deeper acts: nothing looks for its closing; one
/// that stays closed to rounding over a step, for it would close in it again and again; and one that pushed
/// in the step before, if it parts slowly: as its answer was to keep it closed, it parts by what that was
/// wrong. One that parts and acts may come back as fast, which does no work: held where it has come to, it
/// would gain what loads take to draw it back. \param of_corners whether it is one of the two of corners that
/// meet
bool StepConstraints::is_freed(const StepInput& in, bool of_corners, Constraint& constraint) const {
  constexpr double noise = 1e-12;  // of the velocities along a normal
  const double* const v = in.start.v.data();
  const double rate = constraint.normal_velocity(v);
  if (!(rate > rules_.slowest)) return false;
  const bool near = !(constraint.gap < -rules_.rounding), parts = rate > noise * constraint.speed(0, v);
  if (near && parts && (rate > rules_.capture_speed || !lasting_.is_pressed(constraint.key, of_corners)))
    return true;
  constraint.allowed_approach = std::max(constraint.allowed_approach, rate);
  return false;
}

/// Takes those that do not act out of a list, from its place `first` on.
void StepConstraints::free_parting(const StepInput& in, std::size_t first, ConstraintSet& out) const {
  const double same_place = detector_.outlines().on_ground().lengths().corner;
  std::size_t kept = first;
  bool meets_next = false;  // two contacts of corners that meet follow one another
  for (std::size_t i = first; i < out.size(); ++i) {
    const bool met = meets_next;
    meets_next = i + 1 < out.size() && are_of_corners(out[i], out[i + 1], same_place);
    if (is_freed(in, met || meets_next, out[i])) continue;
    if (kept < i) out[kept] = std::move(out[i]);
    ++kept;
  }
  out.resize(kept);
}

void StepConstraints::find_in(const StepInput& in, Range components, const StepTrial& trial,
                              ConstraintSet& out) {
  const std::size_t first = out.size();
  const StateView start = in.start.view();
  detector_.find(components, query(in, trial), out);
  if (rules_.parting == Parting::is_free) free_parting(in, first, out);
  // Components with joints come alone.
  if (detector_.joints().has_friction() && components.size() == 1) {
    const auto friction = static_cast<std::ptrdiff_t>(out.size());
    detector_.joints().find_friction(components.begin, start, trial.at_start, out);
    // Impulses over the step, also where it is repeated.
    std::for_each(out.begin() + friction, out.end(),
                  [&](Constraint& at) { at.of_joint.friction_bound *= in.step; });
  }
  if (out.size() == first) return;
  const std::span<Constraint> found = std::span(out).subspan(first);
  take_sticking(found);
  // Friction in joints comes last.
  if (found.back().has_given_bound())
    share_impact_restitution(found, in.start.v.data(), rules_.capture_speed);
  if (resists_rolling(detector_)) add_rolling(first, out);
}

/// Rolling resistance behind each contact that has some, of the constraints from `first` on.
void StepConstraints::add_rolling(std::size_t first, ConstraintSet& out) {
  with_rolling_.assign(std::span(out).first(first));
  for (std::size_t i = first; i < out.size(); ++i) {
    with_rolling_.add(out[i]);
    if (out[i].law.resists_rolling()) {
      Constraint& rolling = with_rolling_.add();
      write_rolling_resistance(out[i], ground_motion_of(detector_, out[i], ground_.start), rolling);
      rolling.drift = {};  // steps take the spins at both ends
      const GroundMotion* const after = ground_motion_of(detector_, out[i], ground_.end);
      if (after == nullptr) continue;
      rolling.surface_velocity_after[0] = rolling.of_joint.length * after->spin;
    }
  }
  std::swap(out, with_rolling_);
}

void StepConstraints::find(const StepInput& in, std::span<const Range> batches, const StepTrial& trial,
                           Parting parting) {
  begin(in, parting);
  rules_.by_part = false;
  if (detector_.bodies_touch() && find_joining(in, batches, trial)) return;
  constraints_.clear();
  // Where nothing touched in the step before there is hardly anything to be found.
  rules_.by_part = rules_.part_size != none && !in.companion.modes.empty();
  for (const Range batch : batches) {
    if (!goes_in_parts(batch)) find_in(in, batch, trial, constraints_);
  }
  islands_.find(batches);
  islands_.take(constraints_);
}

std::span<Constraint> StepConstraints::find_part(const StepInput& in, Range components,
                                                 const StepTrial& trial) {
  single_.clear();
  if (!rules_.plain) {
    find_in(in, components, trial, single_);
    return single_;
  }
  detector_.points().find(components, query(in, trial), single_);
  if (rules_.parting == Parting::is_free) {
    single_.remove_if([&](Constraint& contact) { return is_freed(in, false, contact); });
  }
  return single_;
}

/// With contacts of bodies with each other. Constraints are large, and these are many: they are written once,
/// where they stand among those of their island, and where that of the same contact stood in the step before.
/// False if there are none.
bool StepConstraints::find_joining(const StepInput& in, std::span<const Range> batches,
                                   const StepTrial& trial) {
  const Outlines& outlines = detector_.outlines();
  const ContactQuery at_start = query(in, trial);
  std::span<const Touch> touching = find_body_touches(outlines, at_start, search_);
  if (rules_.parting == Parting::is_free) {
    std::erase_if(search_.touching, [&](const Touch& touch) {
      SingleConstraint written;
      outlines.write(touch, at_start, written);
      return is_freed(in, touch.of_corners, written);
    });
    touching = search_.touching;
  }
  if (touching.empty()) return false;
  single_.clear();
  for (const Range batch : batches) find_in(in, batch, trial, single_);
  merge(in, touching);
  Index last = none;
  const std::span<const Index> order = islands_.find(batches, joined_);
  constraints_.resize(order.size());
  const bool sticks = detector_.has_static_friction();
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Index source = sources_[order[k]];
    Constraint& out = constraints_[k];
    fetch_ahead(std::span(constraints_), k + 4);
    if (source >= touching.size()) {
      out.take(single_[source - touching.size()]);
      continue;
    }
    if (std::exchange(last, source) == source) {
      write_rolling_resistance(constraints_[k - 1], nullptr, out);
      continue;
    }
    if (rules_.drifts) {
      out.start_contact();
      outlines.write(touching[source], at_start, out);
    } else {
      write_rows(outlines, touching[source], search_, in.start.view(), out);
    }
    if (sticks) take_sticking({&out, 1});
    if (rules_.parting == Parting::is_free) static_cast<void>(is_freed(in, touching[source].of_corners, out));
  }
  islands_.take(constraints_);
  if (detector_.joints().has_friction()) share_restitution(islands(), in, rules_.capture_speed);
  return true;
}

/// Lists all constraints in the order of the components of their first bodies. Contacts of bodies with each
/// other come before the others of a component: friction in joints stays last. What has rolling resistance is
/// listed twice.
void StepConstraints::merge(const StepInput& in, std::span<const Touch> touching) {
  const std::vector<BodyOutline>& outlines = detector_.outlines().of_bodies().list();
  const auto count = static_cast<Index>(touching.size());
  const bool one_body_each = in.assembly.components().size() == in.assembly.layout()->bodies().size();
  const auto component_of = [&](Index body) { return one_body_each ? body : in.assembly.component_of(body); };
  const bool resists = detector_.outlines().laws().facts_of_bodies().rolling_resistance;
  joined_.clear();
  sources_.clear();
  Index next = 0;
  const auto add_single_before = [&](Index end) {
    for (; next < single_.size(); ++next) {
      const Index component = component_of(single_[next].body());
      if (component >= end) return;
      joined_.push_back({component, component});
      sources_.push_back(count + next);
    }
  };
  for (Index i = 0; i < count; ++i) {
    const Index first = component_of(outlines[touching[i].a].body);
    add_single_before(first);
    joined_.push_back({first, component_of(outlines[touching[i].b].body)});
    sources_.push_back(i);
    if (!resists || !detector_.outlines().law(touching[i].a, touching[i].b).resists_rolling()) continue;
    joined_.push_back(joined_.back());
    sources_.push_back(i);
  }
  add_single_before(none);
}

}  // namespace carom
