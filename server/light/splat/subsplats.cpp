// SPDX-License-Identifier: Apache-2.0
#include "light/splat/subsplats.h"

#include <algorithm>

#include "base/parallel.h"

namespace wellspring::light {
namespace {

// Calls visit(subsplat) for those within a square.
template <class Visit>
void refine(const SplatPixels& pixels, const MinMaxPyramid& pyramid, const SplatSettings& settings,
            int finest, int level, int x, int y, const Visit& visit) {
  const MinMaxLevel& here = pyramid.levels[size_t(level)];
  if (x >= here.columns || y >= here.rows) return;
  if (level == 0) {
    if (is_lit(pixels, size_t(y) * size_t(here.columns) + size_t(x)))
      visit(Subsplat{uint16_t(x), uint16_t(y), 0});
    return;
  }
  const MinMaxCell& cell = pyramid.at(level, x, y);
  if (!(cell.low_high[0] < std::numeric_limits<float>::infinity())) return;
  if (level <= finest || !is_discontinuous(cell, settings))
    return visit(Subsplat{uint16_t(x), uint16_t(y), uint8_t(level)});
  for (int k = 0; k < 4; k++)
    refine(pixels, pyramid, settings, finest, level - 1, 2 * x + (k & 1), 2 * y + (k >> 1), visit);
}

}  // namespace

void make_subsplats(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                    const SplatSettings& settings, Subsplats& subsplats) {
  subsplats.count = 0;
  subsplats.coarsest = int(pyramid.levels.size()) - 1;
  if (pixels.view.width > most_splat_side || pixels.view.height > most_splat_side) return;
  const MinMaxLevel& top = pyramid.levels.back();
  const int squares = top.columns * top.rows, finest = finest_level(settings, subsplats.coarsest);
  if (subsplats.first.size() < size_t(squares) + 1) subsplats.first.resize(size_t(squares) + 1);
  auto for_each = [&](int square, const auto& visit) {
    refine(pixels, pyramid, settings, finest, subsplats.coarsest, square % top.columns,
           square / top.columns, visit);
  };
  parallel_ranges(squares, 4, [&](int begin, int end) {
    for (int s = begin; s < end; s++) {
      uint32_t number = 0;
      for_each(s, [&](const Subsplat&) { number++; });
      subsplats.first[size_t(s) + 1] = number;
    }
  });
  subsplats.first[0] = 0;
  for (size_t s = 0; s < size_t(squares); s++) subsplats.first[s + 1] += subsplats.first[s];
  subsplats.count = subsplats.first[size_t(squares)];
  if (subsplats.list.size() < subsplats.count) subsplats.list.resize(subsplats.count);
  parallel_ranges(squares, 4, [&](int begin, int end) {
    for (int s = begin; s < end; s++) {
      size_t at = subsplats.first[size_t(s)];
      for_each(s, [&](const Subsplat& one) { subsplats.list[at++] = one; });
    }
  });
}

void part_subsplats(const SplatPixels& pixels, Subsplats& subsplats) {
  subsplats.parted.resize(0);
  for (size_t i = 0; i < subsplats.count; i++) {
    const Subsplat one = subsplats.list[i];
    if (!subsplats.split[i]) {
      subsplats.parted.push_back(one);
      continue;
    }
    for (int k = 0; k < 4; k++) {
      Subsplat part{uint16_t(2 * one.x + (k & 1)), uint16_t(2 * one.y + (k >> 1)),
                    uint8_t(one.level - 1)};
      int x, y;
      if (part.x << part.level < pixels.view.width && part.y << part.level < pixels.view.height &&
          find_lit_pixel(pixels, part, x, y))
        subsplats.parted.push_back(part);
    }
  }
  subsplats.list.swap(subsplats.parted);
  subsplats.count = subsplats.list.size();
}

bool find_lit_pixel(const SplatPixels& pixels, const Subsplat& subsplat, int& x, int& y) {
  const int width = pixels.view.width, height = pixels.view.height, size = 1 << subsplat.level;
  const int left = subsplat.x * size, top = subsplat.y * size;
  x = std::min(left + size / 2, width - 1), y = std::min(top + size / 2, height - 1);
  if (is_lit(pixels, size_t(y) * size_t(width) + size_t(x))) return true;
  for (y = top; y < std::min(top + size, height); y++)
    for (x = left; x < std::min(left + size, width); x++)
      if (is_lit(pixels, size_t(y) * size_t(width) + size_t(x))) return true;
  return false;
}

}  // namespace wellspring::light
