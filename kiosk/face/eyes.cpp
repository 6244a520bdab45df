// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/eyes.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float closed_lids = 0.06f, wide_lids = 0.3f;  // height over width of an eye
constexpr float wide_mouth = 0.7f;                      // the same of the inner lips
// Points of the mesh: inner edges of the lips above and below, their corners.
constexpr size_t upper_lip = 13, lower_lip = 14, lip_corners[] = {78, 308};

constexpr float ball_radius = 0.0115f;  // metres, to the iris
constexpr float ball_depth = 0.0105f;   // metres behind the corners of the eye
// Corners of the eyes among the 68 landmarks: at image left, at image right.
constexpr size_t corners[2][2] = {{36, 39}, {42, 45}};

constexpr double usual_spread = 0.12;  // of the logarithm of faces' sizes about an adult's
constexpr double pixel_error = 0.6;    // of an iris' width
constexpr double most_weight = 40 / (usual_spread * usual_spread);

}  // namespace

std::optional<float> iris_width(const FaceMesh& mesh) {
  if (!mesh.irises) return {};
  float sum = 0;
  for (const auto& iris : *mesh.irises)
    sum += std::max(glm::length(iris[1] - iris[3]), glm::length(iris[2] - iris[4]));
  return std::isfinite(sum) ? std::optional(sum / 2) : std::nullopt;
}

std::optional<float> open_lids(const FaceMesh& mesh) {
  if (!mesh.irises) return {};
  const float height = (mesh.lids[0] + mesh.lids[1]) / 2;
  return std::clamp((height - closed_lids) / (wide_lids - closed_lids), 0.f, 1.f);
}

float open_mouth(const FaceMesh& mesh) {
  const float height = glm::length(mesh.points[upper_lip] - mesh.points[lower_lip]);
  const float width = glm::length(mesh.points[lip_corners[0]] - mesh.points[lip_corners[1]]);
  return width > 0 ? std::clamp(height / width / wide_mouth, 0.f, 1.f) : 0;
}

std::optional<vec3> look_direction(const FaceMesh& mesh, const HeadPose& pose, float focal,
                                   int width, int height) {
  if (!mesh.irises || !(focal > 0)) return {};
  vec3 sum{0};
  for (size_t eye = 0; eye < 2; eye++) {
    const vec2 iris = (*mesh.irises)[eye][0] - vec2(width, height) / 2.f;
    const vec3 ray = glm::normalize(vec3(iris / focal, 1));
    const vec3 between = (face_point(corners[eye][0]) + face_point(corners[eye][1])) / 2.f;
    const vec3 ball = pose.position + pose.rotation * (between + vec3(0, 0, ball_depth));
    const float along = glm::dot(ball, ray);
    const float past = glm::length(ball - along * ray);
    const float inside = ball_radius * ball_radius - past * past;
    const vec3 at = (along - std::sqrt(std::max(inside, 0.f))) * ray;
    sum += glm::normalize(at - ball);
  }
  const float length = glm::length(sum);
  return length > 0.1f ? std::optional(sum / length) : std::nullopt;
}

void add_look(FaceSize& size, float iris, float focal, float pose_distance) {
  if (!(iris > 2) || !(focal > 0) || !(pose_distance > 0)) return;
  const double error = pixel_error / iris;
  const double weight = 1 / (error * error);
  size.sum += weight * std::log(double(iris_metres * focal / iris / pose_distance));
  size.weight += weight;
  if (size.weight > most_weight) {  // old looks fade
    size.sum *= most_weight / size.weight;
    size.weight = most_weight;
  }
}

float size_of(const FaceSize& size) {
  return float(std::exp(size.sum / (size.weight + 1 / (usual_spread * usual_spread))));
}

}  // namespace wellspring::kiosk
