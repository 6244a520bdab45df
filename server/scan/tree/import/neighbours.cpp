// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/neighbours.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace wellspring::scan {
namespace {

constexpr size_t most_near = 768;
constexpr float far_away = 1e9f;

// Returns the eigenvector of the least eigenvalue of a symmetric matrix, or 0 if the second one is
// as small (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
vec3 least_eigenvector(float xx, float xy, float xz, float yy, float yz, float zz) {
  const float mean = (xx + yy + zz) / 3;
  if (!(mean > 0)) return vec3(0);
  const float a = xx - mean, b = yy - mean, c = zz - mean;
  const float spread = std::sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
  if (!(spread > 1e-6f * mean)) return vec3(0);
  const float half_det =
      (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) /
      (2 * spread * spread * spread);
  const float angle = std::acos(std::clamp(half_det, -1.0f, 1.0f)) / 3;
  const float least = mean + 2 * spread * std::cos(angle + 2 * pi / 3);
  const float most = mean + 2 * spread * std::cos(angle);
  if (3 * mean - least - most < 1e-5f * most) return vec3(0);
  const vec3 r0(xx - least, xy, xz), r1(xy, yy - least, yz), r2(xz, yz, zz - least);
  const vec3 c01 = glm::cross(r0, r1), c12 = glm::cross(r1, r2), c20 = glm::cross(r2, r0);
  const float d01 = glm::dot(c01, c01), d12 = glm::dot(c12, c12), d20 = glm::dot(c20, c20);
  const vec3 longest = d01 >= d12 && d01 >= d20 ? c01 : d12 >= d20 ? c12 : c20;
  const float length = std::sqrt(std::max({d01, d12, d20}));
  return length > 0 ? longest / length : vec3(0);
}

// Returns the normal of the plane through points around one.
vec3 plane_normal(vec3 place, const vec3* nearest, int count) {
  vec3 mean(0);
  for (int i = 0; i < count; i++) mean += nearest[i] - place;
  mean /= float(count + 1);
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  const auto add = [&](vec3 d) {
    xx += d.x * d.x, xy += d.x * d.y, xz += d.x * d.z;
    yy += d.y * d.y, yz += d.y * d.z, zz += d.z * d.z;
  };
  add(-mean);
  for (int i = 0; i < count; i++) add(nearest[i] - place - mean);
  return least_eigenvector(xx, xy, xz, yy, yz, zz);
}

// Returns whether neighbours lie around a place and in one plane with it, as on a surface: not to
// one side as at an edge, along a line as on a twig, or to all sides as in the air.
bool is_on_surface(vec3 place, const vec3* nearest) {
  constexpr float most_aside = 0.65f, least_across = 0.3f, most_off_plane = 0.4f;
  vec3 ways[spacing_neighbour], all(0), normal(0);
  for (int i = 0; i < spacing_neighbour; i++) {
    const vec3 way = nearest[i] - place;
    const float length = glm::length(way);
    if (!(length > 0)) return false;
    ways[i] = way / length, all += ways[i];
  }
  for (int i = 1; i < spacing_neighbour; i++) {
    const vec3 across = glm::cross(ways[0], ways[i]);
    if (glm::dot(across, across) > glm::dot(normal, normal)) normal = across;
  }
  const float width = glm::length(normal);
  if (glm::length(all) > most_aside * spacing_neighbour || width < least_across) return false;
  for (const vec3& way : ways)
    if (std::abs(glm::dot(way, normal)) > most_off_plane * width) return false;
  return true;
}

}  // namespace

void Neighbours::sort(const NodePlaces& places) {
  const size_t n = places.size();
  // On a surface so many cells have about three points each.
  side_ = std::clamp(int(std::sqrt(double(n) / 4)), 1, 96);
  const auto side = uint32_t(side_);
  starts_.assign(size_t(side) * side * side + 1, 0);
  cells_.resize(n), order_.resize(n), x_.resize(n), y_.resize(n), z_.resize(n);
  for (size_t i = 0; i < n; i++) {
    const auto cell = [side](uint16_t a) { return (a * side) >> 16; };
    cells_[i] = (cell(places.z[i]) * side + cell(places.y[i])) * side + cell(places.x[i]);
    starts_[cells_[i] + 1]++;
  }
  for (size_t c = 1; c < starts_.size(); c++) starts_[c] += starts_[c - 1];
  for (size_t i = 0; i < n; i++) {
    const uint32_t to = starts_[cells_[i]]++;
    order_[to] = uint32_t(i);
    x_[to] = places.x[i], y_[to] = places.y[i], z_[to] = places.z[i];
  }
  for (size_t c = starts_.size() - 1; c > 0; c--) starts_[c] = starts_[c - 1];
  starts_[0] = 0;
}

