#include <carom/core/errors.h>
#include <carom/integrators/contact_forces.h>
#include <carom/integrators/forces_of_step.h>

#include <algorithm>
#include <map>
#include <string>

namespace carom {

namespace {

using Numbers = std::array<double, 3>;

/// An impulse, or a force, in the plane, and its moment about the origin.
struct Action {
  Vec<2> sum = filled<2>(0.0);
  double moment = 0.0;

  /// \param along normal and tangent \param rolling moment \param sign of the part
  Action(const ContactPlace& at, const Numbers& along, double rolling, double sign) {
    if (at.directions > 2) {
      throw ModelError("force_on: a contact has " + std::to_string(at.directions) +
                       " directions; allowed: contacts in the plane");
    }
    sum = sign * at.vector_of(along).head<2>();
    moment = at.point[0] * sum[1] - at.point[1] * sum[0] + sign * rolling;
  }
};

/// Adds the impulse of a record, which acts on its body. \param sign of the part
void add(const ContactRecord& contact, double sign, double step, PartForce& out) {
  if (contact.directions < 2) return;  // limit of a joint
  const Action impulse(contact, contact.impulse, contact.rolling_moment, sign);
  out.impulse += impulse.sum;
  out.angular_impulse += impulse.moment;
  if (contact.impact) {
    out.impact_impulse += impulse.sum;
  } else if (step > 0.0) {
    out.mean_force += impulse.sum / step;
    out.mean_moment += impulse.moment / step;
  }
  ++out.contacts;
}

void add(const LastingContact& contact, double sign, PartForce& out) {
  const Action force(contact, contact.force, contact.rolling_moment, sign);
  out.mean_force += force.sum;
  out.mean_moment += force.moment;
  ++out.contacts;
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

PartForce force_on(std::span<const LastingContact> forces, BodyId body) {
  PartForce sum;
  if (!body.valid()) return sum;
  for (const LastingContact& contact : forces) {
    if (contact.body == body) add(contact, 1.0, sum);
    if (contact.other == body) add(contact, -1.0, sum);
  }
  return sum;
}

PartForce force_on(std::span<const LastingContact> forces, ObstacleId obstacle) {
  PartForce sum;
  if (!obstacle.valid()) return sum;
  for (const LastingContact& contact : forces) {
    if (contact.obstacle == obstacle) add(contact, -1.0, sum);
  }
  return sum;
}

bool is_parted(const StepReport& report) {
  return std::any_of(report.contacts.begin(), report.contacts.end(),
                     [&](const ContactRecord& contact) { return contact.time != report.time; });
}

std::vector<LastingContact> forces_of_step(const StepReport& report) {
  std::vector<LastingContact> out;
  const bool parted = is_parted(report);
  std::map<ConstraintKey, std::size_t> places;  // in `out`
  for (const ContactRecord& contact : report.contacts) {
    if (contact.impact || !(report.step > 0.0)) continue;
    const std::size_t place = parted ? places.try_emplace(contact.key, out.size()).first->second : out.size();
    if (place == out.size()) out.emplace_back();
    LastingContact& force = out[place];
    static_cast<ContactPlace&>(force) = contact;
    force.velocity = contact.velocity_after;
    for (std::size_t row = 0; row < 3; ++row) force.force[row] += contact.impulse[row] / report.step;
    force.rolling_moment += contact.rolling_moment / report.step;
    force.mode = contact.mode;
  }
  return out;
}

std::vector<LastingContact> lasting_forces(const StepReport& report) {
  std::vector<LastingContact> forces = forces_of_step(report);
  std::erase_if(forces, [](const LastingContact& force) { return force.directions < 2; });  // limits
  return forces;
}

}  // namespace carom
