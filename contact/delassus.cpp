// Problem: how impulses along the rows of constraints change the velocities along the same rows.

#include <carom/contact/delassus.h>

#include <algorithm>
#include <numeric>

namespace carom {

void Delassus::build(std::span<const ImpulseDirection> directions, BodyResponse& response) {
  directions_ = directions;
  loads_.clear();
  lay_out(response);
  for (std::size_t j = 0; j < size(); ++j) {
    write_column(j);
    bool moves = false;
    for (std::size_t part = columns_[j].first_part; part < columns_[j + 1].first_part; ++part) {
      const Part& at = parts_[part];
      double* const x = responses_.data() + at.begin;
      if (response.take_loads(at.body, x)) {
        loads_.resize(responses_.size());
        std::copy_n(x, at.v.size(), loads_.data() + at.begin);
      }
      moves = response.answer(at.body, x) || moves;
    }
    columns_[j].held = !moves;
  }
}

/// Room for all responses, zero. Columns of one constraint reach the same bodies.
void Delassus::lay_out(BodyResponse& response) {
  const std::size_t n = size();
  columns_.resize(n + 1);
  parts_.clear();
  std::size_t numbers = 0;
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t first = parts_.size();
    columns_[j].first_part = first;
    if (j == 0 || directions_[j].constraint != directions_[j - 1].constraint) {
      add_parts(*directions_[j].constraint, response, numbers);
      continue;
    }
    for (std::size_t part = columns_[j - 1].first_part; part < first; ++part) {
      parts_.push_back(parts_[part]);
      parts_.back().begin = numbers;
      numbers += parts_.back().v.size();
    }
  }
  columns_[n].first_part = parts_.size();
  responses_.assign(numbers, 0.0);
}

/// One part for each reach of the bodies of a constraint.
void Delassus::add_parts(const Constraint& constraint, BodyResponse& response, std::size_t& numbers) {
  const std::size_t first = parts_.size();
  for (int b = 0; b < constraint.bodies; ++b) {
    const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
    const Range reach = response.reach(body);
    const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto same = [&](const Part& part) { return part.v.begin == reach.begin; };
    if (std::any_of(begin, parts_.end(), same)) continue;
    parts_.push_back({reach, numbers, body});
    numbers += reach.size();
  }
}

/// The part of a column that a velocity is in; null if it is in none.
const Delassus::Part* Delassus::part_of(std::size_t column, Index v) const {
  for (std::size_t part = columns_[column].first_part; part < columns_[column + 1].first_part; ++part) {
    if (v >= parts_[part].v.begin && v < parts_[part].v.end) return &parts_[part];
  }
  return nullptr;
}

/// A unit impulse along a column, over what it reaches.
void Delassus::write_column(std::size_t j) {
  const ImpulseDirection& direction = directions_[j];
  const Constraint& at = *direction.constraint;
  const double* number = at.row(direction.row);
  const double* tangent = at.row(at.tangent_row());
  for (int b = 0; b < at.bodies; ++b) {
    const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
    const Part& part = *part_of(j, block.v);
    double* const x = responses_.data() + part.begin + (block.v - part.v.begin);
    for (int c = 0; c < block.columns; ++c) x[c] = number[c];
    if (direction.ratio != 0.0) {
      for (int c = 0; c < block.columns; ++c) x[c] += direction.ratio * tangent[c];
    }
    number += block.columns;
    tangent += block.columns;
  }
}

double Delassus::product(const Constraint& at, int row, std::size_t j) const {
  double sum = 0.0;
  const double* h = at.row(row);
  for (int b = 0; b < at.bodies; ++b) {
    const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
    if (const Part* const part = part_of(j, block.v)) {
      const double* const response = responses_.data() + part->begin + (block.v - part->v.begin);
      for (int c = 0; c < block.columns; ++c) sum += h[c] * response[c];
    }
    h += block.columns;
  }
  return sum;
}

double Delassus::entry(std::size_t i, std::size_t j) const {
  if (loads_.empty()) return product(*directions_[i].constraint, directions_[i].row, j);
  double sum = 0.0;
  for (std::size_t part = columns_[i].first_part; part < columns_[i + 1].first_part; ++part) {
    for (std::size_t other = columns_[j].first_part; other < columns_[j + 1].first_part; ++other) {
      if (parts_[part].v.begin != parts_[other].v.begin) continue;
      const double* const load = loads_.data() + parts_[part].begin;
      sum = std::inner_product(load, load + parts_[part].v.size(), responses_.data() + parts_[other].begin,
                               sum);
    }
  }
  return sum;
}

void Delassus::write_symmetric(double* matrix) const {
  const std::size_t n = size();
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      const double w = is_held(row) || is_held(column) ? 0.0 : entry(row, column);
      matrix[row * n + column] = matrix[column * n + row] = w;
    }
  }
}

void Delassus::write(double* matrix) const {
  const std::size_t n = size();
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) matrix[row * n + column] = entry(row, column);
  }
}

void Delassus::add_response(std::size_t column, double impulse, double* x) const {
  for (std::size_t part = columns_[column].first_part; part < columns_[column + 1].first_part; ++part) {
    const double* const response = responses_.data() + parts_[part].begin;
    const Range v = parts_[part].v;
    for (Index i = 0; i < v.size(); ++i) x[v.begin + i] += response[i] * impulse;
  }
}

void Delassus::add_response(std::span<const double> impulses, double* x, double scale) const {
  for (std::size_t column = 0; column < size(); ++column) add_response(column, scale * impulses[column], x);
}

}  // namespace carom
