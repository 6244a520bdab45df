// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/screen_window.h"

#include <algorithm>
#include <cmath>

#include "show/storyteller/audience.h"

namespace wellspring::show {

namespace {

constexpr float near_zone = 2.5f;                    // metres from the screen: who is there watches
constexpr float found_after = 0.5f, lost_after = 1;  // seconds: cameras lose heads for moments
// Metres that a head moves before it counts: cameras are less sure of its distance.
constexpr vec3 slack{0.03f, 0.03f, 0.06f};
// Shares of half the picture that what is far away shifts at most: what the viewpoint shows in its
// middle stays well in the picture.
constexpr float most_shift = 0.5f;
constexpr float nearest = 0.75f, farthest = 1.25f;  // of the distance at rest
constexpr float most_aside = 0.4f;                  // metres
constexpr float least_distance = 0.2f;              // metres of a head from the screen

constexpr float smooth_seconds = 0.35f;  // in which it arrives, nearly
constexpr float most_speed = 0.5f;       // metres a second
constexpr float arrived = 2e-4f;         // metres: less than a pixel

}  // namespace

float picture_height(const ScreenSize& screen, const View& rest) {
  if (!screen.known()) return 2 * viewing_distance * rest.tan_half_fov;
  return std::max(screen.height, screen.width * float(rest.height) / float(rest.width));
}

float rest_distance(const ScreenSize& screen, const View& rest) {
  if (!screen.known()) return viewing_distance;
  return 0.5f * picture_height(screen, rest) / rest.tan_half_fov;
}

vec3 place_of_head(vec3 head, const ScreenSize& screen, const View& rest) {
  if (!is_finite(head)) return vec3(0);
  const float distance = rest_distance(screen, rest);
  const float away = std::max(head.z, least_distance);
  const vec2 most =
      most_shift * rest.tan_half_fov * vec2(float(rest.width) / float(rest.height), 1);
  const vec2 slope = glm::clamp(vec2(head) / away, -most, most);
  const float depth = std::clamp(away, nearest * distance, farthest * distance);
  vec2 aside = slope * depth;
  if (const float length = glm::length(aside); length > most_aside) aside *= most_aside / length;
  return {aside, depth - distance};
}

void watch_heads(WindowEye& eye, std::span<const vec3> heads, const ScreenSize& screen,
                 const View& rest, float dt) {
  int watching = 0;
  vec3 head(0);
  for (vec3 one : heads)
    if (one.z < near_zone && ++watching == 1) head = one;
  watching = std::min(watching, 2);
  eye.since = watching == eye.watching ? eye.since + dt : 0;
  eye.watching = watching;
  if (watching > 1 || (watching == 0 && eye.since >= lost_after)) eye.follows = false;
  if (watching == 1 && !eye.follows && eye.since >= found_after)
    eye.follows = true, eye.head = head;
  if (watching == 1 && eye.follows) {
    const vec3 off = head - eye.head;
    const float times = glm::length(off / slack);
    if (times > 1) eye.head += off * (1 - 1 / times);
  }
  eye.aim = eye.follows ? place_of_head(eye.head, screen, rest) : vec3(0);
}

void move_eye(WindowEye& eye, float dt) {
  if (!(dt > 0)) return;
  const float rate = 2 / smooth_seconds, most = most_speed * smooth_seconds;
  vec3 off = eye.place - eye.aim;
  if (const float length = glm::length(off); length > most) off *= most / length;
  // The spring's exact motion towards the aim, or towards a place so near that it stays slow.
  const vec3 towards = eye.place - off, pull = (eye.speed + rate * off) * dt;
  const float left = std::exp(-rate * dt);
  eye.place = towards + (off + pull) * left;
  eye.speed = (eye.speed - rate * pull) * left;
  if (glm::length(eye.place - eye.aim) < arrived && glm::length(eye.speed) < rate * arrived)
    eye.place = eye.aim, eye.speed = vec3(0);
}

View through_window(const View& rest, const ScreenSize& screen, vec3 place) {
  if (!screen.known() || place == vec3(0)) return rest;
  const float distance = rest_distance(screen, rest),
              away = std::max(distance + place.z, 0.1f * distance);
  View view = rest;
  view.position += rest.right * place.x + rest.up * place.y - rest.forward * (away - distance);
  view.tan_half_fov = rest.tan_half_fov * distance / away;
  view.middle = vec2(place) / -away;
  return view;
}

}  // namespace wellspring::show
