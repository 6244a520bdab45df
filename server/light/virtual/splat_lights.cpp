// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/splat_lights.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::light {
namespace {

constexpr float boundless = std::numeric_limits<float>::infinity();

MinMaxCell nothing() {
  MinMaxCell cell;
  std::fill_n(cell.low_high, lane_count, boundless);
  cell.plane_low = boundless, cell.plane_high = -boundless;
  return cell;
}

}  // namespace

MinMaxCell look_at_pixel(const SplatPixels& pixels, const PixelGrid& grid, int x, int y) {
  const size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  if (!is_lit(pixels, i)) {
    MinMaxCell cell = nothing();
    cell.low_high[4] = -boundless;
    return cell;
  }
  const vec3 n(pixels.nx[i], pixels.ny[i], pixels.nz[i]);
  const float z = pixels.depth[i];
  const float plane = dot(n, place_from_eye(pixels, grid, x, y));
  return {{z, n.x, n.y, n.z, -z, -n.x, -n.y, -n.z}, plane, plane};
}

int coarsest_level(const SplatSettings& settings, int width, int height) {
  const int side = std::min(width, height), least = std::max(settings.coarsest, 1);
  return side <= least ? 0 : std::bit_width(unsigned(side / least)) - 1;
}

void make_min_max_pyramid(const SplatPixels& pixels, int coarsest, MinMaxPyramid& pyramid) {
  const int width = pixels.view.width, height = pixels.view.height;
  pyramid.levels.assign(size_t(coarsest) + 1, {});
  size_t total = 0;
  for (int k = 0; k <= coarsest; k++) {
    const int size = 1 << k;
    MinMaxLevel& level = pyramid.levels[size_t(k)];
    level = {(width + size - 1) / size, (height + size - 1) / size, total};
    if (k > 0) total += size_t(level.columns) * size_t(level.rows);
  }
  if (pyramid.cells.size() < total) pyramid.cells.resize(total);
  const PixelGrid grid = make_pixel_grid(pixels);
  for (int k = 1; k <= coarsest; k++) {
    const MinMaxLevel &to = pyramid.levels[size_t(k)], &from = pyramid.levels[size_t(k) - 1];
    parallel_ranges(to.rows, 4, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < to.columns; x++) {
          MinMaxCell cell = nothing();
          for (int j = 2 * y; j < std::min(2 * y + 2, from.rows); j++)
            for (int i = 2 * x; i < std::min(2 * x + 2, from.columns); i++)
              cell = join_cells(
                  cell, k == 1 ? look_at_pixel(pixels, grid, i, j) : pyramid.at(k - 1, i, j));
          pyramid.cells[to.first + size_t(y) * size_t(to.columns) + size_t(x)] = cell;
        }
    });
  }
}

namespace {

constexpr int steps[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};

int number_of(int dx, int dy) {
  for (int k = 0; k < 8; k++)
    if (steps[k][0] == dx && steps[k][1] == dy) return k;
  return 0;
}

// Sets bit k of each texel that may be mixed with its neighbour k.
void join_texels(const MinMaxPyramid& pyramid, const SplatSettings& settings, int level,
                 const IlluminationLevel& light, RawVector<uint8_t>& joined) {
  const size_t count = size_t(light.columns) * size_t(light.rows);
  if (joined.size() < count) joined.resize(count);
  parallel_ranges(light.rows, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < light.columns; x++) {
        uint8_t bits = 0;
        if (light.at(x, y).held > 0) {
          const MinMaxCell& own = pyramid.at(level, x, y);
          for (int k = 0; k < 8; k++) {
            int i = x + steps[k][0], j = y + steps[k][1];
            if (i < 0 || j < 0 || i >= light.columns || j >= light.rows) continue;
            if (!(light.at(i, j).held > 0)) continue;
            if (!is_discontinuous(join_cells(own, pyramid.at(level, i, j)), settings))
              bits |= uint8_t(1 << k);
          }
        }
        joined[size_t(y) * size_t(light.columns) + size_t(x)] = bits;
      }
  });
}

HalfLanes load_texel(const IlluminationTexel& texel) { return load_lanes<HalfLanes>(&texel.red); }

