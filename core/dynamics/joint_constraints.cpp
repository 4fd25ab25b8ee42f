#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <utility>

namespace carom {

namespace {

/// Calls f with numbers of rows and columns, the usual ones as constants for loops.
template <class F>
void with_sizes(Index rows, Index columns, F&& f) {
  if (rows == 2 && columns == 3) {
    f(std::integral_constant<Index, 2>(), std::integral_constant<Index, 3>());
  } else if (rows == 1 && columns == 2) {
    f(std::integral_constant<Index, 1>(), std::integral_constant<Index, 2>());
  } else {
    f(rows, columns);
  }
}

}  // namespace

static_assert(JointKind::most_rows <= SparseFactors::most_rows);

/// Appends the pattern of a joint.
void JointConstraints::Pattern::add(const JointKind& kind, Index joint) {
  const auto refuse = [&](const char* what) { throw ModelError(std::string(kind.label()) + ": " + what); };
  if (kind.rows() > JointKind::most_rows) refuse("more rows than a joint can have; allowed: at most 6");
  std::array<JointRow, std::size_t{JointKind::most_rows}> rows;
  kind.pattern(joint, rows.data());
  Index columns = 0;
  for (int b = 0; b < rows[0].bodies; ++b) {
    const JointRow::Block& block = rows[0].blocks[static_cast<std::size_t>(b)];
    for (Index row = 1; row < kind.rows(); ++row) {
      const JointRow::Block& other = rows[row].blocks[static_cast<std::size_t>(b)];
      if (rows[row].bodies != rows[0].bodies || other.v != block.v || other.columns != block.columns)
        refuse("rows of a joint have different blocks; allowed: the same");
    }
    blocks.push_back({block.v, static_cast<Index>(block.columns)});
    columns += blocks.back().columns;
  }
  const Joint& last = joints.back();
  joints.push_back(
      {last.row + kind.rows(), last.number + kind.rows() * columns, static_cast<Index>(blocks.size())});
}

/// Numbers in a row of a joint.
Index JointConstraints::Pattern::stride(std::size_t joint) const {
  return (joints[joint + 1].number - joints[joint].number) / (joints[joint + 1].row - joints[joint].row);
}

/// Which blocks meet in the matrix: those of joints that share a body.
void JointConstraints::Pattern::multiply(SparseFactors& factors) {
  struct Use {
    Index v, joint, number, columns;
  };
  std::vector<Use> uses;
  std::vector<Index> sizes;
  for (Index joint = 0; joint + 1 < joints.size(); ++joint) {
    sizes.push_back(joints[joint + 1].row - joints[joint].row);
    Index number = joints[joint].number;
    for (Index b = joints[joint].block; b < joints[joint + 1].block; number += blocks[b++].columns) {
      uses.push_back({blocks[b].v, joint, number, blocks[b].columns});
    }
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.v < b.v; });
  struct Pair {
    Use of, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    while (last < uses.size() && uses[last].v == uses[first].v) ++last;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = first; j <= i; ++j) pairs.push_back({uses[i], uses[j]});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::pair(a.of.joint, a.other.joint) < std::pair(b.of.joint, b.other.joint);
  });
  std::vector<std::pair<Index, Index>> entries;
  std::vector<Index> entry_of;
  for (const Pair& pair : pairs) {
    const std::pair entry(pair.of.joint, pair.other.joint);
    if (entries.empty() || entries.back() != entry) entries.push_back(entry);
    entry_of.push_back(static_cast<Index>(entries.size() - 1));
  }
  const std::vector<SparseFactors::Place> places = factors.analyse(sizes, entries);
  products.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const SparseFactors::Place& place = places[entry_of[i]];
    const Use& of = place.transposed ? pairs[i].other : pairs[i].of;
    const Use& other = place.transposed ? pairs[i].of : pairs[i].other;
    const auto small = [](Index number) { return static_cast<std::uint8_t>(number); };
    products.push_back({of.number, other.number, place.first, of.v, small(sizes[of.joint]),
                        small(sizes[other.joint]), small(stride(of.joint)), small(stride(other.joint)),
                        small(of.columns), i == 0 || entry_of[i] != entry_of[i - 1]});
  }
}

