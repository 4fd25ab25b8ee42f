// Problem: forces and corrections of contacts that are constraints.

#include <carom/contact/active_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace carom {

namespace {

// A pivot below this part of the largest one is rounding: the constraint follows from the others.
constexpr double dependent = 1e-11;

// Margin where nothing can come to an end: friction in joints that slips [N].
constexpr double unbounded_margin = 1.0;

}  // namespace

void ActiveSet::bind(const Assembly& assembly, JointConstraints& joints) {
  assembly_ = &assembly;
  joints_ = joints.empty() ? nullptr : &joints;
}

double ActiveContact::friction_at(const Constraint& where, const double* velocities) const {
  if (frictionless) return 0.0;
  return sticks() ? where.law.sticking_friction()
                  : where.law.sliding_friction(slip_sign() * where.tangential_velocity(velocities));
}

void ActiveSet::update_and_factor(const Detector& detector, const StateView& state,
                                  const Evaluation& evaluation, const ObstaclePlaces& places) {
  for (ActiveContact& contact : contacts_) {
    detector.contact(contact.pair, state, evaluation, places, contact.at);
    contact.friction = contact.friction_at(contact.at, state.v);
  }
}

template <class F>
void ActiveSet::for_groups(F&& f) {
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    while (last < contacts_.size() && group(contacts_[last]) == group(contacts_[first])) ++last;
    f(first, last);
    first = last;
  }
}

/// Rows of one group, what impulses along their columns do to it, and the products of the two.
void ActiveSet::lay_out(const Assembly& assembly, std::size_t first, std::size_t last, bool rubbing) {
  const BodySlot body = assembly.layout()->bodies()[contacts_[first].at.body()];
  const BodyKind& kind = *assembly.body_kinds()[body.kind];
  const bool bound = joints_ != nullptr && assembly.is_jointed(contacts_[first].at.body());
  span_ = bound ? joints_->velocities() : Range{body.v, body.v + body.v_size};
  rows_.clear();
  for (std::size_t i = first; i < last; ++i) {
    if (!contacts_[i].at.has_dry_friction()) rows_.push_back({i, false});
    if (contacts_[i].sticks()) rows_.push_back({i, true});
  }
  const std::size_t count = rows_.size(), stride = span_.size();
  response_.resize(count * stride);
  matrix_.resize(count * count);
  if (bound) full_.resize(assembly.layout()->v_size());
  for (std::size_t j = 0; j < count; ++j) {
    const ActiveContact& contact = contacts_[rows_[j].contact];
    const int row = rows_[j].tangent ? contact.at.tangent_row() : 0;
    const double ratio = rows_[j].tangent || !rubbing ? 0.0 : -contact.slip_sign() * contact.friction;
    double* const response = response_.data() + j * stride;
    if (bound) {
      std::fill(full_.begin() + span_.begin, full_.begin() + span_.end, 0.0);
      contact.at.add_transposed(row, 1.0, full_.data());
      if (ratio != 0.0) contact.at.add_transposed(1, ratio, full_.data());
      joints_->constrained_response(full_.data());
      std::copy(full_.begin() + span_.begin, full_.begin() + span_.end, response);
      continue;
    }
    std::array<double, static_cast<std::size_t>(Constraint::max_columns)> column{};
    for (int k = 0; k < contact.at.columns(); ++k) {
      column[static_cast<std::size_t>(k)] = contact.at.row(row)[k];
      if (ratio != 0.0) column[static_cast<std::size_t>(k)] += ratio * contact.at.row(1)[k];
    }
    kind.apply_inverse_mass({body.slot, body.slot + 1}, column.data(), response);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Constraint& at = contacts_[rows_[i].contact].at;
    for (std::size_t j = 0; j < count; ++j) {
      // Contacts count velocities from the first of all.
      matrix_[i * count + j] =
          at.times(rows_[i].tangent ? at.tangent_row() : 0, response_.data() + j * stride - span_.begin);
    }
  }
}

/// Friction in joints is known where it slips: a load. \param acceleration to add to
void ActiveSet::dry_friction(std::size_t first, std::size_t last, double* acceleration) {
  for (std::size_t i = first; i < last; ++i) {
    ActiveContact& contact = contacts_[i];
    if (!contact.at.has_dry_friction()) continue;
    contact.normal = contact.at.friction_bound;
    if (contact.sticks()) continue;
    contact.tangential = -contact.slip_sign() * contact.friction * contact.normal;
    std::fill(full_.begin() + span_.begin, full_.begin() + span_.end, 0.0);
    contact.at.add_transposed(0, contact.tangential, full_.data());
    joints_->constrained_response(full_.data());
    for (Index k = span_.begin; k < span_.end; ++k) acceleration[k] += full_[k];
  }
}

