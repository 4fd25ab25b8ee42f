#include <carom/core/errors.h>
#include <carom/integrators/contact_forces.h>

#include <string>

namespace carom {

namespace {

/// Adds the impulse of a record, which acts on its body. \param sign of the part
void add(const ContactRecord& contact, double sign, double step, PartForce& sum) {
  if (contact.directions > 2) {
    throw ModelError("force_on: a contact has " + std::to_string(contact.directions) +
                     " directions; allowed: contacts in the plane");
  }
  if (contact.directions < 2) return;  // limit of a joint
  const Vec<2> normal(contact.normal[0], contact.normal[1]), tangent(normal[1], -normal[0]);
  const Vec<2> impulse = sign * (contact.impulse[0] * normal + contact.impulse[1] * tangent);
  sum.impulse += impulse;
  sum.angular_impulse += contact.point[0] * impulse[1] - contact.point[1] * impulse[0];
  sum.angular_impulse += sign * contact.rolling_moment;
  if (contact.impact) {
    sum.impact_impulse += impulse;
  } else if (step > 0.0) {
    sum.mean_force += impulse / step;
  }
  ++sum.contacts;
}

}  // namespace

PartForce force_on(const StepReport& report, BodyId body) {
  PartForce sum;
  if (!body.valid()) return sum;
  for (const ContactRecord& contact : report.contacts) {
    if (contact.body == body) add(contact, 1.0, report.step, sum);
    if (contact.other == body) add(contact, -1.0, report.step, sum);
  }
  return sum;
}

PartForce force_on(const StepReport& report, ObstacleId obstacle) {
  PartForce sum;
  if (!obstacle.valid()) return sum;
  for (const ContactRecord& contact : report.contacts) {
    if (contact.obstacle == obstacle) add(contact, -1.0, report.step, sum);
  }
  return sum;
}

}  // namespace carom
