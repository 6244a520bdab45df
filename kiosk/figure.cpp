// SPDX-License-Identifier: Apache-2.0
#include "kiosk/figure.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "kiosk/figure_head.h"

namespace wellspring::kiosk {

namespace {

const vec3 eyes_to_center{0, -0.012f, -0.085f};  // from between the eyes to the head's middle
// Metres of distance per row and column of rays in a pixel: what is far away must not flicker.
constexpr float rays_per_metre = 1;
constexpr int most_rays = 4;

float smooth(float a, float b, float x) {
  float t = glm::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

struct Ray {
  vec3 origin, direction;
};

// Nearest hit of the unit sphere scaled by `radii` about `center`; negative: none.
float hit_ellipsoid(const Ray& ray, vec3 center, vec3 radii) {
  vec3 o = (ray.origin - center) / radii, d = ray.direction / radii;
  float a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1;
  float disc = b * b - a * c;
  return disc < 0 ? -1 : (-b - std::sqrt(disc)) / a;
}

// Grey level 0..1 of the empty room behind (u, v), each 0..1 over the picture.
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

// Standard normal numbers (Box and Muller 1958), a table to draw from: a picture needs 300,000 of
// them.
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
  const float focal = focal_length(mount, room.width);
  const mat3 head =
      rotation_matrix(pose.rotation);  // head axes in screen axes; z points away from the screen
  // Head frame (figure_head.h): z out of the face, towards the screen; x stays the visitor's right.
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
  // What a ray through the picture at (x, y) sees of the figure; below 0: nothing.
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

}  // namespace wellspring::kiosk
