#include <carom/contact/contact_cluster.h>
#include <carom/contact/solvers/contact_mode.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace carom {

namespace {

// The modes are known and, if they are right, linear: one step solves them, another takes the rounding.
constexpr int newton_steps = 2;

// Whether a problem has the form of one planar contact, so that only its numbers need to be filled in.
bool is_one_planar_contact(const ContactProblem& problem) {
  return problem.rows() == 2 && problem.groups().size() == 1 &&
         problem.sets()[0].kind == SetKind::half_line && problem.sets()[1].kind == SetKind::bounded_interval;
}

}  // namespace

void ContactCluster::build(const Assembly& assembly, std::span<const Constraint> contacts,
                           const double* velocity_before) {
  constexpr auto stride = static_cast<std::size_t>(Constraint::max_columns);
  contacts_ = contacts;
  solved_ = changed_modes_ = false;
  if (contacts.size() == 1 && contacts[0].rows == 2 &&
      is_one_planar_contact(problem_)) {
    // The same form as before, which is the hot path.
    const Constraint& contact = contacts[0];
    const BodySlot body = assembly.layout()->bodies()[contact.body()];
    const BodyKind& kind = *assembly.body_kinds()[body.kind];
    for (int i = 0; i < 2; ++i) {
      kind.apply_inverse_mass({body.slot, body.slot + 1}, contact.row(i),
                              response_.data() + static_cast<std::size_t>(i) * stride);
    }
    const auto product = [&](int row, int column) {
      const double* const response = response_.data() + static_cast<std::size_t>(column) * stride;
      double sum = 0.0;
      for (int k = 0; k < contact.columns(); ++k) sum += contact.row(row)[k] * response[k];
      return sum;
    };
    problem_.w(0, 0) = product(0, 0);
    problem_.w(0, 1) = problem_.w(1, 0) = product(1, 0);
    problem_.w(1, 1) = product(1, 1);
    problem_.sets()[1].coefficient = contact.friction;
    before_[0] = contact.velocity(0, velocity_before);
    before_[1] = contact.velocity(1, velocity_before);
    restitution_[0] = contact.law.normal_restitution;
    restitution_[1] = contact.law.tangential_restitution;
    impulse_[0] = impulse_[1] = 0.0;
    return;
  }
  first_row_.clear();
  int rows = 0;
  for (const Constraint& contact : contacts) {
    first_row_.push_back(rows);
    rows += contact.rows;
  }
  const auto count = static_cast<std::size_t>(rows);
  problem_.reset(rows);
  before_.resize(count);
  restitution_.resize(count);
  impulse_.assign(count, 0.0);
  response_.resize(count * stride);
  slides_.assign(contacts.size(), 0.0);

  const auto& bodies = assembly.layout()->bodies();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Constraint& contact = contacts[c];
    const BodySlot& body = bodies[contact.body()];
    const BodyKind& kind = *assembly.body_kinds()[body.kind];
    for (int i = 0; i < contact.rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      kind.apply_inverse_mass({body.slot, body.slot + 1}, contact.row(i), response_.data() + row * stride);
      before_[row] = contact.velocity(i, velocity_before);
      restitution_[row] = contact.restitution(i);
      RowSet& set = problem_.sets()[row];
      if (contact.has_dry_friction()) {
        press(c);
      } else if (i == 0) {
        set.kind = SetKind::half_line;
      } else {
        set.kind = contact.rows == 2 ? SetKind::bounded_interval : SetKind::bounded_disc;
        set.bound = first_row_[c];
        set.coefficient = contact.friction;
      }
    }
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    for (std::size_t d = 0; d <= c; ++d) {
      if (contacts[c].body() != contacts[d].body()) continue;
      for (int i = 0; i < contacts[c].rows; ++i) {
        const int row = first_row_[c] + i;
        const int last = c == d ? i + 1 : contacts[d].rows;
        for (int j = 0; j < last; ++j) {
          const int column = first_row_[d] + j;
          const double* const response = response_.data() + static_cast<std::size_t>(column) * stride;
          double sum = 0.0;
          for (int k = 0; k < contacts[c].columns(); ++k) sum += contacts[c].row(i)[k] * response[k];
          problem_.w(row, column) = problem_.w(column, row) = sum;
        }
      }
    }
  }
  problem_.group();
}

