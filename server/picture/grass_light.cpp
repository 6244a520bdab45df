// SPDX-License-Identifier: Apache-2.0
#include "picture/grass_light.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::picture {
namespace {

constexpr float root_around = 0.3f, root_lamp = 0.2f;  // shares of the tips' light that roots get
constexpr float lift = 0.03f;                          // metres at which shadow rays begin

// Returns the way that a blade of this normal faces for light: it stands for its neighbours, too,
// which face all ways.
vec3 facing_way(vec3 normal) {
  constexpr float lean_up = 0.6f;
  return glm::normalize(normal + vec3(0, lean_up, 0));
}

// Returns the light at a place, between the four nodes around it.
LawnLight::Node light_at(const LawnLight& light, const Lawn& lawn, vec2 place) {
  const vec2 at = clamp((place - lawn.low) / (lawn.high - lawn.low) * vec2(light.size) - 0.5f,
                        vec2(0), vec2(light.size - 1));
  const ivec2 first = min(ivec2(at), max(light.size - 2, ivec2(0)));
  const vec2 share = at - vec2(first);
  LawnLight::Node sum;
  sum.to_lamp = vec3(0);
  float weights = 0, most = 0;
  for (int tap = 0; tap < 4; tap++) {
    const ivec2 from = min(first + ivec2(tap & 1, tap >> 1), light.size - 1);
    const LawnLight::Node& node = light.node[size_t(from.y * light.size.x + from.x)];
    if (!node.known) continue;
    const float weight =
        (tap & 1 ? share.x : 1 - share.x) * (tap >> 1 ? share.y : 1 - share.y) + 1e-4f;
    sum.around += weight * node.around, sum.lamp += weight * node.lamp;
    sum.to_lamp += weight * node.to_lamp, weights += weight;
    if (weight > most) most = weight, sum.lamp_distance = node.lamp_distance;
  }
  if (!(weights > 0)) return {};
  sum.around /= weights, sum.lamp /= weights;
  const float length = glm::length(sum.to_lamp);
  sum.to_lamp = length > 0 ? sum.to_lamp / length : vec3(0, 1, 0);
  return sum;
}

// Returns what a blade sends to the eye. `moving`: light of lights that move, on what faces it.
vec3 shine(const LawnLight::Node& light, vec3 moving, vec3 normal, vec3 color, float transmission,
           float height) {
  const float through = transmission * (0.5f + 0.5f * height);  // blades are thicker at the root
  const vec3 around = light.around * glm::mix(root_around, 1.0f, height),
             lamp = light.lamp * glm::mix(root_lamp, 1.0f, height),
             other = moving * glm::mix(root_lamp, 1.0f, height);
  auto reach = [&](vec3 n) {
    return around * (0.5f + 0.5f * n.y) + lamp * std::max(dot(n, light.to_lamp), 0.0f);
  };
  return color * (reach(facing_way(normal)) + through * reach(facing_way(-normal)) + other);
}

// Reads a lawn's picture at pixels of the view.
struct Pixels {
  const LawnPicture& picture;
  const PictureWindow& window;
  const PixelGrid grid;
  size_t at(int x, int y) const {
    return size_t(y - window.top) * size_t(window.width) + size_t(x - window.left);
  }
  bool shows(int x, int y) const {
    return x >= window.left && x < window.left + window.width && y >= window.top &&
           y < window.top + window.height && picture.coverage[at(x, y)] > 0;
  }
  float depth(int x, int y) const { return shows(x, y) ? picture.depth[at(x, y)] : INFINITY; }
  vec3 facing(int x, int y) const { return facing_way(picture.normal[at(x, y)]); }
};

// Finds the light of lights that move on blocks of the picture; false: there is none. The sun is in
// the lawn's own light, but for what it sends off other things.
bool find_moving_light(const GrassWorld& world, const View& view, vec2 offset, const Pixels& pixels,
                       GrassLightWork& work) {
  if (!world.world || !world.lights || !world.dynamic) return false;
  DynamicLights from;
  for (const DynamicLight& one : world.dynamic->from)
    if (one.light.type != PunctualType::directional) from.push_back(one);
  if (from.empty() && world.dynamic->bounce.sources.empty()) return false;
  work.blocks.begin(view, offset, pixels.window);
  work.blocks.fill([&](int x, int y) { return pixels.depth(x, y); },
                   [&](int x, int y) { return pixels.facing(x, y); },
                   [](vec3, LitBlock& lit) { return lit.light = vec3(0), true; });
  work.blocks.describe(lift, work.surfaces);
  light_others(*world.world, *world.lights, *world.dynamic, from, work.surfaces, work.bounce,
               work.light);
  work.blocks.add(work.light);
  return true;
}

// Returns that light on eight pixels from (x, y) on.
Lanes3 moving_light_at(const LitBlocks& blocks, const Pixels& pixels, int x, int y) {
  if (!blocks.reach(x, y)) return {};
  Lanes depth = all_lanes(INFINITY);
  Lanes3 normal;
  for (int k = 0; k < lane_count; k++)
    if (pixels.shows(x + k, y)) {
      depth[k] = pixels.depth(x + k, y);
      normal.set(k, pixels.facing(x + k, y));
    }
  return blocks.at(x, y, depth, normal, 0);
}

// Holds what things that move leave of a lawn's light in a block of pixels.
struct Left {
  float around = 1, lamp = 1;  // shares
};

// Finds it for a row of blocks, from that of `top` on, each at the first pixel that shows grass.
void find_left(const ShownLawn& shown, const World& world, const MovingShade& shade,
               const Pixels& pixels, vec3 eye, int top, std::span<Left> left) {
  const PictureWindow& window = pixels.window;
  for (int i = 0; i < int(left.size()); i++) {
    left[size_t(i)] = {};
    for (int k = 0; k < LitBlocks::side * LitBlocks::side; k++) {
      const int x = window.left + i * LitBlocks::side + k % LitBlocks::side,
                y = top + k / LitBlocks::side;
      if (!pixels.shows(x, y)) continue;
      const vec3 place = eye + pixels.depth(x, y) * pixels.grid.at(float(x), float(y));
      if (shade.reaches(place))
        left[size_t(i)].around = shade.eval_open(place, vec3(0, 1, 0), vec3(0));
      const LawnLight::Node light = light_at(*shown.light, *shown.lawn, {place.x, place.z});
      if (light.lamp != vec3(0))
        left[size_t(i)].lamp =
            shade.eval_lamp(world, place + vec3(0, lift, 0), light.to_lamp, light.lamp_distance);
      break;
    }
  }
}

}  // namespace

