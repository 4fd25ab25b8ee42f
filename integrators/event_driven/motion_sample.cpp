// Problem: memory of a sample, for the largest component as for all.

#include <carom/integrators/event_driven/motion_sample.h>

namespace carom {

MotionSample::MotionSample(const Assembly& assembly)
    : state(assembly.layout()), evaluation(make_evaluation(assembly)) {
  for (std::vector<double>* array : {&dissipative, &external, &loads, &acceleration}) {
    array->assign(state.v.size(), 0.0);
  }
}

}  // namespace carom