JointConstraints::JointConstraints(const Assembly& assembly, Index component)
    : assembly_(&assembly), v_(assembly.components()[component].v) {
  auto pattern = std::make_shared<Pattern>();
  pattern->joints.push_back({0, 0, 0});
  bool depends_on_time = false;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(component, kind);
    if (range.empty() || joints.rows() == 0) continue;
    pattern->kinds.push_back({kind, range, static_cast<Index>(pattern->joints.size() - 1)});
    for (Index joint = range.begin; joint < range.end; ++joint) pattern->add(joints, joint);
    depends_on_time = depends_on_time || joints.depends_on_time();
  }
  if (pattern->kinds.empty()) return;
  pattern->joints.shrink_to_fit();
  pattern->blocks.shrink_to_fit();
  pattern->multiply(factors_);
  const Joint& end = pattern->joints.back();
  jacobian_.assign(end.number, 0.0);
  for (std::vector<double>* const numbers : {&gap_, &drift_, &right_}) numbers->assign(end.row, 0.0);
  if (depends_on_time) rate_.assign(end.row, 0.0);
  pattern_ = std::move(pattern);
  // Masses of planar bodies, and of particles, are diagonal in the velocities.
  const std::vector<double> ones(v_.size(), 1.0);
  inverse_mass_.resize(v_.size());
  assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    kind.apply_inverse_mass(slots, ones.data() + (v - v_.begin), inverse_mass_.data() + (v - v_.begin));
  });
}

void JointConstraints::fix(Range velocities) {
  for (Index i = velocities.begin; i < velocities.end; ++i) inverse_mass_[i - v_.begin] = 0.0;
}

void JointConstraints::evaluate(const JointView& at, JointNumbers out) const {
  for (const OfKind& of : pattern_->kinds) {
    const Joint& first = pattern_->joints[of.first];
    const auto from = [](double* numbers, Index place) {
      return numbers == nullptr ? numbers : numbers + place;
    };
    assembly_->joint_kinds()[of.kind]->evaluate_all(at, of.joints,
                                                    {from(out.jacobian, first.number), out.gap + first.row,
                                                     from(out.rate, first.row), from(out.drift, first.row)});
  }
}

void JointConstraints::update(const JointView& at) {
  if (empty()) return;
  evaluate(at, {jacobian_.data(), gap_.data(), rate_.empty() ? nullptr : rate_.data(), drift_.data()});
}

void JointConstraints::update_gaps(const JointView& at) {
  if (!empty()) evaluate(at, {.gap = gap_.data()});
}

void JointConstraints::update_and_factor(const JointView& at) {
  update(at);
  factor();
}

void JointConstraints::factor() {
  if (empty()) return;
  std::vector<double>& values = factors_.values();
  for (const Product& product : pattern_->products) {
    const double* const a = jacobian_.data() + product.number;
    const double* const b = jacobian_.data() + product.other;
    const double* const inverse = inverse_mass_.data() + (product.v - v_.begin);
    double* const value = values.data() + product.value;
    const auto multiply = [&](auto rows, auto others, auto columns) {
      for (Index i = 0; i < rows; ++i) {
        for (Index j = 0; j < others; ++j) {
          double sum = 0.0;
          for (Index c = 0; c < columns; ++c) {
            sum += a[i * product.stride + c] * inverse[c] * b[j * product.other_stride + c];
          }
          double& at_place = value[i * others + j];
          at_place = product.first ? sum : at_place + sum;
        }
      }
    };
    if (product.rows == product.other_rows) {
      with_sizes(product.rows, product.columns,
                 [&](auto rows, auto columns) { multiply(rows, rows, columns); });
    } else {
      multiply(product.rows, product.other_rows, product.columns);
    }
  }
  factors_.factor();
}

std::size_t JointConstraints::joint_of(std::size_t row) const {
  const auto after = std::upper_bound(pattern_->joints.begin(), pattern_->joints.end(), row,
                                      [](std::size_t at, const Joint& joint) { return at < joint.row; });
  return static_cast<std::size_t>(after - pattern_->joints.begin()) - 1;
}

const JointConstraints::OfKind& JointConstraints::kind_of(std::size_t joint) const {
  std::size_t kind = pattern_->kinds.size() - 1;
  while (pattern_->kinds[kind].first > joint) --kind;
  return pattern_->kinds[kind];
}

JointId JointConstraints::joint(std::size_t row) const {
  const auto joint = static_cast<Index>(joint_of(row));
  const OfKind& of = kind_of(joint);
  return assembly_->joint_id(of.kind, of.joints.begin + (joint - of.first));
}

void JointConstraints::derivatives(const JointView& at, std::size_t joint, JointRowDerivative* out) const {
  const OfKind& of = kind_of(joint);
  const Index slot = of.joints.begin + (static_cast<Index>(joint) - of.first);
  assembly_->joint_kinds()[of.kind]->derivatives(at, slot, out);
}