size_t GrassLightWork::memory_bytes() const {
  return blocks.memory_bytes() + light::memory_bytes(surfaces) + light::memory_bytes(bounce) +
         light::memory_bytes(light);
}

void light_grass(const ShownLawn& shown, const GrassWorld& world, const MovingShade& shade,
                 const View& view, vec2 offset, const PictureWindow& window, GrassLightWork& work,
                 LawnPicture& picture) {
  const Pixels pixels{picture, window, PixelGrid(view, offset)};
  const bool moving = find_moving_light(world, view, offset, pixels, work);
  constexpr int side = LitBlocks::side;
  parallel_each((picture.height + side - 1) / side, [&](int band) {
    const int top = window.top + band * side;
    std::vector<Left> left(size_t((window.width + side - 1) / side));
    if (shade.any()) find_left(shown, *world.world, shade, pixels, view.position, top, left);
    for (int y = top; y < std::min(top + side, window.top + window.height); y++)
      for (int x = window.left; x < window.left + window.width; x += lane_count) {
        const Lanes3 others = moving ? moving_light_at(work.blocks, pixels, x, y) : Lanes3{};
        for (int k = 0; k < lane_count; k++) {
          if (!pixels.shows(x + k, y)) continue;
          const size_t i = pixels.at(x + k, y);
          const vec3 place =
              view.position + picture.depth[i] * pixels.grid.at(float(x + k), float(y));
          LawnLight::Node light = light_at(*shown.light, *shown.lawn, {place.x, place.z});
          const Left& share = left[size_t(x + k - window.left) / side];
          light.around *= share.around, light.lamp *= share.lamp;
          picture.color[i] = shine(light, others.at(k), picture.normal[i], picture.color[i],
                                   shown.lawn->colors.transmission, picture.height_share[i]);
        }
      }
  });
}

}  // namespace wellspring::picture
