#pragma once

/// \file
/// The model: a graph of bodies (nodes), force elements and joints (edges), shapes of bodies and shapes on
/// ground (obstacles).

#include <carom/core/errors.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/model_finding.h>
#include <carom/core/owner.h>
#include <carom/core/part.h>
#include <carom/core/surface.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom {

struct ContactSide;
template <class K>
class Registry;

/// Whether shapes of two bodies may touch, as decided (System::allow_contact()).
struct ContactDecision {
  BodyId a{};            ///< added before the other one
  BodyId b{};            ///< the other body
  bool allowed = false;  ///< whether their shapes may touch
};

/// Describes a model; it has no state. Parts are checked when they are added. Copies are independent and keep
/// the identities of their parts.
class CAROM_API System {
public:
  System();
  System(const System& other);
  System(System&& other) noexcept;
  System& operator=(const System& other);
  System& operator=(System&& other) noexcept;
  ~System();

  /// Adds a part, of the library or of the user: a body, force element, joint, shape of a body or on ground.
  /// \param name optional, unique among the parts of its role
  /// \return its identity
  /// Throws ModelError (naming the part, the value and what is allowed) if the part is invalid.
  template <Part P>
  IdOf<P> add(const P& part, std::string name = {}) {
    return {add_to(P::role, type_of_part<P>(), &part, std::move(name)), token_};
  }

  /// Adds a shape on ground with its contact law. Short for a material of its own that has this law with
  /// everything; it holds where no law of materials is set (see between()).
  template <Part P>
    requires(P::role == Role::obstacle)
  ObstacleId add(const P& part, const Surface& surface, std::string name = {}) {
    check_surface(surface, type_of_part<P>().label, name);
    const ObstacleId id = add(part, std::move(name));
    set_own_law(id, surface);
    return id;
  }

  /// Removes a part. The force elements, joints and shapes of a body must be removed before it, and the parts
  /// on the coordinate of a joint before the joint; otherwise a ModelError names one of them.
  void remove(BodyId id);
  void remove(ElementId id);
  void remove(JointId id);
  void remove(ShapeId id);
  void remove(ObstacleId id);

  /// Excludes a body from the projection onto the joints at the start of a run: it keeps its described
  /// position and velocity, and others are moved. Throws ModelError for a body that is not of this system.
  void keep_place(BodyId body, bool keep = true);
  /// True if a body is excluded from the projection onto the joints. Throws ModelError for a body that is not
  /// of this system.
  [[nodiscard]] bool keeps_place(BodyId body) const;
  /// Lets the projection onto the joints at the start of a run move bodies however far. Without this a
  /// Simulation refuses a joint that is drawn open by more than a tenth of the size of its bodies.
  void close_joints(bool however_far = true);
  /// True if the projection onto the joints may move bodies however far.
  [[nodiscard]] bool closes_joints() const;

  /// Decides whether shapes of two bodies may touch, where their filters let them. Undecided, they may unless
  /// a joint binds both bodies. Throws ModelError for a body that is not of this system, and for the same
  /// twice. \param allowed empty: undecided again
  void allow_contact(BodyId a, BodyId b, std::optional<bool> allowed = true);
  /// Whether shapes of two bodies may touch, as decided by allow_contact(); empty if it is undecided. Throws
  /// ModelError for a body that is not of this system, and for one body named twice.
  [[nodiscard]] std::optional<bool> is_contact_allowed(BodyId a, BodyId b) const;
  /// All decisions, in the order of their bodies.
  [[nodiscard]] std::vector<ContactDecision> contact_decisions() const;

  /// The material of that name, made if it is new. Throws ModelError for an empty name.
  MaterialId material(std::string_view name);
  /// Sets the contact law between two materials. Throws ModelError for invalid coefficients.
  void between(MaterialId a, MaterialId b, const Surface& surface);
  /// Sets the contact law of all pairs that have no other, of parts without a material too. Unless it is set
  /// there is no such law, and a pair without a law is an error: a Simulation refuses it by name. Throws
  /// ModelError for invalid coefficients.
  void set_default_law(const Surface& surface);
  /// Contact law between parts of two materials, in either order: that set by between(), else the default
  /// law, else none. Either may be no material. Throws ModelError for a material that is not of this system.
  [[nodiscard]] std::optional<Surface> law(MaterialId a, MaterialId b) const;
  /// Contact law between a part of material `a` and a shape on ground: that of their materials, set by
  /// between(), else the surface that the shape was added with, else the default law, else none. `a` may be
  /// no material. Throws ModelError for a material or a shape that is not of this system.
  [[nodiscard]] std::optional<Surface> law(MaterialId a, ObstacleId obstacle) const;

