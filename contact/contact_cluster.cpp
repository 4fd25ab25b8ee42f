#include <carom/contact/contact_cluster.h>

#include <algorithm>

namespace carom {

void ContactCluster::build(const Assembly& assembly, std::span<const Contact> contacts,
                           const double* velocity_before) {
  constexpr auto stride = static_cast<std::size_t>(Contact::max_columns);
  contacts_ = contacts;
  first_row_.clear();
  int rows = 0;
  for (const Contact& contact : contacts) {
    first_row_.push_back(rows);
    rows += contact.rows;
  }
  const auto count = static_cast<std::size_t>(rows);
  problem_.reset(rows);
  before_.resize(count);
  restitution_.resize(count);
  impulse_.assign(count, 0.0);
  response_.resize(count * stride);

  const auto& bodies = assembly.layout()->bodies();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    const BodySlot& body = bodies[contact.body];
    const BodyKind& kind = *assembly.body_kinds()[body.kind];
    for (int i = 0; i < contact.rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      kind.apply_inverse_mass({body.slot, body.slot + 1}, contact.row(i), response_.data() + row * stride);
      before_[row] = contact.velocity(i, velocity_before);
      restitution_[row] = i == 0 ? contact.law.normal_restitution : contact.law.tangential_restitution;
      RowSet& set = problem_.sets()[row];
      if (i == 0) {
        set.kind = SetKind::half_line;
      } else {
        set.kind = contact.rows == 2 ? SetKind::bounded_interval : SetKind::bounded_disc;
        set.bound = first_row_[c];
        set.coefficient = contact.law.friction;
      }
    }
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    for (std::size_t d = 0; d <= c; ++d) {
      if (contacts[c].body != contacts[d].body) continue;
      for (int i = 0; i < contacts[c].rows; ++i) {
        const int row = first_row_[c] + i;
        const int last = c == d ? i + 1 : contacts[d].rows;
        for (int j = 0; j < last; ++j) {
          const int column = first_row_[d] + j;
          const double* const response = response_.data() + static_cast<std::size_t>(column) * stride;
          double sum = 0.0;
          for (int k = 0; k < contacts[c].columns; ++k) sum += contacts[c].row(i)[k] * response[k];
          problem_.w(row, column) = problem_.w(column, row) = sum;
        }
      }
    }
  }
  problem_.group();
}

void ContactCluster::set_free_velocity(const double* velocity_free) {
  const auto b = problem_.vector();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      b[row] = contacts_[c].velocity(i, velocity_free) + restitution_[row] * before_[row];
    }
  }
}

const ContactReport& ContactCluster::solve(SolverChain& chain) {
  report_ = chain.solve(problem_, impulse_);
  modes_.assign(chain.modes().begin(), chain.modes().end());
  return report_;
}

void ContactCluster::apply(double* velocity) const {
  constexpr auto stride = static_cast<std::size_t>(Contact::max_columns);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    for (int i = 0; i < contacts_[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(first_row_[c] + i);
      for (int k = 0; k < contacts_[c].columns; ++k) {
        velocity[contacts_[c].v + static_cast<Index>(k)] +=
            response_[row * stride + static_cast<std::size_t>(k)] * impulse_[row];
      }
    }
  }
}

}  // namespace carom