void ContactCluster::couple(Range v, const std::function<void(double*)>& solve) {
  coupled_range_ = v;
  const auto rows = static_cast<std::size_t>(problem_.rows());
  coupled_.assign(rows * v.size(), 0.0);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      double* const response = coupled_.data() + static_cast<std::size_t>(first_row_[c] + i) * v.size();
      // Contacts count velocities from the first of all.
      contacts_[c].add_transposed(i, 1.0, response - v.begin);
      solve(response);
    }
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const int row = first_row_[c] + i;
      for (int column = 0; column <= row; ++column) {
        const double* const response = coupled_.data() + static_cast<std::size_t>(column) * v.size();
        problem_.w(row, column) = problem_.w(column, row) = contacts_[c].times(i, response - v.begin);
      }
    }
  }
  problem_.group();
}

void ContactCluster::couple(JointConstraints& joints) {
  // Joints count velocities from the first of all. Little is captured, so that nothing is allocated.
  couple(joints.velocities(),
         [&joints](double* x) { joints.constrained_response(x - joints.velocities().begin); });
  // A row that the joints hold fast (of a corner at a pin to the ground) is left without any response, in
  // place of one by rounding, against which impulses would be as large as its inverse: nothing acts along it.
  constexpr double held = 1e-12;  // of the response without joints: rounding
  constexpr auto stride = static_cast<std::size_t>(Constraint::max_columns);
  const auto largest = [](const double* numbers, std::size_t count) {
    double size = 0.0;
    for (std::size_t k = 0; k < count; ++k) size = std::max(size, std::abs(numbers[k]));
    return size;
  };
  const int rows = problem_.rows();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto columns = static_cast<std::size_t>(contacts_[c].columns());
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const int row = first_row_[c] + i;
      const auto at = static_cast<std::size_t>(row);
      double* const coupled = coupled_.data() + at * coupled_range_.size();
      const double alone = largest(response_.data() + at * stride, columns);
      if (largest(coupled, coupled_range_.size()) > held * alone) continue;
      for (int other = 0; other < rows; ++other) problem_.w(row, other) = problem_.w(other, row) = 0.0;
      std::fill_n(coupled, coupled_range_.size(), 0.0);
    }
  }
}

void ContactCluster::couple_again(const std::function<void(const double* x, double* p)>& mass,
                                  const std::function<void(double*)>& solve) {
  const std::size_t size = coupled_range_.size(), rows = impulse_.size();
  loads_.resize(coupled_.size());
  for (std::size_t row = 0; row < rows; ++row) {
    double* const response = coupled_.data() + row * size;
    mass(response, loads_.data() + row * size);
    std::copy_n(loads_.data() + row * size, size, response);
    solve(response);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double* const load = loads_.data() + row * size;
    for (std::size_t column = 0; column <= row; ++column) {
      const double w = std::inner_product(load, load + size, coupled_.data() + column * size, 0.0);
      problem_.w(static_cast<int>(row), static_cast<int>(column)) = w;
      problem_.w(static_cast<int>(column), static_cast<int>(row)) = w;
    }
  }
  problem_.group();
}

void ContactCluster::apply_coupled(double* velocity, double scale) const {
  for (std::size_t row = 0; row < impulse_.size(); ++row) {
    const double* const response = coupled_.data() + row * coupled_range_.size();
    for (Index i = 0; i < coupled_range_.size(); ++i) {
      velocity[coupled_range_.begin + i] += scale * response[i] * impulse_[row];
    }
  }
}

void ContactCluster::add_loads(double scale, double* load) const {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      contacts_[c].add_transposed(i, scale * impulse_[static_cast<std::size_t>(first_row_[c] + i)], load);
    }
  }
}

void ContactCluster::press(std::size_t contact) {
  const Constraint& at = contacts_[contact];
  RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[contact])];
  const double slides = slides_[contact] * at.friction_bound, bound = at.friction * at.friction_bound;
  set.kind = SetKind::interval;
  set.lower = slides_[contact] != 0.0 ? slides : -bound;
  set.upper = slides_[contact] != 0.0 ? slides : bound;
}

void ContactCluster::slide(std::size_t contact, double ratio) {
  if (contacts_[contact].has_dry_friction()) {
    slides_[contact] = ratio;
    press(contact);
    problem_.group();
    return;
  }
  RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[contact] + 1)];
  set.kind = SetKind::proportional;
  set.coefficient = ratio;
  problem_.group();
}

