// Problem: few of many components are in the middle of a step at any time, and what steps take is large.

#include <carom/integrators/flow/flow_pool.h>

namespace carom {

void FlowPool::Return::operator()(Flow* flow) const noexcept { shelf_->free.push_back(flow); }

FlowPool::Loan FlowPool::borrow(FlowProblem& problem) {
  Shelf& shelf = shelves_[{problem.size(), problem.integrals(), problem.is_ballistic()}];
  if (shelf.free.empty()) {
    // Giving back must not fail.
    if (shelf.free.capacity() == shelf.flows.size()) shelf.free.reserve(2 * shelf.flows.size() + 1);
    shelf.flows.push_back(make_flow(method_, problem, relative_tolerance_));
    return {shelf.flows.back().get(), Return(shelf)};
  }
  Flow* const flow = shelf.free.back();
  flow->bind(problem);
  shelf.free.pop_back();
  return {flow, Return(shelf)};
}

std::size_t FlowPool::made() const {
  std::size_t sum = 0;
  for (const auto& [kind, shelf] : shelves_) sum += shelf.flows.size();
  return sum;
}

std::size_t FlowPool::lent() const {
  std::size_t sum = 0;
  for (const auto& [kind, shelf] : shelves_) sum += shelf.flows.size() - shelf.free.size();
  return sum;
}

FlowCounts FlowPool::counts() const {
  FlowCounts sum;
  for (const auto& [kind, shelf] : shelves_) {
    for (const auto& flow : shelf.flows) sum += flow->counts();
  }
  return sum;
}

}  // namespace carom
