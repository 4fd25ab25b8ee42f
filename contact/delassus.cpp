// Problem: how impulses along the rows of constraints change the velocities along the same rows.

#include <carom/contact/delassus.h>

#include <algorithm>
#include <numeric>

namespace carom {

void Delassus::build(std::span<const ImpulseDirection> directions, BodyResponse& response) {
  directions_.assign(directions.begin(), directions.end());
  columns_.clear();
  parts_.clear();
  responses_.clear();
  loads_.clear();
  for (const ImpulseDirection& direction : directions_) add_column(direction, response);
  columns_.push_back({parts_.size(), false});
}

/// Room for the bodies of one reach, once.
void Delassus::add_part(const Constraint& constraint, Range reach) {
  const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(columns_.back().begin);
  const auto same = [&](const Part& part) { return part.v.begin == reach.begin; };
  if (constraint.bodies > 1 && std::any_of(begin, parts_.end(), same)) return;
  parts_.push_back({reach, responses_.size()});
  responses_.resize(responses_.size() + reach.size(), 0.0);
}

void Delassus::add_column(const ImpulseDirection& direction, BodyResponse& response) {
  const Constraint& at = *direction.constraint;
  Column& column = columns_.emplace_back(Column{parts_.size(), false});
  const double* number = at.row(direction.row);
  const double* tangent = at.row(at.tangent_row());
  for (int b = 0; b < at.bodies; ++b) {
    const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
    const Range reach = response.reach(block.body);
    add_part(at, reach);
    std::size_t part = column.begin;
    while (parts_[part].v.begin != reach.begin) ++part;
    double* const x = responses_.data() + parts_[part].begin + (block.v - reach.begin);
    for (int c = 0; c < block.columns; ++c, ++number, ++tangent) {
      x[c] = *number;
      if (direction.ratio != 0.0) x[c] += direction.ratio * *tangent;
    }
  }
  bool moves = false;
  for (std::size_t part = column.begin; part < parts_.size(); ++part) {
    const Range v = parts_[part].v;
    Index body = at.blocks[0].body;
    for (int b = 1; b < at.bodies; ++b) {
      const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
      if (block.v >= v.begin && block.v < v.end) body = block.body;
    }
    double* const x = responses_.data() + parts_[part].begin;
    if (response.take_loads(body, x)) {
      loads_.resize(responses_.size());
      std::copy_n(x, v.size(), loads_.data() + parts_[part].begin);
    }
    moves = response.answer(body, x) || moves;
  }
  column.held = !moves;
}

double Delassus::product(const Constraint& at, int row, std::size_t j) const {
  double sum = 0.0;
  const double* h = at.row(row);
  for (int b = 0; b < at.bodies; ++b) {
    const Constraint::Block& block = at.blocks[static_cast<std::size_t>(b)];
    for (std::size_t part = columns_[j].begin; part < columns_[j + 1].begin; ++part) {
      const Range v = parts_[part].v;
      if (block.v < v.begin || block.v >= v.end) continue;
      const double* const response = responses_.data() + parts_[part].begin + (block.v - v.begin);
      for (int c = 0; c < block.columns; ++c) sum += h[c] * response[c];
    }
    h += block.columns;
  }
  return sum;
}

double Delassus::entry(std::size_t i, std::size_t j) const {
  if (loads_.empty()) return product(*directions_[i].constraint, directions_[i].row, j);
  double sum = 0.0;
  for (std::size_t part = columns_[i].begin; part < columns_[i + 1].begin; ++part) {
    for (std::size_t other = columns_[j].begin; other < columns_[j + 1].begin; ++other) {
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
  for (std::size_t part = columns_[column].begin; part < columns_[column + 1].begin; ++part) {
    const double* const response = responses_.data() + parts_[part].begin;
    const Range v = parts_[part].v;
    for (Index i = 0; i < v.size(); ++i) x[v.begin + i] += response[i] * impulse;
  }
}

void Delassus::add_response(std::span<const double> impulses, double* x, double scale) const {
  for (std::size_t column = 0; column < size(); ++column) add_response(column, scale * impulses[column], x);
}

}  // namespace carom
