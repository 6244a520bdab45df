// SPDX-License-Identifier: Apache-2.0
// Says how bright the matter of a volume is: the same for rays that march and rays that are
// tracked.
#pragma once
#include <cmath>
#include <span>

#include "volume/draw/along_ray.h"
#include "volume/draw/light_grid.h"
#include "volume/reconstruct/trilinear.h"

namespace wellspring::volume {

// Returns the volume's own colour at places in the level, in samples; white where it has none.
inline Lanes3 own_color(const VolumeLevel& level, const Lanes3& p) {
  if (level.colors[0].empty()) return all_lanes(vec3(1));
  const auto channel = [&](const std::vector<uint16_t>& plane) {
    const Lanes root = linear_value(whole_box(plane.data(), level.size), p) * (1 / most_code);
    return root * root;
  };
  return {channel(level.colors[0]), channel(level.colors[1]), channel(level.colors[2])};
}

// Returns how much cuts expose places on rays, 0 to 1: what lies right behind a cut is as bright as
// what was outside before. `place`: metres along the rays.
inline Lanes laid_open(std::span<const VolumeCut> cuts, const Lanes3& origin,
                       const Lanes3& direction, const Lanes& place, float voxel) {
  constexpr float depth = 6;  // voxels in which light from a cut fades
  Lanes most{};
  for (const VolumeCut& cut : cuts) {
    const Lanes3 normal = all_lanes(cut.normal);
    const Lanes behind = dot(origin, normal) - cut.offset + dot(direction, normal) * place;
    most = lanes_max(most, fade(positive_lanes(behind) * (1 / (depth * voxel))));
  }
  return most;
}

// Eight rays of these directions meet matter in a level.
class MatterLight {
 public:
  MatterLight(const VolumeLight& light, const LightGrid& grid, const ToSamples& to_samples,
              int level, const Lanes3& direction)
      : light_(light), grid_(grid), to_finest_(std::ldexp(1.0f, level)), toward_eye_(-direction) {
    // Normals are counted in samples; the transpose turns them to metres.
    for (int i = 0; i < 3; i++)
      normal_[i] = vec3(to_samples.turn[i][0], to_samples.turn[i][1], to_samples.turn[i][2]);
  }

  // Returns the light that matter of this colour sends to the eye. `p` is its place in the level,
  // in samples, `stored` its normal as linear_value_and_normal() gives it. `exposed`: the share of
  // all light that comes there at least, since a cut has laid it open (laid_open()).
  Lanes3 lit(const Lanes3& color, const Lanes3& p, const Lanes3& stored,
             const Lanes& exposed) const {
    const Lanes3 n = {stored.x * normal_[0].x + stored.y * normal_[0].y + stored.z * normal_[0].z,
                      stored.x * normal_[1].x + stored.y * normal_[1].y + stored.z * normal_[1].z,
                      stored.x * normal_[2].x + stored.y * normal_[2].y + stored.z * normal_[2].z};
    const Lanes length2 = dot(n, n);
    // There is no surface where neighbours disagree: light goes all ways.
    const Lanes surface = lanes_min(dot(stored, stored) * 2.0f, all_lanes(1));
    const Lanes unit = 1.0f / lanes_sqrt(lanes_max(length2, all_lanes(1e-20f)));
    const Lanes facing = dot(n, all_lanes(light_.to_lamp)) * unit;
    const Lanes diffuse = positive_lanes(facing) * surface + 0.25f * (1.0f - surface);
    const Lanes3 half = toward_eye_ + all_lanes(light_.to_lamp);
    const Lanes along = positive_lanes(dot(n, half) * unit /
                                       lanes_sqrt(lanes_max(dot(half, half), all_lanes(1e-12f))));
    const Lanes two = along * along, four = two * two, eight = four * four;
    const Lanes shine =
        0.15f * eight * eight * four * surface * (facing > 0.0f ? all_lanes(1) : Lanes{});
    const Lanes3 fine = (p + all_lanes(vec3(0.5f))) * all_lanes(to_finest_) - all_lanes(vec3(0.5f));
    const Lanes3 node = fine * all_lanes(grid_.scale);
    const auto share_at = [&](const std::vector<uint8_t>& shares) {
      return lanes_max(linear_value(whole_box(shares.data(), grid_.size), node) * (1 / 255.0f),
                       exposed);
    };
    const Lanes lamp = share_at(grid_.lamp), around = share_at(grid_.around);
    const Lanes3 from_lamp = all_lanes(light_.lamp) * lamp;
    return color * (from_lamp * diffuse + all_lanes(light_.around) * around) + from_lamp * shine;
  }

 private:
  const VolumeLight& light_;
  const LightGrid& grid_;
  float to_finest_;
  Lanes3 toward_eye_;
  vec3 normal_[3];
};

}  // namespace wellspring::volume
