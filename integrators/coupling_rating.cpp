#include <carom/core/difference_derivatives.h>
#include <carom/integrators/coupling_rating.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

namespace carom {

namespace {

/// Row sums of |L M^-1 K L^-1| and |L M^-1 C L^-1| of one set of derivatives.
struct RowSums {
  std::vector<double> stiffness, damping;

  explicit RowSums(Index size) : stiffness(size, 0.0), damping(size, 0.0) {}
};

double rate(double stiffness, double damping, double step) {
  return 0.25 * step * step * stiffness + 0.5 * step * damping;
}

/// Largest h with rate(h) <= 1/2.
double step_of_half(double stiffness, double damping) {
  const double root = damping + std::sqrt(damping * damping + 2.0 * stiffness);
  return root > 0.0 ? 2.0 / root : std::numeric_limits<double>::infinity();
}

class Rater {
public:
  Rater(const Assembly& assembly, Index island)
      : assembly_(assembly),
        first_(assembly.islands()[island].v.begin),
        sums_(assembly.islands()[island].v.size()),
        body_of_(sums_.stiffness.size()) {
    const Range bodies = assembly.islands()[island].bodies;
    for (Index body = bodies.begin; body < bodies.end; ++body) {
      const BodySlot& slot = assembly.layout()->bodies()[body];
      for (Index i = 0; i < slot.v_size; ++i) body_of_[slot.v + i - first_] = body;
    }
  }

  /// Takes the derivatives of one element; returns its own rate.
  double add(const std::vector<LoadDerivative>& entries, double step) {
    // Entries of equal place add up before their absolute value counts.
    std::vector<LoadDerivative> sorted = entries;
    const auto place = [this](const LoadDerivative& e) {
      return std::tuple(e.column, body_of_[e.row - first_], e.row);
    };
    std::sort(sorted.begin(), sorted.end(),
              [&](const LoadDerivative& a, const LoadDerivative& b) { return place(a) < place(b); });
    RowMap own;
    for (auto at = sorted.begin(); at != sorted.end();) {
      // All rows of one body in one column: a load, which M^-1 turns into an acceleration.
      const Index body = body_of_[at->row - first_];
      const Index column = at->column;
      const BodySlot& slot = assembly_.layout()->bodies()[body];
      std::vector<double> by_position(slot.v_size, 0.0), by_velocity(slot.v_size, 0.0);
      for (; at != sorted.end() && at->column == column && body_of_[at->row - first_] == body; ++at) {
        by_position[at->row - slot.v] += at->by_position;
        by_velocity[at->row - slot.v] += at->by_velocity;
      }
      const BodyKind& kind = *assembly_.body_kinds()[slot.kind];
      std::vector<double> a(slot.v_size), b(slot.v_size);
      kind.apply_inverse_mass({slot.slot, slot.slot + 1}, by_position.data(), a.data());
      kind.apply_inverse_mass({slot.slot, slot.slot + 1}, by_velocity.data(), b.data());
      const auto& lengths = assembly_.length_scales();
      for (Index i = 0; i < slot.v_size; ++i) {
        const double weight = lengths[slot.v + i] / lengths[column];
        own.add(slot.v + i, std::abs(a[i]) * weight, std::abs(b[i]) * weight);
      }
    }
    double worst = 0.0;
    for (const auto& [row, stiffness, damping] : own.rows) {
      sums_.stiffness[row - first_] += stiffness;
      sums_.damping[row - first_] += damping;
      worst = std::max(worst, rate(stiffness, damping, step));
    }
    return worst;
  }

  void finish(CouplingRating& rating, double step) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < sums_.stiffness.size(); ++row) {
      rating.island_rate = std::max(rating.island_rate, rate(sums_.stiffness[row], sums_.damping[row], step));
      smallest = std::min(smallest, step_of_half(sums_.stiffness[row], sums_.damping[row]));
    }
    rating.contracting_step = std::isfinite(smallest) ? smallest : 0.0;
  }

private:
  struct RowMap {
    struct Row {
      Index row;
      double stiffness, damping;
    };
    std::vector<Row> rows;

    void add(Index row, double stiffness, double damping) {
      const auto found = std::find_if(rows.begin(), rows.end(), [row](const Row& r) { return r.row == row; });
      if (found == rows.end()) {
        rows.push_back({row, stiffness, damping});
      } else {
        found->stiffness += stiffness;
        found->damping += damping;
      }
    }
  };

  const Assembly& assembly_;
  Index first_;
  RowSums sums_;
  std::vector<Index> body_of_;
};

}  // namespace

CouplingRating rate_couplings(const Assembly& assembly, Index island, const StateView& state,
                              const Evaluation& evaluation, double step) {
  const EvaluationContext at{assembly, state, evaluation, island};
  CouplingRating rating;
  Rater rater(assembly, island);
  std::vector<LoadDerivative> entries;
  std::optional<DifferenceDerivatives> differences;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *assembly.force_kinds()[kind];
    const Range elements = force.is_field() ? Range{} : assembly.elements(island, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      entries.clear();
      if (force.has_derivatives()) {
        force.derivatives(at, element, entries);
      } else {
        if (!differences) differences.emplace(at);
        differences->append(force, element, entries);
      }
      const double own = rater.add(entries, step);
      if (own > rating.rate) {
        rating.rate = own;
        rating.worst = assembly.element_id(kind, element);
      }
    }
  }
  rater.finish(rating, step);
  return rating;
}

namespace {

/// The first element of the island that `is_bad`, a function of (kind, element, context).
template <class F>
ElementId find_element(const Assembly& assembly, Index island, const StateView& state,
                       const Evaluation& evaluation, F&& is_bad) {
  const EvaluationContext at{assembly, state, evaluation, island};
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(island, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      if (is_bad(*assembly.force_kinds()[kind], Range{element, element + 1}, at)) {
        return assembly.element_id(kind, element);
      }
    }
  }
  return {};
}

}  // namespace

ElementId find_non_finite(const Assembly& assembly, Index island, const StateView& state,
                          const Evaluation& evaluation) {
  const Range v = assembly.islands()[island].v;
  std::vector<double> force(assembly.layout()->v_size(), 0.0);
  return find_element(assembly, island, state, evaluation,
                      [&](const ForceKind& kind, Range element, const EvaluationContext& at) {
                        std::fill(force.begin() + v.begin, force.begin() + v.end, 0.0);
                        kind.evaluate(at, element, {force.data(), force.data(), force.data()});
                        return !std::all_of(force.begin() + v.begin, force.begin() + v.end,
                                            [](double number) { return std::isfinite(number); });
                      });
}

ElementId find_non_finite_potential(const Assembly& assembly, Index island, const StateView& state,
                                    const Evaluation& evaluation) {
  return find_element(assembly, island, state, evaluation,
                      [](const ForceKind& kind, Range element, const EvaluationContext& at) {
                        return !std::isfinite(kind.potential(at, element));
                      });
}

}  // namespace carom
