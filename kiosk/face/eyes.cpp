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

// The network reads irises narrower than they are (mean of the castle's figures who look into the
// lens from 0.5 and 1 m).
constexpr float read_over_true = 0.93f;
constexpr float least_iris = 6, most_turned = 0.35f;  // pixels, radians
// Errors of logarithms: one of all looks together, and one of a look at an iris of one pixel.
constexpr double common_error = 0.06, pixel_error = 0.6;
constexpr double most_looks = 200;  // as many of irises of ten pixels; older ones fade

struct Prior {
  double share, mean, spread;
};
constexpr Prior priors[] = {{0.8, 0, 0.045}, {0.2, -0.174, 0.08}};  // adults, children

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

void add_look(FaceSize& size, float iris, float focal, const HeadPose& pose) {
  const float distance = pose.position.z;
  if (!(iris >= least_iris) || !(focal > 0) || !(distance > 0)) return;
  const vec3 straight = glm::normalize(pose.position);  // a face that turns to the lens looks there
  if (!(glm::dot(pose.rotation[2], straight) > std::cos(most_turned))) return;
  const double ratio = iris_metres * read_over_true * focal / iris / distance;
  const double weight = double(iris * iris) / 100;
  size.sum += weight * std::log(ratio), size.looks += weight;
  if (size.looks > most_looks) size.sum *= most_looks / size.looks, size.looks = most_looks;
}

float size_of(const FaceSize& size) {
  if (!(size.looks > 0)) return 1;
  const double seen = size.sum / size.looks;
  const double error = common_error * common_error + pixel_error * pixel_error / 100 / size.looks;
  double total = 0, mean = 0;
  for (const Prior& prior : priors) {
    const double spread = prior.spread * prior.spread, both = spread + error;
    const double off = seen - prior.mean;
    const double share = prior.share * std::exp(-0.5 * off * off / both) / std::sqrt(both);
    total += share, mean += share * (seen * spread + prior.mean * error) / both;
  }
  return total > 1e-12 ? float(std::exp(mean / total)) : 1;
}

}  // namespace wellspring::kiosk
