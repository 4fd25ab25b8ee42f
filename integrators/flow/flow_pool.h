#pragma once

/// \file
/// Flows that many problems share: made where none is free, used again wherever one is.

#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>

#include <cstddef>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace carom {

/// Flows of one method and tolerance, by the numbers of unknowns and of integrals of what they serve,
/// ballistic ones apart. What a flow computes does not depend on whom it served before; bdf analyses its
/// matrix anew where the pattern is another one. The pool must outlive its loans.
class CAROM_API FlowPool {
private:
  // All flows for problems of one size, and those that nobody has.
  struct Shelf {
    std::vector<std::unique_ptr<Flow>> flows;
    std::vector<Flow*> free;  // room for all
  };

public:
  /// Puts a flow back.
  class CAROM_API Return {
  public:
    Return() = default;
    void operator()(Flow* flow) const noexcept;

  private:
    friend class FlowPool;
    explicit Return(Shelf& shelf) : shelf_(&shelf) {}
    Shelf* shelf_ = nullptr;
  };
  /// A flow for its user alone, until it is reset or destroyed.
  using Loan = std::unique_ptr<Flow, Return>;

  /// \param relative_tolerance of make_flow()
  FlowPool(FlowMethod method, double relative_tolerance)
      : method_(method), relative_tolerance_(relative_tolerance) {}
  FlowPool(const FlowPool&) = delete;
  FlowPool& operator=(const FlowPool&) = delete;

  /// A flow bound to a problem that must outlive the loan; the one that came back last, a new one if none is
  /// free. ModelError: as make_flow().
  [[nodiscard]] Loan borrow(FlowProblem& problem);

  /// Flows made so far.
  [[nodiscard]] std::size_t made() const;
  /// Flows on loan.
  [[nodiscard]] std::size_t lent() const;
  /// Counts of all flows together.
  [[nodiscard]] FlowCounts counts() const;

private:
  FlowMethod method_;
  double relative_tolerance_;
  std::map<std::tuple<std::size_t, std::size_t, bool>, Shelf> shelves_;
};

}  // namespace carom
