// Problem: many appointments, most of which become void before their time.

#include <carom/integrators/event_driven/meeting_queue.h>

#include <algorithm>
#include <tuple>

namespace carom {

namespace {

bool is_later(const Appointment& x, const Appointment& y) {
  const auto order = [](const Appointment& at) { return std::tuple(at.time, at.b == none, at.a, at.b); };
  return order(x) > order(y);
}

}  // namespace

void MeetingQueue::start(Index count) {
  motion_.assign(count, 0);
  heap_.clear();
}

void MeetingQueue::add(double time, Index a, Index b, const Guess& guess) {
  heap_.push_back({time, a, b, motion_[a], b == none ? 0 : motion_[b], guess});
  std::push_heap(heap_.begin(), heap_.end(), is_later);
}

bool MeetingQueue::take(double until, Appointment& out) {
  while (!heap_.empty() && heap_.front().time <= until) {
    std::pop_heap(heap_.begin(), heap_.end(), is_later);
    out = heap_.back();
    heap_.pop_back();
    if (out.of_a == motion_[out.a] && (out.b == none || out.of_b == motion_[out.b])) return true;
  }
  return false;
}

}  // namespace carom
