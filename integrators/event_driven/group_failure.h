#pragma once

/// \file
/// Errors of a clock group: they name its times, the parts that keep it from going on, and the problem.

#include <carom/contact/island_problem.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/group_model.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// Times of a clock group.
struct GroupClock {
  double now = 0.0;     ///< up to which it is decided [s]
  double output = 0.0;  ///< that it was last advanced to: its last good state [s]
};

/// Maker of the errors of one clock group.
class CAROM_API GroupFailure {
public:
  /// \param model,clock must outlive it
  GroupFailure(const GroupModel& model, const GroupClock& clock) : model_(&model), clock_(&clock) {}

  /// Throws a SolverError. \param parts named, the worst first; empty: a body of the group \param problem
  /// whose problem is attached, may be null \param unkept contacts that no forces keep closed: ground that
  /// presses or carries bodies there is named; empty: that of a problem of an impact, where it has no answer
  [[noreturn]] void fail(const std::string& what, std::vector<std::string> parts,
                         const IslandProblem* problem = nullptr,
                         std::span<const Constraint> unkept = {}) const;
  /// Fails, naming the element and its bodies, if the loads of one are not finite in a sample.
  void demand_finite_loads(const MotionSample& at) const;
  /// Fails, naming the element if there is one.
  [[noreturn]] void fail_loads(const MotionSample& at) const;
  /// Fails as a flow did, naming the element whose loads are not finite at the last sample or where the flow
  /// failed. \param y the last good state \param memory last sample, overwritten
  [[noreturn]] void fail_flow(const RunError& error, SmoothMotion& motion, const double* y,
                              MotionSample& memory) const;

  /// Name of a contact.
  [[nodiscard]] std::string name(const Constraint& contact) const {
    return model_->detector->name(contact.key);
  }
  /// Names of contacts. \param constraint_of gives the contact of an element of the list
  template <class List, class F>
  [[nodiscard]] std::vector<std::string> names(const List& list, F&& constraint_of) const {
    std::vector<std::string> names;
    names.reserve(list.size());
    for (const auto& each : list) names.push_back(name(constraint_of(each)));
    return names;
  }
  /// Names of contacts.
  [[nodiscard]] std::vector<std::string> names(std::span<const Constraint> contacts) const {
    return names(contacts, [](const Constraint& contact) -> const Constraint& { return contact; });
  }

private:
  const GroupModel* model_;
  const GroupClock* clock_;
};

}  // namespace carom
