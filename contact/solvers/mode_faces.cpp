#include <carom/contact/solvers/mode_faces.h>
#include <carom/contact/solvers/solution_list.h>

#include <cmath>

namespace carom {

bool ModeFaces::build(const ContactProblem& problem) {
  const std::size_t n = problem.groups().size();
  if (n > static_cast<std::size_t>(enumeration_groups)) return false;
  faces_.resize(n);
  groups_.assign(problem.groups().begin(), problem.groups().end());
  for (std::size_t g = 0; g < n; ++g) {
    const RowGroup& group = problem.groups()[g];
    auto& faces = faces_[g];
    faces.clear();
    const RowSet& own = problem.sets()[static_cast<std::size_t>(group.first)];
    if (group.size > 2) return false;
    if (group.size == 2) {
      const RowSet& friction = problem.sets()[static_cast<std::size_t>(group.first) + 1];
      const bool slides = friction.kind == SetKind::proportional;
      if (own.kind != SetKind::half_line) return false;
      if (!slides && friction.kind != SetKind::bounded_interval) return false;
      const double mu = friction.coefficient;
      faces.push_back({});  // open
      if (mu > 0.0 && !slides) {
        faces.push_back({0.0, 2, 0.0, 2, true});   // stick
        faces.push_back({0.0, 1, -mu, 1, true});   // slip+
        faces.push_back({0.0, 1, mu, 1, true});    // slip-
        faces.push_back({0.0, 1, -mu, 2, false});  // friction exhausted without slip
        faces.push_back({0.0, 1, mu, 2, false});
      } else {
        faces.push_back({0.0, 1, mu, 1, true});  // slides, or has no friction
      }
      faces.push_back({0.0, 0, 0.0, 1, false});  // touching without impulse
      continue;
    }
    const bool half_line = own.kind == SetKind::half_line;
    faces.push_back({0.0, 1, 0.0, 1, true});  // no velocity
    for (const double bound : {half_line ? 0.0 : own.lower, half_line ? own.lower : own.upper}) {
      if (!std::isfinite(bound) || (half_line && faces.size() > 1)) continue;
      faces.push_back({bound, 0, 0.0, 0, true});   // at a bound, moving
      faces.push_back({bound, 0, 0.0, 1, false});  // at a bound without velocity
    }
  }
  return true;
}

ModeFaces::Size ModeFaces::size(std::span<const std::size_t> choice) const {
  Size size;
  for (std::size_t g = 0; g < choice.size(); ++g) {
    const Face& face = faces_[g][choice[g]];
    size.unknowns += static_cast<std::size_t>(face.unknowns);
    size.equations += static_cast<std::size_t>(face.equations);
    size.pure = size.pure && face.pure;
  }
  return size;
}

void ModeFaces::write_equations(const ContactProblem& problem, std::span<const std::size_t> choice,
                                std::span<const double> rho, std::vector<double>& system,
                                std::vector<double>& rhs) const {
  const std::size_t n = choice.size(), rows = rho.size();
  const Size shape = size(choice);
  system.assign(shape.equations * shape.unknowns, 0.0);
  rhs.assign(shape.equations, 0.0);
  std::size_t equation = 0;
  for (std::size_t g = 0; g < n; ++g) {
    for (int e = 0; e < faces_[g][choice[g]].equations; ++e, ++equation) {
      const auto row = static_cast<std::size_t>(groups_[g].first + e);
      const double weight = std::sqrt(rho[row]);
      double sum = problem.vector()[row];
      std::size_t k = 0;
      for (std::size_t h = 0; h < n; ++h) {
        const Face& face = faces_[h][choice[h]];
        const auto column = static_cast<std::size_t>(groups_[h].first);
        const double* w = problem.matrix().data() + row * rows;
        sum += w[column] * face.offset;
        if (face.unknowns == 1) {
          const double tangential = groups_[h].size == 2 ? face.slope * w[column + 1] : 0.0;
          system[equation * shape.unknowns + k++] = weight * (w[column] + tangential);
        } else if (face.unknowns == 2) {
          system[equation * shape.unknowns + k++] = weight * w[column];
          system[equation * shape.unknowns + k++] = weight * w[column + 1];
        }
      }
      rhs[equation] = -weight * sum;
    }
  }
}

void ModeFaces::place(std::span<const std::size_t> choice, std::span<const double> x,
                      std::span<double> impulses) const {
  std::size_t k = 0;
  for (std::size_t g = 0; g < choice.size(); ++g) {
    const Face& face = faces_[g][choice[g]];
    const auto row = static_cast<std::size_t>(groups_[g].first);
    impulses[row] = face.unknowns > 0 ? x[k++] : 0.0;
    if (groups_[g].size == 2) {
      impulses[row + 1] = face.unknowns == 2 ? x[k++] : face.slope * impulses[row];
    }
  }
}

void ModeFaces::add_offsets(std::span<const std::size_t> choice, std::span<double> impulses) const {
  for (std::size_t g = 0; g < choice.size(); ++g) {
    impulses[static_cast<std::size_t>(groups_[g].first)] += faces_[g][choice[g]].offset;
  }
}

}  // namespace carom
