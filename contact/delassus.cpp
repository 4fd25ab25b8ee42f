// Problem: how impulses along the rows of constraints change the velocities along the same rows.

#include <carom/contact/delassus.h>
#include <carom/contact/one_body_products.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace carom {

/// Responses of one body that answers for itself, the usual case, in a tight loop. Returns the number of its
/// velocities, 0 if there is no such body.
int Delassus::build_of_one_body(const BodyResponse& response) {
  if (directions_.empty()) return 0;
  const Constraint::Block& block = directions_.front().constraint->blocks[0];
  const Constraint* last = nullptr;
  for (const ImpulseDirection& direction : directions_) {
    if (std::exchange(last, direction.constraint) == direction.constraint) continue;
    if (last->bodies != 1 || last->blocks[0].body != block.body) return 0;
  }
  const BodyMasses masses = response.alone(block.body);
  if (masses.mass == nullptr || masses.layout == BodyMasses::Layout::spatial_points) return 0;
  common_ = {block.v, block.v + static_cast<Index>(block.columns)};
  responses_.resize(size() * common_.size());
  if (masses.layout == BodyMasses::Layout::planar_points) {
    one_body::answer_alone<2>(directions_, masses.mass, masses.mass, responses_.data());
  } else {
    one_body::answer_alone<3>(directions_, masses.mass, masses.inertia, responses_.data());
  }
  return block.columns;
}

bool Delassus::build_of_one_contact(std::span<const ImpulseDirection> directions,
                                    const BodyResponse& response, double* matrix) {
  const Constraint& at = *directions.front().constraint;
  if (at.bodies != 1 || at.blocks[0].columns != static_cast<int>(one_body::of_planar_body)) return false;
  const BodyMasses masses = response.alone(at.body());
  if (masses.mass == nullptr || masses.layout != BodyMasses::Layout::planar_bodies) return false;
  directions_ = directions;
  loads_.clear();
  velocities_of_one_ = static_cast<int>(one_body::of_planar_body);
  common_ = {at.blocks[0].v, at.blocks[0].v + static_cast<Index>(one_body::of_planar_body)};
  responses_.resize(2 * one_body::of_planar_body);
  one_body::answer_contact(at, masses, responses_.data(), matrix);
  return true;
}

void Delassus::build(std::span<const ImpulseDirection> directions, BodyResponse& response) {
  directions_ = directions;
  loads_.clear();
  const std::size_t n = size();
  velocities_of_one_ = build_of_one_body(response);
  if (velocities_of_one_ != 0) return;
  if (held_.size() < n) held_.resize(n);
  if (find_common_reach(response)) {
    const std::size_t stride = common_.size();
    responses_.assign(n * stride, 0.0);
    for (std::size_t j = 0; j < n; ++j) write_column(j);
    if (n > 0) answer(directions_[0].constraint->body(), common_, 0, n, held_.data(), response);
    return;
  }
  lay_out(response);
  for (std::size_t j = 0; j < n; ++j) {
    write_column(j);
    held_[j] = 1;
    for (const Part& part : parts(j)) {
      char held = 0;
      answer(part.body, part.v, part.begin, 1, &held, response);
      if (held == 0) held_[j] = 0;
    }
  }
}

void Delassus::answer(Index body, Range v, std::size_t begin, std::size_t columns, char* held,
                      BodyResponse& response) {
  double* const x = responses_.data() + begin;
  for (std::size_t j = 0; j < columns; ++j) {
    if (!response.take_loads(body, x + j * v.size())) break;
    loads_.resize(responses_.size());
    std::copy_n(x + j * v.size(), v.size(), loads_.data() + begin + j * v.size());
  }
  response.answer(body, x, columns, held);
}

/// True if all columns reach the same velocities.
bool Delassus::find_common_reach(BodyResponse& response) {
  common_ = {};
  const Constraint* last = nullptr;
  Index body = none;
  for (const ImpulseDirection& direction : directions_) {
    if (direction.constraint == last) continue;
    last = direction.constraint;
    for (int b = 0; b < last->bodies; ++b) {
      const Index next = last->blocks[static_cast<std::size_t>(b)].body;
      if (next == body) continue;
      const Range reach = response.reach(next);
      if (body == none) common_ = reach;
      if (reach.begin != common_.begin) {
        common_ = {};
        return false;
      }
      body = next;
    }
  }
  return true;
}

