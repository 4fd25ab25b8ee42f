#pragma once

/// \file
/// Identities of constraints in a checkpoint.

#include <carom/core/constraint.h>
#include <carom/core/ids.h>
#include <carom/integrators/checkpoint_bytes.h>

#include <cstdint>

namespace carom {

/// Writes the identity of a feature.
inline void add(CheckpointWriter& out, const FeatureKey& key) {
  out.add(std::uint64_t{static_cast<std::uint8_t>(key.owner)});
  out.add(std::uint64_t{key.serial});
  out.add(std::uint64_t{key.feature});
}

/// Reads the identity of a feature.
inline void get(CheckpointReader& in, FeatureKey& key) {
  std::uint64_t owner = 0, serial = 0, feature = 0;
  in.get(owner);
  in.get(serial);
  in.get(feature);
  if (owner > static_cast<std::uint64_t>(FeatureKey::Owner::joint))
    in.damaged("a contact has an unknown owner");
  key = {static_cast<FeatureKey::Owner>(owner), static_cast<Index>(serial), static_cast<Index>(feature)};
}

/// Writes the identity of a constraint.
inline void add(CheckpointWriter& out, const ConstraintKey& key) {
  add(out, key.a);
  add(out, key.b);
}

/// Reads the identity of a constraint.
inline void get(CheckpointReader& in, ConstraintKey& key) {
  get(in, key.a);
  get(in, key.b);
}

}  // namespace carom
