// Problem: tell of forces along a line that has no direction before a run begins with them.

#include <carom/core/dynamics/force_directions.h>

#include <limits>
#include <vector>

namespace carom {

ElementId find_without_direction(const Assembly& assembly, Index component, const StateView& state,
                                 const Evaluation& evaluation, double fastest) {
  const EvaluationContext at{assembly, state, evaluation, component};
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(component, kind);
    const Index found = assembly.force_kinds()[kind]->first_without_direction(at, elements, fastest);
    if (found != elements.end) return assembly.element_id(kind, found);
  }
  return {};
}

std::string tell_without_direction(const Assembly& assembly, ElementId element) {
  const System& system = assembly.system();
  std::vector<BodyId> bodies;
  system.force_kinds().kind_of(element.serial).ends(system.force_kinds().place(element.serial).slot, bodies);
  std::string ends;
  for (const BodyId body : bodies) {
    ends += (ends.empty() ? "" : " and ") + (body == ground ? "ground" : system.name(body));
  }
  return "force of " + system.name(element) + " has no direction: its ends on " + ends +
         " stand at one place";
}

void demand_directions(const Assembly& assembly, const State& state) {
  Evaluation evaluation = make_evaluation(assembly);
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, state.view(), evaluation);
    const ElementId found = find_without_direction(assembly, component, state.view(), evaluation,
                                                   std::numeric_limits<double>::infinity());
    if (!found.valid()) continue;
    throw ModelError(tell_without_direction(assembly, found) +
                     "; allowed: ends apart, or an element whose force vanishes there (free_length 0)");
  }
}

}  // namespace carom
