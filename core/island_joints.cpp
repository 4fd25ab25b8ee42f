#include <carom/core/island_joints.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

/// Calls f(kind, joint, first row) for the joints of an island.
template <class F>
void for_joints(const Assembly& assembly, Index island, F&& f) {
  Index row = 0;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(island, kind);
    for (Index joint = range.begin; joint < range.end; ++joint, row += joints.rows()) f(kind, joint, row);
  }
}

}  // namespace

IslandJoints::IslandJoints(const Assembly& assembly, Index island)
    : assembly_(&assembly), island_(island), v_(assembly.islands()[island].v) {
  for_joints(assembly, island, [&](Index kind, Index joint, Index row) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    first_row_.push_back(row);
    rows_.resize(row + joints.rows());
    joints_.resize(rows_.size(), assembly.joint_id(kind, joint));
    joints.pattern(joint, rows_.data() + row);
    depends_on_time_ = depends_on_time_ || joints.depends_on_time();
  });
  if (rows_.empty()) return;
  first_row_.push_back(static_cast<Index>(rows_.size()));
  right_.resize(rows_.size());
  // Masses of planar bodies, and of particles, are diagonal in the velocities.
  std::vector<double> ones(assembly.layout()->v_size(), 0.0), inverse(ones.size(), 0.0);
  std::fill(ones.begin() + v_.begin, ones.begin() + v_.end, 1.0);
  assembly.for_bodies(island, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    kind.apply_inverse_mass(slots, ones.data() + v, inverse.data() + v);
  });
  inverse_mass_.assign(inverse.begin() + v_.begin, inverse.begin() + v_.end);

  // Rows that share a body share an entry.
  struct Use {
    Index v, row;
    std::uint8_t block;
  };
  std::vector<Use> uses;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    for (int b = 0; b < rows_[row].bodies; ++b) {
      uses.push_back({rows_[row].blocks[static_cast<std::size_t>(b)].v, static_cast<Index>(row),
                      static_cast<std::uint8_t>(b)});
    }
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.v < b.v; });
  struct Shared {
    Index row, other;
    std::uint8_t block, against;
  };
  std::vector<Shared> shared;
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first;
    while (last < uses.size() && uses[last].v == uses[first].v) ++last;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = first; j <= i; ++j) {
        const bool swap = uses[i].row < uses[j].row;
        const Use& a = swap ? uses[j] : uses[i];
        const Use& b = swap ? uses[i] : uses[j];
        shared.push_back({a.row, b.row, a.block, b.block});
      }
    }
    first = last;
  }
  std::stable_sort(shared.begin(), shared.end(), [](const Shared& a, const Shared& b) {
    return a.row < b.row || (a.row == b.row && a.other < b.other);
  });
  std::vector<std::pair<Index, Index>> entries;
  std::vector<Index> entry_of;
  for (const Shared& pair : shared) {
    if (entries.empty() || entries.back() != std::pair(pair.row, pair.other)) {
      entries.emplace_back(pair.row, pair.other);
    }
    entry_of.push_back(static_cast<Index>(entries.size() - 1));
  }
  factors_.analyse(static_cast<Index>(rows_.size()), entries);
  products_.reserve(shared.size());
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const Shared& pair = shared[i];
    products_.push_back({pair.row, pair.other, pair.block, pair.against, factors_.place(entry_of[i])});
  }
}

void IslandJoints::hold_still(Range velocities) {
  for (Index i = velocities.begin; i < velocities.end; ++i) inverse_mass_[i - v_.begin] = 0.0;
}

void IslandJoints::evaluate(const JointView& at, std::vector<JointRow>& out) const {
  out.resize(rows_.size());
  for_joints(*assembly_, island_, [&](Index kind, Index joint, Index row) {
    assembly_->joint_kinds()[kind]->evaluate(at, joint, out.data() + row);
  });
}

void IslandJoints::locate(const JointView& at) {
  if (rows_.empty()) return;
  evaluate(at, rows_);
  std::vector<double>& values = factors_.values();
  std::fill(values.begin(), values.end(), 0.0);
  for (const Product& product : products_) {
    const JointRow::Block& a = rows_[product.row].blocks[product.block];
    const JointRow::Block& b = rows_[product.other].blocks[product.against];
    const double* const inverse = inverse_mass_.data() + (a.v - v_.begin);
    double sum = 0.0;
    for (int c = 0; c < a.columns; ++c) {
      const auto i = static_cast<std::size_t>(c);
      sum += a.jacobian[i] * inverse[i] * b.jacobian[i];
    }
    values[product.entry] += sum;
  }
  factors_.factor();
}

void IslandJoints::solve(double* r) {
  for (std::size_t i = 0; i < rows_.size(); ++i) r[i] = -r[i];
  factors_.solve(r);
}

void IslandJoints::add_response(const double* multipliers, double* x) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const JointRow& row = rows_[i];
    const double multiplier = multipliers[i];
    for (int b = 0; b < row.bodies; ++b) {
      const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
      const double* const inverse = inverse_mass_.data() + (block.v - v_.begin);
      for (int c = 0; c < block.columns; ++c) {
        const auto k = static_cast<std::size_t>(c);
        x[block.v + static_cast<Index>(c)] += inverse[k] * block.jacobian[k] * multiplier;
      }
    }
  }
}

void IslandJoints::apply_inverse_mass(double* x) const {
  for (Index i = v_.begin; i < v_.end; ++i) x[i] *= inverse_mass_[i - v_.begin];
}

void IslandJoints::respond(double* x) {
  apply_inverse_mass(x);
  hold(JointLevel::change, x);
}

void IslandJoints::hold(JointLevel level, double* x, double* multipliers) {
  if (rows_.empty()) return;
  for (std::size_t i = 0; i < rows_.size(); ++i) right_[i] = residual(level, rows_[i], x);
  solve(right_.data());
  add_response(right_.data(), x);
  if (multipliers != nullptr) std::copy(right_.begin(), right_.end(), multipliers);
}

}  // namespace carom