void Neighbours::gather(int x, int y, int z, int ring) {
  const auto clamped = [this](int a) { return std::clamp(a, 0, side_ - 1); };
  const int x0 = clamped(x - ring), x1 = clamped(x + ring);
  // Rows that are near come first, so that the search finds near points early.
  const auto each_row = [&](const auto& take) {
    for (int apart = 0; apart <= 2 * ring; apart++)
      for (int k = std::max(-ring, -apart); k <= std::min(ring, apart); k++) {
        const int left = apart - std::abs(k);
        if (left > ring || z + k < 0 || z + k >= side_) continue;
        for (const int j : {-left, left}) {
          if (y + j >= 0 && y + j < side_) {
            const size_t row = (size_t(z + k) * size_t(side_) + size_t(y + j)) * size_t(side_);
            take(starts_[row + size_t(x0)], starts_[row + size_t(x1) + 1]);
          }
          if (left == 0) break;
        }
      }
  };
  size_t all = 0;
  each_row([&](uint32_t from, uint32_t to) { all += to - from; });
  const size_t step = all <= most_near ? 1 : (all + most_near - 1) / most_near;
  near_ = 0;
  near_x_.resize(all / step + 64), near_y_.resize(near_x_.size()), near_z_.resize(near_x_.size());
  size_t skip = 0;
  each_row([&](uint32_t from, uint32_t to) {
    size_t i = from + skip;
    for (; i < to; i += step) {
      near_x_[near_] = x_[i], near_y_[near_] = y_[i], near_z_[near_] = z_[i];
      near_++;
    }
    skip = i - to;
  });
  for (size_t i = near_; i < near_ + lane_count; i++)
    near_x_[i] = near_y_[i] = near_z_[i] = far_away;
}

// Finds the nearest that are gathered, sorted by squared distance, without one at the place itself.
// within: as many as are looked for are known to be nearer than this, or it is far away.
template <int wanted>
int Neighbours::find_nearest(vec3 place, float within, vec3* nearest, float* distances) const {
  int count = 0;
  float worst = std::min(within * within, far_away);
  bool is_itself_out = false;
  for (size_t i = 0; i < near_; i += lane_count) {
    const Lanes dx = load_lanes(&near_x_[i]) - place.x, dy = load_lanes(&near_y_[i]) - place.y,
                dz = load_lanes(&near_z_[i]) - place.z;
    const Lanes squares = dx * dx + dy * dy + dz * dz;
    for (unsigned found = negative_lanes(squares < all_lanes(worst)); found; found &= found - 1) {
      const int lane = __builtin_ctz(found);
      const float square = squares[lane];
      if (square == 0 && !is_itself_out) {
        is_itself_out = true;
        continue;
      }
      if (square >= worst) continue;
      int at = count < wanted ? count++ : wanted - 1;
      for (; at > 0 && distances[at - 1] > square; at--)
        distances[at] = distances[at - 1], nearest[at] = nearest[at - 1];
      distances[at] = square;
      const size_t which = i + size_t(lane);
      nearest[at] = {near_x_[which], near_y_[which], near_z_[which]};
      if (count == wanted) worst = distances[wanted - 1];
    }
  }
  return count;
}

float Neighbours::look(std::vector<float>& own, std::vector<vec3>* normals) {
  const size_t n = order_.size();
  own.assign(n, 0);
  if (normals) normals->assign(n, vec3(0));
  double sum = 0;
  size_t looked = 0;
  vec3 nearest[neighbour_count];
  float distances[neighbour_count];
  vec3 last_place(0);
  float last_reach = far_away;  // around the last place of the same cell, where enough points are
  for (size_t i = 0, cell = size_t(-1); i < n; i++) {
    if (cells_[order_[i]] != cell) {
      last_reach = far_away;
      cell = cells_[order_[i]];
      const auto side = size_t(side_);
      const int x = int(cell % side), y = int(cell / side % side), z = int(cell / side / side);
      gather(x, y, z, 1);
      for (int ring = 2; near_ <= neighbour_count && ring < side_ * 2; ring *= 2)
        gather(x, y, z, ring);
    }
    const vec3 place(x_[i], y_[i], z_[i]);
    const float within = (last_reach + glm::distance(last_place, place)) * 1.00001f;
    const int wanted = normals ? neighbour_count : spacing_neighbour;
    const int count = normals ? find_nearest<neighbour_count>(place, within, nearest, distances)
                              : find_nearest<spacing_neighbour>(place, within, nearest, distances);
    if (count == 0) continue;
    last_place = place;
    last_reach = count == wanted ? std::sqrt(distances[count - 1]) : far_away;
    const float distance = std::sqrt(distances[std::min(count, spacing_neighbour) - 1]);
    if (distance > 0) sum += double(distance), looked++;
    if (count >= spacing_neighbour && is_on_surface(place, nearest)) own[i] = distance;
    if (normals && count >= 3) (*normals)[i] = plane_normal(place, nearest, count);
  }
  return looked > 0 ? float(sum / double(looked)) : 0;
}

}  // namespace wellspring::scan
