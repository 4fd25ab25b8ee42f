// Problem: all stages of an event see the same state.

#include <carom/contact/detection/rolling_resistance.h>
#include <carom/integrators/event_driven/event_instant.h>

#include <algorithm>
#include <limits>

namespace carom {

EventInstant::EventInstant(SmoothMotion& group, InstantMemory& memory, double at_time, std::span<double> y_in,
                           EventBalance& books)
    : motion(group),
      time(at_time),
      y(y_in),
      now(memory.now),
      contacts(memory.contacts),
      before(memory.before),
      before_at(memory.before_at),
      islands(memory.islands),
      balance(books),
      corners_(memory.corners),
      twins_(memory.twins) {
  twins_.clear();
}

void EventInstant::update() {
  motion.sample(time, y.data(), Forces::without_contact, now);
  contacts.resize(motion.model().pairs.size());
  const GroupModel& model = motion.model();
  // Whatever touches or is captured is nearer.
  const double near = 16.0 * model.options->gap_tolerance;
  corners_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (model.pairs[i].rolling) {
      contacts[i] =
          rolling_resistance(contacts[i - 1], motion_of(*model.detector, model.pairs[i], now.places));
      continue;
    }
    motion.contact_if_near(i, now, near, contacts[i]);
    const Index bound = model.bound_of(i);
    if (bound == none || contacts[i].gap > near || model.bounds[bound].rounding > 0.0) continue;
    if (!motion.regions(model.pairs[i], now).may_touch()) {
      contacts[i].gap = std::numeric_limits<double>::infinity();
    } else {
      corners_.push_back(static_cast<Index>(i));
    }
  }
  for (const Index twin : twins_) contacts[twin].gap = std::numeric_limits<double>::infinity();
}

void EventInstant::leave_out_twins() {
  const auto is_new = [&](Index pair) { return before_at[pair] == none && contacts[pair].gap <= touch_gap; };
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    for (std::size_t j = i + 1; j < corners_.size(); ++j) {
      const Index a = corners_[i], b = corners_[j];
      if (is_new(a) && is_new(b) && are_twins(a, b)) twins_.push_back(approach(a) >= approach(b) ? b : a);
    }
  }
  for (const Index twin : twins_) contacts[twin].gap = std::numeric_limits<double>::infinity();
}

/// True if the vertex of either pair stands at that of the other, before an edge of other direction.
bool EventInstant::are_twins(Index a, Index b) const {
  constexpr double same_direction = 1e-6;  // edges of equal blocks in a stack
  const ContactPair &one = motion.model().pairs[a], &other = motion.model().pairs[b];
  const bool bodies = one.other != none && one.body == other.other && one.other == other.body;
  const bool ground = one.is_of_pieces() && one.body == other.body &&
                      one.ground_shape == other.ground_shape &&
                      (one.ground_vertex == none) != (other.ground_vertex == none);
  if (!bodies && !ground) return false;
  const auto place = [&](const ContactPair& pair) {
    const OutlinePair view =
        outline_pair(*motion.model().detector, pair, now.view(), now.evaluation, now.places);
    return view.vertex_frame.outside(view.vertex);
  };
  const Vec<2> apart = place(one) - place(other);
  if (std::max(std::abs(apart[0]), std::abs(apart[1])) > FeatureMargin::corner_touches) return false;
  const double *const n = contacts[a].row(0), *const m = contacts[b].row(0);
  return std::abs(n[0] * m[1] - n[1] * m[0]) > same_direction;
}

void EventInstant::take_contacts_before() {
  before = motion.active().list();
  before_at.assign(motion.model().pairs.size(), none);
  for (Index i = 0; i < before.size(); ++i) before_at[before[i].place] = i;
}

void EventInstant::find_islands() {
  // Projections during the event move bodies by less than this.
  constexpr double moved = 4.0;
  const double near = moved * std::max(motion.model().options->gap_tolerance, touch_gap);
  const auto is_near = [&](std::size_t pair) {
    return before_at[pair] != none || contacts[pair].gap <= near;
  };
  islands.find(motion.model(), is_near);
}

void EventInstant::take_velocities() {
  for (const auto& part : motion.model().parts()) {
    const Range v = part.ranges.v;
    std::copy(now.state.v.begin() + v.begin, now.state.v.begin() + v.end, y.data() + part.v);
  }
}

}  // namespace carom
