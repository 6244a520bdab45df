// SPDX-License-Identifier: Apache-2.0
#include "cache/point_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "cache/packing.h"
#include "light/material/material_use.h"
#include "light/walk/first_surface.h"
#include "world/surface.h"

namespace wellspring::cache {
namespace {

using ManyBytes = uint8_t __attribute__((vector_size(32)));
using GroupBytes = uint8_t __attribute__((vector_size(8)));
static_assert(group_size == sizeof(GroupBytes), "capacities are whole groups");

template <class Bytes>
void age_some(uint8_t* age, const uint8_t* flags, uint8_t step) {
  Bytes base = Bytes{} + step, flag = load_lanes<Bytes>(flags), old = load_lanes<Bytes>(age);
  Bytes seen = lanes_as<Bytes>((flag & uint8_t(point_visible)) != 0),
        fast = lanes_as<Bytes>((flag & uint8_t(point_specular | point_moving)) != 0);
  Bytes sum = old + (base + (uint8_t(2) * base & fast) + (base & ~seen));
  sum |= lanes_as<Bytes>(sum < old);  // the sum wraps around beyond 255
  // A seen point stops one before eviction; one that was evicted meanwhile stays evicted.
  sum += seen & lanes_as<Bytes>(sum == evicted_age);
  store_lanes(age, sum | lanes_as<Bytes>(old == evicted_age));
}

}  // namespace

void resize_points(PointCache& points, int capacity) {
  capacity = std::clamp(capacity, int(group_size), max_capacity);
  size_t size = (size_t(capacity) + group_size - 1) / group_size * group_size;
  if (size == points.x.size()) return;
  constexpr float nowhere = std::numeric_limits<float>::quiet_NaN();
  auto fit = [size](auto& values, auto fill) {
    values.resize(size, fill);
    values.shrink_to_fit();
  };
  fit(points.x, nowhere);
  fit(points.y, nowhere);
  fit(points.z, nowhere);
  fit(points.normal, uint16_t(0));
  fit(points.flags, uint8_t(0));
  fit(points.age, evicted_age);
  fit(points.count, uint8_t(0));
  fit(points.color, PointColor{});
  fit(points.seen, uint64_t(0));
  points.seen.resize((size + 63) / 64);
  points.seen.shrink_to_fit();
  std::erase_if(points.anchors, [size](const Anchor& a) { return a.point >= size; });
  points.anchors.reserve(size_t(max_anchors(int(size))));
  points.next_group = 0;
}

void clear_points(PointCache& points) {
  std::fill(points.flags.begin(), points.flags.end(), uint8_t(0));
  std::fill(points.age.begin(), points.age.end(), evicted_age);
  std::fill(points.count.begin(), points.count.end(), uint8_t(0));
  std::fill(points.x.begin(), points.x.end(), std::numeric_limits<float>::quiet_NaN());
  points.anchors.clear();
  points.next_group = 0;
}

int max_anchors(int capacity) { return std::max(64, capacity / 8); }

void age_points(PointCache& points, float new_points) {
  int capacity = points.capacity();
  if (capacity == 0) return;
  float step = 128 * std::clamp(new_points, 0.0f, float(capacity)) / float(capacity);
  points.age_carry += step;
  int whole = int(points.age_carry);
  points.age_carry -= float(whole);
  whole = std::min(whole, 63);  // four times as much must fit a byte
  if (whole == 0) return;
  uint8_t* age = points.age.data();
  const uint8_t* flags = points.flags.data();
  parallel_ranges(capacity / int(group_size), 1 << 12, [=](int begin, int end) {
    size_t i = size_t(begin) * group_size, last = size_t(end) * group_size;
    for (; i + sizeof(ManyBytes) <= last; i += sizeof(ManyBytes))
      age_some<ManyBytes>(age + i, flags + i, uint8_t(whole));
    for (; i < last; i += sizeof(GroupBytes))
      age_some<GroupBytes>(age + i, flags + i, uint8_t(whole));
  });
}

void invalidate_light_of(PointCache& points, uint32_t i, int ageing) {
  if (points.age[i] == evicted_age) return;
  points.age[i] = uint8_t(std::min(points.age[i] + ageing, oldest_age));
  points.count[i] = 0;
  points.color[i].noise = forgotten_noise;
  points.color[i].doubts = 0;
  points.flags[i] |= point_relit;
}

void invalidate_light(PointCache& points, const Forgotten& forgotten) {
  parallel_ranges(points.capacity(), 1 << 14, [&](int begin, int end) {
    for (uint32_t i = uint32_t(begin); i < uint32_t(end); i++) {
      vec3 kept(1), added(0);
      if (!is_alive(points, i) || !forgotten(i, kept, added)) continue;
      invalidate_light_of(points, i, oldest_age);
      PointColor& color = points.color[i];
      color.smooth = pack_rgb9e5(kept * unpack_rgb9e5(color.smooth) + added);
      color.rest = pack_rgb9e5(kept * unpack_rgb9e5(color.rest));
    }
  });
}

bool invalidate_paint(PointCache& points, const World& world, const std::vector<char>& repainted) {
  std::atomic<bool> found = false;
  parallel_ranges(int(points.anchors.size()), 512, [&](int begin, int end) {
    for (int k = begin; k < end; k++) {
      const Anchor& a = points.anchors[size_t(k)];
      size_t i = a.point;
      if (a.instance >= repainted.size() || !repainted[a.instance] || !is_alive(points, a.point))
        continue;
      found = true;
      invalidate_light_of(points, uint32_t(i), oldest_age);
      vec3 place(points.x[i], points.y[i], points.z[i]), way = unpack_normal(points.normal[i]);
      Hit hit{1, a.instance, a.triangle, vec2(a.u, a.v) * (1.0f / 65535)};
      Surface surface = eval_surface(world, {.origin = place + way, .direction = -way}, hit);
      bool known = surface.transmission == 0 && surface.anisotropy == 0 &&
                   !world.material_of(a.instance).unlit;
      if (!known) continue;
      // This place alone says here whether the material is metal; the next sample knows better.
      bool metal =
          surface.metallic >= all_metal && surface.roughness >= least_demodulated_roughness;
      points.color[i].albedo = pack_albedo(demodulated_albedo(
          surface, metal ? MetalDemodulation::reflectance : MetalDemodulation::none));
    }
  });
  return found;
}

void find_on_mesh(const World& world, uint32_t instance, uint32_t triangle, vec2 barycentric,
                  vec3& place, vec3& normal) {
  if (instance >= uint32_t(world.instance_count())) return;
  const Mesh& mesh = world.mesh_of(instance);
  if (triangle >= mesh.triangles.size()) return;
  uvec3 corner = mesh.triangles[triangle];
  float u = barycentric.x, v = barycentric.y, w = 1 - u - v;
  vec3 p =
      w * mesh.positions[corner.x] + u * mesh.positions[corner.y] + v * mesh.positions[corner.z];
  vec3 n = w * mesh.normals[corner.x] + u * mesh.normals[corner.y] + v * mesh.normals[corner.z];
  if (!world.is_moving(instance)) {  // a scene instance that a technique marked as moving
    p = vec3(world.to_world(instance) * vec4(p, 1));
    n = world.normal_to_world(instance) * n;
  }
  place = p;
  // Normals of samples face the eye that saw them.
  normal = dot(normal, n) < 0 ? -n : n;
}

void move_anchored_points(PointCache& points, const World& world) {
  auto& anchors = points.anchors;
  if (anchors.empty()) return;
  // The newest anchor of a point counts: walk backwards, keep the first seen of each living point.
  std::fill(points.seen.begin(), points.seen.end(), 0);
  uint32_t instances = uint32_t(world.instance_count());
  size_t kept = anchors.size();
  for (size_t i = anchors.size(); i-- > 0;) {
    const Anchor& a = anchors[i];
    uint64_t bit = uint64_t(1) << (a.point & 63);
    bool alive = (points.flags[a.point] & point_moving) && is_alive(points, a.point);
    if (!alive || (points.seen[a.point >> 6] & bit) || a.instance >= instances) continue;
    if (a.triangle >= world.mesh_of(a.instance).triangles.size()) continue;
    points.seen[a.point >> 6] |= bit;
    anchors[--kept] = a;
  }
  anchors.erase(anchors.begin(), anchors.begin() + ptrdiff_t(kept));
  parallel_ranges(int(anchors.size()), 2048, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const Anchor& a = anchors[size_t(i)];
      vec3 p(points.x[a.point], points.y[a.point], points.z[a.point]);
      vec3 n = unpack_normal(points.normal[a.point]);
      find_on_mesh(world, a.instance, a.triangle, vec2(a.u, a.v) * (1.0f / 65535), p, n);
      points.x[a.point] = p.x;
      points.y[a.point] = p.y;
      points.z[a.point] = p.z;
      points.normal[a.point] = points.color[a.point].normal = pack_normal(n);
    }
  });
}

size_t points_bytes(const PointCache& points) {
  return bytes_of(points.x, points.y, points.z, points.normal, points.flags, points.age,
                  points.count, points.color, points.anchors, points.seen);
}

}  // namespace wellspring::cache
