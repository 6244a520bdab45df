// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_finish.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace wellspring::scan {
namespace {

// The real spherical harmonics of a degree with the reference's signs (Kerbl et al. 2023,
// eval_sh); in `to` stand 2 degree + 1 values.
void eval_harmonics(int degree, dvec3 d, double* to) {
  const double x = d.x, y = d.y, z = d.z;
  if (degree == 1) {
    const double c = 0.4886025119029199;
    to[0] = -c * y, to[1] = c * z, to[2] = -c * x;
  } else if (degree == 2) {
    to[0] = 1.0925484305920792 * x * y;
    to[1] = -1.0925484305920792 * y * z;
    to[2] = 0.31539156525252005 * (2 * z * z - x * x - y * y);
    to[3] = -1.0925484305920792 * x * z;
    to[4] = 0.5462742152960396 * (x * x - y * y);
  } else {
    to[0] = -0.5900435899266435 * y * (3 * x * x - y * y);
    to[1] = 2.890611442640554 * x * y * z;
    to[2] = -0.4570457994644658 * y * (4 * z * z - x * x - y * y);
    to[3] = 0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y);
    to[4] = -0.4570457994644658 * x * (4 * z * z - x * x - y * y);
    to[5] = 1.445305721320277 * z * (x * x - y * y);
    to[6] = -0.5900435899266435 * x * (x * x - 3 * y * y);
  }
}

using Square = std::array<std::array<double, 7>, 7>;

// Returns the matrix that turns a degree's coefficients: a turned function has at d the value that
// it had at turn^-1 d. Turning stays within a degree, so the least squares over any directions that
// are enough and well spread have no rest.
Square turn_of_degree(int degree, const glm::dmat3& turn) {
  const size_t size = size_t(2 * degree + 1);
  constexpr int directions = 40;
  Square left{}, right{};
  for (int i = 0; i < directions; i++) {
    const double z = 1 - (2 * i + 1.0) / directions, around = 2.399963229728653 * i;
    const double radius = std::sqrt(1 - z * z);
    const dvec3 d(radius * std::cos(around), radius * std::sin(around), z);
    double here[7], before[7];
    eval_harmonics(degree, d, here);
    eval_harmonics(degree, glm::transpose(turn) * d, before);
    for (size_t r = 0; r < size; r++)
      for (size_t c = 0; c < size; c++) {
        left[r][c] += here[r] * here[c];
        right[r][c] += here[r] * before[c];
      }
  }
  // The left side is positive definite: elimination needs no pivots.
  for (size_t k = 0; k < size; k++)
    for (size_t r = 0; r < size; r++) {
      if (r == k) continue;
      const double factor = left[r][k] / left[k][k];
      for (size_t c = 0; c < size; c++) {
        left[r][c] -= factor * left[k][c];
        right[r][c] -= factor * right[k][c];
      }
    }
  for (size_t r = 0; r < size; r++)
    for (size_t c = 0; c < size; c++) right[r][c] /= left[r][r];
  return right;
}

void turn_harmonics(SplatSet& set, const mat3& turn) {
  size_t begin = 0;
  const size_t all = size_t(splat_harmonics[set.degree]);
  for (int degree = 1; degree <= set.degree; degree++) {
    const Square by = turn_of_degree(degree, glm::dmat3(turn));
    const size_t size = size_t(2 * degree + 1);
    for (size_t i = 0; i < set.size(); i++) {
      vec3* of = &set.harmonics[i * all + begin];
      std::array<vec3, 7> turned{};
      for (size_t r = 0; r < size; r++)
        for (size_t c = 0; c < size; c++) turned[r] += float(by[r][c]) * of[c];
      std::copy_n(turned.begin(), size, of);
    }
    begin += size;
  }
}

bool is_finite(const quat& turn) {
  return std::isfinite(turn.w) && std::isfinite(turn.x) && std::isfinite(turn.y) &&
         std::isfinite(turn.z);
}

}  // namespace

void resize_splats(SplatSet& set, size_t count) {
  set.place.resize(count), set.scale.resize(count), set.opacity.resize(count);
  set.turn.resize(count, quat(1, 0, 0, 0)), set.color.resize(count);
  set.harmonics.resize(count * size_t(splat_harmonics[set.degree]));
}

void finish_splats(SplatSet& set) {
  size_t kept = 0, turns = 0, scales = 0;
  const size_t count = set.size(), all = size_t(splat_harmonics[set.degree]);
  for (size_t i = 0; i < count; i++) {
    const vec3* harmonics = set.harmonics.data() + i * all;
    if (!wellspring::is_finite(set.place[i]) || !wellspring::is_finite(set.scale[i]) ||
        !wellspring::is_finite(set.color[i]) || !std::isfinite(set.opacity[i]) ||
        !is_finite(set.turn[i]) || !std::all_of(harmonics, harmonics + all, [](vec3 one) {
          return wellspring::is_finite(one);
        }))
      continue;
    const vec3 scale = glm::abs(set.scale[i]);
    if (scale != set.scale[i]) scales++;
    // Lengths of very large or small turns are finite in double precision.
    const glm::dquat turn(set.turn[i]);
    const double length = glm::length(turn);
    if (!(length > 1e-30)) turns++;
    set.turn[kept] = length > 1e-30 ? quat(turn / length) : quat(1, 0, 0, 0);
    set.scale[kept] = scale;
    set.place[kept] = set.place[i];
    set.color[kept] = set.color[i];
    set.opacity[kept] = std::clamp(set.opacity[i], 0.0f, 1.0f);
    if (kept != i) std::copy_n(harmonics, all, set.harmonics.begin() + std::ptrdiff_t(kept * all));
    kept++;
  }
  resize_splats(set, kept);
  const auto say = [&set](size_t number, const char* what) {
    if (number > 0) set.notices.push_back(fmt::format("{} splats {}", number, what));
  };
  say(count - kept, "with values that are not finite were left out");
  say(turns, "have a turn of length 0 and are not turned");
  say(scales, "have a negative scale, which is taken as positive");
}

void move_splats(SplatSet& set, const mat3& turn, float size, vec3 shift) {
  if (turn == mat3(1) && size == 1 && shift == vec3(0)) return;
  for (size_t i = 0; i < set.size(); i++) {
    set.place[i] = turn * (size * set.place[i]) + shift;
    set.scale[i] *= size;
    mat3 axes = turn * glm::mat3_cast(glm::normalize(set.turn[i]));
    // An ellipsoid is the same with an axis the other way round.
    if (glm::determinant(axes) < 0) axes[2] = -axes[2];
    set.turn[i] = glm::normalize(glm::quat_cast(axes));
  }
  if (turn != mat3(1)) turn_harmonics(set, turn);
}

}  // namespace wellspring::scan
