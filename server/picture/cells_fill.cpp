// SPDX-License-Identifier: Apache-2.0
// Holes: the known cells are gathered into coarser and coarser levels, then every unknown cell
// takes what the level above knows (push and pull, Gortler et al. 1996), one object at a time.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "picture/cells.h"

namespace wellspring::picture {
namespace {

constexpr float flat = 0.97f;  // of Coarse::flatness: normals some ten degrees apart

struct Coarse {
  vec3 albedo{0}, rest{0}, smooth{0}, normal{0};
  vec3 plane{0};  // as Cells::plane: the same for all cells of one plane
  float inverse_depth = 0, weight = 0;
  float flatness = 0;  // 1: all that it was made of faces one way
  uint32_t object = no_object;
};

struct Level {
  int width = 0, height = 0;
  std::vector<Coarse> cells;
  const Coarse& at(int x, int y) const {
    return cells[size_t(std::clamp(y, 0, height - 1)) * size_t(width) +
                 size_t(std::clamp(x, 0, width - 1))];
  }
};

void add(Coarse& sum, const Coarse& c, float weight) {
  sum.albedo += c.albedo * weight;
  sum.rest += c.rest * weight;
  sum.smooth += c.smooth * weight;
  sum.normal += c.normal * weight;
  sum.plane += c.plane * weight;
  sum.inverse_depth += c.inverse_depth * weight;
  sum.flatness += c.flatness * weight;
  sum.weight += weight;
}

// The mean of those that show the object of most weight; the weight is theirs.
Coarse blend(const Coarse* const* candidates, const float* weights, int count) {
  Coarse sum;
  float best = 0;
  for (int i = 0; i < count; i++) {
    if (weights[i] <= 0 || candidates[i]->object == no_object) continue;
    float support = 0;
    for (int j = 0; j < count; j++)
      if (candidates[j]->object == candidates[i]->object) support += weights[j];
    if (support > best) best = support, sum.object = candidates[i]->object;
  }
  if (best <= 0) return sum;
  for (int i = 0; i < count; i++)
    if (candidates[i]->object == sum.object) add(sum, *candidates[i], weights[i]);
  float share = 1 / sum.weight;
  sum.albedo *= share, sum.rest *= share, sum.smooth *= share, sum.inverse_depth *= share;
  sum.plane *= share;
  float facing = length(sum.normal);
  sum.flatness *= share * facing * share;
  sum.normal /= std::max(facing, 1e-6f);
  return sum;
}

Coarse read_cell(const Cells& cells, int x, int y) {
  Coarse c;
  if (x >= cells.width || y >= cells.height) return c;
  size_t i = size_t(cells.index(x, y));
  if (cells.object[i] == no_object) return c;
  for (int k = 0; k < 3; k++) {
    c.albedo[k] = cells.albedo[size_t(k)][i];
    c.rest[k] = cells.rest[size_t(k)][i];
    c.smooth[k] = cells.smooth[size_t(k)][i];
    c.normal[k] = cells.normal[size_t(k)][i];
    c.plane[k] = cells.plane[size_t(k)][i];
  }
  c.flatness = 1;
  c.inverse_depth = 1 / cells.depth[i];
  c.weight = std::min(cells.samples[i], 16.0f);
  c.object = cells.object[i];
  return c;
}

// Children at (2x, 2y) .. (2x+1, 2y+1).
template <class Read>
Coarse reduce(const Read& read, int x, int y) {
  Coarse child[4] = {read(2 * x, 2 * y), read(2 * x + 1, 2 * y), read(2 * x, 2 * y + 1),
                     read(2 * x + 1, 2 * y + 1)};
  const Coarse* candidates[4] = {&child[0], &child[1], &child[2], &child[3]};
  float weights[4];
  for (int k = 0; k < 4; k++) weights[k] = child[k].weight;
  Coarse result = blend(candidates, weights, 4);
  result.weight = std::min(result.weight, 16.0f);
  return result;
}

// What the level above knows around the middle of cell (x, y): its four nearest cells, bilinear.
Coarse pull(const Level& above, int x, int y) {
  int px = x >> 1, py = y >> 1, sx = x & 1 ? 1 : -1, sy = y & 1 ? 1 : -1;
  const Coarse* candidates[4] = {&above.at(px, py), &above.at(px + sx, py), &above.at(px, py + sy),
                                 &above.at(px + sx, py + sy)};
  constexpr float bilinear[4] = {9, 3, 3, 1};
  float weights[4];
  for (int k = 0; k < 4; k++) weights[k] = candidates[k]->object == no_object ? 0.0f : bilinear[k];
  return blend(candidates, weights, 4);
}

void write_cell(const PixelRays& rays, const Coarse& c, int x, int y, Cells& cells) {
  size_t i = size_t(cells.index(x, y));
  vec3 ray(rays.x((float(x) + 0.5f) * cell_size), rays.y((float(y) + 0.5f) * cell_size), 1);
  // A flat surface goes on as it does around. Of others the cell faces the viewer: its depth is a
  // guess, a slope would be a bolder one.
  float inverse_depth = c.inverse_depth, there = dot(c.plane, ray);
  vec3 plane(0, 0, inverse_depth);
  if (c.flatness > flat && there > 0.5f * inverse_depth && there < 2 * inverse_depth)
    plane = c.plane, inverse_depth = there;
  for (int k = 0; k < 3; k++) {
    cells.albedo[size_t(k)][i] = c.albedo[k];
    cells.rest[size_t(k)][i] = c.rest[k];
    cells.smooth[size_t(k)][i] = c.smooth[k];
    cells.normal[size_t(k)][i] = c.normal[k];
    cells.plane[size_t(k)][i] = plane[k];
  }
  cells.depth[i] = 1 / inverse_depth;
  cells.object[i] = c.object;
}

}  // namespace

bool fill_cells(const WindowView& view, Cells& cells) {
  PixelRays rays(view);
  int known = 0;
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++)
      known += cells.object[size_t(cells.index(x, y))] != no_object;
  if (known == 0) return false;
  if (known == cells.width * cells.height) return true;

  std::vector<Level> levels;
  int width = cells.width, height = cells.height;
  do {
    width = (width + 1) / 2, height = (height + 1) / 2;
    Level level{width, height, std::vector<Coarse>(size_t(width) * size_t(height))};
    const Level* below = levels.empty() ? nullptr : &levels.back();
    auto read = [&](int x, int y) {
      if (!below) return read_cell(cells, x, y);
      return x < below->width && y < below->height ? below->at(x, y) : Coarse{};
    };
    parallel_ranges(height, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < width; x++)
          level.cells[size_t(y) * size_t(width) + size_t(x)] = reduce(read, x, y);
    });
    levels.push_back(std::move(level));
  } while (width > 1 || height > 1);
  if (levels.back().cells[0].object == no_object) return false;

  for (size_t k = levels.size() - 1; k-- > 0;) {
    Level& level = levels[k];
    parallel_ranges(level.height, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < level.width; x++) {
          Coarse& c = level.cells[size_t(y) * size_t(level.width) + size_t(x)];
          if (c.object == no_object) c = pull(levels[k + 1], x, y);
        }
    });
  }
  parallel_ranges(cells.height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x++)
        if (cells.object[size_t(cells.index(x, y))] == no_object)
          write_cell(rays, pull(levels[0], x, y), x, y, cells);
  });
  return true;
}

}  // namespace wellspring::picture
