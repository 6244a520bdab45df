// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/splat_lights.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::light {
namespace {

// Calls visit(subsplat) for each subsplat within a square.
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

namespace {

// Squared distances within which light is computed: below, a light lies on the place and does not
// light it; above, its light is too weak for a float.
constexpr float least_distance2 = 1e-20f, most_distance2 = 1e18f;

template <bool wants_each>
vec3 sum_lights(const VirtualLights& lights, vec3 position, vec3 normal, float* each) {
  Lanes red{}, green{}, blue{};
  for (size_t i = 0; i < size_t(lights.padded); i += lane_count) {
    const Lanes x = load_lanes(&lights.x[i]) - position.x,
                y = load_lanes(&lights.y[i]) - position.y,
                z = load_lanes(&lights.z[i]) - position.z;
    const Lanes d2 = x * x + y * y + z * z;
    const Lanes here = x * normal.x + y * normal.y + z * normal.z;
    const Lanes there = -(x * load_lanes(&lights.nx[i]) + y * load_lanes(&lights.ny[i]) +
                          z * load_lanes(&lights.nz[i]));
    const LaneMask counts =
        (here > 0) & (there > 0) & (d2 > least_distance2) & (d2 < most_distance2);
    const Lanes share =
        keep_lanes(counts, here * there / (d2 * (d2 + load_lanes(&lights.radius2[i]))));
    const Lanes r = share * load_lanes(&lights.red[i]), g = share * load_lanes(&lights.green[i]),
                b = share * load_lanes(&lights.blue[i]);
    red += r, green += g, blue += b;
    if constexpr (wants_each) store_lanes(each + i, 0.2126f * r + 0.7152f * g + 0.0722f * b);
  }
  return {lanes_sum(red), lanes_sum(green), lanes_sum(blue)};
}

}  // namespace

vec3 sum_virtual_lights(const VirtualLights& lights, vec3 position, vec3 normal, float* each) {
  return each ? sum_lights<true>(lights, position, normal, each)
              : sum_lights<false>(lights, position, normal, nullptr);
}

vec3 eval_virtual_light(const VirtualLights& lights, size_t light, vec3 position, vec3 normal) {
  vec3 way = vec3(lights.x[light], lights.y[light], lights.z[light]) - position;
  float d2 = dot(way, way), here = dot(way, normal),
        there = -dot(way, vec3(lights.nx[light], lights.ny[light], lights.nz[light]));
  if (!(here > 0 && there > 0 && d2 > least_distance2 && d2 < most_distance2)) return vec3(0);
  return lights.intensity(light) * (here * there / (d2 * (d2 + lights.radius2[light])));
}

void clear_illumination(const MinMaxPyramid& pyramid, IlluminationPyramid& to) {
  to.levels.resize(pyramid.levels.size());
  for (size_t k = 0; k < to.levels.size(); k++) {
    IlluminationLevel& level = to.levels[k];
    level.columns = pyramid.levels[k].columns, level.rows = pyramid.levels[k].rows;
    const size_t count = size_t(level.columns) * size_t(level.rows);
    if (level.texels.size() < count) level.texels.resize(count);
    parallel_ranges(level.rows, 64, [&](int begin, int end) {
      std::fill(level.texels.begin() + long(begin) * level.columns,
                level.texels.begin() + long(end) * level.columns, IlluminationTexel{});
    });
  }
}

void splat_lights(const SplatPixels& pixels, const VirtualLights& lights,
                  std::span<const Subsplat> subsplats, IlluminationPyramid& to) {
  const PixelGrid grid = make_pixel_grid(pixels);
  parallel_ranges(int(subsplats.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const Subsplat& one = subsplats[size_t(i)];
      int x, y;
      if (!find_lit_pixel(pixels, one, x, y)) continue;
      const size_t at = size_t(y) * size_t(pixels.view.width) + size_t(x);
      vec3 place = pixels.view.position + place_from_eye(pixels, grid, x, y);
      vec3 normal(pixels.nx[at], pixels.ny[at], pixels.nz[at]);
      vec3 light = bounded_light(sum_virtual_lights(lights, place, normal));
      to.levels[one.level].at(one.x, one.y) = {light.x, light.y, light.z, 1};
    }
  });
}

namespace {

// Returns what linear interpolation between a texel and its neighbours on one axis may miss, as a
// share of the texel's light; 0 if there is no neighbour.
float missed_share(const IlluminationTexel& own, const IlluminationTexel* before,
                   const IlluminationTexel* behind) {
  auto light = [](const IlluminationTexel& texel) { return texel.red + texel.green + texel.blue; };
  const float here = light(own);
  if (!(here > 0)) return 0;
  if (before && behind) return std::abs(light(*before) + light(*behind) - 2 * here) / (8 * here);
  const IlluminationTexel* only = before ? before : behind;
  return only ? std::abs(light(*only) - here) / (2 * here) : 0;
}

}  // namespace

uint64_t refine_by_convergence(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                               const VirtualLights& lights, const SplatSettings& settings,
                               Subsplats& subsplats, IlluminationPyramid& to) {
  uint64_t lit = 0;
  for (int level = subsplats.coarsest; level > finest_level(settings, subsplats.coarsest);
       level--) {
    IlluminationLevel& light = to.levels[size_t(level)];
    auto neighbour = [&](const Subsplat& one, int dx, int dy) -> const IlluminationTexel* {
      int x = one.x + dx, y = one.y + dy;
      if (x < 0 || y < 0 || x >= light.columns || y >= light.rows || !(light.at(x, y).held > 0))
        return nullptr;
      MinMaxCell both = join_cells(pyramid.at(level, one.x, one.y), pyramid.at(level, x, y));
      return is_discontinuous(both, settings) ? nullptr : &light.at(x, y);
    };
    subsplats.split.resize(subsplats.count);
    bool any = false;
    for (size_t i = 0; i < subsplats.count; i++) {
      const Subsplat& one = subsplats.list[i];
      subsplats.split[i] = 0;
      if (one.level != level) continue;
      const IlluminationTexel& own = light.at(one.x, one.y);
      float missed = std::max(missed_share(own, neighbour(one, -1, 0), neighbour(one, 1, 0)),
                              missed_share(own, neighbour(one, 0, -1), neighbour(one, 0, 1)));
      if (missed > settings.convergence) subsplats.split[i] = 1, any = true;
    }
    if (!any) continue;
    for (size_t i = 0; i < subsplats.count; i++)
      if (subsplats.split[i]) light.at(subsplats.list[i].x, subsplats.list[i].y) = {};
    part_subsplats(pixels, subsplats);
    subsplats.parted.resize(0);
    for (const Subsplat& one : subsplats.all())
      if (one.level == level - 1 && !(to.levels[one.level].at(one.x, one.y).held > 0))
        subsplats.parted.push_back(one);
    splat_lights(pixels, lights, subsplats.parted, to);
    lit += subsplats.parted.size();
  }
  return lit;
}

}  // namespace wellspring::light
