#pragma once

/// \file
/// The problems of the report. Each function makes all the runs of its page.

#include "validation/report.h"

#include <array>
#include <functional>

namespace carom {
class Simulation;
}

namespace validation {

// Johansson's paper.
Page johansson_tables();   ///< section 4, figures 3 and 4
Page johansson_horak();    ///< section 5, figure 5
Page johansson_incline();  ///< section 6, figures 6 to 8
Page johansson_energy();   ///< section 3.3, the impact that gains energy

// Experiments.
Page foerster();
Page kharaz();

// Impacts and contact.
Page incline_variants();
Page bouncing_ball();
Page rolling();
Page friction();
Page ladder();
Page rocking_block();
Page impact_oscillator();
Page vibrating_table();
Page painleve();

// Contact problems by themselves.
Page three_solutions();
Page random_contacts();
Page several_bodies();
Page lcp_cases();

// Smooth motion.
Page mechanisms();
/// The page of mechanisms. \param watch sees each event-driven run of the windows before it begins
/// \param forty_until end of that of forty windows [s], which takes longer than all the others; up to 10 s
Page mechanisms(const std::function<void(carom::Simulation&)>& watch, double forty_until = 10.0);
Page springs();

// Error against step and cost.
Page convergence();

/// A problem of the report.
struct Problem {
  const char* name;  ///< of its page
  Page (*run)();
  bool quick;  ///< takes less than about half a second
};

/// All problems, in the order of the report.
inline constexpr std::array all_problems{
    Problem{"johansson_tables", johansson_tables, true},
    Problem{"johansson_horak", johansson_horak, false},
    Problem{"johansson_incline", johansson_incline, false},
    Problem{"johansson_energy", johansson_energy, true},
    Problem{"foerster", foerster, true},
    Problem{"kharaz", kharaz, true},
    Problem{"incline_variants", incline_variants, false},
    Problem{"bouncing_ball", bouncing_ball, false},
    Problem{"rolling", rolling, false},
    Problem{"friction", friction, false},
    Problem{"ladder", ladder, false},
    Problem{"rocking_block", rocking_block, false},
    Problem{"impact_oscillator", impact_oscillator, false},
    Problem{"vibrating_table", vibrating_table, false},
    Problem{"painleve", painleve, true},
    Problem{"three_solutions", three_solutions, false},
    Problem{"random_contacts", random_contacts, true},
    Problem{"several_bodies", several_bodies, true},
    Problem{"lcp_cases", lcp_cases, true},
    Problem{"mechanisms", mechanisms, false},
    Problem{"springs", springs, false},
    Problem{"convergence", convergence, false},
};

}  // namespace validation
