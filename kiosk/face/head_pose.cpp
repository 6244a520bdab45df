// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/head_pose.h"

#include <cmath>
#include <opencv2/calib3d.hpp>

namespace wellspring::kiosk {

namespace {

// These points are in millimetres, image left half and middle; the other half mirrors them. Widths
// and heights are after Farkas (Anthropometry of the Head and Face, 1994), means of North American
// women and men: pupils 63 apart, inner corners of the eyes 33, outer 90; nose 34 wide, 52 high,
// its tip 19 before its root's foot; mouth 52 wide, 22 below the nose; chin 68 below the nose; face
// 134 wide, jaw 100. Depths are what is left of his distances from the ear's tragus: 122 to the
// nose's root, 128 to its foot, 145 to the chin, 82 to the eye's outer corner. The points of the
// nose stand where the network sets them: 1 to 6 lower than people do (mean over the hand-marked
// faces of dlib).
constexpr float half[][3] = {
    {-69, -4, 80},  {-68, 17, 77},  {-66, 37, 72},  {-61, 57, 63},  {-53, 75, 50},   // 0-4
    {-42, 91, 34},  {-29, 103, 18}, {-15, 111, -1}, {0, 114, -6},                    // 5-8
    {-53, -15, 14}, {-46, -21, 6},  {-37, -24, 1},  {-26, -23, -3}, {-15, -19, -6},  // 17-21
    {0, 1, -12},    {0, 14, -19},   {0, 28, -27},   {0, 38, -31},                    // 27-30
    {-15, 44, -6},  {-8, 46, -11},  {0, 47, -13},                                    // 31-33
    {-45, 0, 10},   {-37, -5, 3},   {-26, -5, 1},   {-16.5f, 2, 5}, {-26, 5, 2},
    {-37, 5, 4},    {-26, 68, 0},   {-16, 63, -9},  {-6, 60, -14},  {0, 61, -15},    // 48-51
    {0, 78, -12},   {-8, 77, -11},  {-17, 73, -7},                                   // 57-59
    {-23, 68, -2},  {-8, 67, -11},  {0, 67, -12},   {0, 70, -12},   {-8, 70, -11}};  // 60-62, 66-67
// Entry k is the index of point k in `half`; if the point is mirrored, -1 - index.
constexpr int place[landmark_count] = {
    0,  1,  2,  3,   4,   5,   6,   7,   8,   -8,  -7,  -6,  -5, -4, -3, -2, -1,  // outline
    9,  10, 11, 12,  13,  -14, -13, -12, -11, -10,                                // brows
    14, 15, 16, 17,  18,  19,  20,  -20, -19,                                     // nose
    21, 22, 23, 24,  25,  26,  -25, -24, -23, -22, -27, -26,                      // eyes
    27, 28, 29, 30,  -30, -29, -28, -34, -33, 31,  32,  33,                       // lips
    34, 35, 36, -36, -35, -39, 37,  38};

// Returns how much a point counts. The outline slides over the cheeks as the head turns, so only
// the chin's part of it counts; brows, lips and chin move with expression.
float weight_of(size_t k) {
  constexpr float chin[] = {0.2f, 0.4f, 0.6f, 0.4f, 0.2f};
  if (k < 17) return k >= 6 && k <= 10 ? chin[k - 6] : 0;
  if (k < 27) return 0.1f;
  if (k < 48) return 1;
  return k == 48 || k == 51 || k == 54 || k == 62 ? 0.4f : 0;
}

constexpr int rounds = 12;
// share of the distance between the pupils; larger errors count less
constexpr float huber = 0.05f;
constexpr float good_error = 0.06f, bad_error = 0.22f;  // shares of that distance, too

}  // namespace

vec3 face_point(size_t k) {
  const int at = place[k];
  const float* p = half[size_t(at < 0 ? -1 - at : at)];
  return vec3(at < 0 ? -p[0] : p[0], p[1], p[2]) * 0.001f;
}

std::optional<HeadPose> solve_head_pose(const FaceMarks& marks, float focal, int width,
                                        int height) {
  const vec2 middle{float(width) / 2, float(height) / 2};
  std::vector<cv::Point3d> model;
  std::vector<cv::Point2d> seen;  // tangents of the angle from the camera's axis
  std::vector<double> weights;
  vec2 low(1e9f), high(-1e9f);
  for (size_t k = 0; k < marks.size(); k++) {
    if (!std::isfinite(marks[k].x) || !std::isfinite(marks[k].y)) return {};
    const float weight = weight_of(k);
    if (!(weight > 0)) continue;
    const vec3 m = face_point(k);
    const vec2 s = (marks[k] - middle) / focal;
    model.emplace_back(m.x, m.y, m.z);
    seen.emplace_back(s.x, s.y);
    weights.push_back(weight);
    low = glm::min(low, marks[k]), high = glm::max(high, marks[k]);
  }
  if (!(std::min(high.x - low.x, high.y - low.y) > 3)) return {};
  cv::Vec3d turn, at;
  const cv::Matx33d lens = cv::Matx33d::eye();
  try {
    if (!cv::solvePnP(model, seen, lens, cv::noArray(), turn, at, false, cv::SOLVEPNP_SQPNP))
      return {};
  } catch (const cv::Exception&) {
    return {};
  }
  double error = 0;
  for (int round = 0; round < rounds; round++) {
    cv::Mat points, jacobian;
    cv::projectPoints(model, turn, at, lens, cv::noArray(), points, jacobian);
    if (!cv::checkRange(jacobian)) return {};
    const double apart = 0.063 / std::max(0.05, at[2]);  // tangent between the pupils
    cv::Matx66d a = cv::Matx66d::zeros();
    cv::Vec6d b;
    double sum = 0, total = 0;
    for (size_t i = 0; i < model.size(); i++) {
      const cv::Point2d left = seen[i] - points.at<cv::Point2d>(int(i));
      const double r = std::hypot(left.x, left.y) / apart;
      const double w = weights[i] * (r > huber ? huber / r : 1);
      sum += weights[i] * r * r, total += weights[i];
      for (int axis = 0; axis < 2; axis++) {
        const double* j = jacobian.ptr<double>(2 * int(i) + axis);
        for (int p = 0; p < 6; p++) {
          for (int q = 0; q < 6; q++) a(p, q) += w * j[p] * j[q];
          b[p] += w * j[p] * (axis ? left.y : left.x);
        }
      }
    }
    error = std::sqrt(sum / total);
    cv::Vec6d step;
    if (!cv::solve(a, b, step, cv::DECOMP_CHOLESKY)) return {};
    for (int p = 0; p < 3; p++) turn[p] += step[p], at[p] += step[p + 3];
    if (cv::norm(step) < 1e-7) break;
  }
  cv::Matx33d matrix;
  cv::Rodrigues(turn, matrix);
  HeadPose pose;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      pose.rotation[column][row] = float(matrix(row, column));
  pose.position = {float(at[0]), float(at[1]), float(at[2])};
  pose.error = float(error);
  // A visible face looks towards the lens, by at most 100 degrees past it.
  const bool faces = glm::dot(pose.rotation[2], glm::normalize(pose.position)) > -0.17f;
  if (!is_finite(pose.position) || !(pose.position.z > 0.05f) || !std::isfinite(pose.error) ||
      !faces)
    return {};
  return pose;
}

float trust_of_error(float error) {
  return glm::clamp((bad_error - error) / (bad_error - good_error), 0.f, 1.f);
}

}  // namespace wellspring::kiosk
