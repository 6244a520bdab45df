// SPDX-License-Identifier: Apache-2.0
#include "kiosk/figure_head.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr vec3 bound_center{0, -0.005f, -0.085f}, bound_radii{0.095f, 0.135f, 0.130f};
constexpr float touch = 2e-4f;  // metres: nearer is on the surface
constexpr int most_steps = 48;

float smooth_between(float a, float b, float x) {
  float t = glm::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// Distances, nearly: below the true one near the surface.
float ellipsoid(vec3 p, vec3 center, vec3 radii) {
  const vec3 q = p - center;
  const float near = glm::length(q / radii), steep = glm::length(q / (radii * radii));
  return steep > 0 ? near * (near - 1) / steep : -std::min({radii.x, radii.y, radii.z});
}
// A round cone about the line from a to b.
float cone(vec3 p, vec3 a, vec3 b, float radius_a, float radius_b) {
  const float t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.f, 1.f);
  return glm::length(p - a - t * (b - a)) - glm::mix(radius_a, radius_b, t);
}
// The union of two bodies, rounded where they are nearer than k.
float join(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.f) / k;
  return std::min(a, b) - h * h * k / 4;
}
float carve(float a, float b, float k) { return -join(-a, b, k); }

float distance(vec3 p) {
  const vec3 q{std::abs(p.x), p.y, p.z};                                   // both sides are alike
  float d = ellipsoid(q, {0, 0.025f, -0.087f}, {0.076f, 0.092f, 0.095f});  // cranium
  d = join(d, ellipsoid(q, {0, -0.042f, -0.052f}, {0.060f, 0.077f, 0.056f}), 0.03f);  // face
  d = join(d, ellipsoid(q, {0, -0.100f, -0.014f}, {0.026f, 0.016f, 0.020f}), 0.02f);  // chin
  d = join(d, ellipsoid(q, {0.043f, -0.030f, -0.020f}, {0.022f, 0.026f, 0.022f}), 0.025f);
  d = join(d, cone(q, {0.012f, 0.017f, -0.002f}, {0.040f, 0.019f, -0.012f}, 0.008f, 0.007f),
           0.014f);  // brow
  d = carve(d, ellipsoid(q, {0.032f, 0.001f, 0.010f}, {0.019f, 0.011f, 0.013f}), 0.010f);
  d = join(d, glm::length(q - vec3(0.0315f, 0, -0.0125f)) - 0.0125f, 0.002f);  // eyeball
  d = join(d, ellipsoid(q, {0, -0.068f, -0.012f}, {0.032f, 0.024f, 0.022f}), 0.018f);
  d = join(d, cone(q, {0, 0.004f, 0.002f}, {0, -0.033f, 0.022f}, 0.007f, 0.0095f), 0.012f);
  d = join(d, glm::length(q - vec3(0.0105f, -0.040f, 0.009f)) - 0.0072f, 0.006f);  // nostril
  d = join(d, cone(q, {0, -0.0635f, 0.0085f}, {0.023f, -0.068f, -0.002f}, 0.0045f, 0.002f), 0.004f);
  d = join(d, cone(q, {0, -0.0735f, 0.0065f}, {0.021f, -0.069f, -0.002f}, 0.0055f, 0.002f), 0.004f);
  d = join(d, ellipsoid(q, {0.074f, -0.012f, -0.092f}, {0.008f, 0.030f, 0.017f}), 0.006f);  // ear
  return d;
}

// 1 inside the ellipse about (x, y), 0 outside, with a soft rim.
float blob(vec2 p, float x, float y, float rx, float ry) {
  const float d = glm::length((p - vec2(x, y)) / vec2(rx, ry));
  return 1 - smooth_between(0.8f, 1.2f, d);
}

// Reflectance of skin, hair and what is painted on them.
float albedo_at(vec3 p) {
  float out = 0.66f;
  const vec2 q{std::abs(p.x), p.y};
  if (p.z > -0.035f) {
    const float lids =
        0.0052f * std::sqrt(std::max(0.f, 1 - std::pow((q.x - 0.0305f) / 0.0150f, 2.f)));
    const float in_eye = std::abs(q.y) < lids ? 1.f : 0.f;
    const float iris = blob(q, 0.0315f, 0.0005f, 0.0058f, 0.0058f);
    out -= 0.10f * blob(q, 0.031f, 0.002f, 0.023f, 0.015f);  // about the eye
    if (in_eye > 0) out = glm::mix(0.80f, 0.10f, iris);
    else if (lids > 0 && std::abs(q.y) < lids + 0.0016f) out -= q.y > 0 ? 0.42f : 0.14f;  // lashes
    const float along = (q.x - 0.014f) / 0.038f;  // of the brow, 0 to 1
    if (along > 0 && along < 1) {
      const float arch = 0.0195f + 0.006f * std::sin(pi * (0.15f + 0.7f * along)) - 0.004f * along;
      out -= 0.42f * (1 - smooth_between(0.0022f, 0.0052f - 0.002f * along, std::abs(q.y - arch)));
    }
    const float lip = q.x < 0.026f ? std::sqrt(1 - q.x * q.x / (0.026f * 0.026f)) : 0.f;
    if (p.y < -0.0685f + 0.0085f * lip && p.y > -0.0685f - 0.0095f * lip) out -= 0.20f;
    out -= 0.30f * (1 - smooth_between(0.0004f, 0.0018f, std::abs(p.y + 0.0685f))) * (lip > 0.2f);
    if (p.z > 0.002f) out -= 0.45f * blob(q, 0.0065f, -0.0455f, 0.0042f, 0.0024f);  // nostrils
  }
  // Hair: above the forehead, behind the temples.
  const float line = 0.068f - 6 * p.x * p.x;
  const float hair =
      std::max(smooth_between(line - 0.004f, line + 0.004f, p.y),
               smooth_between(-0.062f, -0.070f, p.z) * smooth_between(-0.05f, -0.035f, p.y));
  const bool ear = q.x > 0.0775f && p.y < 0.022f && p.y > -0.045f;
  return ear ? out : glm::mix(out, 0.09f, hair);
}

}  // namespace

std::optional<HeadHit> hit_head(vec3 origin, vec3 direction) {
  const vec3 o = (origin - bound_center) / bound_radii, d = direction / bound_radii;
  const float a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1, disc = b * b - a * c;
  if (disc < 0) return {};
  const float length = glm::length(direction), end = (-b + std::sqrt(disc)) / a;
  float t = std::max(0.f, (-b - std::sqrt(disc)) / a), from = 1;
  for (int step = 0; step < most_steps && t < end; step++) {
    from = distance(origin + t * direction);
    if (from < touch) break;
    t += from / length;
  }
  if (!(from < 5 * touch)) return {};
  const vec3 p = origin + t * direction;
  constexpr float h = 4e-4f;
  const vec3 normal{distance(p + vec3(h, 0, 0)) - distance(p - vec3(h, 0, 0)),
                    distance(p + vec3(0, h, 0)) - distance(p - vec3(0, h, 0)),
                    distance(p + vec3(0, 0, h)) - distance(p - vec3(0, 0, h))};
  const float steep = glm::length(normal);
  if (!(steep > 0)) return {};
  return HeadHit{t, normal / steep, albedo_at(p)};
}

}  // namespace wellspring::kiosk
