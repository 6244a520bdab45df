// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/cone_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "volume/compare/ray_lanes.h"

namespace wellspring::volume {

namespace {

// Cones that are narrower are their axis: other rays would find the same place.
constexpr float narrowest_cone = 1.5f * pi / 180;
// Nearer boundaries are not looked for once one is this near, in voxels.
constexpr float near_enough = 0.005f;

struct ConeSearch {
  const DensityField& field;
  const ConeSettings& settings;
  float reach = 0;  // metres
};

// The nearest boundary that was found from a point so far.
struct NearestBoundary {
  vec3 ray{0};
  float offset = 0;  // metres
  bool found = false;
};

bool can_measure(const SurfacePoint& point) {
  return std::isfinite(point.position.x) && std::isfinite(point.position.y) &&
         std::isfinite(point.position.z) && is_finite(point.normal) &&
         glm::dot(point.normal, point.normal) > 0.5f;
}

vec3 middle_of(const ConeSearch& search, const SurfacePoint& point) {
  return vec3(search.field.to_index * glm::dvec4(point.position, 1));
}

// Collects lines, and what a step of each is worth.
struct ConeLines {
  const ConeSearch& search;
  LineBatch lines{};
  float metres[lane_count] = {};

  explicit ConeLines(const ConeSearch& search) : search(search) { clear(); }
  void clear() { lines.limit = all_lanes(-1); }
  void set(int lane, vec3 middle, vec3 ray) {
    const LineScale scale = line_scale(search.field, ray, search.settings.threshold);
    lines.middle.set(lane, middle);
    lines.step.set(lane, scale.step);
    lines.threshold[lane] = float(scale.threshold);
    metres[lane] = float(scale.metres);
  }
  // Boundaries farther away than `limit` metres do not count.
  void limit(int lane, float limit) {
    lines.limit[lane] = std::min(limit / metres[lane], float(most_line_steps - 1));
  }
  LineHits look() const {
    return first_boundaries(search.field, lines, search.settings.boundary == Boundary::falling);
  }
};

// Finds the boundaries along the axes of eight points.
void search_axes(const ConeSearch& search, const SurfacePoint* points, int count,
                 NearestBoundary* nearest) {
  ConeLines lines(search);
  for (int i = 0; i < count; i++) {
    if (!can_measure(points[i])) continue;
    lines.set(i, middle_of(search, points[i]), points[i].normal);
    lines.limit(i, search.reach);
  }
  const LineHits hits = lines.look();
  for (int i = 0; i < count; i++)
    nearest[i] = {points[i].normal, hits.offset[i] * lines.metres[i], hits.found[i] != 0};
}

// Shoots rays from one point, eight at a time, and calls each(ray, offset in metres) for each that
// meets a boundary. `limit` returns how many metres away boundaries still count.
template <class Limit, class Each>
struct RayShooter {
  vec3 middle;
  Limit limit;
  Each each;
  ConeLines lines;
  vec3 rays[lane_count] = {};
  int waiting = 0;

