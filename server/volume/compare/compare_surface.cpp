// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/compare_surface.h"

#include <algorithm>
#include <cmath>

namespace wellspring::volume {
namespace {

constexpr size_t most_points = 4'000'000;

ColorScale scale_of(const Comparison& comparison) {
  double range = 0;
  for (const auto& one : comparison.summary.percentiles)
    range = std::max(range, std::abs(one.distance) * 1000);
  return distance_scale(range > 0 ? range : comparison.voxel * 1000);
}

}  // namespace

Comparison compare_surface(const DensityField& field, const CompareSettings& settings,
                           SurfaceMesh& mesh) {
  Comparison comparison;
  comparison.triangles = mesh.triangles.size(), comparison.vertices = mesh.positions.size();
  comparison.flat_triangles = flat_triangles(mesh);
  comparison.grid = field.grid.size, comparison.voxel = field.voxel;
  comparison.settings = settings.cone;
  comparison.threshold = slope_threshold(field, settings.cone);
  if (settings.registers) {
    RegistrationSettings registration;
    registration.kept_share = settings.kept_share, registration.reach = settings.cone.reach;
    registration.threshold = settings.cone.threshold;
    comparison.registration = register_surface(mesh, field, settings.pairs, registration);
    mesh = moved(mesh, comparison.registration->to_volume);
  }
  comparison.points = triangle_points(mesh, settings.spacing_voxels * field.voxel, most_points);
  const std::vector<SurfacePoint> vertices = vertex_points(mesh);
  comparison.points.insert(comparison.points.end(), vertices.begin(), vertices.end());
  comparison.deviations = find_deviations(field, comparison.points, comparison.settings);
  comparison.summary = summarize(comparison.points, comparison.deviations);
  comparison.scale = scale_of(comparison);
  return comparison;
}

}  // namespace wellspring::volume
