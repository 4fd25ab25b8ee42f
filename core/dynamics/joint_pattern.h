#pragma once

/// \file
/// Places of the numbers of all joints of a component: rows, the numbers of G, and the products of blocks
/// that make up G M^-1 G^T. Does not change with the configuration.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/numerics/sparse_factors.h>

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace carom {

/// Joints with rows of one component, kind by kind.
class CAROM_API JointPattern {
public:
  /// Lists the joints and analyses the matrix that `factors` will hold.
  JointPattern(const Assembly& assembly, Index component, SparseFactors& factors);
  /// Of no joints; one for all.
  [[nodiscard]] static std::shared_ptr<const JointPattern> empty();

  [[nodiscard]] std::size_t size() const { return joints_.size() - 1; }    ///< number of joints
  [[nodiscard]] Index rows() const { return joints_.back().row; }          ///< number of rows
  [[nodiscard]] Index numbers() const { return joints_.back().number; }    ///< numbers of G
  [[nodiscard]] bool depends_on_time() const { return depends_on_time_; }  ///< true if a row does
  /// Velocities of a body that are not of angles.
  [[nodiscard]] Index dimension() const { return static_cast<Index>(assembly_->layout()->dimension()); }
  /// Calls f(velocity of an angle, first velocity of its body) for the angles of all bodies of the component.
  template <class F>
  void for_angles(F&& f) const;
  /// First of the rows of a joint; their number behind the last joint.
  [[nodiscard]] Index first_row(std::size_t joint) const { return joints_[joint].row; }
  /// Joint of a row.
  [[nodiscard]] std::size_t joint_of(std::size_t row) const;
  /// Identity of a joint.
  [[nodiscard]] JointId id(std::size_t joint) const;

  /// Evaluates the rows of all joints into arrays that begin with the first row.
  void evaluate(const JointView& at, JointNumbers out) const;
  /// Writes the derivatives of the rows of a joint.
  void derivatives(const JointView& at, std::size_t joint, JointRowDerivative* out) const;
  /// A row of G as blocks. \param jacobian the numbers of G
  [[nodiscard]] JointRow row(std::size_t row, const double* jacobian) const;
  /// Writes G M^-1 G^T. \param inverse_mass over the velocities of the component, which begin with `v`
  void multiply(const double* jacobian, const double* inverse_mass, Index v,
                std::vector<double>& values) const;
  /// Calls f(first row, rows, columns, first velocity, its numbers in the first row, numbers in a row) for
  /// the blocks of all joints; rows and columns of the block are constants if usual.
  template <class F>
  void for_blocks(const double* jacobian, F&& f) const;

private:
  template <class F>
  void for_pins(const double* jacobian, F&& f) const;
  // Velocities of a body.
  struct Block {
    Index v, columns;
  };
  // Beginnings of all that belongs to a joint.
  struct Joint {
    Index row;     // of its rows
    Index number;  // of its numbers of G
    Index block;   // of its blocks
  };
  // Joints of a kind.
  struct OfKind {
    Index kind;
    Range joints;
    Index first;  // the first one's place in joints_
  };
  // A product of two blocks that belongs to a block of the matrix: numbers of the two in G, of the result in
  // the matrix; the velocities they share.
  struct Product {
    Index number, other, value, v;
    std::uint8_t rows, other_rows, stride, other_stride, columns;
    bool first;  // of those that belong to the block
  };
  // A block of a joint, by the velocities that it multiplies.
  struct Use {
    Index v, joint, number, columns;
  };
  // Two blocks on the same velocities.
  struct Meeting {
    Use of, other;
  };

  JointPattern() = default;
  void add(const JointKind& kind, Index joint);
  [[nodiscard]] std::vector<Meeting> meetings() const;
  void find_products(SparseFactors& factors);
  [[nodiscard]] Index stride(std::size_t joint) const;
  [[nodiscard]] const OfKind& kind_of(std::size_t joint) const;

  const Assembly* assembly_ = nullptr;
  Range bodies_{};  // of the component
  std::vector<OfKind> kinds_;
  std::vector<Joint> joints_ = {{0, 0, 0}};  // and an end
  std::vector<Block> blocks_;
  std::vector<Product> products_;
  bool depends_on_time_ = false;
  bool pinned_ = true;  // all joints have two rows, on the three velocities of one body or of two
};

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

template <class F>
void JointPattern::for_angles(F&& f) const {
  for (Index body = bodies_.begin; body != bodies_.end; ++body) {
    const BodySlot at = assembly_->layout()->bodies()[body];
    for (Index c = dimension(); c < at.v_size; ++c) f(at.v + c, at.v);
  }
}

/// for_blocks() where all joints are pins.
template <class F>
void JointPattern::for_pins(const double* jacobian, F&& f) const {
  constexpr std::integral_constant<Index, 2> rows;
  constexpr std::integral_constant<Index, 3> columns;
  constexpr std::integral_constant<Index, 6> both;
  const double* number = jacobian;
  for (std::size_t joint = 0; joint < size(); ++joint) {
    const Index row = joints_[joint].row;
    const Block* const block = blocks_.data() + joints_[joint].block;
    if (joints_[joint + 1].block - joints_[joint].block == 1) {
      f(row, rows, columns, block->v, number, columns);
      number += rows * columns;
    } else {
      f(row, rows, columns, block[0].v, number, both);
      f(row, rows, columns, block[1].v, number + columns, both);
      number += rows * both;
    }
  }
}

template <class F>
void JointPattern::for_blocks(const double* jacobian, F&& f) const {
  const Joint* joint = joints_.data();
  const double* number = jacobian;
  if (pinned_) return for_pins(jacobian, f);
  for (const Joint* const end = joint + size(); joint != end; ++joint) {
    const Index rows = joint[1].row - joint->row;
    const Block* const first = blocks_.data() + joint->block;
    const Block* const last = blocks_.data() + joint[1].block;
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

}  // namespace carom
