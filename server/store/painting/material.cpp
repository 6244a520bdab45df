// SPDX-License-Identifier: Apache-2.0
#include "store/painting/material.h"

#include <algorithm>
#include <cmath>

namespace wellspring::store {

namespace {

// Returns smooth noise from -1 to 1 along the rows of a window, faster than one by one. The same
// place has the same noise in all windows of a level.
class RowNoise {
 public:
  RowNoise(uint64_t seed, double period, const StrokeWindow& window, int width)
      : seed_(seed), period_(period), top_(window.top) {
    first_ = int64_t(std::floor(window.left / period));
    for (int x = 0; x < width; x++) {
      const double across = (window.left + x) / period - double(first_);
      corners_.push_back(int(across));
      parts_.push_back(ease(float(across - std::floor(across))));
    }
    upper_.resize(size_t(corners_.back()) + 2), lower_ = mixed_ = upper_;
  }
  void start_row(int y) {
    const double down = (top_ + y) / period_;
    const int64_t row = int64_t(std::floor(down));
    const float part = ease(float(down - double(row)));
    for (size_t i = 0; i < upper_.size(); i++) {
      if (row != row_) upper_[i] = at_corner(int64_t(i), row);
      if (row != row_) lower_[i] = at_corner(int64_t(i), row + 1);
      mixed_[i] = upper_[i] + part * (lower_[i] - upper_[i]);
    }
    row_ = row;
  }
  float at(int x) const {
    const float* corner = &mixed_[size_t(corners_[size_t(x)])];
    return corner[0] + parts_[size_t(x)] * (corner[1] - corner[0]);
  }

 private:
  static float ease(float t) { return t * t * (3 - 2 * t); }
  float at_corner(int64_t i, int64_t row) const {
    return float(2 * paint_chance(seed_, first_ + i, row, 0) - 1);
  }
  uint64_t seed_;
  double period_, top_;
  int64_t first_ = 0, row_ = INT64_MIN;
  std::vector<int> corners_;  // one for each column of the window
  std::vector<float> parts_;  // how far it is on its way to the next
  std::vector<float> upper_, lower_, mixed_;
};

// Keeps the middles of cells around a window.
class CrackCells {
 public:
  CrackCells(uint64_t seed, double cell, const StrokeWindow& window, int width, int height)
      : cell_(cell) {
    first_ = {int64_t(std::floor(window.left / cell)) - 2,
              int64_t(std::floor(window.top / cell)) - 2};
    columns_ = int64_t(std::floor((window.left + width) / cell)) + 3 - first_.x;
    const int64_t rows = int64_t(std::floor((window.top + height) / cell)) + 3 - first_.y;
    for (int64_t row = 0; row < rows; row++)
      for (int64_t column = 0; column < columns_; column++) {
        const int64_t x = first_.x + column, y = first_.y + row;
        const dvec2 middle = cell * dvec2(double(x) + paint_chance(seed, x, y, 0),
                                          double(y) + paint_chance(seed, x, y, 1));
        middles_.push_back(vec2(middle - dvec2(window.left, window.top)));
      }
    offset_ = dvec2(window.left, window.top) - cell * dvec2(first_);
  }

  // Returns the distance in texels from a place of the window to the nearest border of a cell.
  float distance(vec2 place) const {
    const int64_t column = int64_t((double(place.x) + offset_.x) / cell_),
                  row = int64_t((double(place.y) + offset_.y) / cell_);
    vec2 nearest(0);
    float least = 1e30f;
    vec2 around[9];
    int count = 0;
    for (int64_t k = -1; k <= 1; k++)
      for (int64_t i = -1; i <= 1; i++) {
        const vec2 to = middles_[size_t((row + k) * columns_ + column + i)] - place;
        around[count++] = to;
        const float square = to.x * to.x + to.y * to.y;
        if (square < least) least = square, nearest = to;
      }
    float border = 1e30f;
    for (vec2 to : around) {
      const vec2 apart = to - nearest;
      const float square = apart.x * apart.x + apart.y * apart.y;
      if (square < 1e-6f) continue;
      const float middle = 0.5f * ((to.x + nearest.x) * apart.x + (to.y + nearest.y) * apart.y);
      if (middle * middle < border * border * square) border = middle / std::sqrt(square);
    }
    return std::max(border, 0.f);
  }

