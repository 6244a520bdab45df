// SPDX-License-Identifier: Apache-2.0
#include "light/kept/moving_shade.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/sample/sample_light.h"
#include "world/one_ray.h"

namespace wellspring::light {
namespace {

constexpr float least_cell = 0.08f;        // metres a side
constexpr float cells_across = 24;         // cells along a group's diagonal
constexpr float reach_share = 0.7f;        // reach as a share of the diagonal
constexpr float most_reach = 2;            // metres
constexpr float most_weight = 2.5f;        // weight of light from one direction
constexpr float most_folds = 1.5f;         // sides of a cell that its surface covers
constexpr float clear_of_surface = 2e-3f;  // metres
constexpr int most_hits = 16;              // surfaces that a shadow ray passes
constexpr int most_parts = 32;             // parts of a triangle's side

float distance_to(const Bounds& box, vec3 place) {
  return length(max(max(box.low - place, place - box.high), vec3(0)));
}

bool overlap(const Bounds& a, const Bounds& b) {
  for (int axis = 0; axis < 3; axis++)
    if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  return true;
}

void widen(Bounds& box, const Bounds& by, float more = 0) {
  box.low = min(box.low, by.low - more), box.high = max(box.high, by.high + more);
}

Bounds bounds_of(const Mesh& mesh) {
  Bounds box;
  for (const vec3& p : mesh.positions) box.low = min(box.low, p), box.high = max(box.high, p);
  return box;
}

// Calls add(middle, part) for parts of the triangle that are no wider than `side`; `part`: its area
// along its normal.
template <class Add>
void split(const std::array<vec3, 3>& corner, float side, const Add& add) {
  const vec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
  const float longest = std::max({length(u), length(v), length(u - v)});
  const int parts = std::clamp(int(std::ceil(longest / side)), 1, most_parts);
  const float step = 1 / float(parts);
  const vec3 part = 0.5f * step * step * cross(u, v);
  for (int i = 0; i < parts; i++)
    for (int k = 0; k < 2 * (parts - i) - 1; k++) {
      // Two triangles of a square, the second one turned round.
      const float third = k & 1 ? 2 / 3.0f : 1 / 3.0f;
      add(corner[0] + u * ((float(i) + third) * step) + v * ((float(k / 2) + third) * step), part);
    }
}

// Holds a part of a surface.
struct CellSum {
  vec3 place{0};  // times its area
  float area = 0;
  vec3 front{0}, back{0};
};

}  // namespace

MovingShade::MovingShade(const World& world) {
  std::vector<std::pair<Bounds, std::vector<uint32_t>>> parts;
  for (uint32_t i = uint32_t(world.scene().instances.size()); i < uint32_t(world.instance_count());
       i++) {
    if (!world.is_visible(i)) continue;
    const Bounds box = bounds_of(world.mesh_of(i));
    if (box.low.x <= box.high.x) parts.push_back({box, {i}});
  }
  // Clothes lie around a body: together they hide no more than the body.
  for (size_t i = 0; i < parts.size(); i++)
    for (size_t k = i + 1; k < parts.size(); k++) {
      if (!overlap(parts[i].first, parts[k].first)) continue;
      widen(parts[i].first, parts[k].first);
      parts[i].second.insert(parts[i].second.end(), parts[k].second.begin(), parts[k].second.end());
      parts.erase(parts.begin() + ptrdiff_t(k));
      k = i;
    }
  for (const auto& [box, instances] : parts) add_group(world, instances, box);
}

void MovingShade::add_group(const World& world, const std::vector<uint32_t>& instances,
                            const Bounds& box) {
  const float diagonal = length(box.high - box.low);
  const float side = std::max(least_cell, diagonal / cells_across);
  const glm::ivec3 count(glm::floor((box.high - box.low) / side) + 1.0f);
  std::vector<CellSum> sums(size_t(count.x) * size_t(count.y) * size_t(count.z));
  for (const uint32_t instance : instances) {
    const PlacedMesh& placed = world.placed(instance);
    const std::vector<vec3>& corners = placed.mesh->positions;
    const bool both = placed.material->double_sided;
    for (const uvec3& t : placed.mesh->triangles)
      split({corners[t.x], corners[t.y], corners[t.z]}, 0.5f * side, [&](vec3 middle, vec3 part) {
        const glm::ivec3 at =
            glm::clamp(glm::ivec3((middle - box.low) / side), glm::ivec3(0), count - 1);
        CellSum& sum = sums[size_t(at.x + count.x * (at.y + count.y * at.z))];
        if (placed.mirrored) part = -part;
        const float area = length(part);
        sum.place += area * middle, sum.area += area;
        sum.front += max(both ? glm::abs(part) : part, vec3(0));
        sum.back += max(both ? glm::abs(part) : -part, vec3(0));
      });
  }
  Group group{box, std::min(reach_share * diagonal, most_reach), {}};
  int used = lane_count;
  for (const CellSum& sum : sums) {
    if (!(sum.area > 0)) continue;
    if (used == lane_count) group.cells.emplace_back(), used = 0;
    Cells& cells = group.cells.back();
    // None is seen as much larger than its side, however often its surface is folded.
    const vec3 most(most_folds * side * side);
    cells.place.set(used, sum.place / sum.area);
    cells.front.set(used, min(sum.front, most));
    cells.back.set(used++, min(sum.back, most));
  }
  if (group.cells.empty()) return;
  widen(bounds_, box, group.reach);
  groups_.push_back(std::move(group));
}

// Returns the area that faces a place from which it is seen along `way`, of one axis.
static Lanes facing(const Lanes& front, const Lanes& back, const Lanes& way) {
  return way < 0 ? -front * way : back * way;
}

float MovingShade::eval_open(vec3 place, vec3 normal, vec3 slope) const {
  float open = 1;
  // Light is a + b * direction, of which the slope is known at the normal.
  const float even = 1 - dot(slope, normal);
  const Lanes3 n = all_lanes(normal), from = all_lanes(place), ahead = all_lanes(1.5f * slope);
  for (const Group& group : groups_) {
    const float away = distance_to(group.box, place) / group.reach;
    if (away >= 1) continue;
    Lanes sum{};
    for (const Cells& cells : group.cells) {
      const Lanes3 to = cells.place - from;
      const Lanes square = dot(to, to) + 1e-8f, inverse = 1 / lanes_sqrt(square);
      const Lanes3 way = to * inverse;
      const Lanes weight =
          lanes_min(positive_lanes(even + dot(way, ahead)), all_lanes(most_weight));
      const Lanes area = facing(cells.front.x, cells.back.x, way.x) +
                         facing(cells.front.y, cells.back.y, way.y) +
                         facing(cells.front.z, cells.back.z, way.z);
      sum += weight * area * positive_lanes(dot(way, n)) / (pi * square + area);
    }
    // Cells that hide one another hide no more than all of the light.
    const float all = lanes_sum(sum),
                hidden = all / std::sqrt(std::sqrt(1 + all * all * all * all));
    open *= 1 - hidden * (1 - away * away * away * away);
  }
  return open;
}

bool MovingShade::crosses(const Ray& ray) const {
  return std::ranges::any_of(groups_,
                             [&](const Group& group) { return meets(group.box, ray, ray.t_max); });
}

namespace {

constexpr uint32_t no_stand_in = 0xffffffffu;

vec3 any_across(vec3 normal) {
  return cross(normal, std::abs(normal.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0));
}

// Returns whether only what moves keeps the light of a shadow ray away.
bool is_kept_away(const World& world, Ray ray, uint32_t stand_in, float near) {
  bool moves = false;
  for (int k = 0; k < most_hits; k++) {
    const Hit hit = world.intersect(ray);
    if (!hit.valid()) break;
    if (world.is_moving(hit.instance)) moves = true;
    // If it is dark there anyway, nothing is lost.
    else if (hit.instance != stand_in || hit.t > near) return false;
    ray.t_min = hit.t + clear_of_surface;
  }
  return moves;
}

}  // namespace

float MovingShade::eval_lamp(const World& world, vec3 place, vec3 way, float distance) const {
  const Ray ray{place, 0, way, distance};
  return crosses(ray) && is_kept_away(world, ray, no_stand_in, 0) ? 0.0f : 1.0f;
}

vec3 MovingShade::shade(const World& world, const LightTables& tables, vec3 place, vec3 normal,
                        const StandInLit& lit, uint32_t stand_in, float near, float width) const {
  // Four places of the block tell how much of it a shadow covers.
  const vec3 along = 0.25f * width * normalize(any_across(normal)), across = cross(normal, along);
  vec3 blocked(0);
  for (size_t i = 0; i < tables.punctual.size(); i++) {
    const LightSample sent =
        eval_punctual(tables.punctual[i], tables.cones[i], {.position = place});
    const float cosine = dot(normal, sent.direction);
    const Ray ray{place + clear_of_surface * normal, 0, sent.direction, sent.distance};
    if (!(sent.pdf > 0) || cosine <= 0 || !crosses(ray)) continue;
    int hidden = 0;
    for (const vec3 aside : {along + across, along - across, -along - across, across - along}) {
      Ray beside = ray;
      beside.origin += aside;
      hidden += is_kept_away(world, beside, stand_in, near);
    }
    blocked += sent.radiance * (0.25f * float(hidden) * cosine / pi);
  }
  // Light that a shadow leaves comes from all around.
  const bool sharp = luminance(blocked) > 0;
  return max(lit.light - blocked, vec3(0)) * eval_open(place, normal, sharp ? vec3(0) : lit.slope);
}

}  // namespace wellspring::light
