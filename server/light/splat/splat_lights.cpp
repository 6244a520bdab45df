// SPDX-License-Identifier: Apache-2.0
#include "light/splat/splat_lights.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring {
namespace {

// Squared distances that are computed with: below, a light lies on the place, and lights none of
// it; above, it lights nothing that a float could hold.
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
      vec3 light = sum_virtual_lights(lights, place, normal);
      to.levels[one.level].at(one.x, one.y) = {light.x, light.y, light.z, 1};
    }
  });
}

}  // namespace wellspring
