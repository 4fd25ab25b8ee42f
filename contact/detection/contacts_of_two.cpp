// Problem: which contacts two outlines have where corners of them meet.

#include <carom/contact/detection/contacts_of_two.h>

#include <cmath>

namespace carom {

void list_contacts(std::span<const GapPoint> nearest, const TwoOutlines& of) {
  using Adds = TwoOutlines::Adds;
  GapPoint first = nearest[0];
  std::optional<GapPoint> second;
  bool is_alone = nearest.size() < 2;
  if (const std::optional<CornerMeeting> meeting = of.corners_near(first)) {
    if (!leave_hidden_side(first, *meeting)) return;
    is_alone = is_alone || first.normal != nearest[0].normal;  // the other one is of the hidden side
    second = second_contact(first, *meeting);
  }
  const bool of_corners = second.has_value(), is_first = of.add(first, of_corners, Adds::if_it_touches),
             is_second = second && of.add(*second, true, Adds::if_it_touches);
  // Where one of two corners that meet touches, so does the other one.
  if (second && is_first != is_second && std::abs(first.gap - second->gap) <= of.same_place)
    of.add(is_first ? *second : first, true, Adds::anyway);
  // One of the same name as the second is of the same corner.
  if (is_alone || (second && of.have_one_name(*second, nearest[1]))) return;
  const GapPoint& far = nearest[1];
  if (!of.add(far, false, Adds::if_it_touches) || !second) return;
  const std::optional<CornerMeeting> meeting = of.corners_near(far);
  if (!meeting || meeting->a.hidden != HiddenSide::neither || meeting->b.hidden != HiddenSide::neither)
    return;
  if (const auto other = along_other_face(far, *meeting)) of.add(*other, false, Adds::if_it_touches);
}

}  // namespace carom
