// SPDX-License-Identifier: Apache-2.0
#include "light/splat/shadow_packet.h"

#include <algorithm>

#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {

namespace {
constexpr float lift = 3e-4f;                 // off the surface, as a share of its depth
constexpr float apart_share = -4 * 0x1p-23f;  // so many steps of a coordinate, in metres
}  // namespace

ShadowOrigin shadow_origin(vec3 place, vec3 normal, float depth, bool apart) {
  SurfacePlace surface;
  surface.position = place + normal * (lift * depth);
  surface.geometric_normal = normal;
  surface.extent = max_component(glm::abs(place));
  if (apart) surface.extent *= apart_share;
  return {offset_origin(surface, normal), normal};
}

void ShadowPacket::add(const ShadowOrigin& from, vec3 target, uint32_t item) {
  const int i = count_++;
  vec3 way = target - from.position;
  rays_.origin_x[i] = from.position.x, rays_.origin_y[i] = from.position.y;
  rays_.origin_z[i] = from.position.z;
  rays_.direction_x[i] = way.x, rays_.direction_y[i] = way.y, rays_.direction_z[i] = way.z;
  rays_.t_max[i] = 1;
  from_[i] = from, target_[i] = target, item_[i] = item;
}

uint32_t ShadowPacket::find_blocked() const {
  return transport_.world.occluded_each(rays_, uint32_t((1u << count_) - 1));
}

// What of the light arrives where something is in between.
vec3 ShadowPacket::through_panes(int i) const {
  if (!transport_.tables.any_pane) return vec3(0);
  vec3 way = target_[i] - from_[i].position;
  Ray ray;
  ray.origin = from_[i].position;
  ray.direction = way;
  ray.t_max = 1;
  float distance = length(way);
  if (!(distance > 0) || !may_cross_pane(transport_.tables.pane_boxes, ray)) return vec3(0);
  SurfacePlace place;
  place.position = from_[i].position, place.geometric_normal = from_[i].normal;
  LightSample sample;
  sample.direction = way / distance;
  sample.distance = distance;
  sample.target = target_[i];
  return eval_visibility(transport_, place, sample);
}

}  // namespace wellspring::light
