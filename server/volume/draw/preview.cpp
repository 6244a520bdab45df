// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/preview.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace wellspring::volume {
namespace {

constexpr float eye_distance = 2.5f;  // radii of the sphere around the volume
constexpr float room = 1.06f;         // picture's width over the sphere's

}  // namespace

PreviewEye::PreviewEye(const ShownVolume& volume, const PreviewView& view) {
  const glm::dvec3 last = glm::dvec3(volume.levels.front().size) - 1.0;
  const vec3 centre(volume.to_metres * glm::dvec4(0.5 * last, 1));
  float radius = 0;
  for (int corner = 0; corner < 8; corner++) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const vec3 place(volume.to_metres * glm::dvec4(side * (last + 1.0) - 0.5, 1));
    radius = std::max(radius, length(place - centre));
  }
  const float up = std::sin(view.rise), flat = std::cos(view.rise);
  from = vec3(std::sin(view.turn) * flat, up, std::cos(view.turn) * flat);
  eye = centre + from * (eye_distance * radius);
  right = normalize(cross(vec3(0, 1, 0), from)), above = cross(from, right);
  half = room / std::sqrt(eye_distance * eye_distance - 1);
  pixel = 2 * half / float(view.side);
  level = level_for(volume, double(pixel * (eye_distance - 1) * radius));
}

vec3 PreviewEye::way(float x, float y) const {
  return normalize(right * (x * pixel - half) - above * (y * pixel - half) - from);
}

VolumeLight preview_light() {
  return {
      .to_lamp = normalize(vec3(-0.5f, 0.75f, 0.6f)), .lamp = vec3(0.95f), .around = vec3(0.35f)};
}

VolumePicture draw_volume(const ShownVolume& volume, const DrawnPreset& preset,
                          const PreviewView& view) {
  const PreviewEye eye(volume, view);
  MarchSettings settings;
  settings.level = eye.level;
  settings.step = view.step;
  settings.cuts = view.cuts;
  VolumePicture picture{view.side, view.side, {}, {}};
  picture.color.resize(size_t(view.side) * size_t(view.side));
  picture.clear.resize(picture.color.size());
  parallel_each(view.side, [&](int y) {
    VolumeRays rays;
    rays.origin = all_lanes(eye.eye);
    for (int x = 0; x < view.side; x += lane_count) {
      for (int k = 0; k < lane_count; k++) {
        rays.direction.set(k, eye.way(float(x + k) + 0.5f, float(y) + 0.5f));
      }
      rays.near = Lanes{}, rays.far = all_lanes(INFINITY);
      const MarchedLight found = march(volume, preset, rays, settings);
      for (int k = 0; k < std::min(lane_count, view.side - x); k++) {
        const size_t at = size_t(y) * size_t(view.side) + size_t(x + k);
        picture.color[at] = found.color.at(k), picture.clear[at] = found.clear[k];
      }
    }
  });
  return picture;
}

}  // namespace wellspring::volume
