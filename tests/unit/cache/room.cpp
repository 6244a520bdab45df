// SPDX-License-Identifier: Apache-2.0
#include "unit/cache/room.h"

#include <cmath>

#include "base/parallel.h"
#include "scenes/build.h"

namespace wellspring::test {
namespace {

constexpr vec3 low{-4, 0, -5}, high{4, 3, 5};
constexpr vec3 spot_place{2.5f, 2.8f, 2.0f}, spot_power{9, 8, 7};
constexpr vec3 lamp_radiance{14, 13, 11};
constexpr float lamp_half = 0.7f;

struct RoomHit {
  float t = 1e30f;
  vec3 normal{0}, albedo{0}, emission{0};
  uint32_t object = 0;
  bool mirror = false;
};

struct Ball {
  vec3 center;
  float radius;
  vec3 albedo;
  bool mirror;
};
constexpr Ball balls[4] = {{{-1.2f, 0.6f, -1.5f}, 0.6f, {0.8f, 0.75f, 0.2f}, false},
                           {{1.3f, 0.8f, -2.6f}, 0.8f, {0.2f, 0.7f, 0.3f}, false},
                           {{0.2f, 0.35f, -0.4f}, 0.35f, {0.8f, 0.8f, 0.8f}, false},
                           {{2.6f, 0.7f, -0.8f}, 0.7f, {0, 0, 0}, true}};

float checker(float u, float v) {
  return (int(std::floor(u)) + int(std::floor(v))) & 1 ? 1.0f : 0.0f;
}

vec3 wall_albedo(uint32_t object, vec3 p) {
  switch (object) {
    case 1:
      return mix(vec3(0.25f, 0.16f, 0.1f), vec3(0.75f, 0.68f, 0.55f), checker(p.x * 2, p.z * 2));
    case 2: return vec3(0.85f);
    case 3: return vec3(0.7f, 0.25f, 0.2f);
    case 4: return vec3(0.25f, 0.4f, 0.7f);
    default: {
      // Back and front walls carry pictures of fine stripes.
      bool frame = std::abs(std::fmod(p.x + 8, 2.0f) - 1) < 0.7f && p.y > 1 && p.y < 2.2f;
      if (!frame) return vec3(0.7f, 0.68f, 0.6f);
      return mix(vec3(0.1f, 0.3f, 0.15f), vec3(0.9f, 0.8f, 0.4f),
                 checker(p.x * 8 + 5 * std::sin(p.y * 4), p.y * 8));
    }
  }
}

RoomHit hit_room(const Room& room, vec3 o, vec3 d) {
  RoomHit hit;
  for (int axis = 0; axis < 3; axis++) {
    if (d[axis] == 0) continue;
    float plane = d[axis] > 0 ? high[axis] : low[axis], t = (plane - o[axis]) / d[axis];
    if (t <= 1e-4f || t >= hit.t) continue;
    hit.t = t;
    hit.normal = vec3(0);
    hit.normal[axis] = d[axis] > 0 ? -1.0f : 1.0f;
    hit.object = axis == 1   ? (d.y < 0 ? 1u : 2u)
                 : axis == 0 ? (d.x < 0 ? 3u : 4u)
                             : (d.z < 0 ? 5u : 6u);
  }
  vec3 p = o + d * hit.t;
  hit.albedo = wall_albedo(hit.object, p);
  if (hit.object == 2 && room.lamp && std::abs(p.x) < lamp_half && std::abs(p.z) < lamp_half) {
    hit.emission = lamp_radiance;
    hit.object = 7;
  }
  for (uint32_t i = 0; i < 4; i++) {
    vec3 to = o - balls[i].center;
    float b = dot(to, d), c = dot(to, to) - balls[i].radius * balls[i].radius, disc = b * b - c;
    if (disc <= 0) continue;
    float root = std::sqrt(disc), t = -b - root;
    if (t <= 1e-3f) t = -b + root;
    if (t <= 1e-3f || t >= hit.t) continue;
    hit.t = t;
    hit.normal = (o + d * t - balls[i].center) / balls[i].radius;
    hit.albedo = balls[i].albedo;
    hit.emission = vec3(0);
    hit.object = 8 + i;
    hit.mirror = balls[i].mirror;
  }
  return hit;
}

bool blocked(const Room& room, vec3 p, vec3 d, float far) {
  return hit_room(room, p, d).t < far - 2e-3f;
}

vec3 spot_light(const Room& room, vec3 p, vec3 n) {
  if (!room.spot) return vec3(0);
  vec3 to = spot_place - p;
  float distance = length(to);
  to /= distance;
  float facing = dot(n, to);
  if (facing <= 0 || blocked(room, p, to, distance)) return vec3(0);
  return spot_power * (facing / (distance * distance * pi));
}

vec3 lamp_light(const Room& room, vec3 p, vec3 n, float u, float v) {
  if (!room.lamp) return vec3(0);
  vec3 q((u * 2 - 1) * lamp_half, high.y, (v * 2 - 1) * lamp_half), to = q - p;
  float distance = length(to);
  to /= distance;
  float facing = dot(n, to);
  if (facing <= 0 || to.y <= 0 || blocked(room, p, to, distance)) return vec3(0);
  return lamp_radiance * (facing * to.y * 4 * lamp_half * lamp_half / (distance * distance * pi));
}

vec3 scatter(vec3 n, float u, float v) {
  float r = std::sqrt(u), phi = 2 * pi * v;
  vec3 a = std::abs(n.x) > 0.5f ? vec3(0, 1, 0) : vec3(1, 0, 0), t = normalize(cross(a, n)),
       b = cross(n, t);
  return normalize(t * (r * std::cos(phi)) + b * (r * std::sin(phi)) +
                   n * std::sqrt(std::max(0.0f, 1 - u)));
}

// Light falling on p by other ways than straight from the spot, over albedo.
vec3 indirect(const Room& room, vec3 p, vec3 n, Rng& rng) {
  vec3 sum(0), weight(1);
  for (int bounce = 0; bounce < room.bounces; bounce++) {
    float u = rng.uniform(), v = rng.uniform();
    sum += weight * lamp_light(room, p, n, u, v);
    u = rng.uniform(), v = rng.uniform();
    vec3 d = scatter(n, u, v);
    vec3 from = p + n * 1e-3f;
    RoomHit hit = hit_room(room, from, d);
    if (hit.mirror) break;
    weight *= hit.albedo;
    p = from + d * hit.t;
    n = hit.normal;
    p += n * 1e-3f;
    if (bounce + 1 < room.bounces) sum += weight * spot_light(room, p, n);
  }
  return sum;
}

vec3 plain_light(vec3 p, vec3 n) {
  return vec3(0.6f + 0.2f * n.y + 0.1f * std::sin(p.x) + 0.1f * std::cos(p.z));
}

}  // namespace

Sample trace_room(const Room& room, const Request& request) {
  Rng rng(request.seed);
  vec3 o = request.ray.origin, d = request.ray.direction, reflectance(1);
  Sample sample;
  RoomHit hit = hit_room(room, o, d);
  sample.distance = hit.t;
  sample.position = o + d * hit.t;
  sample.normal = hit.normal;
  if (dot(sample.normal, d) > 0) sample.normal = -sample.normal;
  sample.object = hit.object;
  sample.flags = sample_hit;
  bool mirrored = hit.mirror;
  if (mirrored) {
    sample.flags |= sample_specular;
    d = reflect(d, hit.normal);
    o = sample.position + hit.normal * 1e-3f;
    reflectance = vec3(0.9f);
    hit = hit_room(room, o, d);
  }
  vec3 p = o + d * hit.t, n = dot(hit.normal, d) > 0 ? -hit.normal : hit.normal,
       from = p + n * 1e-3f;
  vec3 smooth = room.noisy ? indirect(room, from, n, rng) : plain_light(p, n);
  vec3 rest = hit.emission + hit.albedo * spot_light(room, from, n);
  if (hit.emission != vec3(0)) smooth = vec3(0), hit.albedo = vec3(0);
  if (mirrored) {
    sample.rest = reflectance * (hit.albedo * smooth + rest);
  } else {
    sample.albedo = hit.albedo;
    sample.smooth = smooth;
    sample.rest = rest;
    sample.glow = hit.emission;
  }
  return sample;
}

void trace_room(const Room& room, std::span<const Request> requests, std::vector<Sample>& samples) {
  samples.resize(requests.size());
  parallel_ranges(int(requests.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++) samples[size_t(i)] = trace_room(room, requests[size_t(i)]);
  });
}

