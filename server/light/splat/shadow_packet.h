// SPDX-License-Identifier: Apache-2.0
// Shadow rays from what pixels see to virtual lights, collected until a packet is full.
#pragma once
#include "light/sample/transport.h"
#include "light/splat/splat_pixels.h"
#include "light/splat/virtual_lights.h"
#include "world/world.h"

namespace wellspring::light {

// Where rays leave a pixel's surface. Its normal may be a shading normal, and its depth be rounded.
struct ShadowOrigin {
  vec3 position{0}, normal{0, 1, 0};
};
// `apart`: World::any_apart().
ShadowOrigin shadow_origin(vec3 place, vec3 normal, float depth, bool apart = false);

// What arrives along one ray goes to the item that it was added for.
class ShadowPacket {
 public:
  explicit ShadowPacket(const Transport& transport) : transport_(transport) {}
  bool full() const { return count_ == RayPacket::lanes; }
  void add(const ShadowOrigin& from, vec3 target, uint32_t item);
  // Calls arrive(item, tint) for every ray that is not blocked, in the order of add(), and is
  // empty.
  template <class Arrive>
  void cast(const Arrive& arrive) {
    if (count_ == 0) return;
    uint32_t blocked = find_blocked();
    for (int i = 0; i < count_; i++) {
      vec3 tint = blocked >> i & 1 ? through_panes(i) : vec3(1);
      if (max_component(tint) > 0) arrive(item_[i], tint);
    }
    count_ = 0;
  }

 private:
  uint32_t find_blocked() const;
  vec3 through_panes(int i) const;
  const Transport& transport_;
  RayPacket rays_;
  ShadowOrigin from_[RayPacket::lanes];
  vec3 target_[RayPacket::lanes];
  uint32_t item_[RayPacket::lanes];
  int count_ = 0;
};

}  // namespace wellspring::light