/// Room for all responses, zero. Columns of one constraint reach the same bodies.
void Delassus::lay_out(BodyResponse& response) {
  const std::size_t n = size();
  first_part_.resize(n + 1);
  parts_.clear();
  std::size_t numbers = 0;
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t first = parts_.size();
    first_part_[j] = first;
    if (j == 0 || directions_[j].constraint != directions_[j - 1].constraint) {
      add_parts(j, response, numbers);
      continue;
    }
    for (std::size_t part = first_part_[j - 1]; part < first; ++part) {
      parts_.push_back(parts_[part]);
      parts_.back().begin = numbers;
      parts_.back().column = j;
      numbers += parts_.back().v.size();
    }
  }
  first_part_[n] = parts_.size();
  responses_.assign(numbers, 0.0);
  // Chains of parts that reach the same velocities: W is written without asking each column for each row.
  Index end = 0;
  for (const Part& part : parts_) end = std::max(end, part.v.end);
  last_part_.assign(end, no_part);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].before = std::exchange(last_part_[parts_[i].v.begin], i);
  }
}

/// One part for each reach of the bodies of a column.
void Delassus::add_parts(std::size_t column, BodyResponse& response, std::size_t& numbers) {
  const Constraint& constraint = *directions_[column].constraint;
  const std::size_t first = parts_.size();
  for (int b = 0; b < constraint.bodies; ++b) {
    const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
    const Range reach = response.reach(body);
    const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto same = [&](const Part& part) { return part.v.begin == reach.begin; };
    if (std::any_of(begin, parts_.end(), same)) continue;
    parts_.push_back({reach, numbers, body, column});
    numbers += reach.size();
  }
}

std::span<const Delassus::Part> Delassus::parts(std::size_t column) const {
  return {parts_.data() + first_part_[column], first_part_[column + 1] - first_part_[column]};
}

/// The part of a column that a velocity is in; null if it is in none.
const Delassus::Part* Delassus::part_of(std::size_t column, Index v) const {
  for (const Part& part : parts(column)) {
    if (v >= part.v.begin && v < part.v.end) return &part;
  }
  return nullptr;
}

/// A unit impulse along a column, over what it reaches.
void Delassus::write_column(std::size_t j) {
  const ImpulseDirection& direction = directions_[j];
  const Constraint& at = *direction.constraint;
  const double* number = at.row(direction.row);
  int before = 0;  // columns of the blocks before
  const Constraint::Block* block = at.blocks.data();
  for (int b = 0; b < at.bodies; ++b, ++block) {
    const Part* const part = common_.empty() ? part_of(j, block->v) : nullptr;
    const std::size_t begin = part == nullptr ? j * common_.size() + (block->v - common_.begin)
                                              : part->begin + (block->v - part->v.begin);
    double* const x = responses_.data() + begin;
    std::copy_n(number, block->columns, x);
    for_tangents(at, [&](std::size_t k, int row) {
      if (direction.ratios[k] == 0.0) return;
      const double* const tangent = at.row(row) + before;
      for (int c = 0; c < block->columns; ++c) x[c] += direction.ratios[k] * tangent[c];
    });
    if (direction.lever != 0.0 && block->columns == static_cast<int>(one_body::of_planar_body))
      x[one_body::of_planar_body - 1] += b == 0 ? direction.lever : -direction.lever;
    number += block->columns;
    before += block->columns;
  }
}

