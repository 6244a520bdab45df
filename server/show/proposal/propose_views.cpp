// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/propose_views.h"

#include <algorithm>
#include <cmath>

#include "show/check/check_scene.h"
#include "world/fit_view.h"
#include "world/view.h"

namespace wellspring::show {
namespace {

constexpr float degree = pi / 180;
constexpr int grid = 14;    // places along either side of a room
constexpr int around = 12;  // directions tried at each
constexpr float room_fov = 60 * degree, object_fov = 40 * degree;
constexpr float headroom = 0.15f;   // metres over the eye
constexpr float elbow_room = 0.5f;  // around it
constexpr float closed = 0.7f;      // share of the directions in which a room has walls
constexpr float least_room = 2.5f;  // metres from wall to wall
constexpr float farthest = 12;      // metres beyond which seeing farther is not better
constexpr size_t most_views = 4;
constexpr int columns = 12, rows = 7;  // rays of a view

// A place in a room and how good its best view is.
struct Stand {
  vec3 eye{0};
  float yaw = 0, worth = 0;
};

Hit look(const World& world, vec3 from, vec3 way) { return world.intersect({from, 1e-4f, way}); }

// Nothing is nearer than elbow room, and walls are nearly all around.
bool is_in_room(const World& world, vec3 eye) {
  constexpr int count = 48;
  int walls = 0;
  for (int i = 0; i < count; i++) {
    float y = 1 - 2 * (float(i) + 0.5f) / count, r = std::sqrt(1 - y * y);
    float turn = float(i) * pi * (3 - std::sqrt(5.0f));
    Hit hit = look(world, eye, {r * std::cos(turn), y, r * std::sin(turn)});
    if (!hit.valid()) continue;
    walls++;
    if (hit.t < elbow_room) return false;
  }
  std::string inside;
  return float(walls) > closed * count && !is_in_solid(world, eye, inside);
}

// How much there is to see: far walls, many things, little emptiness.
float worth_of(const World& world, vec3 eye, float yaw) {
  View view = make_view(world.scene(), world.scene().origin + dvec3(eye), yaw, -4 * degree,
                        room_fov, columns, rows);
  float sum = 0;
  std::vector<uint32_t> seen;
  for (int i = 0; i < columns * rows; i++) {
    Hit hit = world.intersect(view_ray(view, float(i % columns) + 0.5f, float(i / columns) + 0.5f));
    if (!hit.valid()) continue;
    sum += std::log1p(std::min(hit.t, farthest));
    uint32_t object = world.object_of(hit.instance);
    if (std::find(seen.begin(), seen.end(), object) == seen.end()) seen.push_back(object);
  }
  return sum / (columns * rows) * (1 + 0.05f * float(std::min<size_t>(seen.size(), 12)));
}

// Eyes over every floor below (x, z) that leaves room for a visitor.
void find_stands(const World& world, vec3 from, float eye_height, std::vector<Stand>& stands) {
  vec3 place = from;
  for (int floors = 0; floors < 8; floors++) {
    Hit hit = look(world, place, {0, -1, 0});
    if (!hit.valid()) return;
    place.y -= hit.t;
    vec3 eye = place + vec3(0, eye_height, 0);
    Hit over = look(world, place + vec3(0, 0.01f, 0), {0, 1, 0});
    if (over.t > eye_height + headroom && is_in_room(world, eye)) {
      Stand stand{eye};
      for (int i = 0; i < around; i++) {
        float yaw = 2 * pi * float(i) / around, worth = worth_of(world, eye, yaw);
        if (worth > stand.worth) stand.yaw = yaw, stand.worth = worth;
      }
      stands.push_back(stand);
    }
    place.y -= 1e-3f;
  }
}

Viewpoint make_viewpoint(const World& world, std::string name, vec3 eye, float yaw, float pitch,
                         float fov) {
  Viewpoint view;
  view.name = std::move(name);
  view.position = world.scene().origin + dvec3(eye);
  view.yaw = yaw;
  view.pitch = pitch;
  view.fov = fov;
  return view;
}

std::vector<Viewpoint> propose_inside(const World& world, const Bounds& box, float eye_height) {
  const vec3 size = box.high - box.low;
  if (std::min(size.x, size.z) < least_room || size.y < eye_height) return {};
  std::vector<Stand> stands;
  for (int i = 0; i < grid * grid; i++) {
    vec2 at = (vec2(float(i % grid), float(i / grid)) + 0.5f) / float(grid);
    find_stands(world, {box.low.x + size.x * at.x, box.high.y + 0.1f, box.low.z + size.z * at.y},
                eye_height, stands);
  }
  if (stands.size() < 3) return {};
  // The best, then those that are good and far from the ones there are, or look the other way.
  std::vector<Stand> chosen;
  const float reach = glm::length(size);
  while (chosen.size() < most_views) {
    const Stand* best = nullptr;
    float most = 0;
    for (const Stand& stand : stands) {
      float apart = 1;
      for (const Stand& other : chosen) {
        float turned = 0.5f - 0.5f * std::cos(stand.yaw - other.yaw);
        apart = std::min(apart, glm::length(stand.eye - other.eye) / reach + 0.4f * turned);
      }
      if (!chosen.empty() && apart < 0.2f) continue;
      if (stand.worth * std::sqrt(apart) > most)
        best = &stand, most = stand.worth * std::sqrt(apart);
    }
    if (!best) break;
    chosen.push_back(*best);
  }
  if (chosen.size() < 2) return {};
  std::vector<Viewpoint> views;
  for (const Stand& stand : chosen)
    views.push_back(make_viewpoint(world, "view" + std::to_string(views.size() + 1), stand.eye,
                                   stand.yaw, -4 * degree, room_fov));
  return views;
}

std::vector<Viewpoint> propose_outside(const World& world, const Bounds& box) {
  struct Side {
    const char* name;
    float yaw, height;  // degrees from the front, and over the horizon
  };
  constexpr Side solid[] = {{"front", 24, 14},
                            {"right", 90, 10},
                            {"back", 204, 14},
                            {"left", -90, 10},
                            {"above", 35, 50}};
  constexpr Side flat[] = {{"front", 0, 0}, {"right", 40, 8}, {"left", -40, 8}};
  constexpr Side lying[] = {{"front", 20, 40}, {"back", 200, 40}, {"above", 0, 80}};
  const vec3 size = box.high - box.low, half = 0.5f * size;
  const float thin = 0.08f * max_component(size);
  const bool is_flat = std::min(size.x, size.z) < thin && size.y >= thin;
  const bool is_lying = size.y < thin && !is_flat;
  float front = is_flat && size.x < size.z ? 90.0f : 0.0f;
  std::span<const Side> sides = is_flat    ? std::span<const Side>(flat)
                                : is_lying ? std::span<const Side>(lying)
                                           : std::span<const Side>(solid);
  const float tan_y = std::tan(0.5f * object_fov);
  auto view_from = [&](const Side& side) {
    float yaw = (side.yaw + front) * degree, pitch = side.height * degree;
    vec3 back(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
    float distance = 1.08f * distance_to_fit(half, back, tan_y * 4 / 3, tan_y);
    return make_viewpoint(world, side.name, box.low + half + back * distance, yaw, -pitch,
                          object_fov);
  };
  if (is_flat && !sees_something(world, view_from(sides[0]))) front += 180;  // its front is there
  std::vector<Viewpoint> views, all;
  for (const Side& side : sides) {
    all.push_back(view_from(side));
    if (sees_something(world, all.back())) views.push_back(all.back());
  }
  return views.empty() ? all : views;
}

}  // namespace

ProposedViews propose_views(const World& world, float eye_height) {
  ProposedViews proposed;
  const Bounds box = scene_bounds(world.scene());
  proposed.views = propose_inside(world, box, eye_height);
  proposed.is_room = !proposed.views.empty();
  if (!proposed.is_room) proposed.views = propose_outside(world, box);
  return proposed;
}

}  // namespace wellspring::show
