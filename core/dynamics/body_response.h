#pragma once

/// \file
/// How bodies answer impulses: by their masses alone (M^-1), with the joints that bind them (K, what joints
/// leave of it), or as a linearised step does (A^-1, core/dynamics/implicit_solver.h). The matrix of a
/// contact problem is made from any of them in one way (contact/delassus.h).

#include <carom/core/assembly.h>
#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A symmetric map from impulses to changes of velocity.
class CAROM_API BodyResponse {
public:
  virtual ~BodyResponse() = default;

  /// Velocities that an impulse on a body may change: a range that holds those of the body. Ranges of two
  /// bodies are equal or have nothing in common.
  [[nodiscard]] virtual Range reach(Index body) const = 0;
  /// Columns of impulses become changes of velocity. Where nothing moves, since joints hold it fast, they are
  /// zero. \param body one of those pushed \param x columns over its reach, one behind the other, each
  /// beginning with the first velocity there \param held out, by column: true where nothing moves
  virtual void answer(Index body, double* x, std::size_t columns, char* held) = 0;
  /// Masses of a body that answers for itself; null `mass` where others answer with it.
  [[nodiscard]] virtual BodyMasses alone(Index body) const;
  /// Impulses become the loads that act, where more acts than they: with them what joints answer at once.
  /// Then W = D^T A^-1 D over these loads D. True if they are other loads. One column, as for answer().
  virtual bool take_loads(Index body, double* x);
};

/// M^-1: every body answers for itself.
class CAROM_API MassResponse final : public BodyResponse {
public:
  /// \param assembly must outlive it
  explicit MassResponse(const Assembly& assembly);
  [[nodiscard]] Range reach(Index body) const override;
  [[nodiscard]] BodyMasses alone(Index body) const override {
    if (of_all_.mass == nullptr) return of_any(body);
    BodyMasses own = of_all_;
    const Index before = own.stride * body;
    own.mass += before;
    if (own.inertia != nullptr) own.inertia += before;
    if (own.gyration_radius != nullptr) own.gyration_radius += before;
    return own;
  }
  void answer(Index body, double* x, std::size_t columns, char* held) override;

private:
  [[nodiscard]] BodyMasses of_any(Index body) const;

  const Assembly* assembly_;
  BodyMasses of_all_;  // from the first body on, where all are of one kind; else null `mass`
};

/// K = M^-1 - M^-1 G^T (G M^-1 G^T)^-1 G M^-1 over one component: bodies that joints bind answer together.
class CAROM_API JointResponse final : public BodyResponse {
public:
  /// \param joints not empty, factored wherever it is asked; must outlive it
  explicit JointResponse(JointConstraints& joints) : joints_(&joints) {}
  [[nodiscard]] Range reach(Index) const override { return joints_->velocities(); }
  void answer(Index body, double* x, std::size_t columns, char* held) override;

private:
  JointConstraints* joints_;
};

/// The linearised step of one component.
struct LinearisedComponent {
  ImplicitSolver* step = nullptr;  ///< factored
  Range velocities;                ///< of the component
  /// Joints whose answer to an impulse acts together with it, factored; null: none.
  JointConstraints* at_impact = nullptr;
};

/// A^-1 of the linearised steps of some components: the bodies of each answer together.
class CAROM_API LinearisedResponse final : public BodyResponse {
public:
  /// All must outlive it. \param components ascending; impulses act on their bodies alone
  LinearisedResponse(const Assembly& assembly, std::span<const LinearisedComponent> components);
  [[nodiscard]] Range reach(Index body) const override { return component_of(body).velocities; }
  void answer(Index body, double* x, std::size_t columns, char* held) override;
  bool take_loads(Index body, double* x) override;

private:
  [[nodiscard]] const LinearisedComponent& component_of(Index body) const;

  const Assembly* assembly_;
  std::span<const LinearisedComponent> components_;
  bool joints_answer_;  // in one of them: then loads of all are those that act
  std::vector<double> velocity_;
};

}  // namespace carom