/// Gauss's elimination with full pivoting: a basic solution where rows depend on each other.
bool ActiveSet::solve() {
  const std::size_t n = rows_.size();
  row_order_.resize(n);
  column_order_.resize(n);
  std::iota(row_order_.begin(), row_order_.end(), std::size_t{0});
  std::iota(column_order_.begin(), column_order_.end(), std::size_t{0});
  const auto entry = [&](std::size_t i, std::size_t j) -> double& {
    return matrix_[row_order_[i] * n + column_order_[j]];
  };
  double largest = 0.0;
  rank_ = n;
  for (std::size_t step = 0; step < n; ++step) {
    std::size_t at_row = step, at_column = step;
    double best = -1.0;
    for (std::size_t i = step; i < n; ++i) {
      for (std::size_t j = step; j < n; ++j) {
        if (std::abs(entry(i, j)) > best) {
          best = std::abs(entry(i, j));
          at_row = i;
          at_column = j;
        }
      }
    }
    if (step == 0) largest = best;
    if (!(best > dependent * largest)) {
      rank_ = step;
      break;
    }
    std::swap(row_order_[step], row_order_[at_row]);
    std::swap(column_order_[step], column_order_[at_column]);
    for (std::size_t i = step + 1; i < n; ++i) {
      const double factor = entry(i, step) / entry(step, step);
      if (factor == 0.0) continue;
      for (std::size_t j = step + 1; j < n; ++j) entry(i, j) -= factor * entry(step, j);
      unknown_[row_order_[i]] -= factor * unknown_[row_order_[step]];
    }
  }
  work_.assign(n, 0.0);
  for (std::size_t i = rank_; i-- > 0;) {
    double sum = unknown_[row_order_[i]];
    for (std::size_t j = i + 1; j < rank_; ++j) sum -= entry(i, j) * work_[column_order_[j]];
    work_[column_order_[i]] = sum / entry(i, i);
  }
  unknown_.swap(work_);
  return std::all_of(unknown_.begin(), unknown_.end(), [](double number) { return std::isfinite(number); });
}

bool ActiveSet::add_reactions(const Assembly& assembly, double* acceleration) {
  bool solved = true;
  spreads_.clear();
  null_.clear();
  pivots_.clear();
  for_groups([&](std::size_t first, std::size_t last) {
    lay_out(assembly, first, last, true);
    dry_friction(first, last, acceleration);
    const std::size_t n = rows_.size();
    unknown_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Constraint& at = contacts_[rows_[i].contact].at;
      unknown_[i] = -at.acceleration(rows_[i].tangent ? at.tangent_row() : 0, acceleration);
    }
    solved = solve() && solved;
    if (least_ && rank_ < n) take_least(first, last);
    for (std::size_t k = 0; k < rank_; ++k) {
      pivots_.push_back({rows_[row_order_[k]], rows_[column_order_[k]]});
    }
    for (std::size_t i = 0; i < n; ++i) {
      ActiveContact& contact = contacts_[rows_[i].contact];
      if (rows_[i].tangent) {
        contact.tangential = unknown_[i];
      } else {
        contact.normal = unknown_[i];
        if (!contact.sticks()) contact.tangential = -contact.slip_sign() * contact.friction * contact.normal;
      }
      const double* const response = response_.data() + i * span_.size();
      for (Index k = 0; k < span_.size(); ++k) {
        acceleration[span_.begin + k] += response[k] * unknown_[i];
      }
    }
    if (rank_ < n) spread(first, last);
  });
  return solved;
}

/// Keeps the vectors along which forces may change without anybody noticing.
void ActiveSet::spread(std::size_t first, std::size_t last) {
  const std::size_t n = rows_.size();
  for (std::size_t free = rank_; free < n; ++free) {
    find_null_vector(free);
    spreads_.push_back({first, last, null_.size()});
    null_.resize(null_.size() + 2 * (last - first), 0.0);
    double* const vector = null_.data() + spreads_.back().vector;
    for (std::size_t i = 0; i < n; ++i) {
      const ActiveContact& contact = contacts_[rows_[i].contact];
      double* const of_contact = vector + 2 * (rows_[i].contact - first);
      if (rows_[i].tangent) {
        of_contact[1] = work_[i];
      } else {
        of_contact[0] = work_[i];
        if (!contact.sticks()) of_contact[1] = -contact.slip_sign() * contact.friction * work_[i];
      }
    }
  }
}

