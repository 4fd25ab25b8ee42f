// Problem: move bodies out of shapes on ground, and apart from each other, by the smallest displacement.

#include <carom/contact/separation.h>

#include <algorithm>
#include <cmath>

namespace carom {

/// No displacement yet.
void Separator::start(GapSource& gaps) {
  const Range v = gaps.velocities();
  if (displacement_.size() < v.end) displacement_.resize(v.end);
  if (towards_.size() < v.end) towards_.resize(v.end);
  std::fill(displacement_.begin() + v.begin, displacement_.begin() + v.end, 0.0);
  pushed_.clear();
  gaps.begin();
}

Separation Separator::separate(GapSource& gaps, SolverChain& chain) {
  // Gaps are linear in the coordinates but for turning bodies. The least displacement is then found by a part
  // of what is left from pass to pass, the smaller the less it turns; and bodies that are deep in something
  // touch with other features from pass to pass, and may do so without end. So at last each pass moves them
  // by the least from where the one before has left them, which squares what is left.
  constexpr int passes = 20, most_passes = 20 * passes;
  const double depth = gaps.rounding();
  const Range v = gaps.velocities();
  start(gaps);
  Separation result{.depth = depth};
  for (int pass = 0; pass < most_passes; ++pass) {
    // Bodies may have been moved too far: those contacts are open now, and looked at too.
    const std::span<Constraint> contacts = gaps.find(2.0 * result.shift);
    if (pass >= passes) start(gaps);
    const auto together_with = [&](Index body) { return gaps.first_together(body); };
    result.left = nullptr;
    double worst = 2.0 * depth;
    bool improved = false;
    for (const Range island : partition_.arrange(contacts, gaps.bodies(), together_with)) {
      const std::span<const Constraint> together = contacts.subspan(island.begin, island.size());
      at_hand_ = gaps.select(together);
      const bool moved = has_moved();
      look(together, worst, result);
      const bool deep = std::any_of(together.begin(), together.end(),
                                    [&](const Constraint& at) { return at.gap < -2.0 * depth; });
      // Contacts that push end closed: a pass that moves a body too far leaves them open by the square of
      // the way, and the next step is made without them.
      const bool open = moved && std::any_of(together.begin(), together.end(), [&](const Constraint& at) {
                          return at.gap > 0.0 && has_pushed(at.key);
                        });
      // Where turning bodies have been moved far their joints are off by the square of it.
      if (deep || open || (moved && gaps.is_off(2.0 * depth))) {
        improved = move(gaps, together, chain, depth) || improved;
      }
    }
    if (!improved) return result;
    result.moved = true;
    double shift = 0.0;
    for (Index i = v.begin; i < v.end; ++i)
      shift = std::max(shift, std::abs(displacement_[i]) * gaps.lengths()[i]);
    result.shift = pass < passes ? std::max(result.shift, shift) : result.shift + shift;
    gaps.update();
  }
  return result;
}

/// Notes the deepest contact. \param worst depth of the deepest so far [m]
void Separator::look(std::span<const Constraint> together, double& worst, Separation& out) const {
  for (const Constraint& contact : together) {
    if (-contact.gap <= worst) continue;
    worst = -contact.gap;
    out.left = &contact;
    out.together = together;
  }
}

/// True if any of the bodies at hand has been moved.
bool Separator::has_moved() const {
  return std::any_of(at_hand_.begin(), at_hand_.end(), [&](const Range& v) {
    return std::any_of(displacement_.begin() + v.begin, displacement_.begin() + v.end,
                       [](double number) { return number != 0.0; });
  });
}

/// True if a contact pushed in the last pass that moved its bodies.
bool Separator::has_pushed(const ConstraintKey& key) const {
  return std::binary_search(pushed_.begin(), pushed_.end(), key);
}

/// Notes which contacts push, by their multipliers.
void Separator::note_pushes(std::span<const Constraint> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto place = std::lower_bound(pushed_.begin(), pushed_.end(), contacts[i].key);
    const bool is_there = place != pushed_.end() && *place == contacts[i].key;
    if (multipliers_[i] > 0.0 && !is_there) pushed_.insert(place, contacts[i].key);
    if (!(multipliers_[i] > 0.0) && is_there) pushed_.erase(place);
  }
}

/// Makes a better estimate for the bodies of the island at hand; false if there is none.
bool Separator::move(GapSource& gaps, std::span<const Constraint> contacts, SolverChain& chain,
                     double depth) {
  for (const Range v : at_hand_) std::fill(towards_.begin() + v.begin, towards_.begin() + v.end, 0.0);
  gaps.close_joints(displacement_.data(), towards_.data());
  // W = G B G^T of the normal rows, each with y >= 0.
  normals_.clear();
  for (const Constraint& contact : contacts) normals_.push_back({&contact, 0});
  delassus_.build(normals_, gaps.response());
  problem_.reset(static_cast<int>(contacts.size()));
  delassus_.write(problem_.matrix().data());
  problem_.group();
  multipliers_.assign(contacts.size(), 0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem_.vector()[i] = contacts[i].gap + depth - contacts[i].times(0, displacement_.data()) +
                           contacts[i].times(0, towards_.data());
  }
  if (!chain.solve(problem_, multipliers_).usable()) return false;
  note_pushes(contacts);
  delassus_.add_response(multipliers_, towards_.data());
  for (const Range v : at_hand_)
    std::copy(towards_.begin() + v.begin, towards_.begin() + v.end, displacement_.begin() + v.begin);
  gaps.move(displacement_.data());
  return true;
}

}  // namespace carom
