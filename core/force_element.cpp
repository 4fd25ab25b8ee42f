#include <carom/core/force_element.h>

namespace carom {

void ForceElements::place_internal(std::span<const Index> first) {
  internal_.assign(first.begin(), first.end());
}

void ForceElements::check_bodies(const PartCheck& check, const std::vector<BodyId>& bodies) {
  if (bodies.empty()) check.refuse("number of bodies", "0", "at least one");
  bool only_ground = true;
  for (const BodyId body : bodies) {
    check.body(body, "body", true);
    only_ground = only_ground && body == ground;
  }
  if (only_ground) check.refuse("body", "ground", "at least one body of this system");
}

void ForceElements::append(const std::vector<BodyId>& bodies, std::vector<BodyId>& out) {
  out.insert(out.end(), bodies.begin(), bodies.end());
}

void ForceElements::add_bodies(Fingerprint& print, const std::vector<BodyId>& bodies) {
  print.add(std::uint64_t{bodies.size()});
  for (const BodyId body : bodies) print.add(std::uint64_t{body.serial});
}

}  // namespace carom
