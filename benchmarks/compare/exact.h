#pragma once

/// \file
/// Motions that are known in closed form: spheres over or between horizontal planes and the bar over its
/// plane, as parabolas between impacts with Coulomb friction, a normal coefficient of restitution and no
/// tangential one.

#include "scenes.h"

namespace compare {

/// Whether a scene is known in closed form; the others have a run to tight tolerances beside them.
[[nodiscard]] bool has_closed_form(Scene scene);

/// Places and energies of a scene that is known in closed form.
[[nodiscard]] Seen exact(Scene scene, const Scale& scale);

}  // namespace compare
