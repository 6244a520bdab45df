// SPDX-License-Identifier: Apache-2.0
#include "lawn/depth_cube.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wellspring::lawn {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

}  // namespace

DepthCube::DepthCube(std::span<const vec3> places, std::span<const uvec3> triangles, int side)
    : side_(std::clamp(side, 1, 1024)) {
  std::vector<std::array<vec3, 3>> good;
  vec3 low{infinity}, high{-infinity};
  for (const uvec3& t : triangles) {
    if (std::max({t.x, t.y, t.z}) >= places.size()) continue;
    const std::array<vec3, 3> corner = {places[t.x], places[t.y], places[t.z]};
    if (!is_finite(corner[0]) || !is_finite(corner[1]) || !is_finite(corner[2])) continue;
    for (const vec3& c : corner) low = min(low, c), high = max(high, c);
    good.push_back(corner);
  }
  const float widest = good.empty() ? 0 : max_component(high - low);
  if (!(widest > 0) || !std::isfinite(widest)) return;
  middle_ = 0.5f * low + 0.5f * high;
  half_size_ = 0.5f * high - 0.5f * low;
  half_ = 0.5f * widest * (1 + 2 / float(side_));  // a pixel of margin
  for (auto& face : face_) face.assign(size_t(side_) * size_t(side_), {-infinity, {0, 1, 0}});
  for (std::array<vec3, 3>& corner : good) {
    for (vec3& c : corner) c -= middle_;
    draw(corner);
  }
}

void DepthCube::draw(const std::array<vec3, 3>& corner) {
  const vec3 across = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const float size = glm::length(across);
  if (!(size > 0)) return;
  const vec3 normal = across / size;
  const float texels = float(side_) / (2 * half_);
  // Faces of an axis see the same columns from both ends.
  for (int axis = 0; axis < 3; axis++) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    vec2 at[3];
    for (int i = 0; i < 3; i++)
      at[i] = (vec2(corner[size_t(i)][u], corner[size_t(i)][v]) + half_) * texels - 0.5f;
    const vec2 a = at[1] - at[0], b = at[2] - at[0];
    const float area = a.x * b.y - a.y * b.x;
    if (std::abs(area) < 1e-12f) continue;
    const vec2 least = min(at[0], min(at[1], at[2])), most = max(at[0], max(at[1], at[2]));
    const ivec2 first = max(ivec2(ceil(least)), ivec2(0)),
                last = min(ivec2(floor(most)), ivec2(side_ - 1));
    for (int y = first.y; y <= last.y; y++)
      for (int x = first.x; x <= last.x; x++) {
        const vec2 p = vec2(x, y) - at[0];
        const float s = (p.x * b.y - p.y * b.x) / area, t = (a.x * p.y - a.y * p.x) / area;
        constexpr float edge = -1e-5f;  // neighbours leave no gap
        if (s < edge || t < edge || s + t > 1 - edge) continue;
        const float height = corner[0][axis] + s * (corner[1][axis] - corner[0][axis]) +
                             t * (corner[2][axis] - corner[0][axis]);
        for (int end = 0; end < 2; end++) {
          const float out = end ? -1.0f : 1.0f;
          Texel& texel = face_[size_t(2 * axis + end)][size_t(y * side_ + x)];
          if (out * height <= texel.height) continue;
          texel.height = out * height;
          texel.normal = out * normal[axis] < 0 ? -normal : normal;
        }
      }
  }
}

DepthCube::Depth DepthCube::at(vec3 v) const {
  Depth inside{-infinity}, outside{infinity};
  if (half_ == 0) return outside;
  const vec3 p = v - middle_;
  if (!is_finite(p)) return outside;
  bool is_inside = true;
  const float texels = float(side_) / (2 * half_);
  for (int face = 0; face < 6; face++) {
    const int axis = face / 2;
    const float out = face % 2 ? -1.0f : 1.0f;
    const float x = std::floor((p[(axis + 1) % 3] + half_) * texels),
                y = std::floor((p[(axis + 2) % 3] + half_) * texels);
    const float last = float(side_ - 1);
    if (!(x >= 0 && y >= 0 && x <= last && y <= last)) {
      is_inside = false;
      continue;
    }
    const Texel& texel = face_[size_t(face)][size_t(y) * size_t(side_) + size_t(x)];
    const float distance = out * p[axis] - texel.height;  // infinite where the face sees nothing
    Depth here{distance, texel.normal, vec3(0)};
    here.axis[axis] = out;
    if (distance >= 0) {
      is_inside = false;
      if (distance < outside.distance) outside = here;
    } else if (distance > inside.distance) {
      inside = here;
    }
  }
  return is_inside ? inside : outside;
}

}  // namespace wellspring::lawn
