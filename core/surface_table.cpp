#include <carom/core/surface_table.h>

#include <algorithm>
#include <cstdint>

namespace carom {

namespace {

void add(const Surface& law, Fingerprint& print) {
  print.add(law.friction);
  print.add(law.normal_restitution);
  print.add(law.tangential_restitution);
  // Nothing of what is not used: models without keep the fingerprints of earlier versions.
  if (law.impact_law != ImpactLaw::newton) print.add(to_string(law.impact_law));
  if (law.rolling_resistance > 0.0) {
    print.add("rolling resistance");
    print.add(law.rolling_resistance);
    print.add(law.rolling_restitution);
  }
  if (!law.has_static_friction()) return;
  print.add(law.static_friction);
  print.add(law.stribeck_speed);
}

}  // namespace

Index SurfaceTable::material(std::string_view name) {
  const auto found = std::find(materials_.begin(), materials_.end(), name);
  const auto number = static_cast<Index>(found - materials_.begin());
  if (found == materials_.end()) materials_.emplace_back(name);
  return number;
}

void SurfaceTable::set(Index a, Index b, const Surface& law) { pairs_[std::minmax(a, b)] = law; }

void SurfaceTable::set_own(Index own, const Surface& law) { own_.insert_or_assign(own, law); }
void SurfaceTable::remove_own(Index own) { own_.erase(own); }

const Surface* SurfaceTable::find(const ContactSide& a, const ContactSide& b) const {
  if (a.material != none && b.material != none) {
    if (const auto found = pairs_.find(std::minmax(a.material, b.material)); found != pairs_.end()) {
      return &found->second;
    }
  }
  for (const Index own : {a.own, b.own}) {
    if (const Surface* const law = find_own(own)) return law;
  }
  return default_ ? &*default_ : nullptr;
}

const Surface* SurfaceTable::find_own(Index own) const {
  const auto found = own_.find(own);
  return found == own_.end() ? nullptr : &found->second;
}

void SurfaceTable::fingerprint(Fingerprint& print) const {
  for (const auto& [pair, law] : pairs_) {
    print.add(std::uint64_t{pair.first});
    print.add(std::uint64_t{pair.second});
    add(law, print);
  }
  for (const auto& [own, law] : own_) {
    print.add(std::uint64_t{own});
    add(law, print);
  }
  // Nothing where there is none: models without a default keep the fingerprints of earlier versions.
  if (!default_) return;
  print.add("default law");
  add(*default_, print);
}

}  // namespace carom