  void shoot(vec3 ray) {
    rays[waiting] = ray;
    lines.set(waiting, middle, ray);
    if (++waiting == lane_count) finish();
  }
  void finish() {
    if (waiting == 0) return;
    for (int i = 0; i < waiting; i++) lines.limit(i, limit());
    const LineHits hits = lines.look();
    for (int i = 0; i < waiting; i++)
      if (hits.found[i]) each(rays[i], hits.offset[i] * lines.metres[i]);
    waiting = 0;
    lines.clear();
  }
};

// Calls each(ray) for `count` rays at an angle around an axis.
template <class Each>
void each_ray_around(vec3 axis, float angle, int count, const Each& each) {
  const vec3 other = std::abs(axis.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 right = glm::normalize(glm::cross(axis, other)), up = glm::cross(right, axis);
  const float along = std::cos(angle), beside = std::sin(angle);
  for (int i = 0; i < count; i++) {
    const float turn = 2 * pi * (float(i) + 0.5f) / float(count);
    each(axis * along + (right * std::cos(turn) + up * std::sin(turn)) * beside);
  }
}

// Improves on the axis by concentric circles of rays whose density is nearly constant.
void search_cone(const ConeSearch& search, const SurfacePoint& point, NearestBoundary& nearest) {
  auto limit = [&] { return nearest.found ? std::abs(nearest.offset) : search.reach; };
  auto keep = [&](vec3 ray, float offset) {
    if (!nearest.found || std::abs(offset) < std::abs(nearest.offset))
      nearest = {ray, offset, true};
  };
  RayShooter<decltype(limit), decltype(keep)> shooter{middle_of(search, point), limit, keep,
                                                      ConeLines(search)};
  const int circles = std::max(1, int(std::ceil(point.search_angle / search.settings.ray_spacing)));
  for (int circle = 1; circle <= circles; circle++) {
    const float angle = point.search_angle * float(circle) / float(circles);
    const float spacing = point.search_angle / float(circles);
    each_ray_around(point.normal, angle,
                    std::max(6, int(std::ceil(2 * pi * std::sin(angle) / spacing))),
                    [&](vec3 ray) { shooter.shoot(ray); });
    if (nearest.found && std::abs(nearest.offset) < near_enough * search.field.voxel) return;
  }
  shooter.finish();
}

float uncertainty_of(const ConeSearch& search, const SurfacePoint& point,
                     const NearestBoundary& nearest) {
  const float voxel = float(search.field.voxel);
  float farthest = std::abs(nearest.offset);
  const float angle = std::min(point.search_angle, std::atan2(voxel, farthest));
  auto limit = [&] { return search.reach; };
  auto keep = [&](vec3, float offset) { farthest = std::max(farthest, std::abs(offset)); };
  RayShooter<decltype(limit), decltype(keep)> shooter{middle_of(search, point), limit, keep,
                                                      ConeLines(search)};
  each_ray_around(nearest.ray, angle, lane_count, [&](vec3 ray) { shooter.shoot(ray); });
  return farthest - std::abs(nearest.offset);
}

Deviation measure(const ConeSearch& search, const SurfacePoint& point, NearestBoundary nearest) {
  Deviation result;
  if (!can_measure(point)) return result;
  const bool has_cone = point.search_angle > narrowest_cone;
  result.cone_base = 2 * search.reach * std::sin(point.search_angle);
  if (has_cone) search_cone(search, point, nearest);
  if (!nearest.found) return result;
  result.found = true;
  result.ray = nearest.ray;
  result.boundary = point.position + dvec3(nearest.ray) * double(nearest.offset);
  result.distance = -nearest.offset;
  if (has_cone) result.uncertainty = uncertainty_of(search, point, nearest);
  const dvec3 gradient = density_gradient(search.field, result.boundary);
  const double steepness = glm::length(gradient);
  if (!(steepness > 0)) return result;
  result.boundary_normal = vec3(-gradient / steepness);
  float cosine = glm::dot(result.boundary_normal, point.normal);
  if (search.settings.boundary == Boundary::any) cosine = std::abs(cosine);
  result.normal_angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  return result;
}

}  // namespace

double slope_threshold(const DensityField& field, const ConeSettings& settings) {
  if (settings.threshold > 0) return settings.threshold;
  const double apart = field.high - field.low;
  return apart > 0 ? apart / field.voxel / 10 : std::numeric_limits<double>::infinity();
}

std::vector<Deviation> find_deviations(const DensityField& field,
                                       const std::vector<SurfacePoint>& points,
                                       const ConeSettings& settings) {
  ConeSearch search{field, settings};
  search.reach = float(std::clamp(settings.reach, 1.0, longest_reach - 1) * field.voxel);
  std::vector<Deviation> results(points.size());
  const int batches = int((points.size() + lane_count - 1) / lane_count);
  parallel_ranges(batches, 8, [&](int begin, int end) {
    for (int batch = begin; batch < end; batch++) {
      const size_t first = size_t(batch) * lane_count;
      const int count = int(std::min(points.size() - first, size_t(lane_count)));
      NearestBoundary nearest[lane_count];
      search_axes(search, &points[first], count, nearest);
      for (int i = 0; i < count; i++)
        results[first + size_t(i)] = measure(search, points[first + size_t(i)], nearest[i]);
    }
  });
  return results;
}

}  // namespace wellspring::volume