void ActiveSet::margins(std::vector<ForceMargin>& out) {
  for (ActiveContact& contact : contacts_) contact.sets_margin = true;
  std::vector<Line>& lines = lines_;
  const auto collect = [&](std::size_t first, std::size_t last, const double* vector) {
    lines.clear();
    for (std::size_t i = first; i < last; ++i) {
      const ActiveContact& c = contacts_[i];
      const double dn = vector ? vector[2 * (i - first)] : 0.0;
      const double dt = vector ? vector[2 * (i - first) + 1] : 0.0;
      if (!c.at.has_dry_friction()) lines.push_back({c.normal, dn});
      if (!c.sticks()) continue;
      lines.push_back({c.friction * c.normal - c.tangential, c.friction * dn - dt});
      lines.push_back({c.friction * c.normal + c.tangential, c.friction * dn + dt});
    }
  };
  // Wedged contacts have no largest margin: one as large as the forces is enough.
  const auto bound = [&](std::size_t first, std::size_t last) {
    const auto rises = [](const Line& line) { return line.slope > 0.0; };
    const auto falls = [](const Line& line) { return line.slope < 0.0; };
    if (std::any_of(lines.begin(), lines.end(), rises) && std::any_of(lines.begin(), lines.end(), falls))
      return;
    double size = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      size += std::abs(contacts_[i].normal) + std::abs(contacts_[i].tangential);
    }
    lines.push_back({size, 0.0});
  };
  const auto least = [&](double shift) {
    double value = std::numeric_limits<double>::infinity();
    for (const Line& line : lines) value = std::min(value, line.at + shift * line.slope);
    return value;
  };
  for (std::size_t at = 0; at < spreads_.size();) {
    std::size_t next = at + 1;
    while (next < spreads_.size() && spreads_[next].first == spreads_[at].first) ++next;
    const bool shared = next > at + 1 && distribute_forces(at, next);
    // A single vector leads to the largest margin; one after the other several lead to a good one.
    for (; at < next; ++at) {
      if (shared) continue;
      const Spread& spread = spreads_[at];
      const double* const vector = null_.data() + spread.vector;
      collect(spread.first, spread.last, vector);
      bound(spread.first, spread.last);
      double best_shift = 0.0, best = least(0.0);
      for (const Line& a : lines) {
        for (const Line& b : lines) {
          if (!(a.slope >= 0.0 && b.slope <= 0.0 && a.slope > b.slope)) continue;
          const double shift = (b.at - a.at) / (a.slope - b.slope);
          const double value = least(shift);
          if (value > best) {
            best = value;
            best_shift = shift;
          }
        }
      }
      for (std::size_t i = spread.first; i < spread.last; ++i) {
        contacts_[i].normal += best_shift * vector[2 * (i - spread.first)];
        contacts_[i].tangential += best_shift * vector[2 * (i - spread.first) + 1];
      }
    }
  }
  out.clear();
  for_groups([&](std::size_t first, std::size_t last) {
    collect(first, last, nullptr);
    out.push_back({first, last, lines.empty() ? unbounded_margin : least(0.0)});
  });
}

bool ActiveSet::corrections(const Assembly& assembly, const double* velocity, double* of_position,
                            double* of_velocity) {
  bool any = false;
  for_groups([&](std::size_t first, std::size_t last) {
    for (const bool position : {true, false}) {
      lay_out(assembly, first, last, false);
      double* const out = position ? of_position : of_velocity;
      unknown_.resize(rows_.size());
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Constraint& at = contacts_[rows_[i].contact].at;
        const int row = rows_[i].tangent ? at.tangent_row() : 0;
        // Sticking contacts have no place of their own: the tangent is kept on velocity level.
        unknown_[i] = position ? (rows_[i].tangent ? 0.0 : -at.gap) : -at.velocity(row, velocity);
        if (!(position && rows_[i].tangent)) unknown_[i] -= at.times(row, out);
        any = any || unknown_[i] != 0.0;
      }
      if (!solve()) continue;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double* const response = response_.data() + i * span_.size();
        for (Index k = 0; k < span_.size(); ++k) out[span_.begin + k] += response[k] * unknown_[i];
      }
    }
  });
  return any;
}

}  // namespace carom
