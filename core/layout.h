#pragma once

/// \file
/// Where the coordinates and velocities of each body stand in the arrays of a state.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

/// Place of one body in every array, in the order of assembly.
struct BodySlot {
  Index serial = none;    ///< serial number of the body's identity
  Index q = 0;            ///< first coordinate
  Index v = 0;            ///< first velocity
  Index q_size = 0;       ///< number of coordinates
  Index v_size = 0;       ///< number of velocities
  Index rotation = none;  ///< first number of its rotation in Evaluation::rotation, `none` for particles
  Index kind = 0;         ///< kind of body
  Index slot = 0;         ///< place within its kind
};

/// Place of the internal variables of one element.
struct InternalSlot {
  Index serial = none;  ///< serial number of the element's identity
  Index first = 0;      ///< first of them in State::z
  Index size = 0;       ///< how many
};

/// Map from identities to places. Constant once made, shared by the states of one assembly.
class CAROM_API Layout {
public:
  /// \param dimension 2 or 3
  /// \param token token of the system
  /// \param bodies slots in the order of assembly
  /// \param internals slots of elements with internal variables
  Layout(int dimension, Index token, std::vector<BodySlot> bodies, std::vector<InternalSlot> internals = {});

  [[nodiscard]] int dimension() const { return dimension_; }            ///< 2 or 3
  [[nodiscard]] Index q_size() const { return q_size_; }                ///< number of coordinates
  [[nodiscard]] Index v_size() const { return v_size_; }                ///< number of velocities
  [[nodiscard]] Index z_size() const { return z_size_; }                ///< number of internal variables
  [[nodiscard]] Index rotation_size() const { return rotation_size_; }  ///< numbers in all rotations
  [[nodiscard]] const std::vector<BodySlot>& bodies() const { return bodies_; }  ///< in the order of assembly
  [[nodiscard]] BodyId id(Index body) const {
    return {bodies_[body].serial, token_};
  }  ///< of the body-th body

  /// Place of a body in bodies(). Throws ModelError for an identity that is not of this model.
  [[nodiscard]] Index index(BodyId id) const;
  /// Slot of a body. Throws as index().
  [[nodiscard]] const BodySlot& slot(BodyId id) const { return bodies_[index(id)]; }
  /// Elements with internal variables, by serial number.
  [[nodiscard]] const std::vector<InternalSlot>& internals() const { return internals_; }
  /// True if the element has internal variables in this model.
  [[nodiscard]] bool contains(ElementId id) const;
  /// Slot of an element's internal variables. Throws ModelError for an element that has none here.
  [[nodiscard]] const InternalSlot& internal(ElementId id) const;
  /// True if the body is part of the model.
  [[nodiscard]] bool contains(BodyId id) const;

private:
  int dimension_;
  Index token_;
  Index q_size_ = 0, v_size_ = 0, rotation_size_ = 0, z_size_ = 0;
  std::vector<BodySlot> bodies_;
  std::vector<Index> by_serial_;
  std::vector<InternalSlot> internals_;
};

}  // namespace carom
