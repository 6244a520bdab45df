// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"
#include "base/rng.h"
#include "volume/compare/cone_search.h"
#include "volume/compare/nearest_point.h"
#include "volume/compare/rigid.h"

namespace wellspring::volume {

namespace {

constexpr size_t most_boundary_points = 30'000, most_surface_points = 8'000, some_points = 2'000,
                 few_points = 300;

dvec3 moved_point(const dmat4& move, dvec3 point) { return dvec3(move * glm::dvec4(point, 1)); }

// Returns points drawn from the mesh, evenly by area, in an order without a pattern.
std::vector<SurfacePoint> drawn_points(const SurfaceMesh& mesh) {
  const std::vector<SurfacePoint> all = triangle_points(mesh, 1e300, SIZE_MAX);
  double area = 0;
  for (const SurfacePoint& point : all) area += point.area;
  std::vector<SurfacePoint> points =
      triangle_points(mesh, 1.5 * std::sqrt(area / double(most_surface_points)), 1 << 20);
  // Each point stands for its area: where triangles are small, few are drawn.
  std::vector<double> until(points.size());
  double sum = 0;
  for (size_t i = 0; i < points.size(); i++) until[i] = sum += points[i].area;
  Rng random(1);
  std::vector<SurfacePoint> drawn;
  for (size_t i = 0; i < most_surface_points && !points.empty(); i++) {
    const double at = sum * double(random.next()) / 4294967296.0;
    const auto found = std::upper_bound(until.begin(), until.end(), at);
    drawn.push_back(points[size_t(std::min(found - until.begin(), ptrdiff_t(points.size()) - 1))]);
    drawn.back().search_angle = 0;
  }
  return drawn;
}

struct Axes {
  dvec3 middle{0};
  glm::dmat3 turn{1};  // columns: principal axes, right-handed
};

Axes principal_axes(const std::vector<dvec3>& points) {
  Axes axes;
  for (dvec3 point : points) axes.middle += point / double(points.size());
  SymmetricMatrix<3> spread;
  for (dvec3 point : points)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        spread.at[i][j] += (point - axes.middle)[i] * (point - axes.middle)[j];
  const auto found = eigenvectors(spread);
  for (int i = 0; i < 3; i++)
    axes.turn[i] = {found.vectors[i][0], found.vectors[i][1], found.vectors[i][2]};
  if (glm::determinant(axes.turn) < 0) axes.turn[2] = -axes.turn[2];
  return axes;
}

// Returns the moves that lay axes on axes in any order and with any signs, without mirroring.
std::vector<dmat4> axis_moves(const Axes& from, const Axes& to) {
  std::vector<dmat4> moves;
  int order[3] = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; signs++) {
      glm::dmat3 change(0);
      for (int i = 0; i < 3; i++) change[i][order[i]] = signs >> i & 1 ? -1 : 1;
      if (glm::determinant(change) < 0) continue;
      dmat4 move(to.turn * change * glm::transpose(from.turn));
      move[3] = glm::dvec4(to.middle - glm::dmat3(move) * from.middle, 1);
      moves.push_back(move);
    }
  } while (std::next_permutation(order, order + 3));
  return moves;
}

// Returns the indices of the share of `sizes` that is smallest.
std::vector<size_t> smallest_share(const std::vector<double>& sizes, double share) {
  std::vector<size_t> order(sizes.size());
  for (size_t i = 0; i < order.size(); i++) order[i] = i;
  const size_t kept =
      std::min(sizes.size(), size_t(std::ceil(double(sizes.size()) * std::clamp(share, 0.1, 1.0))));
  std::nth_element(order.begin(), order.begin() + ptrdiff_t(kept > 0 ? kept - 1 : 0), order.end(),
                   [&](size_t a, size_t b) { return sizes[a] < sizes[b]; });
  order.resize(kept);
  return order;
}

constexpr double endless = 1e300;

struct Fit {
  dmat4 move{1};
  double error = std::numeric_limits<double>::infinity();  // mean square of what is kept
  int iterations = 0;
};

// Steps by the nearest boundary points, as long as the error falls by a thousandth.
void fit_nearest(Fit& fit, const PointTree& tree, const std::vector<SurfacePoint>& points,
                 size_t count, int most_iterations, double kept_share) {
  std::vector<dvec3> at(count), nearest(count);
  std::vector<double> squares(count);
  fit.error = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= most_iterations; i++) {
    for (size_t k = 0; k < count; k++) {
      at[k] = moved_point(fit.move, points[k].position);
      nearest[k] = tree.points()[tree.nearest(at[k])];
      squares[k] = glm::dot(at[k] - nearest[k], at[k] - nearest[k]);
      if (!(squares[k] < endless)) squares[k] = endless;  // comparisons need numbers
    }
    std::vector<dvec3> from, to;
    double error = 0;
    for (size_t k : smallest_share(squares, kept_share))
      from.push_back(at[k]), to.push_back(nearest[k]), error += squares[k];
    error /= double(from.size());
    const bool better = error < fit.error * 0.999;
    fit.error = std::min(error, fit.error);
    if (!better || i == most_iterations) break;
    fit.move = fit_points(from, to) * fit.move;
    fit.iterations++;
  }
}

