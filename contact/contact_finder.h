#pragma once

/// \file
/// Finds the contacts of bodies with obstacles: all pairs of a rounded point and an obstacle whose gap is
/// closed (Johansson 1999, section 4: violated contacts take part in a step).

#include <carom/contact/contact.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <array>
#include <string>
#include <vector>

namespace carom {

/// A feature of a body and an obstacle, wherever they stand.
struct ContactPair {
  Index body = none;      ///< in the order of assembly
  Index feature = none;   ///< of the finder; `none` where the body touches at its centre
  Index material = none;  ///< row of the finder's table of laws
  Index obstacle = none;  ///< of the finder
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

/// Features of the bodies of an assembly and the laws they obey.
class CAROM_API ContactFinder {
public:
  /// Throws ModelError where a feature and an obstacle have no contact law.
  explicit ContactFinder(const Assembly& assembly);

  /// Appends the contacts of one island whose gap is <= `margin` [m], ordered by body, then feature, then
  /// obstacle. The position group of `evaluation` must be up to date.
  void find(Index island, const StateView& state, const Evaluation& evaluation, double margin,
            std::vector<Contact>& out) const;

  /// All pairs of one island, in the order of find(). Made at each call.
  [[nodiscard]] std::vector<ContactPair> pairs(Index island) const;
  /// The contact of a pair, whatever its gap. The position group of `evaluation` must be up to date.
  void contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
               Contact& out) const;

  /// True if find() looks at the rotations of bodies: a feature stands off a centre of mass.
  [[nodiscard]] bool needs_rotations() const;

  /// "particle 'lower' on half-plane #0".
  [[nodiscard]] std::string name(const ContactKey& key) const;

private:
  // A point of a shape.
  struct Feature {
    Index body;      // in the order of assembly
    Index material;  // row of the law table
    FeatureKey key;
    std::array<double, 3> centre;
    double radius;
  };
  // Neighbouring bodies of one kind and island that touch at their centres.
  struct Centres {
    Range bodies;
    Index material;
  };
  // What touches in one island: ranges of centres_ and features_.
  struct Touching {
    Range centres, features;
  };
  struct Obstacle {
    const ObstacleKind* kind;
    Index slot;
    Index serial;
  };

  void collect_obstacles();
  void collect_features();
  [[nodiscard]] Index row_of(MaterialId material);
  void collect_centres();
  void make_law_table();
  [[nodiscard]] Feature centre_of(const BodySlot& body, Index place, Index material) const;
  template <int D>
  void add(const BodySlot& body, const Feature& feature, const StateView& state, const Evaluation& evaluation,
           double margin, std::vector<Contact>& out) const;
  // Position of the centre of a feature from its body's centre of mass.
  template <int D>
  [[nodiscard]] static Vec<D> arm(const BodySlot& body, const Feature& feature, const Evaluation& evaluation);
  template <int D>
  void fill(const BodySlot& body, const Feature& feature, Index obstacle, const Gap& gap, const Vec<D>& arm,
            const StateView& state, Contact& out) const;
  template <int D>
  void find_in(Index island, const StateView& state, const Evaluation& evaluation, double margin,
               std::vector<Contact>& out) const;

  const Assembly* assembly_;
  std::vector<Obstacle> obstacles_;
  std::vector<Centres> centres_;   // ordered by body
  std::vector<Feature> features_;  // ordered by body
  std::vector<Touching> of_island_;
  std::vector<MaterialId> materials_;  // rows of the law table
  std::vector<Surface> laws_;          // row-major: material, obstacle
};

}  // namespace carom