/// A product of a row and a column of a common reach.
double Delassus::entry(std::size_t i, std::size_t j) const {
  const std::size_t stride = common_.size();
  const double* const response = responses_.data() + j * stride;
  if (!loads_.empty()) {
    const double* const load = loads_.data() + i * stride;
    return std::inner_product(load, load + stride, response, 0.0);
  }
  const Constraint& at = *directions_[i].constraint;
  const double* h = at.row(directions_[i].row);
  double sum = 0.0;
  const Constraint::Block* block = at.blocks.data();
  for (int b = 0; b < at.bodies; ++b, ++block) {
    const double* of_block = response + (block->v - common_.begin);
    for (const double* const end = h + block->columns; h != end;) sum += *h++ * *of_block++;
  }
  return sum;
}

/// Products of rows and the columns that reach the same bodies; the others are zero.
void Delassus::write_by_parts(bool lower, double* matrix) const {
  const std::size_t n = size();
  std::fill_n(matrix, n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    double* const row = matrix + i * n;
    const auto add = [&](Index reach, Index offset, const double* h, std::size_t width) {
      for (std::size_t k = last_part_[reach]; k != no_part; k = parts_[k].before) {
        if (lower && parts_[k].column > i) continue;
        double& sum = row[parts_[k].column];
        const double* const response = responses_.data() + parts_[k].begin + offset;
        for (std::size_t c = 0; c < width; ++c) sum += h[c] * response[c];
      }
    };
    if (!loads_.empty()) {
      for (const Part& part : parts(i)) add(part.v.begin, 0, loads_.data() + part.begin, part.v.size());
    } else {
      const Constraint& at = *directions_[i].constraint;
      const double* h = at.row(directions_[i].row);
      for (int b = 0; b < at.bodies; ++b) {
        const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
        const Index reach = part_of(i, block.v)->v.begin;
        add(reach, block.v - reach, h, static_cast<std::size_t>(block.columns));
        h += block.columns;
      }
    }
    for (std::size_t j = 0; lower && j < i; ++j) matrix[j * n + i] = row[j];
  }
}

/// Writes W as it is, or its lower triangle, mirrored.
void Delassus::write_entries(bool lower, double* matrix) const {
  if (common_.empty()) return write_by_parts(lower, matrix);
  const std::size_t n = size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < (lower ? i + 1 : n); ++j) {
      matrix[i * n + j] = entry(i, j);
      if (lower) matrix[j * n + i] = matrix[i * n + j];
    }
  }
}

void Delassus::write_symmetric(double* matrix) const {
  if (velocities_of_one_ == 3) return one_body::multiply_symmetric<3>(directions_, responses_.data(), matrix);
  if (velocities_of_one_ == 2) return one_body::multiply_symmetric<2>(directions_, responses_.data(), matrix);
  write_entries(true, matrix);
  const std::size_t n = size();
  for (std::size_t row = 0; row < n; ++row) {
    if (held_[row] == 0) continue;
    for (std::size_t other = 0; other < n; ++other) matrix[row * n + other] = matrix[other * n + row] = 0.0;
  }
}

void Delassus::write(double* matrix) const {
  if (velocities_of_one_ == 3) return one_body::multiply<3>(directions_, responses_.data(), false, matrix);
  if (velocities_of_one_ == 2) return one_body::multiply<2>(directions_, responses_.data(), false, matrix);
  write_entries(false, matrix);
}

void Delassus::add_response(std::span<const double> impulses, double* x, double scale) const {
  if (velocities_of_one_ == 3)
    return one_body::add_alone<3>(responses_.data(), impulses.first(size()), scale, x + common_.begin);
  if (velocities_of_one_ == 2)
    return one_body::add_alone<2>(responses_.data(), impulses.first(size()), scale, x + common_.begin);
  const auto add = [&](const double* response, double impulse, Range v) {
    for (Index i = v.begin; i < v.end; ++i) x[i] += *response++ * impulse;
  };
  for (std::size_t column = 0; column < size(); ++column) {
    const double impulse = scale * impulses[column];
    if (!common_.empty()) {
      add(responses_.data() + column * common_.size(), impulse, common_);
      continue;
    }
    for (const Part& part : parts(column)) add(responses_.data() + part.begin, impulse, part.v);
  }
}

Index Delassus::reach_end() const {
  Index end = common_.end;
  for (const Part& part : parts_) end = std::max(end, part.v.end);
  return end;
}

}  // namespace carom
