// Problem: which contacts take part in a step, and their impulses against the guess of the loads.

#include <carom/integrators/time_stepper.h>

#include <algorithm>

namespace carom {

void TimeStepper::remember_sticking(const Companion& companion) {
  if (!finder_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

void TimeStepper::find_contacts(Index island, const State& state) {
  contacts_.clear();
  clusters_in_use_ = 0;
  finder_.find(island, state.view(), start_, places_, &places_after_, 0.0, contacts_);
  finder_.find_rubbing(island, state.view(), start_, contacts_);
  if (contacts_.empty()) return;
  if (finder_.has_static_friction()) {
    for (Contact& contact : contacts_) {
      if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
      contact.friction = contact.law.sticking_friction();
    }
  }
  const Range v = assembly_->islands()[island].v;
  response_.resize(trial_.v.size());
  free_.resize(trial_.v.size());
  std::fill(response_.begin() + v.begin, response_.begin() + v.end, 0.0);
  if (options_.iteration == Iteration::linearly_implicit || jointed(island)) {
    add_cluster(state, 0, contacts_.size());  // bodies answer together
    return;
  }
  // Obstacles go their own way, so contacts share a problem where they share a body; they come ordered by
  // body.
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    while (last < contacts_.size() && contacts_[last].body == contacts_[first].body) ++last;
    add_cluster(state, first, last);
    first = last;
  }
}

void TimeStepper::add_cluster(const State& state, std::size_t first, std::size_t last) {
  if (clusters_in_use_ == clusters_.size()) clusters_.emplace_back();
  clusters_[clusters_in_use_++].build(*assembly_, {contacts_.data() + first, last - first}, state.v.data());
}

void TimeStepper::solve_contacts(Index island, const State& state, const Companion& companion, double step) {
  const double half = 0.5 * step;
  const double* const load0 = start_of_sum(companion);
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    ContactCluster& cluster = clusters_[i];
    const BodySlot& body = assembly_->layout()->bodies()[cluster.contacts().front().body];
    for (Index k = body.v; k < body.v + body.v_size; ++k) {
      response_[k] = half * (load0[k] + evaluation_.force[k]);
    }
    assembly_->body_kinds()[body.kind]->apply_inverse_mass({body.slot, body.slot + 1},
                                                           response_.data() + body.v, free_.data() + body.v);
    for (Index k = body.v; k < body.v + body.v_size; ++k) {
      free_[k] += static_cast<double>(companion.rounding[k]) + state.v[k];
      response_[k] = 0.0;
    }
    cluster.set_free_velocity(free_.data());
    if (!cluster.solve(chain_).usable()) fail_contact(island, cluster, state, step);
    cluster.apply(response_.data());
  }
}

}  // namespace carom
