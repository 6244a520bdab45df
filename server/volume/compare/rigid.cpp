// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/rigid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wellspring::volume {

namespace {

template <size_t Size>
Eigenvectors<Size> jacobi_eigenvectors(const SymmetricMatrix<Size>& matrix) {
  auto a = matrix.at;
  std::array<std::array<double, Size>, Size> v{};
  for (size_t i = 0; i < Size; i++) v[i][i] = 1;
  for (int sweep = 0; sweep < 64; sweep++) {
    double beside = 0, all = 0;
    for (size_t i = 0; i < Size; i++)
      for (size_t j = 0; j < Size; j++) {
        all += a[i][j] * a[i][j];
        if (i != j) beside += a[i][j] * a[i][j];
      }
    if (!(beside > all * 1e-30)) break;
    for (size_t p = 0; p < Size; p++)
      for (size_t q = p + 1; q < Size; q++) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (size_t k = 0; k < Size; k++) {
          const double before = a[k][p], after = a[k][q];
          a[k][p] = c * before - s * after, a[k][q] = s * before + c * after;
        }
        for (size_t k = 0; k < Size; k++) {
          const double before = a[p][k], after = a[q][k];
          a[p][k] = c * before - s * after, a[q][k] = s * before + c * after;
        }
        for (size_t k = 0; k < Size; k++) {
          const double before = v[k][p], after = v[k][q];
          v[k][p] = c * before - s * after, v[k][q] = s * before + c * after;
        }
      }
  }
  std::array<size_t, Size> order;
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return a[i][i] > a[j][j]; });
  Eigenvectors<Size> result;
  for (size_t i = 0; i < Size; i++) {
    result.values[i] = a[order[i]][order[i]];
    for (size_t k = 0; k < Size; k++) result.vectors[i][k] = v[k][order[i]];
  }
  return result;
}

dvec3 mean_of(const std::vector<dvec3>& points) {
  return std::accumulate(points.begin(), points.end(), dvec3(0)) / double(points.size());
}

using SixNumbers = std::array<double, 6>;

// Solves a symmetric positive system by Cholesky's factors.
SixNumbers solve_six(std::array<SixNumbers, 6> a, SixNumbers b) {
  for (size_t i = 0; i < 6; i++)
    for (size_t j = 0; j <= i; j++) {
      double sum = a[i][j];
      for (size_t k = 0; k < j; k++) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / a[j][j];
    }
  for (size_t i = 0; i < 6; i++) {
    for (size_t k = 0; k < i; k++) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (size_t i = 6; i-- > 0;) {
    for (size_t k = i + 1; k < 6; k++) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace

Eigenvectors<3> eigenvectors(const SymmetricMatrix<3>& matrix) {
  return jacobi_eigenvectors(matrix);
}
Eigenvectors<4> eigenvectors(const SymmetricMatrix<4>& matrix) {
  return jacobi_eigenvectors(matrix);
}

dmat4 fit_points(const std::vector<dvec3>& from, const std::vector<dvec3>& to) {
  const dvec3 from_middle = mean_of(from), to_middle = mean_of(to);
  glm::dmat3 s(0);  // s[i][j]: sum of from_i to_j
  for (size_t n = 0; n < from.size(); n++)
    for (int i = 0; i < 3; i++) s[i] += (from[n] - from_middle)[i] * (to[n] - to_middle);
  // Horn's matrix, whose eigenvector of the largest eigenvalue is the quaternion.
  SymmetricMatrix<4> matrix;
  matrix.at = {
      {{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
       {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
       {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
       {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}}};
  const auto q = eigenvectors(matrix).vectors[0];
  const glm::dquat turn = glm::normalize(glm::dquat(q[0], q[1], q[2], q[3]));
  dmat4 move(glm::mat3_cast(turn));
  move[3] = glm::dvec4(to_middle - glm::dmat3(move) * from_middle, 1);
  return move;
}

dmat4 fit_planes(const std::vector<PlaneGap>& gaps) {
  if (gaps.empty()) return dmat4(1);
  dvec3 middle(0);
  for (const PlaneGap& one : gaps) middle += one.point / double(gaps.size());
  double size = 0;  // turns are measured by the shift that they make at this distance
  for (const PlaneGap& one : gaps) size = std::max(size, glm::distance(one.point, middle));
  if (!(size > 0)) return dmat4(1);
  std::array<SixNumbers, 6> matrix{};
  SixNumbers right{};
  for (const PlaneGap& one : gaps) {
    const dvec3 turn = glm::cross((one.point - middle) / size, one.normal);
    const double row[6] = {turn.x, turn.y, turn.z, one.normal.x, one.normal.y, one.normal.z};
    for (size_t i = 0; i < 6; i++) {
      right[i] -= row[i] * one.gap;
      for (size_t j = 0; j < 6; j++) matrix[i][j] += row[i] * row[j];
    }
  }
  for (size_t i = 0; i < 6; i++) matrix[i][i] += 1e-6 * double(gaps.size());
  const SixNumbers solved = solve_six(matrix, right);
  const dvec3 turn = dvec3(solved[0], solved[1], solved[2]) / size;
  const double angle = glm::length(turn);
  dmat4 move(1);
  if (angle > 1e-15) move = glm::rotate(dmat4(1), angle, turn / angle);
  const dvec3 shift = middle - glm::dmat3(move) * middle + dvec3(solved[3], solved[4], solved[5]);
  move[3] = glm::dvec4(shift, 1);
  return move;
}

}  // namespace wellspring::volume