// Returns the light of the finer texel in a quarter of (x, y): sx, sy are -1 or 1.
HalfLanes mix(const IlluminationLevel& coarse, uint8_t joined, int x, int y, int sx, int sy) {
  HalfLanes sum = load_texel(coarse.at(x, y)) * 9.0f;
  float weight = 9;
  auto add = [&](int dx, int dy, float share) {
    if (!(joined >> number_of(dx, dy) & 1)) return;
    sum += load_texel(coarse.at(x + dx, y + dy)) * share;
    weight += share;
  };
  add(sx, 0, 3), add(0, sy, 3), add(sx, sy, 1);
  return sum * (1 / weight);
}

// Returns the paper's factor on light that was computed coarsely.
float detail_of(const SplatPixels& pixels, const PixelGrid& grid, float detail, int x, int y) {
  const size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  vec3 way = -place_from_eye(pixels, grid, x, y);
  float length2 = dot(way, way);
  if (!(length2 > 0)) return 1;
  float cosine = dot(way, vec3(pixels.nx[i], pixels.ny[i], pixels.nz[i])) / std::sqrt(length2);
  return detail * std::max(cosine, 0.0f) + 1 - detail;
}

}  // namespace

void upsample(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
              const SplatSettings& settings, IlluminationPyramid& illumination, UpsampleRoom& room,
              std::span<vec3> irradiance) {
  const PixelGrid grid = make_pixel_grid(pixels);
  const float detail = std::clamp(settings.detail, 0.0f, 1.0f);
  for (int level = int(illumination.levels.size()) - 2; level >= 0; level--) {
    const IlluminationLevel& coarse = illumination.levels[size_t(level) + 1];
    IlluminationLevel& fine = illumination.levels[size_t(level)];
    join_texels(pyramid, settings, level + 1, coarse, room.joined);
    parallel_ranges(fine.rows, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < fine.columns; x++) {
          IlluminationTexel& to = fine.at(x, y);
          const int cx = x / 2, cy = y / 2;
          if (to.held > 0 || !(coarse.at(cx, cy).held > 0)) continue;
          if (level == 0 && !is_lit(pixels, size_t(y) * size_t(fine.columns) + size_t(x))) continue;
          uint8_t joined = room.joined[size_t(cy) * size_t(coarse.columns) + size_t(cx)];
          HalfLanes light = mix(coarse, joined, cx, cy, x & 1 ? 1 : -1, y & 1 ? 1 : -1);
          if (level == 0 && detail > 0) light *= detail_of(pixels, grid, detail, x, y);
          store_lanes(&to.red, light);
          to.held = 1;
        }
    });
  }
  const IlluminationLevel& pixel = illumination.levels[0];
  const size_t count = std::min(irradiance.size(), size_t(pixel.columns) * size_t(pixel.rows));
  parallel_ranges(int(count), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      irradiance[i] = {pixel.texels[i].red, pixel.texels[i].green, pixel.texels[i].blue};
  });
}

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
  const Lanes3 place = all_lanes(position), faces = all_lanes(normal);
  for (size_t i = 0; i < lights.padded(); i += lane_count) {
    const VirtualLights::Group& group = lights.groups[i / lane_count];
    const Lanes3 way = group.position - place;
    const Lanes d2 = dot(way, way), here = dot(way, faces), there = -dot(way, group.normal);
    const LaneMask counts =
        (here > 0) & (there > 0) & (d2 > least_distance2) & (d2 < most_distance2);
    const Lanes share = keep_lanes(counts, here * there / (d2 * (d2 + group.radius2)));
    const Lanes r = share * group.intensity.x, g = share * group.intensity.y,
                b = share * group.intensity.z;
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
  vec3 way = lights.position(light) - position;
  float d2 = dot(way, way), here = dot(way, normal), there = -dot(way, lights.normal(light));
  if (!(here > 0 && there > 0 && d2 > least_distance2 && d2 < most_distance2)) return vec3(0);
  return lights.intensity(light) * (here * there / (d2 * (d2 + lights.radius2(light))));
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
