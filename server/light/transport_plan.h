// SPDX-License-Identifier: Apache-2.0
// What a scene needs: which parts of light transport can matter, from what is in the Scene and what
// moves in it. A pure function; every decision says why. make_lights() builds, and techniques
// compute, only what the plan uses.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "world/scene.h"

namespace wellspring {

enum class TransportPart : uint8_t {
  area_lights,       // emitting triangles are sampled
  light_tree,        // chosen among by power and place
  emission_texture,  // and within a picture by its brightness
  punctual_lights,
  environment,             // light from infinity
  environment_importance,  // sampled by brightness
  panes,                   // light passes straight through thin smooth glass
  refraction,              // solids with an inside
  absorption,              // that tint what runs in them
  dispersion,              // and bend wavelengths apart
  coats,                   // clearcoat or sheen over the base
  caustics,                // light from a specular thing onto a rough one
  kept_light,              // results may persist: nothing that lights or is lit moves
  count
};
inline constexpr size_t transport_parts = size_t(TransportPart::count);
const char* transport_part_name(TransportPart part);

struct TransportDecision {
  bool used = true;
  std::string why;
};

struct TransportPlan {
  TransportDecision decisions[transport_parts];
  bool uses(TransportPart part) const { return decisions[size_t(part)].used; }
};

// `moving[i]`: instance i moves or deforms; empty: none does.
TransportPlan make_transport_plan(const Scene& scene, const std::vector<bool>& moving = {});
// Everything on: for tests that prove that what a plan left out does not matter.
TransportPlan make_full_plan();

}  // namespace wellspring