Frame render_room(const Room& room, const View& view, int spp, uint64_t seed) {
  Frame frame{.width = view.width, .height = view.height};
  size_t pixels = size_t(view.width) * size_t(view.height);
  frame.color.assign(pixels, vec3(0));
  frame.depth.assign(pixels, 0);
  frame.object.assign(pixels, 0);
  parallel_for(view.height, [&](int y) {
    for (int x = 0; x < view.width; x++) {
      size_t at = size_t(y) * size_t(view.width) + size_t(x);
      for (int i = 0; i < spp; i++) {
        Request request{.seed = sample_seed(seed, uint32_t(x), uint32_t(y), uint32_t(i))};
        Rng rng(request.seed ^ 0x1234567);
        float u = rng.uniform(), v = rng.uniform();
        request.ray = view_ray(view, float(x) + u, float(y) + v);
        Sample sample = trace_room(room, request);
        frame.color[at] += sample.radiance() / float(spp);
        if (i == 0)
          frame.object[at] = sample.object,
          frame.depth[at] = dot(sample.position - view.position, view.forward);
      }
    }
  });
  return frame;
}

View look_at(vec3 eye, vec3 target, float fov_degrees, int width, int height) {
  View view{.position = eye, .forward = normalize(target - eye)};
  view.right = normalize(cross(view.forward, vec3(0, 1, 0)));
  view.up = cross(view.right, view.forward);
  view.tan_half_fov = std::tan(fov_degrees * pi / 360);
  view.width = width;
  view.height = height;
  return view;
}

