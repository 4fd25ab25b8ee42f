// Problem: know once and for all which numbers of joints meet in the matrix of their constraints.

#include <carom/core/dynamics/joint_pattern.h>
#include <carom/core/errors.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace carom {

static_assert(JointKind::most_rows <= SparseFactors::most_rows);

JointPattern::JointPattern(const Assembly& assembly, Index component, SparseFactors& factors)
    : assembly_(&assembly), bodies_(assembly.components()[component].bodies) {
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(component, kind);
    if (range.empty() || joints.rows() == 0) continue;
    kinds_.push_back({kind, range, static_cast<Index>(size())});
    for (Index joint = range.begin; joint < range.end; ++joint) add(joints, joint);
    depends_on_time_ = depends_on_time_ || joints.depends_on_time();
  }
  if (kinds_.empty()) return;
  joints_.shrink_to_fit();
  blocks_.shrink_to_fit();
  find_products(factors);
}

std::shared_ptr<const JointPattern> JointPattern::empty() {
  static const std::shared_ptr<const JointPattern> no_joints(new JointPattern);
  return no_joints;
}

/// Appends the pattern of a joint.
void JointPattern::add(const JointKind& kind, Index joint) {
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
    pinned_ = pinned_ && kind.rows() == 2 && rows[0].bodies <= 2 && block.columns == 3;
    blocks_.push_back({block.v, static_cast<Index>(block.columns)});
    columns += blocks_.back().columns;
  }
  const Joint& last = joints_.back();
  joints_.push_back(
      {last.row + kind.rows(), last.number + kind.rows() * columns, static_cast<Index>(blocks_.size())});
}

/// Numbers in a row of a joint.
Index JointPattern::stride(std::size_t joint) const {
  return (joints_[joint + 1].number - joints_[joint].number) / (joints_[joint + 1].row - joints_[joint].row);
}

/// Blocks that meet in the matrix, those of joints that share a body, in the order of the matrix.
std::vector<JointPattern::Meeting> JointPattern::meetings() const {
  std::vector<Use> uses;
  for (Index joint = 0; joint < size(); ++joint) {
    Index number = joints_[joint].number;
    for (Index b = joints_[joint].block; b < joints_[joint + 1].block; number += blocks_[b++].columns) {
      uses.push_back({blocks_[b].v, joint, number, blocks_[b].columns});
    }
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.v < b.v; });
  std::vector<Meeting> pairs;
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    while (last < uses.size() && uses[last].v == uses[first].v) ++last;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = first; j <= i; ++j) pairs.push_back({uses[i], uses[j]});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Meeting& a, const Meeting& b) {
    return std::pair(a.of.joint, a.other.joint) < std::pair(b.of.joint, b.other.joint);
  });
  return pairs;
}

void JointPattern::find_products(SparseFactors& factors) {
  std::vector<Index> sizes;
  for (Index joint = 0; joint < size(); ++joint) {
    sizes.push_back(joints_[joint + 1].row - joints_[joint].row);
  }
  const std::vector<Meeting> pairs = meetings();
  std::vector<std::pair<Index, Index>> entries;
  std::vector<Index> entry_of;
  for (const Meeting& pair : pairs) {
    const std::pair entry(pair.of.joint, pair.other.joint);
    if (entries.empty() || entries.back() != entry) entries.push_back(entry);
    entry_of.push_back(static_cast<Index>(entries.size() - 1));
  }
  const std::vector<SparseFactors::Place> places = factors.analyse(sizes, entries);
  products_.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const SparseFactors::Place& place = places[entry_of[i]];
    const Use& of = place.transposed ? pairs[i].other : pairs[i].of;
    const Use& other = place.transposed ? pairs[i].of : pairs[i].other;
    const auto small = [](Index number) { return static_cast<std::uint8_t>(number); };
    products_.push_back({of.number, other.number, place.first, of.v, small(sizes[of.joint]),
                         small(sizes[other.joint]), small(stride(of.joint)), small(stride(other.joint)),
                         small(of.columns), i == 0 || entry_of[i] != entry_of[i - 1]});
  }
}

void JointPattern::evaluate(const JointView& at, JointNumbers out) const {
  for (const OfKind& of : kinds_) {
    const Joint& first = joints_[of.first];
    const auto from = [](double* numbers, Index place) {
      return numbers == nullptr ? numbers : numbers + place;
    };
    assembly_->joint_kinds()[of.kind]->evaluate_all(at, of.joints,
                                                    {from(out.jacobian, first.number), out.gap + first.row,
                                                     from(out.rate, first.row), from(out.drift, first.row)});
  }
}

void JointPattern::multiply(const double* jacobian, const double* inverse_mass, Index v,
                            std::vector<double>& values) const {
  for (const Product& product : products_) {
    const double* const a = jacobian + product.number;
    const double* const b = jacobian + product.other;
    const double* const inverse = inverse_mass + (product.v - v);
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
}

std::size_t JointPattern::joint_of(std::size_t row) const {
  const auto after = std::upper_bound(joints_.begin(), joints_.end(), row,
                                      [](std::size_t at, const Joint& joint) { return at < joint.row; });
  return static_cast<std::size_t>(after - joints_.begin()) - 1;
}

const JointPattern::OfKind& JointPattern::kind_of(std::size_t joint) const {
  std::size_t kind = kinds_.size() - 1;
  while (kinds_[kind].first > joint) --kind;
  return kinds_[kind];
}

JointId JointPattern::id(std::size_t joint) const {
  const OfKind& of = kind_of(joint);
  return assembly_->joint_id(of.kind, of.joints.begin + (static_cast<Index>(joint) - of.first));
}

void JointPattern::derivatives(const JointView& at, std::size_t joint, JointRowDerivative* out) const {
  const OfKind& of = kind_of(joint);
  const Index slot = of.joints.begin + (static_cast<Index>(joint) - of.first);
  assembly_->joint_kinds()[of.kind]->derivatives(at, slot, out);
}

JointRow JointPattern::row(std::size_t row, const double* jacobian) const {
  const std::size_t joint = joint_of(row);
  const Joint& at = joints_[joint];
  const double* number = jacobian + at.number + (row - at.row) * stride(joint);
  JointRow result;
  for (Index b = at.block; b < joints_[joint + 1].block; ++b) {
    JointRow::Block& block = result.blocks[static_cast<std::size_t>(result.bodies++)];
    block.v = blocks_[b].v;
    block.columns = static_cast<int>(blocks_[b].columns);
    std::copy_n(number, block.columns, block.jacobian.begin());
    number += block.columns;
  }
  return result;
}

}  // namespace carom
