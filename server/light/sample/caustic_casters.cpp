// SPDX-License-Identifier: Apache-2.0
#include "light/sample/caustic_casters.h"

#include <algorithm>
#include <cmath>

#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr int most_parts = 16;         // per instance
constexpr size_t least_triangles = 8;  // in a part

// Adds triangles [begin, end) of an instance in one sphere, or in parts of it if those are much
// smaller.
void add_spheres(std::vector<Bounds>& boxes, size_t begin, size_t end, int parts, float weight,
                 std::vector<CasterSphere>& spheres) {
  Bounds box;
  for (size_t i = begin; i < end; i++) {
    box.low = glm::min(box.low, boxes[i].low);
    box.high = glm::max(box.high, boxes[i].high);
  }
  vec3 size = box.high - box.low;
  if (!is_finite(size) || size.x < 0) return;
  if (parts > 1 && end - begin >= 2 * least_triangles) {
    int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    auto middle = boxes.begin() + long((begin + end) / 2);
    std::nth_element(boxes.begin() + long(begin), middle, boxes.begin() + long(end),
                     [axis](const Bounds& a, const Bounds& b) {
                       return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
                     });
    std::vector<CasterSphere> split;
    add_spheres(boxes, begin, (begin + end) / 2, parts / 2, weight, split);
    add_spheres(boxes, (begin + end) / 2, end, parts - parts / 2, weight, split);
    float discs = 0;
    for (const CasterSphere& s : split) discs += s.radius * s.radius;
    if (discs < 0.75f * 0.25f * dot(size, size)) {
      spheres.insert(spheres.end(), split.begin(), split.end());
      return;
    }
  }
  float radius = 0.5f * length(size) * 1.0001f;
  if (radius > 0) spheres.push_back({box.low + 0.5f * size, radius, weight});
}

float weight_of(const Material& m) {
  float f0 = (m.ior - 1) / (m.ior + 1);
  float faint = std::clamp(std::max(f0 * f0 * m.specular, 0.04f * m.clearcoat), 0.02f, 1.0f);
  return std::max({std::clamp(m.metallic, 0.0f, 1.0f), std::clamp(m.transmission, 0.0f, 1.0f),
                   m.ior == 0 ? 1.0f : faint});
}

// Returns the solid angle of a sphere; from inside it is all around.
float solid_angle(const CasterSphere& c, vec3 from) {
  vec3 line = c.center - from;
  float d2 = dot(line, line), r2 = c.radius * c.radius;
  if (d2 <= r2) return 4 * pi;
  float sine2 = r2 / d2;
  return 2 * pi * sine2 / (1 + std::sqrt(1 - sine2));
}

bool sees(const CasterSphere& c, vec3 from, vec3 direction) {
  vec3 line = c.center - from;
  float d2 = dot(line, line), r2 = c.radius * c.radius;
  if (d2 <= r2) return true;
  float along = dot(line, direction);
  return along > 0 && d2 - along * along <= r2 * 1.000001f;
}

}  // namespace

std::vector<CasterSphere> find_casters(const World& world, const TransportPlan& plan, bool moving) {
  std::vector<CasterSphere> spheres;
  if (!plan.uses(TransportPart::caustics)) return spheres;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    const PlacedMesh& placed = world.placed(i);
    size_t material = size_t(placed.mesh->material);
    if (placed.moving != moving || !plan.materials[material].sharp) continue;
    std::vector<Bounds> boxes;
    for (const uvec3& t : placed.mesh->triangles) {
      Bounds box;
      for (uint32_t v : {t.x, t.y, t.z}) {
        vec3 p = placed.mesh->positions[v];
        if (!placed.moving) p = vec3(placed.to_world * vec4(p, 1));
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
      }
      if (is_finite(box.low) && is_finite(box.high)) boxes.push_back(box);
    }
    add_spheres(boxes, 0, boxes.size(), most_parts, weight_of(*placed.material), spheres);
  }
  return spheres;
}

float sample_caster_pdf(std::span<const CasterSphere> casters, vec3 from, vec3 direction) {
  float total = 0, density = 0;
  for (const CasterSphere& c : casters) {
    total += c.weight * solid_angle(c, from);
    if (sees(c, from, direction)) density += c.weight;
  }
  return total > 0 ? density / total : 0;
}

vec3 sample_caster(std::span<const CasterSphere> casters, vec3 from, vec2 u) {
  float total = 0;
  for (const CasterSphere& c : casters) total += c.weight * solid_angle(c, from);
  float left = u.x * total, share = 0;
  size_t chosen = 0;
  for (; chosen < casters.size(); chosen++) {
    share = casters[chosen].weight * solid_angle(casters[chosen], from);
    if (left < share || chosen + 1 == casters.size()) break;
    left -= share;
  }
  if (!(share > 0)) return vec3(0, 1, 0);
  u.x = std::clamp(left / share, 0.0f, 0x1.fffffep-1f);
  const CasterSphere& c = casters[chosen];
  vec3 line = c.center - from;
  float d2 = dot(line, line), r2 = c.radius * c.radius;
  if (d2 <= r2) return sample_sphere(u);
  float sine2 = r2 / d2, height = sine2 / (1 + std::sqrt(1 - sine2));  // 1 - cosine
  float rise = u.x * height, z = 1 - rise, radius = std::sqrt(std::max(0.0f, rise * (2 - rise)));
  vec3 axis = line / std::sqrt(d2), tangent, bitangent;
  make_frame_axes(axis, tangent, bitangent);
  float phi = 2 * pi * u.y;
  return normalize(tangent * (radius * std::cos(phi)) + bitangent * (radius * std::sin(phi)) +
                   axis * z);
}

}  // namespace wellspring::light
