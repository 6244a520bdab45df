// SPDX-License-Identifier: Apache-2.0
#include "kiosk/figure.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace wellspring::kiosk {

namespace {

const vec3 eyes_to_center{0, -0.012f, -0.085f};  // way from between the eyes to the head's middle
// A pixel has so many rows and columns of rays a metre of distance: a far figure must not flicker.
constexpr float rays_per_metre = 1;
constexpr int most_rays = 4;

float smooth(float a, float b, float x) {
  float t = glm::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

struct Ray {
  vec3 origin, direction;
};

// Returns the nearest hit of the unit sphere scaled by `radii` about `center`; negative: none.
float hit_ellipsoid(const Ray& ray, vec3 center, vec3 radii) {
  vec3 o = (ray.origin - center) / radii, d = ray.direction / radii;
  float a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1;
  float disc = b * b - a * c;
  return disc < 0 ? -1 : (-b - std::sqrt(disc)) / a;
}

// Returns the grey level 0..1 of the empty room behind (u, v), each 0..1 over the picture.
float room_at(float u, float v) {
  float wall = 0.52f + 0.10f * (1 - v) - 0.14f * u;
  if (v > 0.82f) wall = 0.32f + 0.1f * (v - 0.82f);        // floor
  if (u > 0.06f && u < 0.24f && v > 0.12f && v < 0.42f) {  // picture
    bool frame = u < 0.075f || u > 0.225f || v < 0.14f || v > 0.40f;
    wall = frame ? 0.22f : 0.45f + 0.15f * std::sin(40 * u) * std::sin(25 * v);
  }
  if (u > 0.86f) wall *= 0.8f;  // door
  return wall;
}

// Returns a table of standard normal numbers (Box and Muller 1958) to draw from: a picture needs
// 300,000 of them.
const std::vector<float>& normal_numbers() {
  static const std::vector<float> numbers = [] {
    std::vector<float> out(1 << 13);
    Rng rng(7);
    for (float& n : out)
      n = std::sqrt(-2 * std::log(1 - rng.uniform())) * std::cos(2 * pi * rng.uniform());
    return out;
  }();
  return numbers;
}

}  // namespace

FigurePose figure_at(double time) {
  float t = float(std::fmod(std::max(time, 0.0), figure_round));
  FigurePose pose;
  pose.visible = t >= figure_enters && t < figure_gone;
  float in = smooth(float(figure_enters), float(figure_stands), t);
  float out = smooth(float(figure_leaves), float(figure_gone), t);
  float s = std::max(0.f, t - float(figure_stands)) * (1 - out);
  pose.position = {1.1f * (1 - in) - 1.1f * out + 0.10f * std::sin(0.8f * s),
                   0.03f + 0.012f * std::sin(1.7f * s), 0.85f + 0.08f * std::sin(0.5f * s)};
  pose.rotation = {0.38f * std::sin(1.1f * s), 0.14f * std::sin(0.9f * s),
                   0.12f * std::sin(0.7f * s)};
  return pose;
}

GrayFrame draw_figure(const FigureRoom& room, const Mount& mount, const FigurePose& pose,
                      double time) {
  GrayFrame frame{time, room.width, room.height, {}};
  frame.pixels.resize(size_t(room.width) * room.height);
  const float focal = focal_length(mount, room.width, room.height);
  const mat3 head =
      rotation_matrix(pose.rotation);  // head axes in screen axes; z points away from the screen
  // The head's frame is that of figure.h: z out of the face, towards the screen; x stays the
  // visitor's right.
  const mat3 to_head = glm::transpose(mat3(head[0], head[1], -head[2]));
  const vec3 center = pose.position + glm::transpose(to_head) * eyes_to_center;
  const vec3 lens = mount.offset;
  const vec3 lamp = glm::normalize(vec3(-0.35f, 0.75f, -0.9f));
  const vec3 neck = center + vec3(0, -0.15f, 0.02f), torso = center + vec3(0, -0.52f, 0.03f);
  const std::vector<float>& normal = normal_numbers();
  Rng rng(mix64(room.seed ^ uint64_t(std::llround(time * 1000))));
  // Rays are cast only where the figure can be: in the rectangle around a box around it.
  float left = 1e9f, right = -1e9f, top = 1e9f, bottom = -1e9f;
  for (int corner = 0; pose.visible && corner < 8; corner++) {
    vec3 at = screen_to_camera(
        mount, center + vec3(corner & 1 ? 0.25f : -0.25f, corner & 2 ? 0.15f : -0.9f,
                             corner & 4 ? 0.2f : -0.2f));
    float u = at.x / std::max(at.z, 0.05f) * focal + room.width / 2.f;
    float v = at.y / std::max(at.z, 0.05f) * focal + room.height / 2.f;
    left = std::min(left, u), right = std::max(right, u);
    top = std::min(top, v), bottom = std::max(bottom, v);
  }
  // Returns what a ray through the picture at (x, y) sees of the figure; below 0: nothing.
  auto look = [&](float x, float y) {
    vec3 camera{(x - room.width / 2.f) / focal, (y - room.height / 2.f) / focal, 1};
    Ray ray{lens, camera_to_screen(mount, camera) - lens};
    float best = 1e9f, seen = -1;
    auto shade = [&](float at, vec3 normal, float albedo) {
      best = at;
      seen = albedo * (0.38f + 0.62f * std::max(0.f, glm::dot(normal, lamp)));
    };
    if (auto hit = hit_head(to_head * (ray.origin - pose.position), to_head * ray.direction))
      shade(hit->t, glm::transpose(to_head) * hit->normal, hit->albedo);
    auto body = [&](vec3 c, vec3 radii, float albedo) {
      float at = hit_ellipsoid(ray, c, radii);
      if (at > 0 && at < best) {
        vec3 p = ray.origin + at * ray.direction;
        shade(at, glm::normalize((p - c) / (radii * radii)), albedo);
      }
    };
    body(neck, {0.055f, 0.12f, 0.055f}, 0.60f);
    body(torso, {0.24f, 0.34f, 0.13f}, 0.24f);
    return seen;
  };
  const float away = screen_to_camera(mount, pose.position).z;
  const int rays = std::clamp(int(std::lround(away * rays_per_metre)), 1, most_rays);
  for (int y = 0; y < room.height; y++)
    for (int x = 0; x < room.width; x++) {
      float grey = room_at((x + 0.5f) / room.width, (y + 0.5f) / room.height);
      if (x >= left && x <= right && y >= top && y <= bottom) {
        float sum = 0;
        for (int k = 0; k < rays * rays; k++) {
          const float seen = look(float(x) + (float(k % rays) + 0.5f) / float(rays),
                                  float(y) + (float(k / rays) + 0.5f) / float(rays));
          sum += seen < 0 ? grey : seen;
        }
        grey = sum / float(rays * rays);
      }
      size_t i = size_t(y) * room.width + x;
      float level = 255 * room.light * grey + room.noise * normal[rng.next() & (normal.size() - 1)];
      frame.pixels[i] = uint8_t(glm::clamp(level + 0.5f, 0.f, 255.f));
    }
  return frame;
}

namespace {

constexpr vec3 bound_center{0, -0.005f, -0.085f}, bound_radii{0.095f, 0.135f, 0.130f};
constexpr float touch = 2e-4f;  // metres: anything nearer is on the surface
constexpr int most_steps = 48;

float smooth_between(float a, float b, float x) {
  float t = glm::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// These functions return distances, nearly: below the true one near the surface.
float ellipsoid(vec3 p, vec3 center, vec3 radii) {
  const vec3 q = p - center;
  const float near = glm::length(q / radii), steep = glm::length(q / (radii * radii));
  return steep > 0 ? near * (near - 1) / steep : -std::min({radii.x, radii.y, radii.z});
}
// Returns the distance to a round cone about the line from a to b.
float cone(vec3 p, vec3 a, vec3 b, float radius_a, float radius_b) {
  const float t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.f, 1.f);
  return glm::length(p - a - t * (b - a)) - glm::mix(radius_a, radius_b, t);
}
// Returns the union of two bodies, rounded where they are nearer than k.
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

// Returns 1 inside the ellipse about (x, y), 0 outside, with a soft rim.
float blob(vec2 p, float x, float y, float rx, float ry) {
  const float d = glm::length((p - vec2(x, y)) / vec2(rx, ry));
  return 1 - smooth_between(0.8f, 1.2f, d);
}

// Returns the reflectance of skin, hair and paint on them.
float albedo_at(vec3 p) {
  float out = 0.66f;
  const vec2 q{std::abs(p.x), p.y};
  if (p.z > -0.035f) {
    const float lids =
        0.0052f * std::sqrt(std::max(0.f, 1 - std::pow((q.x - 0.0305f) / 0.0150f, 2.f)));
    const float in_eye = std::abs(q.y) < lids ? 1.f : 0.f;
    const float iris = blob(q, 0.0315f, 0.0005f, 0.0058f, 0.0058f);
    out -= 0.10f * blob(q, 0.031f, 0.002f, 0.023f, 0.015f);  // surroundings of the eye
    if (in_eye > 0) out = glm::mix(0.80f, 0.10f, iris);
    else if (lids > 0 && std::abs(q.y) < lids + 0.0016f) out -= q.y > 0 ? 0.42f : 0.14f;  // lashes
    const float along = (q.x - 0.014f) / 0.038f;  // place along the brow, 0 to 1
    if (along > 0 && along < 1) {
      const float arch = 0.0195f + 0.006f * std::sin(pi * (0.15f + 0.7f * along)) - 0.004f * along;
      out -= 0.42f * (1 - smooth_between(0.0022f, 0.0052f - 0.002f * along, std::abs(q.y - arch)));
    }
    const float lip = q.x < 0.026f ? std::sqrt(1 - q.x * q.x / (0.026f * 0.026f)) : 0.f;
    if (p.y < -0.0685f + 0.0085f * lip && p.y > -0.0685f - 0.0095f * lip) out -= 0.20f;
    out -= 0.30f * (1 - smooth_between(0.0004f, 0.0018f, std::abs(p.y + 0.0685f))) * (lip > 0.2f);
    if (p.z > 0.002f) out -= 0.45f * blob(q, 0.0065f, -0.0455f, 0.0042f, 0.0024f);  // nostrils
  }
  // Hair grows above the forehead and behind the temples.
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
