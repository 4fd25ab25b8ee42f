// Problem: must contacts between bodies be looked for at all?

#include <carom/contact/detection/touching_kinds.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

namespace carom {

namespace {

/// Material, groups and touched groups, and whether it is a point: outlines alike in these touch the same
/// ones.
using Kind = std::tuple<Index, std::uint32_t, std::uint32_t, bool>;
using Members = std::vector<Index>;

/// Pairs of kinds that are looked at, for each outline.
constexpr std::size_t looks_per_outline = 64;

Kind kind_of(const BodyOutline& outline) {
  return {outline.material, outline.filter.groups, outline.filter.touches, outline.is_point()};
}

/// True if two bodies have outlines of two kinds, and nothing parts them. As many pairs are looked at as are
/// parted, and those of one body.
bool any_pair(const std::vector<BodyOutline>& list, const PairFilter& filter, const Members& one,
              const Members& other) {
  return std::any_of(one.begin(), one.end(), [&](Index i) {
    return std::any_of(other.begin(), other.end(), [&](Index j) {
      return list[i].body != list[j].body && !filter.is_excluded(list[i].body, list[j].body);
    });
  });
}

}  // namespace

TouchingKinds touching_kinds(const std::vector<BodyOutline>& list, const PairFilter& filter,
                             FunctionRef<bool(const BodyOutline&, const BodyOutline&)> may_touch) {
  std::map<Kind, Members> kinds;
  for (Index i = 0; i < list.size(); ++i) kinds[kind_of(list[i])].push_back(i);
  TouchingKinds found{.any = false, .all = !list.empty() && !filter.excludes_any()};
  // Where each outline is of a kind of its own, their pairs are more than it costs to look for contacts.
  std::size_t looks = looks_per_outline * list.size();
  for (auto one = kinds.begin(); one != kinds.end(); ++one) {
    for (auto other = one; other != kinds.end(); ++other) {
      if (found.any && !found.all) return found;  // nothing more can change it
      if (looks-- == 0) return {.any = true, .all = false};
      const Members &a = one->second, &b = other->second;
      if (may_touch(list[a.front()], list[b.front()])) {
        found.any = found.any || any_pair(list, filter, a, b);
      } else {
        found.all = false;
      }
    }
  }
  return found;
}

}  // namespace carom
