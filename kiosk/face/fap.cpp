// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/fap.h"

#include <cmath>

namespace wellspring::kiosk {

namespace {

// Points that expression moves least.
constexpr size_t rigid[] = {27, 28, 29, 30, 33, 36, 39, 42, 45};
constexpr float least_unit = 0.002f;  // metres: a face has no smaller distances

enum class Unit : uint8_t { eyes, eye_nose, mouth_nose, mouth, iris };

struct Rule {
  size_t fap, point;
  Unit unit;
  vec2 along;  // the direction of positive values
};
constexpr vec2 up{0, -1}, down{0, 1}, image_left{-1, 0}, image_right{1, 0};
// The face's own left is at image right.
constexpr Rule rules[] = {
    {3, 8, Unit::mouth_nose, down},    {4, 62, Unit::mouth_nose, down},
    {5, 66, Unit::mouth_nose, up},     {6, 64, Unit::mouth, image_right},
    {7, 60, Unit::mouth, image_left},  {12, 64, Unit::mouth_nose, up},
    {13, 60, Unit::mouth_nose, up},    {31, 22, Unit::eye_nose, up},
    {32, 21, Unit::eye_nose, up},      {33, 24, Unit::eye_nose, up},
    {34, 19, Unit::eye_nose, up},      {35, 26, Unit::eye_nose, up},
    {36, 17, Unit::eye_nose, up},      {37, 22, Unit::eyes, image_left},
    {38, 21, Unit::eyes, image_right}, {53, 54, Unit::mouth, image_right},
    {54, 48, Unit::mouth, image_left}, {59, 54, Unit::mouth_nose, up},
    {60, 48, Unit::mouth_nose, up},
};
// Lids have two points each.
struct LidRule {
  size_t fap, a, b;
  vec2 along;
};
constexpr LidRule lids[] = {
    {19, 43, 44, down}, {20, 37, 38, down}, {21, 46, 47, up}, {22, 40, 41, up}};

vec2 middle(const FacePlane& face, size_t from, size_t count) {
  vec2 sum{0};
  for (size_t k = from; k < from + count; k++) sum += face[k];
  return sum / float(count);
}

// `now` moved, turned and scaled so that its rigid points lie on those of `rest` (least squares).
FacePlane aligned(const FacePlane& rest, const FacePlane& now) {
  vec2 from{0}, to{0};
  for (size_t k : rigid) from += now[k], to += rest[k];
  from /= float(std::size(rigid)), to /= float(std::size(rigid));
  float same = 0, cross = 0, size = 0;
  for (size_t k : rigid) {
    const vec2 a = now[k] - from, b = rest[k] - to;
    same += glm::dot(a, b), cross += a.x * b.y - a.y * b.x, size += glm::dot(a, a);
  }
  const float c = same / size, s = cross / size;
  FacePlane out;
  for (size_t k = 0; k < now.size(); k++) {
    const vec2 a = now[k] - from;
    out[k] = to + vec2(c * a.x - s * a.y, s * a.x + c * a.y);
  }
  return out;
}

}  // namespace

FacePlane face_plane(const FaceMarks& marks, const HeadPose& pose, float focal, int width,
                     int height) {
  FacePlane out;
  const mat3 back = glm::transpose(pose.rotation);
  const vec3 eye = back * -pose.position;  // the lens, seen from the head
  for (size_t k = 0; k < marks.size(); k++) {
    const vec3 ray = back * vec3((marks[k].x - float(width) / 2) / focal,
                                 (marks[k].y - float(height) / 2) / focal, 1);
    const float t = (face_point(k).z - eye.z) / ray.z;
    const vec3 p = eye + t * ray;
    out[k] = {p.x, p.y};
  }
  return out;
}

std::optional<Faps> measure_faps(const FacePlane& rest, const FacePlane& now) {
  const float units[] = {
      glm::length(middle(rest, 42, 6) - middle(rest, 36, 6)),
      rest[33].y - (middle(rest, 36, 6).y + middle(rest, 42, 6).y) / 2,
      rest[62].y - rest[33].y,
      glm::length(rest[54] - rest[48]),
      (middle(rest, 40, 2).y + middle(rest, 46, 2).y - middle(rest, 37, 2).y -
       middle(rest, 43, 2).y) /
          2,
  };
  for (float unit : units)
    if (!(unit > least_unit) || !std::isfinite(unit)) return {};
  const FacePlane face = aligned(rest, now);
  Faps faps{};
  auto unit = [&](Unit u) { return units[size_t(u)] / 1024; };
  for (const Rule& r : rules)
    faps[r.fap] = glm::dot(face[r.point] - rest[r.point], r.along) / unit(r.unit);
  for (const LidRule& r : lids)
    faps[r.fap] =
        glm::dot(face[r.a] + face[r.b] - rest[r.a] - rest[r.b], r.along) / 2 / unit(Unit::iris);
  for (float fap : faps)
    if (!std::isfinite(fap)) return {};
  return faps;
}

}  // namespace wellspring::kiosk
