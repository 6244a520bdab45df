// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/splat_merge.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace wellspring::scan {
namespace {

struct CellSplat {
  glm::ivec3 cell;
  bool large;
  uint32_t number;
  auto key() const { return std::make_tuple(cell.z, cell.y, cell.x, large); }
};

// Returns about how much of a picture an ellipsoid covers, as seen from all sides.
double covered_area(dvec3 s) { return s.x * s.y + s.y * s.z + s.z * s.x; }

// Turns a symmetric matrix to its axes by Jacobi's rotations; the columns of `axes` become them,
// and the result is the spreads along them.
dvec3 main_axes(glm::dmat3 m, glm::dmat3& axes) {
  axes = glm::dmat3(1);
  for (int round = 0; round < 12; round++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (std::abs(m[p][q]) <= 1e-300) continue;
        const double theta = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]);
        const double c = std::cos(theta), s = std::sin(theta);
        glm::dmat3 turn(1);
        turn[p][p] = c, turn[q][q] = c, turn[q][p] = s, turn[p][q] = -s;
        m = glm::transpose(turn) * m * turn;
        axes = axes * turn;
      }
  return glm::sqrt(glm::max(dvec3(m[0][0], m[1][1], m[2][2]), 0.0));
}

glm::dmat3 covariance(const SplatSet& set, size_t i) {
  const glm::dquat turn(glm::normalize(glm::dquat(set.turn[i])));
  glm::dmat3 axes = glm::mat3_cast(turn);
  for (int k = 0; k < 3; k++) axes[k] *= double(set.scale[i][k]);
  return axes * glm::transpose(axes);
}

// Opacity and size of what is merged follow from what it covers: where it cannot be more opaque it
// grows, so that as much light is stopped as by all of its splats.
void append_merged(SplatSet& out, const SplatSet& set, std::span<const CellSplat> group) {
  const size_t count = size_t(splat_harmonics[set.degree]);
  double sum = 0, covered = 0;
  dvec3 mean(0), color(0);
  dvec3 harmonics[splat_harmonics[3]] = {};
  const auto weight = [&](size_t i) {
    return double(set.opacity[i]) * (covered_area(dvec3(set.scale[i])) + 1e-30);
  };
  for (const CellSplat& s : group) {
    const size_t i = s.number;
    const double w = weight(i);
    sum += w;
    covered += double(set.opacity[i]) * covered_area(dvec3(set.scale[i]));
    mean += w * dvec3(set.place[i]);
    color += w * dvec3(set.color[i]);
    for (size_t k = 0; k < count; k++) harmonics[k] += w * dvec3(set.harmonics[i * count + k]);
  }
  mean /= sum;
  glm::dmat3 spread(0);
  for (const CellSplat& s : group) {
    const dvec3 away = dvec3(set.place[s.number]) - mean;
    spread +=
        (weight(s.number) / sum) * (covariance(set, s.number) + glm::outerProduct(away, away));
  }
  glm::dmat3 axes;
  dvec3 scale = main_axes(spread, axes);
  const double area = covered_area(scale);
  double opacity = area > 0 ? covered / area : 1;
  if (opacity > 1) {
    scale *= std::sqrt(std::min(opacity, 2.0));
    opacity = 1;
  }
  if (glm::determinant(axes) < 0) axes[2] = -axes[2];
  out.place.push_back(vec3(mean));
  out.scale.push_back(vec3(scale));
  out.turn.push_back(quat(glm::normalize(glm::quat_cast(axes))));
  out.opacity.push_back(float(opacity));
  out.color.push_back(vec3(color / sum));
  for (size_t k = 0; k < count; k++) out.harmonics.push_back(vec3(harmonics[k] / sum));
}

}  // namespace

void append_splat(SplatSet& set, const SplatSet& from, size_t i, vec3 middle) {
  const size_t count = size_t(splat_harmonics[from.degree]);
  set.place.push_back(from.place[i] - middle);
  set.scale.push_back(glm::abs(from.scale[i]));
  const float length = glm::length(from.turn[i]);
  set.turn.push_back(length > 1e-12f ? from.turn[i] / length : quat(1, 0, 0, 0));
  set.opacity.push_back(glm::min(from.opacity[i], 1.0f));
  set.color.push_back(from.color[i]);
  const vec3* harmonics = from.harmonics.data() + i * count;
  set.harmonics.insert(set.harmonics.end(), harmonics, harmonics + count);
}

SplatSet merge_in_cells(const SplatSet& set, float cell) {
  std::vector<CellSplat> cells(set.size());
  for (size_t i = 0; i < set.size(); i++)
    cells[i] = {glm::ivec3(glm::clamp(glm::floor(set.place[i] / cell), -2e9f, 2e9f)),
                max_component(set.scale[i]) > cell, uint32_t(i)};
  std::stable_sort(cells.begin(), cells.end(),
                   [](const CellSplat& a, const CellSplat& b) { return a.key() < b.key(); });
  SplatSet merged;
  merged.degree = set.degree;
  for (size_t begin = 0, end; begin < cells.size(); begin = end) {
    for (end = begin + 1; end < cells.size() && cells[end].key() == cells[begin].key();) end++;
    const std::span<const CellSplat> group(cells.data() + begin, end - begin);
    if (group.size() == 1) append_splat(merged, set, group[0].number, vec3(0));
    else append_merged(merged, set, group);
  }
  return merged;
}

}  // namespace wellspring::scan