// Steps by the boundaries along the normals, until the surface moves by less than a thousandth of a
// voxel.
void fit_finely(Fit& fit, Registration& result, const DensityField& field,
                const std::vector<SurfacePoint>& points, const RegistrationSettings& settings) {
  ConeSettings cone;
  cone.threshold = settings.threshold, cone.reach = settings.reach;
  auto turn_of = [](const dmat4& move) { return glm::dmat3(move); };
  for (int i = 0;; i++) {
    std::vector<SurfacePoint> there = points;
    for (SurfacePoint& point : there) {
      point.position = moved_point(fit.move, point.position);
      point.normal = vec3(turn_of(fit.move) * dvec3(point.normal));
    }
    std::vector<PlaneGap> gaps;
    std::vector<double> sizes;
    const std::vector<Deviation> found = find_deviations(field, there, cone);
    for (size_t k = 0; k < found.size(); k++) {
      // Boundaries that lie across the surface say little about where it belongs.
      if (!found[k].found || found[k].normal_angle > pi / 3) continue;
      PlaneGap gap{there[k].position, dvec3(found[k].boundary_normal), 0};
      gap.gap = glm::dot(gap.normal, there[k].position - found[k].boundary);
      gaps.push_back(gap);
      sizes.push_back(gap.gap);
    }
    result.found_share = double(gaps.size()) / double(points.size());
    if (gaps.size() < 6) return;
    // Those nearest to the middle gap are kept: a surface that is too large everywhere would else
    // be pushed to one side, where the gaps of the other side would be left out.
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + ptrdiff_t(sorted.size() / 2), sorted.end());
    const double middle = sorted[sorted.size() / 2];
    for (double& size : sizes) size = std::abs(size - middle);
    std::vector<PlaneGap> kept;
    double error = 0;
    for (size_t k : smallest_share(sizes, settings.kept_share))
      kept.push_back(gaps[k]), error += gaps[k].gap * gaps[k].gap;
    fit.error = error / double(kept.size());
    if (i >= settings.most_iterations) return;
    const dmat4 step = fit_planes(kept);
    fit.move = step * fit.move;
    fit.iterations++;
    double farthest = 0;
    for (const PlaneGap& one : kept)
      farthest = std::max(farthest, glm::distance(one.point, moved_point(step, one.point)));
    if (farthest < field.voxel / 1000) return;
  }
}

}  // namespace

Registration register_surface(const SurfaceMesh& mesh, const DensityField& field,
                              const std::vector<ControlPair>& pairs,
                              const RegistrationSettings& settings) {
  const std::vector<SurfacePoint> points = drawn_points(mesh);
  if (points.empty()) throw std::invalid_argument("the mesh has no triangle with an area");
  const size_t some = std::min(points.size(), some_points), few = std::min(some, few_points);
  const PointTree tree(boundary_points(field, most_boundary_points));
  if (tree.points().empty()) throw std::invalid_argument("the volume has one density: no boundary");
  Registration result;
  std::vector<Fit> fits;
  if (pairs.empty()) {
    std::vector<dvec3> places;
    for (const SurfacePoint& point : points) places.push_back(point.position);
    fits.push_back({});  // as they are
    for (const dmat4& move : axis_moves(principal_axes(places), principal_axes(tree.points())))
      fits.push_back({move});
    parallel_each(int(fits.size()), [&](int i) {
      fit_nearest(fits[size_t(i)], tree, points, few, 12, settings.kept_share);
    });
    // More points choose among the starts that came near.
    std::vector<size_t> order(fits.size());
    for (size_t i = 0; i < order.size(); i++) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return fits[a].error < fits[b].error; });
    std::vector<Fit> nearest;
    for (size_t i = 0; i < 4; i++) nearest.push_back(fits[order[i]]);
    parallel_each(4, [&](int i) {
      fit_nearest(nearest[size_t(i)], tree, points, some, 12, settings.kept_share);
    });
    const auto best =
        std::min_element(nearest.begin(), nearest.end(),
                         [](const Fit& a, const Fit& b) { return a.error < b.error; });
    result.start = order[size_t(best - nearest.begin())] == 0 ? "as they are" : "principal axes";
    fits = {*best};
  } else {
    std::vector<dvec3> from, to;
    for (const ControlPair& pair : pairs) from.push_back(pair.surface), to.push_back(pair.volume);
    fits.push_back({fit_points(from, to)});
    fit_nearest(fits[0], tree, points, some, settings.most_iterations, settings.kept_share);
    result.start = "control points";
  }
  fit_finely(fits[0], result, field, points, settings);
  result.to_volume = fits[0].move;
  result.mean_square_error = fits[0].error;
  result.iterations = fits[0].iterations;
  return result;
}

}  // namespace wellspring::volume
