// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/light_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "volume/draw/along_ray.h"
#include "volume/reconstruct/trilinear.h"

namespace wellspring::volume {
namespace {

constexpr int grid_step = 4;            // samples of the finest level from node to node
constexpr int most_side = 96;           // nodes
constexpr float opaque_density = 1e5f;  // per metre, behind a surface
constexpr int sky_ways = 12;            // directions for the light around

// Returns directions spread evenly over the sphere (a spiral, Saff and Kuijlaars 1997).
std::array<vec3, sky_ways> spread_ways() {
  std::array<vec3, sky_ways> ways;
  for (int i = 0; i < sky_ways; i++) {
    const float z = 1 - (2 * float(i) + 1) / sky_ways, r = std::sqrt(1 - z * z);
    const float turn = 2.399963f * float(i);
    ways[size_t(i)] = {r * std::cos(turn), z, r * std::sin(turn)};
  }
  return ways;
}

// Follows rays from nodes until they leave the box.
struct ShadowRays {
  SampleBox<uint16_t> box;  // all samples of a level
  const TransferTable& table;
  ToSamples to_samples;
  float voxel;  // metres between samples of the level

  // Returns the share of light that comes through along `way`, from places in samples.
  Lanes clear(const Lanes3& from, vec3 way) const {
    const Lanes3 step = to_samples.way(all_lanes(way * voxel));
    const vec3 each = step.at(0);
    const vec3 last = vec3(box.size - 1);
    Lanes3 place = from + step * all_lanes(1.5f);  // not the node's own matter
    Lanes sum{};
    const int most = int(2 * length(vec3(box.size)));
    for (int i = 0; i < most; i++) {
      const LaneMask inside = (place.x >= -0.5f) & (place.x <= last.x + 0.5f) & (place.y >= -0.5f) &
                              (place.y <= last.y + 0.5f) & (place.z >= -0.5f) &
                              (place.z <= last.z + 0.5f) & (sum < 6.0f);
      if (!any_lane(inside)) break;
      const Lanes codes = linear_value(box, place);
      Lanes density;
      if (table.mode() == VolumeMode::surface)
        density = keep_lanes(codes >= table.threshold(), all_lanes(opaque_density));
      else table.look(codes, density);
      sum += keep_lanes(inside, density * voxel);
      place = place + all_lanes(each);
    }
    return fade(sum);
  }
};

}  // namespace

LightGrid make_light_grid(const ShownVolume& volume, const TransferTable& table,
                          const VolumeLight& light) {
  LightGrid grid;
  const VolumeLevel& finest = volume.levels.front();
  grid.size = glm::clamp((finest.size + grid_step - 1) / grid_step + 1, 2, most_side);
  grid.scale = vec3(grid.size - 1) / glm::max(vec3(finest.size - 1), vec3(1));
  const size_t nodes = size_t(grid.size.x) * size_t(grid.size.y) * size_t(grid.size.z);
  grid.lamp.assign(nodes, 255), grid.around.assign(nodes, 255);
  if (table.mode() == VolumeMode::maximum || table.mode() == VolumeMode::glow) return grid;
  // The level is about as coarse as the grid.
  const float apart = 1 / std::min({grid.scale.x, grid.scale.y, grid.scale.z});
  const int level =
      std::max(std::min(std::max(2, int(std::log2(apart))), int(volume.levels.size()) - 1),
               volume.whole_level);
  const ShadowRays rays{volume.levels[size_t(level)].box(), table, ToSamples(volume, level),
                        float(volume.voxel * std::ldexp(1.0, level))};
  const std::array<vec3, sky_ways> ways = spread_ways();
  const float down = std::ldexp(1.0f, -level);
  parallel_each(grid.size.z, [&](int z) {
    for (int y = 0; y < grid.size.y; y++)
      for (int x = 0; x < grid.size.x; x += lane_count) {
        constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
        const Lanes3 fine = Lanes3{lane + float(x), all_lanes(float(y)), all_lanes(float(z))} *
                            all_lanes(1.0f / grid.scale);
        const Lanes3 place =
            (fine + all_lanes(vec3(0.5f))) * all_lanes(down) - all_lanes(vec3(0.5f));
        const Lanes lamp = rays.clear(place, light.to_lamp);
        Lanes around{};
        for (const vec3& way : ways) around += rays.clear(place, way);
        const size_t at =
            (size_t(z) * size_t(grid.size.y) + size_t(y)) * size_t(grid.size.x) + size_t(x);
        for (int k = 0; k < std::min(lane_count, grid.size.x - x); k++) {
          grid.lamp[at + size_t(k)] = uint8_t(255 * lamp[k] + 0.5f);
          grid.around[at + size_t(k)] = uint8_t(255 / float(sky_ways) * around[k] + 0.5f);
        }
      }
  });
  return grid;
}

}  // namespace wellspring::volume
