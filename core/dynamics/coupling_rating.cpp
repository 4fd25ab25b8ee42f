#include <carom/core/difference_derivatives.h>
#include <carom/core/dynamics/coupling_rating.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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

/// Collects the derivatives of one element after the other. Allocates only while elements grow.
class Rater {
public:
  Rater(const Assembly& assembly, Index component)
      : assembly_(assembly),
        first_(assembly.components()[component].v.begin),
        sums_(assembly.components()[component].v.size()),
        body_of_(sums_.stiffness.size()) {
    const Range bodies = assembly.components()[component].bodies;
    for (Index body = bodies.begin; body < bodies.end; ++body) {
      const BodySlot& slot = assembly.layout()->bodies()[body];
      const BodyKind& kind = *assembly.body_kinds()[slot.kind];
      for (Index i = 0; i < slot.v_size; ++i) {
        body_of_[slot.v + i - first_] = body;
        lengths_.push_back(kind.length_scale(slot.slot, i));
      }
    }
  }

  /// Takes the derivatives of one element; returns its own rate.
  double add(const std::vector<LoadDerivative>& entries, double step) {
    blocks_.clear();
    size_ = 0;
    for (const LoadDerivative& entry : entries) {
      (void)place(entry.row);
      (void)place(entry.column);
    }
    // Entries of equal place add up before their absolute value counts.
    by_position_.assign(std::size_t{size_} * size_, 0.0);
    by_velocity_.assign(std::size_t{size_} * size_, 0.0);
    for (const LoadDerivative& entry : entries) {
      // Column by column, so that those of one body stand together as a load.
      const std::size_t at = std::size_t{place(entry.column)} * size_ + place(entry.row);
      by_position_[at] += entry.by_position;
      by_velocity_[at] += entry.by_velocity;
    }

    double worst = 0.0;
    for (const Block& rows : blocks_) {
      const BodySlot& slot = assembly_.layout()->bodies()[rows.body];
      const BodyKind& kind = *assembly_.body_kinds()[slot.kind];
      stiffness_.assign(slot.v_size, 0.0);
      damping_.assign(slot.v_size, 0.0);
      acceleration_.resize(slot.v_size);
      const auto take = [&](const std::vector<double>& derivatives, std::size_t column, double length,
                            std::vector<double>& sums) {
        kind.apply_inverse_mass({slot.slot, slot.slot + 1}, derivatives.data() + column * size_ + rows.first,
                                acceleration_.data());
        for (Index i = 0; i < slot.v_size; ++i) {
          sums[i] += std::abs(acceleration_[i]) * lengths_[slot.v + i - first_] / length;
        }
      };
      for (const Block& columns : blocks_) {
        const BodySlot& other = assembly_.layout()->bodies()[columns.body];
        for (Index i = 0; i < other.v_size; ++i) {
          take(by_position_, columns.first + i, lengths_[other.v + i - first_], stiffness_);
          take(by_velocity_, columns.first + i, lengths_[other.v + i - first_], damping_);
        }
      }
      for (Index i = 0; i < slot.v_size; ++i) {
        sums_.stiffness[slot.v + i - first_] += stiffness_[i];
        sums_.damping[slot.v + i - first_] += damping_[i];
        worst = std::max(worst, rate(stiffness_[i], damping_[i], step));
      }
    }
    return worst;
  }

  void finish(CouplingRating& rating, double step) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < sums_.stiffness.size(); ++row) {
      rating.component_rate =
          std::max(rating.component_rate, rate(sums_.stiffness[row], sums_.damping[row], step));
      smallest = std::min(smallest, step_of_half(sums_.stiffness[row], sums_.damping[row]));
    }
    rating.contracting_step = std::isfinite(smallest) ? smallest : 0.0;
  }

private:
  /// A body of the element at hand: its velocities stand at first, first + 1, ... of the small matrices.
  struct Block {
    Index body;
    Index first;
  };

  /// Place of a velocity coordinate in the small matrices.
  Index place(Index coordinate) {
    const Index body = body_of_[coordinate - first_];
    const BodySlot& slot = assembly_.layout()->bodies()[body];
    for (const Block& block : blocks_) {
      if (block.body == body) return block.first + (coordinate - slot.v);
    }
    blocks_.push_back({body, size_});
    size_ += slot.v_size;
    return blocks_.back().first + (coordinate - slot.v);
  }

  const Assembly& assembly_;
  Index first_;
  RowSums sums_;
  std::vector<double> lengths_;  // by which changes are weighed (BodyKind::length_scale)
  std::vector<Index> body_of_;
  std::vector<Block> blocks_;
  Index size_ = 0;
  std::vector<double> by_position_, by_velocity_, stiffness_, damping_, acceleration_;
};

}  // namespace

CouplingRating rate_couplings(const Assembly& assembly, Index component, const StateView& state,
                              const Evaluation& evaluation, double step) {
  const EvaluationContext at{assembly, state, evaluation, component};
  CouplingRating rating;
  Rater rater(assembly, component);
  std::vector<LoadDerivative> entries;
  std::optional<DifferenceDerivatives> differences;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *assembly.force_kinds()[kind];
    const Range elements = force.is_field() ? Range{} : assembly.elements(component, kind);
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

/// The first element of a range for which `is_bad`, a function of ranges, is true; that of a range is true if
/// it is for an element of it. Halves are asked, since a question costs a look at the loads of all bodies.
template <class F>
std::optional<Index> first_bad(Range elements, const F& is_bad) {
  if (elements.empty() || !is_bad(elements)) return {};
  if (elements.size() == 1) return elements.begin;
  const Index middle = elements.begin + elements.size() / 2;
  const std::optional<Index> found = first_bad({elements.begin, middle}, is_bad);
  return found ? found : first_bad({middle, elements.end}, is_bad);
}

/// The first element of the component for which `is_bad`, a function of (kind, elements, context), is true.
template <class F>
ElementId find_element(const Assembly& assembly, Index component, const StateView& state,
                       const Evaluation& evaluation, F&& is_bad) {
  const EvaluationContext at{assembly, state, evaluation, component};
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const auto of_kind = [&](Range elements) { return is_bad(*assembly.force_kinds()[kind], elements, at); };
    const std::optional<Index> found = first_bad(assembly.elements(component, kind), of_kind);
    if (found) return assembly.element_id(kind, *found);
  }
  return {};
}

}  // namespace

ElementId find_non_finite(const Assembly& assembly, Index component, const StateView& state,
                          const Evaluation& evaluation) {
  const Range v = assembly.components()[component].v;
  std::vector<double> force(assembly.layout()->v_size(), 0.0);
  return find_element(assembly, component, state, evaluation,
                      [&](const ForceKind& kind, Range elements, const EvaluationContext& at) {
                        std::fill(force.begin() + v.begin, force.begin() + v.end, 0.0);
                        kind.evaluate(at, elements, {force.data(), force.data(), force.data()});
                        return !std::all_of(force.begin() + v.begin, force.begin() + v.end,
                                            [](double number) { return std::isfinite(number); });
                      });
}

ElementId find_non_finite_potential(const Assembly& assembly, Index component, const StateView& state,
                                    const Evaluation& evaluation) {
  return find_element(assembly, component, state, evaluation,
                      [](const ForceKind& kind, Range elements, const EvaluationContext& at) {
                        return !std::isfinite(kind.potential(at, elements));
                      });
}

}  // namespace carom
