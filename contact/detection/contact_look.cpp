#include <carom/contact/detection/contact_look.h>

namespace carom {

ContactLook::ContactLook(const Assembly& assembly, const Detector& detector)
    : assembly_(&assembly), detector_(&detector), evaluation_(make_evaluation(assembly)) {}

void ContactLook::find(const StateView& state, double margin, ConstraintSet& out, const GroundPlaces* after,
                       const LastingContacts* lasting, const ChosenBodies& bodies) {
  evaluate_positions(*assembly_, bodies, state, evaluation_);
  detector_->place(state.time, places_);
  out.clear();
  detector_->find_all({state, evaluation_, places_, after, margin, lasting, {}, bodies}, search_, out);
}

}  // namespace carom