void ContactCluster::set_free_velocity(const double* velocity_free) {
  const auto b = problem_.vector();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      b[row] = contacts_[c].velocity_after(i, velocity_free) + restitution_[row] * before_[row];
    }
    if (contacts_[c].allowed_approach > 0.0) {
      b[static_cast<std::size_t>(first_row_[c])] += contacts_[c].allowed_approach;
    }
    for (int i = 0; i < contacts_[c].rows; ++i) {
      // Of what joints hold fast, against what moves around it, or has moved before [m/s].
      constexpr double rounding = 1e-9, least = 1e-10;
      const int row = first_row_[c] + i;
      double& number = b[static_cast<std::size_t>(row)];
      if (problem_.w(row, row) != 0.0) continue;
      if (std::abs(number) <= rounding * contacts_[c].speed(i, velocity_free) + least) number = 0.0;
    }
  }
}

void ContactCluster::set_velocity(const double* velocity) {
  set_free_velocity(velocity);
  for (int row = 0; row < problem_.rows(); ++row) {
    for (int column = 0; column < problem_.rows(); ++column) {
      problem_.vector()[static_cast<std::size_t>(row)] -=
          problem_.w(row, column) * impulse_[static_cast<std::size_t>(column)];
    }
  }
}

const ContactReport& ContactCluster::solve(SolverChain& chain) {
  changed_modes_ = false;
  const bool again = solved_ && report_.usable();
  solved_ = true;
  // One contact is solved faster than looked at, and asked for its modes where they change only.
  const bool several = problem_.groups().size() > 1;
  if (again && several && keep_modes()) return report_;
  if (again) {
    kept_impulse_.assign(impulse_.begin(), impulse_.end());
    kept_modes_.assign(modes_.begin(), modes_.end());
  }
  report_ = chain.solve(problem_, impulse_);
  modes_.assign(chain.modes().begin(), chain.modes().end());
  changed_modes_ = again && modes_ != kept_modes_;
  if (!changed_modes_ || several) return report_;
  xi_ = impulse_;
  impulse_ = kept_impulse_;
  modes_.swap(kept_modes_);
  if (keep_modes()) {
    if (report_.usable()) report_.outcome = Outcome::several_solutions;
    changed_modes_ = false;
  } else {
    impulse_ = xi_;
    modes_.swap(kept_modes_);
  }
  return report_;
}

/// Solves with the modes of the answer before; false if they are not those of a solution.
bool ContactCluster::keep_modes() {
  kept_impulse_.assign(impulse_.begin(), impulse_.end());
  const Residual found = polish_.improve(problem_, kept_impulse_, newton_steps);
  if (!(found.value <= accepted_residual)) return false;
  kept_xi_.resize(kept_impulse_.size());
  problem_.velocities(kept_impulse_, kept_xi_);
  for (std::size_t group = 0; group < modes_.size(); ++group) {
    const ContactMode mode = contact_mode(problem_, problem_.groups()[group], kept_impulse_, kept_xi_);
    if (mode != modes_[group]) return false;
  }
  impulse_.swap(kept_impulse_);
  report_.residual = found.value;
  report_.worst_group = found.group;
  return true;
}

void ContactCluster::set_impulses(std::span<const double> impulses) {
  std::copy(impulses.begin(), impulses.end(), impulse_.begin());
  xi_.resize(impulse_.size());
  problem_.velocities(impulse_, xi_);
  for (std::size_t group = 0; group < modes_.size(); ++group)
    modes_[group] = contact_mode(problem_, problem_.groups()[group], impulse_, xi_);
}

double ContactCluster::obstacle_work(std::size_t contact) const {
  const Constraint& at = contacts_[contact];
  double work = 0.0;
  for (int i = 0; i < at.rows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    work += 0.5 * impulse_[static_cast<std::size_t>(first_row_[contact] + i)] *
            (at.surface_velocity[row] + at.surface_velocity_after[row]);
  }
  return work;
}

void ContactCluster::apply(double* velocity) const {
  constexpr auto stride = static_cast<std::size_t>(Constraint::max_columns);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      for (int k = 0; k < contacts_[c].columns(); ++k) {
        velocity[contacts_[c].blocks[0].v + static_cast<Index>(k)] +=
            response_[row * stride + static_cast<std::size_t>(k)] * impulse_[row];
      }
    }
  }
}

}  // namespace carom
