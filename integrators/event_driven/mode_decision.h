#pragma once

/// \file
/// Which contacts of a body stay closed, which of these stick? Decided on the level of accelerations
/// (docs/method.md, section 7): contacts that touch without speed get forces by the law of contact with e =
/// 0, written for accelerations; one that slips already rubs against its motion. What has no answer, or
/// several, is Painleve's: it is told which contact and which quantity is to blame.

#include <carom/contact/active_set.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <span>
#include <vector>

namespace carom {

/// A contact that touches without normal speed.
struct Candidate {
  ContactPair pair;
  Index place = none;  ///< of the pair among those of the motion
  Constraint at;
  double slip = 0.0;                        ///< tangential velocity, 0 if it may stick [m/s]
  ContactMode present = ContactMode::open;  ///< before the decision
  ContactMode mode = ContactMode::open;     ///< decided
  bool breaks = false;        ///< its friction is exhausted: it slips against `push`, unless that cannot be
  bool frictionless = false;  ///< without friction
  bool releases = false;      ///< its force has come to an end: it opens, unless that cannot be
  double push = 0.0;          ///< the friction force that was exhausted [N],
  double noise = 0.0;         ///< to this much
  // Where the problem was Painleve's:
  double stiffness = 0.0;          ///< W_nn - s mu W_nt [1/kg]; infinite of friction in a joint
  double free_acceleration = 0.0;  ///< normal acceleration without contact [m/s^2]
};

/// What was decided.
enum class Decision : std::uint8_t {
  made,        ///< modes are given
  several,     ///< likewise, chosen by rule among several
  impossible,  ///< no forces exist: an impact without collision is due
  failed       ///< no solver found an answer
};

/// Decides for the contacts of one body at a time. Keeps memory only.
class CAROM_API ModeDecision {
public:
  /// \param acceleration of all bodies without contact
  /// \param motion of their component, evaluated without contacts
  Decision decide(const Assembly& assembly, SmoothMotion& motion, std::span<Candidate> candidates,
                  const double* acceleration, SolverChain& chain);
  /// The last problem, and what is known of its answer.
  [[nodiscard]] const IslandProblem& cluster() const { return cluster_; }

private:
  struct Slide {
    double sign = 0.0;  // of the sliding velocity, 0: may stick
    bool out = false;   // taken as open
    bool back = false;  // was taken to break loose or slip and did not
  };
  Decision solve(SmoothMotion& motion, std::span<Candidate> candidates, const double* acceleration,
                 SolverChain& chain);
  bool revise(std::span<Candidate> candidates);
  void name_culprit(std::span<Candidate> candidates);
  bool keep_present(std::span<Candidate> candidates);
  void take(std::span<Candidate> candidates, std::size_t solution);
  void read_modes(std::span<Candidate> candidates, std::span<const double> force);
  // Bounds of friction that follow from forces (mode_decision_bounds.cpp):
  bool settle_bounds(SmoothMotion& motion, std::span<Candidate> candidates, const double* acceleration,
                     SolverChain& chain);
  void complete_modes(SmoothMotion& motion, std::span<Candidate> candidates);
  void list_closed(std::span<const Candidate> candidates);

  IslandProblem cluster_;
  SolutionList solutions_;
  std::vector<Constraint> contacts_;
  std::vector<std::size_t> taking_part_;  // candidates by contact of the problem
  std::vector<Slide> slides_;
  std::vector<double> zero_, acceleration_;
  std::vector<ActiveContact> active_;  // those that stay, in the order of contacts_
  std::vector<ForceMargin> margins_;
};

}  // namespace carom
