// SPDX-License-Identifier: Apache-2.0
#include "kiosk/figure.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace wellspring {

namespace {

// Head frame: x to the visitor's right, y up, z out of the face; origin between the eyes' depth and
// the neck. Metres.
const vec3 head_radii{0.077f, 0.118f, 0.095f};
const vec3 eyes_to_center{0, -0.012f, -0.085f};  // from between the eyes to the ellipsoid's centre
// What stands out of the face: the mouth's part with the chin, and the nose. {centre, radii}
const vec3 jaw_center{0, -0.058f, 0.045f}, jaw_radii{0.050f, 0.056f, 0.056f};
const vec3 nose_center{0, -0.012f, 0.090f}, nose_radii{0.014f, 0.028f, 0.026f};

float smooth(float a, float b, float x) {
  float t = glm::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// 1 inside the ellipse about (x, y), 0 outside, with a soft rim.
float blob(vec3 p, float x, float y, float rx, float ry) {
  float d = std::sqrt((p.x - x) * (p.x - x) / (rx * rx) + (p.y - y) * (p.y - y) / (ry * ry));
  return 1 - smooth(0.8f, 1.2f, d);
}

// Reflectance of skin, hair and features at a point of the head's surface.
float head_albedo(vec3 p) {
  float skin = 0.72f;
  if (p.z > 0) {
    for (float side : {-1.f, 1.f}) {
      skin -= 0.20f * blob(p, side * 0.031f, 0.014f, 0.022f, 0.017f);    // socket
      skin += 0.28f * blob(p, side * 0.031f, 0.011f, 0.013f, 0.006f);    // white of the eye
      skin -= 0.62f * blob(p, side * 0.031f, 0.012f, 0.0065f, 0.0065f);  // iris
      skin -= 0.25f * blob(p, side * 0.031f, 0.018f, 0.016f, 0.0025f);   // lid
      skin -= 0.42f * blob(p, side * 0.032f, 0.033f, 0.021f, 0.0045f);   // brow
      skin += 0.06f * blob(p, side * 0.042f, -0.022f, 0.020f, 0.020f);   // cheek
      skin -= 0.32f * blob(p, side * 0.008f, -0.033f, 0.0055f, 0.003f);  // nostril
      skin -= 0.12f * blob(p, side * 0.016f, -0.027f, 0.004f, 0.008f);   // wing of the nose
    }
    skin += 0.08f * blob(p, 0, -0.005f, 0.006f, 0.028f);   // bridge
    skin += 0.07f * blob(p, 0, 0.060f, 0.045f, 0.018f);    // forehead
    skin -= 0.30f * blob(p, 0, -0.062f, 0.025f, 0.0035f);  // mouth
    skin -= 0.14f * blob(p, 0, -0.065f, 0.023f, 0.009f);   // lips
    skin -= 0.10f * blob(p, 0, -0.080f, 0.014f, 0.004f);   // under the lip
  }
  float hairline = 0.078f - 6.f * p.x * p.x;
  float hair = std::max(smooth(hairline - 0.004f, hairline + 0.004f, p.y),
                        smooth(0.012f, -0.012f, p.z + 0.02f) * smooth(-0.06f, -0.04f, p.y));
  return glm::mix(skin, 0.10f, hair);
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
  // Head frame of the texture: z out of the face, towards the screen; x stays the visitor's right.
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
  for (int y = 0; y < room.height; y++)
    for (int x = 0; x < room.width; x++) {
      float grey = room_at((x + 0.5f) / room.width, (y + 0.5f) / room.height);
      if (x >= left && x <= right && y >= top && y <= bottom) {
        vec3 camera{(x + 0.5f - room.width / 2.f) / focal, (y + 0.5f - room.height / 2.f) / focal,
                    1};
        Ray ray{lens, camera_to_screen(mount, camera) - lens};
        Ray in_head{to_head * (ray.origin - center), to_head * ray.direction};
        float t = hit_ellipsoid(in_head, vec3(0), head_radii);
        float nose = hit_ellipsoid(in_head, nose_center, nose_radii);
        float jaw = hit_ellipsoid(in_head, jaw_center, jaw_radii);
        float best = 1e9f;
        auto shade = [&](float at, vec3 normal, float albedo) {
          best = at;
          grey = albedo * (0.38f + 0.62f * std::max(0.f, glm::dot(normal, lamp)));
        };
        if (t > 0) {
          vec3 p = in_head.origin + t * in_head.direction;
          shade(t, glm::transpose(to_head) * glm::normalize(p / (head_radii * head_radii)),
                head_albedo(p));
        }
        // Features are drawn by where they lie across the face, whatever bulges below them.
        auto feature = [&](float at, vec3 c, vec3 radii, float soften) {
          if (!(at > 0 && at < best)) return;
          vec3 p = in_head.origin + at * in_head.direction;
          vec3 n = glm::normalize(
              glm::mix((p - c) / (radii * radii), p / (head_radii * head_radii), soften));
          shade(at, glm::transpose(to_head) * n, head_albedo({p.x, p.y, 0.05f}));
        };
        feature(jaw, jaw_center, jaw_radii, 0.7f);
        feature(nose, nose_center, nose_radii, 0.3f);
        auto body = [&](vec3 c, vec3 radii, float albedo) {
          float at = hit_ellipsoid(ray, c, radii);
          if (at > 0 && at < best) {
            vec3 p = ray.origin + at * ray.direction;
            shade(at, glm::normalize((p - c) / (radii * radii)), albedo);
          }
        };
        body(neck, {0.055f, 0.12f, 0.055f}, 0.60f);
        body(torso, {0.24f, 0.34f, 0.13f}, 0.24f);
      }
      size_t i = size_t(y) * room.width + x;
      float level = 255 * room.light * grey + room.noise * normal[rng.next() & (normal.size() - 1)];
      frame.pixels[i] = uint8_t(glm::clamp(level + 0.5f, 0.f, 255.f));
    }
  return frame;
}

}  // namespace wellspring