JointRow JointConstraints::row(std::size_t row) const {
  const std::size_t joint = joint_of(row);
  const Joint& at = pattern_->joints[joint];
  const double* number = jacobian_.data() + at.number + (row - at.row) * pattern_->stride(joint);
  JointRow result;
  for (Index b = at.block; b < pattern_->joints[joint + 1].block; ++b) {
    JointRow::Block& block = result.blocks[static_cast<std::size_t>(result.bodies++)];
    block.v = pattern_->blocks[b].v;
    block.columns = static_cast<int>(pattern_->blocks[b].columns);
    std::copy_n(number, block.columns, block.jacobian.begin());
    number += block.columns;
  }
  result.gap = gap(row);
  result.rate = rate(row);
  result.drift = drift_[row];
  return result;
}

/// Calls f(first row, rows, block, its numbers in the first row, numbers in a row) for the blocks of all
/// joints; rows and columns of the block are constants if usual.
template <class F>
void JointConstraints::for_blocks(F&& f) const {
  const Joint* joint = pattern_->joints.data();
  const double* number = jacobian_.data();
  for (const Joint* const end = joint + joints(); joint != end; ++joint) {
    const Index rows = joint[1].row - joint->row;
    const Block* const first = pattern_->blocks.data() + joint->block;
    const Block* const last = pattern_->blocks.data() + joint[1].block;
    Index stride = 0;
    for (const Block* block = first; block != last; ++block) stride += block->columns;
    const double* of_block = number;
    for (const Block* block = first; block != last; of_block += block++->columns) {
      with_sizes(rows, block->columns,
                 [&](auto n, auto columns) { f(joint->row, n, columns, block->v, of_block, stride); });
    }
    number += rows * stride;
  }
}

void JointConstraints::residuals(JointLevel level, const double* x, double* out) const {
  const std::vector<double>* constants = nullptr;
  switch (level) {
    case JointLevel::displacement:
      constants = &gap_;
      break;
    case JointLevel::velocity:
      if (!rate_.empty()) constants = &rate_;
      break;
    case JointLevel::acceleration:
      constants = &drift_;
      break;
    case JointLevel::change:
      break;
  }
  if (constants != nullptr) {
    std::copy(constants->begin(), constants->end(), out);
  } else {
    std::fill_n(out, size(), 0.0);
  }
  for_blocks([&](Index row, auto rows, auto columns, Index v, const double* number, Index stride) {
    for (Index i = 0; i < rows; ++i) {
      double sum = 0.0;
      for (Index c = 0; c < columns; ++c) sum += number[i * stride + c] * x[v + c];
      out[row + i] += sum;
    }
  });
}

void JointConstraints::add_transposed(const double* multipliers, double* x) const {
  for_blocks([&](Index row, auto rows, auto columns, Index v, const double* number, Index stride) {
    for (Index c = 0; c < columns; ++c) {
      double sum = 0.0;
      for (Index i = 0; i < rows; ++i) sum += number[i * stride + c] * multipliers[row + i];
      x[v + c] += sum;
    }
  });
}

void JointConstraints::solve(double* r) {
  for (std::size_t i = 0; i < size(); ++i) r[i] = -r[i];
  factors_.solve(r);
}

void JointConstraints::add_response(const double* multipliers, double* x) const {
  const double* const inverse = inverse_mass_.data();
  for_blocks([&](Index row, auto rows, auto columns, Index v, const double* number, Index stride) {
    for (Index c = 0; c < columns; ++c) {
      double sum = 0.0;
      for (Index i = 0; i < rows; ++i) sum += number[i * stride + c] * multipliers[row + i];
      x[v + c] += inverse[v - v_.begin + c] * sum;
    }
  });
}

void JointConstraints::apply_inverse_mass(double* x) const {
  for (Index i = v_.begin; i < v_.end; ++i) x[i] *= inverse_mass_[i - v_.begin];
}

void JointConstraints::constrained_response(double* x) {
  apply_inverse_mass(x);
  project(JointLevel::change, x);
}

void JointConstraints::project(JointLevel level, double* x, double* multipliers) {
  if (empty()) return;
  residuals(level, x, right_.data());
  solve(right_.data());
  add_response(right_.data(), x);
  if (multipliers != nullptr) std::copy(right_.begin(), right_.end(), multipliers);
}

}  // namespace carom