namespace {

// Paints the wall from `a` along u and v, in metres: its reflectances are a picture.
Material paint_wall(Scene& scene, uint32_t object, vec3 a, vec3 u, vec3 v, int columns, int rows) {
  Image image{.width = columns, .height = rows, .srgb = true};
  for (int y = 0; y < rows; y++)
    for (int x = 0; x < columns; x++) {
      vec3 p = a + u * ((float(x) + 0.5f) / float(columns)) + v * ((float(y) + 0.5f) / float(rows));
      vec3 albedo = wall_albedo(object, p);
      for (int c = 0; c < 3; c++) {
        float l = albedo[c];
        float code = l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f;
        image.texels8.push_back(uint8_t(code * 255 + 0.5f));
      }
      image.texels8.push_back(255);
    }
  Material material = scenes::diffuse(vec3(1));
  material.base_color_texture.texture = scenes::add_texture(scene, image, true);
  return material;
}

}  // namespace

Scene make_room_scene(const Room& room) {
  using namespace scenes;
  Scene scene = empty_scene();
  const vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  // The materials are in the order of RoomHit::object.
  auto plain = [&](uint32_t object) {
    return add_material(scene, diffuse(wall_albedo(object, vec3(0))));
  };
  const vec3 front = low + z, back = low + x;
  add_quad(scene, paint_wall(scene, 1, front, x, -z, 512, 640), front, x, -z, "floor");
  add_quad(scene, plain(2), low + y, x, z, "ceiling");
  add_quad(scene, plain(3), front, -z, y, "left");
  add_quad(scene, plain(4), back, z, y, "right");
  add_quad(scene, paint_wall(scene, 5, low, x, y, 1024, 384), low, x, y, "back");
  add_quad(scene, paint_wall(scene, 6, high - y, -x, y, 1024, 384), high - y, -x, y, "front");
  if (room.lamp)
    add_quad(scene, emitter(lamp_radiance), {-lamp_half, high.y - 1e-3f, -lamp_half},
             {2 * lamp_half, 0, 0}, {0, 0, 2 * lamp_half}, "lamp");
  else scene.objects.push_back("lamp");
  for (const Ball& ball : balls)
    add_sphere(scene, diffuse(ball.albedo), ball.radius, "ball", at(ball.center), 64);
  return scene;
}

}  // namespace wellspring::test
