// SPDX-License-Identifier: Apache-2.0
#include "light/mirror_image.h"

#include <algorithm>
#include <cmath>

namespace wellspring {
namespace {

constexpr int most_surfaces = 6;     // of a chain
constexpr float aside = 1e-3f;       // radians, and metres a metre of the way: between neighbours
constexpr float nearest = 0.05f;  // of the first surface's distance: a place right before the eye
constexpr float farthest = 1000;     // likewise: as good as infinitely far

// What one specular surface of the chain is and does.
struct Turn {
  uint32_t instance = 0;
  Bounce bounce = Bounce::reflect;
};
struct Chain {
  Turn turns[most_surfaces];
  int count = 0;
  bool sky = false;
  vec3 place{0}, normal{0};  // where it ends; a direction in the sky
};

// The stronger of mirror image and refraction.
BsdfSample turn_at(const Surface& surface, const Bsdf& bsdf, const Material& material,
                   vec3 direction) {
  vec3 n = dot(bsdf.normal, direction) > 0 ? -bsdf.normal : bsdf.normal;
  BsdfSample turned;
  turned.weight = vec3(1);
  turned.direction = glm::reflect(direction, n);
  if (!(max_component(bsdf.transmit) > 0)) return turned;
  if (bsdf.thin && !is_pane(surface, material)) {
    turned.direction = direction;
    turned.bounce = Bounce::pass;
    return turned;
  }
  vec3 through = glm::refract(direction, n, 1 / bsdf.eta);
  if (through == vec3(0)) return turned;  // total reflection
  float cosine = -dot(direction, n), beyond = -dot(through, n);
  float across = (cosine - bsdf.eta * beyond) / (cosine + bsdf.eta * beyond),
        along = (bsdf.eta * cosine - beyond) / (bsdf.eta * cosine + beyond);
  if (across * across + along * along > 1) return turned;  // more than half is reflected
  turned.direction = through;
  turned.bounce = Bounce::refract;
  return turned;
}

// Follows the walk to where something scatters. Of a `known` chain it must do the same, and ends in
// the plane where that does. False: not so, or there is nothing specular.
bool follow_chain(const Transport& transport, Walk walk, Hit hit, const Chain* known,
                  Chain& chain) {
  for (;;) {
    if (known && chain.count == known->count) {
      chain.sky = known->sky;
      if (known->sky) {
        chain.place = walk.ray.direction;
        return true;
      }
      float slope = dot(walk.ray.direction, known->normal);
      if (!(std::abs(slope) > 1e-3f)) return false;
      float t = dot(known->place - walk.ray.origin, known->normal) / slope;
      chain.place = walk.ray.origin + t * walk.ray.direction;
      return t > 0;
    }
    if (!hit.valid()) {
      chain.sky = true;
      chain.place = walk.ray.direction;
      return chain.count > 0;
    }
    Surface surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Material& material = transport.world.material_of(hit.instance);
    Bsdf bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    bool pane = is_pane(surface, material) && !has_diffuse(bsdf) && bsdf.metallic == 0;
    BsdfSample turned;
    if (pane) {
      turned.direction = walk.ray.direction;
      turned.weight = vec3(1);
      turned.bounce = Bounce::pass;
    } else if (looks_specular(bsdf) && !material.unlit && chain.count < most_surfaces) {
      turned = turn_at(surface, bsdf, material, walk.ray.direction);
      Turn turn{hit.instance, turned.bounce};
      if (known && (turn.instance != known->turns[chain.count].instance ||
                    turn.bounce != known->turns[chain.count].bounce))
        return false;
      chain.turns[chain.count++] = turn;
    } else {
      chain.place = surface.position;
      chain.normal = surface.geometric_normal;
      return chain.count > 0 && !known;
    }
    if (!advance(walk, surface, turned)) return false;
    hit = transport.world.intersect(walk.ray);
  }
}

}  // namespace

bool looks_specular(const Bsdf& bsdf) { return bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f; }

float find_image_distance(const Transport& transport, const Walk& begun, const Hit& hit) {
  Chain chain;
  if (!follow_chain(transport, begun, hit, nullptr, chain)) return 0;
  if (chain.turns[0].bounce != Bounce::reflect) return 0;
  vec3 d = begun.ray.direction;
  vec3 u = normalize(std::abs(d.y) < 0.9f ? cross(d, vec3(0, 1, 0)) : cross(d, vec3(1, 0, 0)));
  // The end's motion by a step of the eye, and by a turn of the ray: both together leave it where
  // it is when the ray turns about the image.
  float step = aside * hit.t, both = 0, turning = 0;
  for (vec3 axis : {u, cross(u, d)}) {
    Walk stepped = begun, turned = begun;
    stepped.ray.origin += step * axis;
    turned.ray.direction = normalize(d + aside * axis);
    Chain by_step, by_turn;
    if (!follow_chain(transport, stepped, transport.world.intersect(stepped.ray), &chain,
                      by_step) ||
        !follow_chain(transport, turned, transport.world.intersect(turned.ray), &chain, by_turn))
      return 0;
    vec3 moved = (by_step.place - chain.place) / step,
         swept = (by_turn.place - chain.place) / aside;
    both += dot(moved, swept);
    turning += dot(swept, swept);
  }
  if (!(both > 0) || !(turning > 0)) return chain.sky && turning > 0 ? farthest * hit.t : 0;
  float distance = turning / both;
  return distance >= nearest * hit.t ? std::min(distance, farthest * hit.t) : 0.0f;
}

}  // namespace wellspring
