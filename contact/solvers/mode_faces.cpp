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
    if (group.size > 1) {
      if (!add_contact(problem, group, faces)) return false;
      continue;
    }
    const bool half_line = own.kind == SetKind::half_line;
    faces.push_back({.carries = true, .vanishes = {true}});  // no velocity
    for (const double bound : {half_line ? 0.0 : own.lower, half_line ? own.lower : own.upper}) {
      if (!std::isfinite(bound) || (half_line && faces.size() > 1)) continue;
      faces.push_back({.offset = bound});                                     // at a bound, moving
      faces.push_back({.offset = bound, .vanishes = {true}, .pure = false});  // at a bound without velocity
    }
  }
  return true;
}

/// Faces of a contact: open; closed, in every mode of its friction rows; touching without impulse. False
/// where it cannot be enumerated.
bool ModeFaces::add_contact(const ContactProblem& problem, const RowGroup& group,
                            std::vector<Face>& faces) const {
  const auto first = static_cast<std::size_t>(group.first);
  const std::size_t rows = static_cast<std::size_t>(group.size) - 1;
  if (problem.sets()[first].kind != SetKind::half_line || rows > Face::most_rows) return false;
  faces.push_back({});  // open
  std::vector<Face> closed{{.carries = true, .vanishes = {true}}};
  for (std::size_t k = 0; k < rows; ++k) {
    const RowSet& friction = problem.sets()[first + 1 + k];
    const bool slides = friction.kind == SetKind::proportional;
    if (!slides && friction.kind != SetKind::bounded_interval) return false;
    const double mu = friction.coefficient;
    if (slides || !(mu > 0.0)) {  // slides, or has no friction
      for (Face& face : closed) face.slope[k] = mu;
      continue;
    }
    const std::vector<Face> before = closed;
    closed.clear();
    for (const Face& face : before) {
      Face sticks = face;
      sticks.free[k] = sticks.vanishes[1 + k] = true;
      closed.push_back(sticks);
      for (const bool exhausted : {false, true}) {  // slip+ and slip-; friction exhausted without slip
        for (const double slope : {-mu, mu}) {
          Face& moves = closed.emplace_back(face);
          moves.slope[k] = slope;
          moves.vanishes[1 + k] = exhausted;
          moves.pure = face.pure && !exhausted;
        }
      }
    }
  }
  faces.insert(faces.end(), closed.begin(), closed.end());
  faces.push_back({.vanishes = {true}, .pure = false});  // touching without impulse
  return true;
}

ModeFaces::Size ModeFaces::size(std::span<const std::size_t> choice) const {
  Size size;
  for (std::size_t g = 0; g < choice.size(); ++g) {
    const Face& face = faces_[g][choice[g]];
    if (face.carries) ++size.unknowns;
    for (const bool free : face.free) size.unknowns += free ? 1 : 0;
    for (const bool vanishes : face.vanishes) size.equations += vanishes ? 1 : 0;
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
    for (std::size_t e = 0; e < 1 + Face::most_rows; ++e) {
      if (!faces_[g][choice[g]].vanishes[e]) continue;
      const std::size_t row = static_cast<std::size_t>(groups_[g].first) + e;
      const double weight = std::sqrt(rho[row]);
      double sum = problem.vector()[row];
      std::size_t k = equation * shape.unknowns;
      for (std::size_t h = 0; h < n; ++h) {
        const Face& face = faces_[h][choice[h]];
        const double* w = problem.matrix().data() + row * rows + static_cast<std::size_t>(groups_[h].first);
        const std::size_t friction = static_cast<std::size_t>(groups_[h].size) - 1;
        sum += w[0] * face.offset;
        if (!face.carries) continue;
        double along = 0.0;
        for (std::size_t i = 0; i < friction; ++i) along += face.slope[i] * w[1 + i];
        system[k++] = weight * (w[0] + along);
        for (std::size_t i = 0; i < friction; ++i) {
          if (face.free[i]) system[k++] = weight * w[1 + i];
        }
      }
      rhs[equation++] = -weight * sum;
    }
  }
}

void ModeFaces::place(std::span<const std::size_t> choice, std::span<const double> x,
                      std::span<double> impulses) const {
  std::size_t k = 0;
  for (std::size_t g = 0; g < choice.size(); ++g) {
    const Face& face = faces_[g][choice[g]];
    const auto row = static_cast<std::size_t>(groups_[g].first);
    const std::size_t friction = static_cast<std::size_t>(groups_[g].size) - 1;
    impulses[row] = face.carries ? x[k++] : 0.0;
    for (std::size_t i = 0; i < friction; ++i)
      impulses[row + 1 + i] = face.free[i] ? x[k++] : face.slope[i] * impulses[row];
  }
}

void ModeFaces::add_offsets(std::span<const std::size_t> choice, std::span<double> impulses) const {
  for (std::size_t g = 0; g < choice.size(); ++g) {
    impulses[static_cast<std::size_t>(groups_[g].first)] += faces_[g][choice[g]].offset;
  }
}

}  // namespace carom