 private:
  double cell_;
  glm::vec<2, int64_t> first_{0};
  int64_t columns_ = 0;
  dvec2 offset_{0};
  std::vector<vec2> middles_;
};

// Cracks are drawn where they are at least so wide, and cells so large, in texels.
constexpr double thinnest_crack = 0.5, least_crack_cell = 6;

void add_cracks(std::vector<float>& factors, int width, const PaintMaterial& material,
                uint64_t seed, const StrokeWindow& window) {
  const int height = int(factors.size()) / width;
  const double cell = material.crack_cell / window.texel;
  const float crack = float(material.crack_width / window.texel);
  // Borders of random cells are about 2 cells long a cell.
  const float mean = std::min(2 * crack / float(cell), 1.f);
  const bool drawn = double(crack) >= thinnest_crack && cell >= least_crack_cell;
  if (!drawn) {
    for (float& factor : factors) factor *= 1 - 0.75f * material.crack_depth * mean;
    return;
  }
  const CrackCells cells(seed, cell, window, width, height);
  RowNoise depths(seed ^ 3, std::max(9 * cell, 2.0), window, width),
      waver(seed ^ 9, std::max(0.35 * cell, 2.0), window, width);
  const float swing = cell < 24 ? 0.f : 0.05f * float(cell);
  // Blocks far from all borders have no cracks. Noise changes by at most 3 within a period.
  constexpr int block = 8;
  const float half = 0.71f * block, shake = 1.42f * 3 * swing / float(std::max(0.35 * cell, 2.0));
  const float near = half * (1 + shake) + 0.5f * crack + 1;
  const int blocks = (width + block - 1) / block;
  std::vector<char> cracked(size_t(blocks), 1);
  for (int y = 0; y < height; y++) {
    if (y % block == 0) waver.start_row(y + block / 2);
    for (int x = 0; x < blocks && y % block == 0; x++) {
      const int middle = std::min(x * block + block / 2, width - 1);
      const float off = swing * waver.at(middle);
      const vec2 place(float(middle) + off, float(y + block / 2) - off);
      cracked[size_t(x)] = cells.distance(place) < near;
    }
    depths.start_row(y), waver.start_row(y);
    for (int x = 0; x < width; x++) {
      if (!cracked[size_t(x / block)]) continue;
      const float off = swing * waver.at(x);
      const vec2 place(float(x) + 0.5f + off, float(y) + 0.5f - off);
      const float cover =
          std::clamp(0.5f * crack + 0.5f - cells.distance(place), 0.f, std::min(crack, 1.f));
      if (cover > 0)
        factors[size_t(y) * size_t(width) + size_t(x)] *=
            1 - material.crack_depth * (0.75f + 0.5f * depths.at(x)) * cover;
    }
  }
}

// Returns how much of a wave of so many texels is left in texels' means.
float wave_left(double period) { return float(std::clamp((period - 3) / 4, 0.0, 1.0)); }

void add_weave(std::vector<float>& factors, int width, const PaintMaterial& material, uint64_t seed,
               const StrokeWindow& window) {
  const double period = material.weave / window.texel;
  const float depth = material.weave_depth * wave_left(period);
  if (depth <= 0) return;
  RowNoise warp(seed, 14 * period, window, width);
  // A thread is round; its height is 0 in the mean.
  const auto thread = [](float part) { return 2.f / 3 - 8 * (part - 0.5f) * (part - 0.5f); };
  const float by_period = float(1 / period);
  // Windows are moved by whole pairs of threads, so that places are small numbers.
  const float left = float(std::fmod(window.left, 2 * period)),
              top = float(std::fmod(window.top, 2 * period));
  for (int y = 0; y < int(factors.size()) / width; y++) {
    warp.start_row(y);
    for (int x = 0; x < width; x++) {
      const float off = 2 + 0.13f * warp.at(x);
      const float u = (left + float(x)) * by_period + off, v = (top + float(y)) * by_period + off;
      const int column = int(u), row = int(v);
      const float over = (column + row) % 2 ? thread(u - float(column)) : thread(v - float(row));
      factors[size_t(y) * size_t(width) + size_t(x)] *= 1 + 1.4f * depth * over;
    }
  }
}

void add_grain(std::vector<float>& factors, int width, const PaintMaterial& material, uint64_t seed,
               const StrokeWindow& window) {
  double period = material.grain / window.texel;
  for (int octave = 0; octave < material.grain_octaves; octave++, period *= 2) {
    const float depth = material.grain_depth * wave_left(2 * period);
    if (depth <= 0) continue;
    RowNoise noise(seed + 31 * uint64_t(octave), period, window, width);
    for (int y = 0; y < int(factors.size()) / width; y++) {
      noise.start_row(y);
      for (int x = 0; x < width; x++)
        factors[size_t(y) * size_t(width) + size_t(x)] *= 1 + depth * noise.at(x);
    }
  }
}

}  // namespace

void age_texels(std::vector<float>& factors, int width, const PaintMaterial& material,
                uint64_t seed, const StrokeWindow& window) {
  if (material.crack_cell > 0) add_cracks(factors, width, material, seed, window);
  if (material.weave > 0) add_weave(factors, width, material, seed + 1, window);
  if (material.grain > 0) add_grain(factors, width, material, seed + 2, window);
}

}  // namespace wellspring::store
