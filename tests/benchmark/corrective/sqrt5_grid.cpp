// SPDX-License-Identifier: Apache-2.0
#include "sqrt5_grid.h"

#include <algorithm>

namespace wellspring::test {
namespace {

// Towards minus infinity; b > 0.
int64_t floor_divide(int64_t a, int64_t b) { return a / b - (a % b < 0); }
int64_t ceil_divide(int64_t a, int64_t b) { return -floor_divide(-a, b); }
int64_t modulo5(int64_t a) { return ((a % 5) + 5) % 5; }

// Keeps of [begin, end] the i for which low <= slope * i + offset <= high.
void clip(int64_t slope, int64_t offset, int64_t low, int64_t high, int64_t& begin, int64_t& end) {
  low -= offset;
  high -= offset;
  if (slope == 0) {
    if (low > 0 || high < 0) end = begin - 1;
    return;
  }
  if (slope < 0) {
    std::swap(low, high);
    slope = -slope, low = -low, high = -high;
  }
  begin = std::max(begin, ceil_divide(low, slope));
  end = std::min(end, floor_divide(high, slope));
}

}  // namespace

Sqrt5Grid make_sqrt5_grid(int levels) {
  Sqrt5Grid grid;
  grid.levels = std::clamp(levels, 1, most_sqrt5_levels);
  ivec2 u(1, 0);
  for (int level = grid.levels; level >= 1; level--) {
    grid.step[size_t(level - 1)] = u;
    u = ivec2(2 * u.x + u.y, 2 * u.y - u.x);  // times 2 - i
  }
  return grid;
}

int level_of_pixel(const Sqrt5Grid& grid, ivec2 pixel) {
  int64_t i = pixel.x, j = pixel.y;
  int level = grid.levels;
  for (; level > 1 && modulo5(i + 2 * j) == 0; level--) {
    int64_t coarser = (2 * i - j) / 5;  // (i + j * sqrt(-1)) / (2 - sqrt(-1)): exact
    j = (i + 2 * j) / 5;
    i = coarser;
  }
  return level;
}

Sqrt5Places::Sqrt5Places(const Sqrt5Grid& grid, int level, const PixelBox& box, int64_t position)
    : box_(box), coarsest_(level <= 1) {
  if (box.empty() || level < 1 || level > grid.levels) return;
  a_ = grid.step[size_t(level - 1)].x;
  b_ = grid.step[size_t(level - 1)].y;
  // A pixel (x, y) has j = (a * y - b * x) / |u|^2, which is extreme in corners.
  const int64_t x[2] = {box.x0, int64_t(box.x1) - 1}, y[2] = {box.y0, int64_t(box.y1) - 1};
  int64_t least = std::min(a_ * y[0], a_ * y[1]) - std::max(b_ * x[0], b_ * x[1]);
  int64_t most = std::max(a_ * y[0], a_ * y[1]) - std::min(b_ * x[0], b_ * x[1]);
  int64_t area = a_ * a_ + b_ * b_;
  j_begin_ = ceil_divide(least, area);
  j_end_ = floor_divide(most, area);

  int64_t left = std::max<int64_t>(position, 0);
  for (j_ = j_begin_; j_ <= j_end_; j_++) {
    row_ = row(j_);
    int64_t here = row_.count();
    if (left < here) break;
    left -= here;
    position_ += here;
  }
  if (j_ > j_end_) return;
  i_ = row_.begin + left;
  if (row_.omitted >= 0) {
    // Four places of five follow each omitted one: `before` of them lie before the row's first.
    int64_t since = modulo5(row_.begin - row_.omitted), before = std::max<int64_t>(since - 1, 0);
    i_ = row_.begin - since + 5 * ((before + left) / 4) + 1 + (before + left) % 4;
  }
  position_ += left;
}

Sqrt5Places::Row Sqrt5Places::row(int64_t j) const {
  Row row;
  row.begin = INT32_MIN, row.end = INT32_MAX;
  clip(a_, -j * b_, box_.x0, int64_t(box_.x1) - 1, row.begin, row.end);
  clip(b_, j * a_, box_.y0, int64_t(box_.y1) - 1, row.begin, row.end);
  // A coarser level has i + j * sqrt(-1) when 2 - sqrt(-1) divides it: (i + 2j) modulo 5 is 0.
  if (!coarsest_) row.omitted = modulo5(-2 * j);
  return row;
}

int64_t Sqrt5Places::Row::count() const {
  if (end < begin) return 0;
  int64_t all = end - begin + 1;
  if (omitted < 0) return all;
  return all - (floor_divide(end - omitted, 5) - floor_divide(begin - 1 - omitted, 5));
}

int64_t Sqrt5Places::count() const {
  int64_t sum = 0;
  for (int64_t j = j_begin_; j <= j_end_; j++) sum += row(j).count();
  return sum;
}

bool Sqrt5Places::next(ivec2& place) {
  while (j_ <= j_end_) {
    if (row_.omitted >= 0 && modulo5(i_ - row_.omitted) == 0) i_++;
    if (i_ <= row_.end) {
      place = ivec2(int(i_ * a_ - j_ * b_), int(i_ * b_ + j_ * a_));
      i_++;
      position_++;
      return true;
    }
    if (++j_ > j_end_) break;
    row_ = row(j_);
    i_ = row_.begin;
  }
  return false;
}

void list_places(const Sqrt5Grid& grid, int level, const PixelBox& box, int64_t position,
                 int64_t count, std::vector<ivec2>& places) {
  Sqrt5Places walk(grid, level, box, position);
  ivec2 place;
  for (int64_t i = 0; i < count && walk.next(place); i++) places.push_back(place);
}

}  // namespace wellspring::test
