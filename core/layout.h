#pragma once

/// \file
/// Where the coordinates and velocities of each body stand in the arrays of a state.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace carom {

class JointTable;

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

/// The slots of all bodies, by place in the order of assembly. Neighbours mostly differ by a constant step
/// from one to the next; only the first of each such run is stored, and slots are given by value.
class CAROM_API BodySlots {
public:
  BodySlots() = default;
  /// \param slots in the order of assembly
  /// \param rotation_length numbers in a rotation
  BodySlots(const std::vector<BodySlot>& slots, Index rotation_length);

  /// Walks over the slots.
  class Iterator {
  public:
    Iterator() = default;
    Iterator(const BodySlots* slots, Index body) : slots_(slots), body_(body) {}
    BodySlot operator*() const { return (*slots_)[body_]; }
    Iterator& operator++() {
      ++body_;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++body_;
      return before;
    }
    friend bool operator==(const Iterator&, const Iterator&) = default;

  private:
    const BodySlots* slots_ = nullptr;
    Index body_ = 0;
  };

  [[nodiscard]] std::size_t size() const { return size_; }                          ///< number of bodies
  [[nodiscard]] bool empty() const { return size_ == 0; }                           ///< true if there is none
  [[nodiscard]] Iterator begin() const { return {this, 0}; }                        ///< first
  [[nodiscard]] Iterator end() const { return {this, static_cast<Index>(size_)}; }  ///< behind the last
  /// Slot of the body-th body.
  [[nodiscard]] BodySlot operator[](std::size_t body) const {
    const Run& run = runs_.size() == 1 ? runs_.front() : run_of(static_cast<Index>(body));
    return run.at(static_cast<Index>(body) - run.body, rotation_length_);
  }
  /// Calls f(body, slot) for the slots of some bodies in turn.
  template <class F>
  void for_range(Range bodies, F&& f) const {
    for (Index body = bodies.begin; body < bodies.end;) {
      const Run& run = run_of(body);
      const Index run_end = run.body + run.count, end = bodies.end < run_end ? bodies.end : run_end;
      const Index rotation = run.first.rotation == none ? 0 : rotation_length_;
      for (BodySlot at = run.at(body - run.body, rotation_length_); body < end; ++body) {
        f(body, at);
        ++at.serial;
        ++at.slot;
        at.q += at.q_size;
        at.v += at.v_size;
        at.rotation += rotation;
      }
    }
  }
  /// Place of a body by its serial number, `none` if there is none.
  [[nodiscard]] Index find(Index serial) const;

private:
  struct Run {
    Index body = 0;   // the first one's place
    Index count = 0;  // number of bodies
    BodySlot first;

    [[nodiscard]] BodySlot at(Index i, Index rotation_length) const {
      return {first.serial + i,
              first.q + i * first.q_size,
              first.v + i * first.v_size,
              first.q_size,
              first.v_size,
              first.rotation == none ? none : first.rotation + i * rotation_length,
              first.kind,
              first.slot + i};
    }
  };
  [[nodiscard]] const Run& run_of(Index body) const;

  std::vector<Run> runs_;         // by place
  std::vector<Index> by_serial_;  // runs, ordered by serial number
  std::size_t size_ = 0;
  Index rotation_length_ = 0;
};

/// Map from identities to places. Constant once made, shared by the states of one assembly.
class CAROM_API Layout {
public:
  /// \param dimension 2 or 3
  /// \param token token of the system
  /// \param bodies slots in the order of assembly
  Layout(int dimension, Index token, const std::vector<BodySlot>& bodies);
  /// Tells the places of internal variables, before the layout is given to anyone.
  void place_internals(std::vector<InternalSlot> internals);

  /// Tells the joints, before the layout is given to anyone.
  void place_joints(std::shared_ptr<const JointTable> joints);

  [[nodiscard]] int dimension() const { return dimension_; }            ///< 2 or 3
  [[nodiscard]] Index q_size() const { return q_size_; }                ///< number of coordinates
  [[nodiscard]] Index v_size() const { return v_size_; }                ///< number of velocities
  [[nodiscard]] Index z_size() const { return z_size_; }                ///< number of internal variables
  [[nodiscard]] Index rotation_size() const { return rotation_size_; }  ///< numbers in all rotations
  [[nodiscard]] const BodySlots& bodies() const { return bodies_; }     ///< in the order of assembly
  /// Identity of the body-th body.
  [[nodiscard]] BodyId id(Index body) const { return {bodies_[body].serial, token_}; }

  /// Place of a body in bodies(). Throws ModelError for an identity that is not of this model.
  [[nodiscard]] Index index(BodyId id) const;
  /// Slot of a body. Throws as index().
  [[nodiscard]] BodySlot slot(BodyId id) const { return bodies_[index(id)]; }
  /// Elements with internal variables, by serial number.
  [[nodiscard]] const std::vector<InternalSlot>& internals() const { return internals_; }
  /// True if the element has internal variables in this model.
  [[nodiscard]] bool contains(ElementId id) const;
  /// Slot of an element's internal variables. Throws ModelError for an element that has none here.
  [[nodiscard]] const InternalSlot& internal(ElementId id) const;
  /// Joints by identity; null where there are none.
  [[nodiscard]] const JointTable* joints() const { return joints_.get(); }
  /// True if bodies and internal variables have the same places in both.
  [[nodiscard]] bool has_places_of(const Layout& other) const;
  /// Token of the system.
  [[nodiscard]] Index token() const { return token_; }
  /// True if the body is part of the model.
  [[nodiscard]] bool contains(BodyId id) const {
    return id.token == token_ && bodies_.find(id.serial) != none;
  }

private:
  int dimension_;
  Index token_;
  Index q_size_ = 0, v_size_ = 0, rotation_size_ = 0, z_size_ = 0;
  BodySlots bodies_;
  std::vector<InternalSlot> internals_;
  std::shared_ptr<const JointTable> joints_;
};

}  // namespace carom