  /// The part of that name. Throws ModelError if there is none.
  [[nodiscard]] BodyId body(std::string_view name) const;
  [[nodiscard]] ElementId element(std::string_view name) const;
  [[nodiscard]] JointId joint(std::string_view name) const;
  [[nodiscard]] ShapeId shape(std::string_view name) const;
  [[nodiscard]] ObstacleId obstacle(std::string_view name) const;

  /// Name of a part in messages: "particle 'lower'" or "particle #3"; "ground". A removed part keeps its
  /// name. Of an identity that is not of this system it says so: "part of another system".
  [[nodiscard]] std::string name(BodyId id) const;
  [[nodiscard]] std::string name(ElementId id) const;
  [[nodiscard]] std::string name(JointId id) const;
  [[nodiscard]] std::string name(ShapeId id) const;
  [[nodiscard]] std::string name(ObstacleId id) const;
  /// The name a body was given, empty if none; a removed body keeps it. Throws ModelError for a body that was
  /// never in this system.
  [[nodiscard]] std::string given_name(BodyId id) const;

  /// True if the part is of this system and was not removed.
  [[nodiscard]] bool contains(BodyId id) const;
  [[nodiscard]] bool contains(ElementId id) const;
  [[nodiscard]] bool contains(JointId id) const;
  [[nodiscard]] bool contains(ShapeId id) const;
  [[nodiscard]] bool contains(ObstacleId id) const;
  [[nodiscard]] bool contains(MaterialId id) const;
  /// The body that a shape is fixed to, or was until it was removed. Throws ModelError for a shape that was
  /// never in this system.
  [[nodiscard]] BodyId body_of(ShapeId shape) const;
  /// True if the body has an orientation; false of the ground. Throws ModelError for a body that is not of
  /// this system.
  [[nodiscard]] bool has_orientation(BodyId id) const;

  /// Probable mistakes: laws of contact that cannot act, parts that can touch nothing, and the like
  /// (core/model_finding.h). Empty if nothing was found. A Simulation calls it; StepReport::findings.
  [[nodiscard]] std::vector<ModelFinding> check() const;

  /// Parts, in the order in which they were added.
  [[nodiscard]] std::vector<BodyId> bodies() const;
  [[nodiscard]] std::vector<ElementId> elements() const;
  [[nodiscard]] std::vector<JointId> joints() const;
  [[nodiscard]] std::vector<ShapeId> shapes() const;
  [[nodiscard]] std::vector<ObstacleId> obstacles() const;

  /// 2 or 3; 0 while no part determines it.
  [[nodiscard]] int dimension() const { return dimension_; }
  /// Token in the identities of this system and its copies.
  [[nodiscard]] Index token() const { return token_; }
  /// Fingerprint of all data that a run depends on besides its state: everything except names, initial
  /// positions and velocities, functions given by users, and data that a user's element does not report.
  [[nodiscard]] std::uint64_t fingerprint() const;

  /// Parts by kind, for assembly (core/registry.h).
  [[nodiscard]] const Registry<BodyKind>& body_kinds() const;
  [[nodiscard]] const Registry<ForceKind>& force_kinds() const;
  [[nodiscard]] const Registry<JointKind>& joint_kinds() const;
  [[nodiscard]] const Registry<ShapeKind>& shape_kinds() const;
  [[nodiscard]] const Registry<GroundShapeKind>& ground_shape_kinds() const;

private:
  template <class K>
  Index add_to(Role role, const PartType<K>& type, const void* part, std::string name);
  void set_own_law(ObstacleId id, const Surface& surface);
  void check_surface(const Surface& surface, std::string_view label, const std::string& name) const;
  template <class Identity, class K>
  [[nodiscard]] std::vector<Identity> identities(const Registry<K>& registry) const;

  // Parts by kind, and what is written beside them: names, laws and decisions.
  struct Stored;

  [[nodiscard]] const Stored& stored() const;
  [[nodiscard]] Stored& stored();
  void take_dimension(int dimension, std::string_view label) const;
  void check_name(Role role, const std::string& name, std::string_view label) const;
  [[nodiscard]] static std::string describe(std::string_view label, const std::string& name, Index serial);
  void added(Role role, int dimension, Index serial, std::string name);
  [[nodiscard]] Index by_name(Role role, std::string_view name, std::string_view what) const;
  [[nodiscard]] std::pair<Index, Index> two_bodies(BodyId a, BodyId b) const;
  [[nodiscard]] std::optional<Surface> find_law(const ContactSide& a, const ContactSide& b) const;
  template <class Identity, class K>
  [[nodiscard]] std::string name_in(Role role, const Registry<K>& registry, Identity id) const;
  template <class Identity, class K>
  void remove_from(Role role, Registry<K>& registry, Identity id, std::string_view what);

  Index token_;
  int dimension_ = 0;
  Owner<Stored> stored_;  // null: no part, nothing written; ask stored()
};

}  // namespace carom
