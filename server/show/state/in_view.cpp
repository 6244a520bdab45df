// SPDX-License-Identifier: Apache-2.0
#include "show/state/in_view.h"

#include <cmath>

namespace wellspring {

namespace {

constexpr float head_height = 1.5f, head_reach = 0.45f;  // metres; bowing and leaning included
constexpr float body_height = 0.9f, body_reach = 1.3f;
constexpr float nobody_near = 1e6f;

vec3 above_feet(const Show& show, float height) {
  return vec3(show.storyteller.placement * vec4(0, height, 0, 1));
}

// Metres to the storyteller's head for who may see it, else nobody_near.
float distance_to_head(const Show& show, const Visitor& visitor) {
  if (!visitor.welcomed) return nobody_near;
  View view = view_of(show, visitor);
  return sees_head(show, view) ? glm::length(view.position - above_feet(show, head_height))
                               : nobody_near;
}

}  // namespace

bool in_view(const View& view, vec3 centre, float radius) {
  vec3 d = centre - view.position;
  float depth = dot(d, view.forward);
  if (depth < -radius) return false;
  float aspect = float(view.width) / float(view.height);
  float slope = view.tan_half_fov * std::sqrt(1 + aspect * aspect);
  return glm::length(d - view.forward * depth) <
         slope * std::max(depth, 0.0f) + radius * std::sqrt(1 + slope * slope);
}

View view_of(const Show& show, const Visitor& visitor) {
  const Viewpoint& at = visitor.place.view;
  return make_view(show.exhibit.scene, at.position, at.yaw, at.pitch, at.fov, visitor.wants.width,
                   visitor.wants.height);
}

bool sees_head(const Show& show, const View& view) {
  return !show.figures.empty() && show.storyteller_visible &&
         in_view(view, above_feet(show, head_height), head_reach);
}

bool sees_figure(const Show& show, const View& view) {
  return !show.figures.empty() && show.storyteller_visible &&
         in_view(view, above_feet(show, body_height), body_reach);
}

const Visitor* heard_on_tour(const Show& show) {
  const Visitor* nearest = nullptr;
  float least = nobody_near;
  for (const Visitor& visitor : show.visitors) {
    const Voice& voice = visitor.hearing.narration.voice;
    if (voice.queue.empty() || voice.paused) continue;
    if (float distance = distance_to_head(show, visitor); distance < least)
      least = distance, nearest = &visitor;
  }
  return nearest;
}

float viewer_distance(const Show& show) {
  float nearest = nobody_near;
  for (const Visitor& visitor : show.visitors)
    nearest = std::min(nearest, distance_to_head(show, visitor));
  return nearest;
}

}  // namespace wellspring
