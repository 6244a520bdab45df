// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "volume/compare/ray_lanes.h"

namespace wellspring::volume {

namespace {

constexpr vec3 inside_color{0.95f, 0.75f, 0.05f}, outside_color{0.05f, 0.2f, 0.9f};

using CubePlace = std::array<int64_t, 3>;

dvec3 in_cubes(dvec3 position, const LensArea& lens, double size) {
  return (position - lens.middle) / size;
}

std::map<CubePlace, std::vector<size_t>> lens_cubes(const std::vector<SurfacePoint>& points,
                                                    const LensArea& lens, double size) {
  // A cube is never so small that the lens holds more of them than anybody can look at.
  std::map<CubePlace, std::vector<size_t>> cubes;
  for (size_t i = 0; i < points.size(); i++) {
    if (!(glm::distance(points[i].position, lens.middle) <= lens.radius)) continue;
    const dvec3 place = glm::floor(in_cubes(points[i].position, lens, size) + 0.5);
    cubes[{int64_t(place.x), int64_t(place.y), int64_t(place.z)}].push_back(i);
  }
  return cubes;
}

double cube_size(const LensArea& lens, double size) { return std::max(size, lens.radius / 256); }

// Returns the value at a share of the sorted ones, between neighbours in a line.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * double(sorted.size() - 1);
  const size_t before = std::min(size_t(place), sorted.size() - 1);
  const size_t after = std::min(before + 1, sorted.size() - 1);
  return sorted[before] + (sorted[after] - sorted[before]) * (place - double(before));
}

}  // namespace

DistanceGlyph distance_glyph(const SurfacePoint& point, const Deviation& deviation,
                             double tolerance) {
  DistanceGlyph glyph{point.position,      point.normal,    0,
                      deviation.cone_base, FoundSide::none, vec3(1)};
  if (!deviation.found || std::abs(deviation.distance) <= tolerance) return glyph;
  glyph.arrow = -deviation.distance;
  glyph.side = deviation.distance > 0 ? FoundSide::inside : FoundSide::outside;
  glyph.disc_color = deviation.distance > 0 ? inside_color : outside_color;
  return glyph;
}

BoxPlot box_plot(const std::vector<SurfacePoint>& points, const std::vector<Deviation>& deviations,
                 const std::vector<size_t>& chosen) {
  BoxPlot plot;
  plot.count = chosen.size();
  if (chosen.empty()) return plot;
  std::vector<double> distances;
  dvec3 normal(0);
  double squares = 0;
  for (size_t i : chosen) {
    plot.position += points[i].position / double(chosen.size());
    plot.diameter += deviations[i].cone_base / double(chosen.size());
    normal += dvec3(points[i].normal);
    if (!deviations[i].found) continue;
    distances.push_back(deviations[i].distance);
    plot.mean += deviations[i].distance;
    plot.uncertainty += deviations[i].uncertainty;
  }
  const double length = glm::length(normal);
  plot.normal = length > 1e-9 ? vec3(normal / length) : points[chosen[0]].normal;
  plot.found = distances.size();
  if (distances.empty()) return plot;
  plot.mean /= double(plot.found), plot.uncertainty /= double(plot.found);
  for (double distance : distances) squares += (distance - plot.mean) * (distance - plot.mean);
  plot.deviation = std::sqrt(squares / double(plot.found));
  std::sort(distances.begin(), distances.end());
  plot.least = distances.front(), plot.greatest = distances.back();
  plot.lower_quartile = quantile(distances, 0.25);
  plot.median = quantile(distances, 0.5);
  plot.upper_quartile = quantile(distances, 0.75);
  return plot;
}

std::vector<BoxPlot> lens_plots(const std::vector<SurfacePoint>& points,
                                const std::vector<Deviation>& deviations, const LensArea& lens,
                                double size) {
  std::vector<BoxPlot> plots;
  for (const auto& [place, chosen] : lens_cubes(points, lens, cube_size(lens, size)))
    plots.push_back(box_plot(points, deviations, chosen));
  return plots;
}

std::vector<DistanceGlyph> lens_glyphs(const std::vector<SurfacePoint>& points,
                                       const std::vector<Deviation>& deviations,
                                       const LensArea& lens, double size, double tolerance) {
  size = cube_size(lens, size);
  std::vector<DistanceGlyph> glyphs;
  for (const auto& [place, chosen] : lens_cubes(points, lens, size)) {
    const dvec3 middle(place[0], place[1], place[2]);
    const size_t nearest = *std::min_element(chosen.begin(), chosen.end(), [&](size_t a, size_t b) {
      return glm::distance(in_cubes(points[a].position, lens, size), middle) <
             glm::distance(in_cubes(points[b].position, lens, size), middle);
    });
    glyphs.push_back(distance_glyph(points[nearest], deviations[nearest], tolerance));
  }
  return glyphs;
}

RayProfile ray_profile(const DensityField& field, const SurfacePoint& point,
                       const Deviation& deviation, const ConeSettings& settings) {
  RayProfile profile;
  const vec3 ray = deviation.found ? deviation.ray : point.normal;
  const LineScale scale = line_scale(field, ray, settings.threshold);
  LineBatch line;
  line.middle = all_lanes(vec3(field.to_index * glm::dvec4(point.position, 1)));
  line.step = all_lanes(scale.step);
  const double reach = std::clamp(settings.reach, 1.0, longest_reach - 1) * field.voxel;
  const int steps = std::clamp(int(reach / scale.metres), 1, most_line_steps - 1);
  const std::vector<float> slopes = line_slopes(field, line, steps);
  for (int i = -steps; i <= steps; i++) {
    profile.places.push_back(i * scale.metres);
    profile.slopes.push_back(double(slopes[size_t(i + steps)]) / scale.metres);
  }
  profile.threshold = scale.threshold / scale.metres;
  profile.found = deviation.found;
  profile.distance = deviation.distance;
  profile.boundary = -profile.distance;
  return profile;
}

}  // namespace wellspring::volume
