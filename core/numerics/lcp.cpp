// Problem: state a linear complementarity problem and judge its answers.

#include <carom/core/numerics/lcp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

void Lcp::reset(int n) {
  size = n;
  m.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
  q.assign(static_cast<std::size_t>(n), 0.0);
}

std::string_view to_string(LcpStatus status) {
  switch (status) {
    case LcpStatus::solved:
      return "solved";
    case LcpStatus::secondary_ray:
      return "secondary ray";
    case LcpStatus::pivot_bound:
      return "pivot bound";
    case LcpStatus::vanishing_pivot:
      return "vanishing pivot";
    case LcpStatus::inaccurate:
      return "inaccurate";
  }
  return "unknown status";
}

double lcp_residual(const Lcp& problem, std::span<const double> z) {
  const auto n = static_cast<std::size_t>(problem.size);
  double z_scale = 0.0;
  for (const double value : z) z_scale = std::max(z_scale, std::abs(value));

  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double w = problem.q[i], w_scale = std::abs(problem.q[i]);
    for (std::size_t j = 0; j < n; ++j) {
      w += problem.m[i * n + j] * z[j];
      w_scale = std::max(w_scale, std::abs(problem.m[i * n + j]) * z_scale);
    }
    const double error =
        std::abs(std::min(w_scale > 0.0 ? w / w_scale : w, z_scale > 0.0 ? z[i] / z_scale : z[i]));
    if (!std::isfinite(error) || !std::isfinite(w) || !std::isfinite(z[i])) {
      return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace carom
