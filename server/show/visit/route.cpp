// SPDX-License-Identifier: Apache-2.0
#include "show/visit/route.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <queue>

namespace wellspring::show {

namespace {

constexpr float spacing = 0.15f;  // metres between the points of a way
constexpr float thin_cost = 3;    // how much dearer a metre is if there is no room to spare
constexpr int smoothing_rounds = 150;

std::string name_place(vec3 p) { return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x, p.y, p.z); }

// Returns the distance from things that an edge between places needs so that all of it keeps the
// radius.
float need_of(const WalkMap& map) { return map.radius + 0.71f * map.cell; }

struct Open {
  float guess = 0;  // guessed length of the whole way
  int place = 0;
  bool operator<(const Open& other) const { return guess > other.guess; }
};

// Returns places from `from` to `to`; empty: none. `nearest` is the place reached that is nearest
// to `to`.
std::vector<int> search(const WalkMap& map, int from, int to, int& nearest) {
  const float need = need_of(map);
  const size_t count = map.places.size();
  std::vector<float> cost(count, INFINITY);
  std::vector<int32_t> before(count, -1);
  std::priority_queue<Open> open;
  auto left = [&](int p) {
    return glm::length(map.places[size_t(p)].ground - map.places[size_t(to)].ground);
  };
  cost[size_t(from)] = 0;
  open.push({left(from), from});
  nearest = from;
  std::vector<bool> done(count);
  while (!open.empty()) {
    int p = open.top().place;
    open.pop();
    if (done[size_t(p)]) continue;
    done[size_t(p)] = true;
    if (left(p) < left(nearest)) nearest = p;
    if (p == to) break;
    const WalkPlace& place = map.places[size_t(p)];
    for (int next : place.next) {
      if (next < 0 || done[size_t(next)]) continue;
      const WalkPlace& other = map.places[size_t(next)];
      if (other.clear < need && next != to) continue;
      float tight =
          std::clamp((map.farthest - other.clear) / (map.farthest - map.radius), 0.0f, 1.0f);
      float there = cost[size_t(p)] +
                    glm::length(other.ground - place.ground) * (1 + thin_cost * tight * tight);
      if (there >= cost[size_t(next)]) continue;
      cost[size_t(next)] = there;
      before[size_t(next)] = p;
      open.push({there + left(next), next});
    }
  }
  std::vector<int> way;
  if (cost[size_t(to)] == INFINITY) return way;
  for (int p = to; p >= 0; p = before[size_t(p)]) way.push_back(p);
  std::reverse(way.begin(), way.end());
  return way;
}

// Returns whether the straight line is free, at `keep` metres from things.
bool is_free(const WalkMap& map, vec3 a, vec3 b, float keep) {
  int steps = std::max(1, int(std::ceil(glm::length(b - a) / (0.5f * map.cell))));
  vec3 p = a;
  for (int i = 0; i <= steps; i++) {
    vec3 next = mix(a, b, float(i) / float(steps));
    p = {next.x, ground_at(map, next.x, next.z, p.y), next.z};
    if (clear_at(map, p) < keep) return false;
  }
  return std::abs(p.y - b.y) < walk_step;
}

// Cuts all corners that can be cut.
std::vector<vec3> pull(const WalkMap& map, const std::vector<vec3>& points) {
  std::vector<vec3> pulled{points.front()};
  for (size_t i = 0; i + 1 < points.size();) {
    size_t next = i + 1;
    // The next point is the farthest that can be seen: the range is halved until it is found.
    size_t low = 1, high = points.size() - 1 - i;
    while (low < high) {
      size_t middle = (low + high + 1) / 2;
      if (is_free(map, points[i], points[i + middle], map.radius + 0.05f)) low = middle;
      else high = middle - 1;
    }
    next = i + low;
    pulled.push_back(points[next]);
    i = next;
  }
  return pulled;
}

std::vector<vec3> resample(const std::vector<vec3>& points) {
  std::vector<vec3> result{points.front()};
  for (size_t i = 1; i < points.size(); i++) {
    int steps = std::max(1, int(std::ceil(glm::length(points[i] - points[i - 1]) / spacing)));
    for (int k = 1; k <= steps; k++)
      result.push_back(mix(points[i - 1], points[i], float(k) / float(steps)));
  }
  return result;
}

// Moves every point towards the middle of its neighbours, unless that leads too near to something.
void smooth(const WalkMap& map, std::vector<vec3>& points) {
  for (int round = 0; round < smoothing_rounds; round++)
    for (size_t i = 1; i + 1 < points.size(); i++) {
      vec3 p = mix(points[i], 0.5f * (points[i - 1] + points[i + 1]), 0.8f);
      p.y = ground_at(map, p.x, p.z, points[i].y);
      float now = clear_at(map, points[i]);
      if (clear_at(map, p) >= std::min(map.radius, now)) points[i] = p;
    }
}

}  // namespace

Route find_route(const WalkMap& map, vec3 from, vec3 to) {
  Route route;
  vec3 feet[2] = {from, to};
  int places[2];
  for (int i = 0; i < 2; i++) {
    feet[i].y -= map.eye_height;
    places[i] = find_place(map, feet[i], lean, need_of(map));
    if (places[i] < 0) {
      route.problem = "there is no room for a visitor of radius " +
                      fmt::format("{:.2f}", map.radius) + " m at " + name_place(feet[i]);
      return route;
    }
  }
  int nearest = places[0];
  std::vector<int> way = search(map, places[0], places[1], nearest);
  if (way.empty()) {
    route.problem = "there is no way for a visitor of radius " + fmt::format("{:.2f}", map.radius) +
                    " m from " + name_place(feet[0]) + " to " + name_place(feet[1]) +
                    "; it ends at " + name_place(map.places[size_t(nearest)].ground);
    return route;
  }
  std::vector<vec3> points;
  for (int p : way) points.push_back(map.places[size_t(p)].ground);
  points = pull(map, points);
  // The route ends at the given ends, not where the grid has a place.
  auto join = [&](vec3 foot, vec3& end) {
    foot.y = end.y;
    if (clear_at(map, foot) >= map.radius) end = foot;
    return foot;
  };
  vec3 first = join(feet[0], points.front()), last = join(feet[1], points.back());
  if (first != points.front()) points.insert(points.begin(), first);
  if (last != points.back()) points.push_back(last);
  points = resample(points);
  smooth(map, points);
  route.points = std::move(points);
  return route;
}

std::vector<int> reachable_places(const WalkMap& map, vec3 eye) {
  const float need = need_of(map);
  std::vector<int> places;
  const int first = find_place(map, eye - vec3(0, map.eye_height, 0), lean, need);
  if (first < 0) {
    for (size_t i = 0; i < map.places.size(); i++)
      if (map.places[i].clear >= need) places.push_back(int(i));
    return places;
  }
  std::vector<bool> found(map.places.size());
  found[size_t(first)] = true;
  places.push_back(first);
  for (size_t i = 0; i < places.size(); i++)
    for (int next : map.places[size_t(places[i])].next) {
      if (next < 0 || found[size_t(next)] || map.places[size_t(next)].clear < need) continue;
      found[size_t(next)] = true;
      places.push_back(next);
    }
  return places;
}

int nearest_of(const WalkMap& map, const std::vector<int>& places, vec3 ground) {
  int best = -1;
  float least = INFINITY;
  for (int place : places) {
    // Another storey counts as farther than it looks.
    vec3 way = (map.places[size_t(place)].ground - ground) * vec3(1, 3, 1);
    if (float distance = dot(way, way); distance < least) least = distance, best = place;
  }
  return best;
}

namespace {

constexpr int most_panes = 64;           // panes passed before a ray counts as lost
constexpr float finger = 0.02f;          // share of the picture's height
constexpr float steepest_ground = 0.7f;  // cosine; steeper surfaces are no ground
constexpr float storey = 20;             // metres in which ground is looked for below a place
// metres: half the diagonal of what is seen as one; half a side of a part
constexpr float largest = 3, part = 1.2f;
constexpr float farthest_look = 14;  // metres from which an object is looked at
constexpr float share = 0.75f;       // share of the picture that the object takes at most
constexpr float narrowest = 0.42f;   // radians, as if the visitor leant over the object
// How a part of a very large picture is looked at: its surroundings over itself, and radians.
constexpr float part_margin = 1.6f, narrowest_part = 0.03f;
constexpr size_t most_looks = 240;   // places tried with rays
constexpr size_t sample_count = 16;  // number of samples of an object's surface

// Holds a triangle: its middle, and the box around it.
struct SurfaceSample {
  vec3 place, normal;
  float area = 0;  // m^2
  vec3 low, high;
};

bool is_glass(const Material& material) { return material.transmission > 0.5f; }

using Objects = std::vector<uint32_t>;  // indices into Scene::objects

bool has(const Objects& objects, uint32_t object) {
  return object != 0 && std::ranges::find(objects, object) != objects.end();
}

// Returns the point of interest that an object belongs to; of several, the one with the fewest
// parts.
int point_of(const Exhibit& exhibit, uint32_t object) {
  int found = -1;
  size_t fewest = SIZE_MAX;
  for (size_t i = 0; i < exhibit.points.size(); i++) {
    const Objects& objects = exhibit.points[i].objects;
    if (objects.size() < fewest && has(objects, object)) found = int(i), fewest = objects.size();
  }
  return found;
}

vec3 normal_of(const World& world, const Hit& hit) {
  const Mesh& mesh = world.mesh_of(hit.instance);
  uvec3 corner = mesh.triangles[hit.triangle];
  vec3 normal = world.normal_to_world(hit.instance) *
                cross(mesh.positions[corner.y] - mesh.positions[corner.x],
                      mesh.positions[corner.z] - mesh.positions[corner.x]);
  float length = glm::length(normal);
  return length > 0 ? normal / length : vec3(0);
}

// Returns whether it is a storyteller's: an object that no node of the scene's files is.
bool is_figure(const World& world, uint32_t instance) {
  const uint32_t object = world.object_of(instance);
  const std::vector<int>& nodes = world.scene().object_nodes;
  return world.is_moving(instance) && (object >= nodes.size() || nodes[object] < 0);
}

// Returns the triangles of objects, or of the part of them around `near`.
std::vector<SurfaceSample> samples_of(const World& world, const Objects& objects,
                                      const std::optional<vec3>& near) {
  std::vector<SurfaceSample> samples;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    if (!has(objects, world.object_of(i))) continue;
    const Mesh& mesh = world.mesh_of(i);
    for (size_t t = 0; t < mesh.triangles.size(); t++) {
      uvec3 corner = mesh.triangles[t];
      auto at = [&](uint32_t k) { return vec3(world.to_world(i) * vec4(mesh.positions[k], 1)); };
      const vec3 a = at(corner.x), b = at(corner.y), c = at(corner.z), place = (a + b + c) / 3.0f;
      vec3 away = near ? abs(place - *near) : vec3(0);
      if (std::max({away.x, away.y, away.z}) > part) continue;
      const vec3 across = cross(b - a, c - a);
      const float twice = glm::length(across);
      vec3 low = min(a, min(b, c)), high = max(a, max(b, c));
      if (near) low = max(low, *near - part), high = min(high, *near + part);
      samples.push_back({place, twice > 0 ? across / twice : vec3(0), 0.5f * twice, low, high});
    }
  }
  return samples;
}

Bounds bounds_of(const std::vector<SurfaceSample>& samples) {
  Bounds bounds;
  for (const SurfaceSample& sample : samples) {
    bounds.low = min(bounds.low, sample.low);
    bounds.high = max(bounds.high, sample.high);
  }
  return bounds;
}

// Keeps some samples, evenly by area: a knob of many triangles counts no more than it is large.
std::vector<SurfaceSample> thin_out(const std::vector<SurfaceSample>& samples) {
  float all = 0, sum = 0;
  for (const SurfaceSample& sample : samples) all += sample.area;
  std::vector<SurfaceSample> few;
  for (const SurfaceSample& sample : samples) {
    sum += sample.area;
    while (few.size() < sample_count && sum * sample_count > all * (float(few.size()) + 0.5f))
      few.push_back(sample);
  }
  // there is no area at all
  if (few.empty()) few = samples, few.resize(std::min(few.size(), sample_count));
  return few;
}

struct Look {
  vec3 eye{0};
  float yaw = 0, pitch = 0;
  float fov = 1;     // vertical, so that the whole object takes its share of it
  float wishes = 0;  // score, but for obstacles
};

// Returns the look from an eye to the middle of a box.
Look look_from(vec3 eye, const Bounds& box, float aspect) {
  Look look{.eye = eye};
  vec3 to = 0.5f * (box.low + box.high) - eye;
  look.yaw = std::atan2(-to.x, -to.z);
  look.pitch = std::atan2(to.y, glm::length(vec2(to.x, to.z)));
  const vec3 forward = normalize(to), right(std::cos(look.yaw), 0, -std::sin(look.yaw)),
             up = cross(right, forward);
  float tangent = 0;
  for (int i = 0; i < 8; i++) {
    vec3 corner(i & 1 ? box.low.x : box.high.x, i & 2 ? box.low.y : box.high.y,
                i & 4 ? box.low.z : box.high.z);
    vec3 d = corner - eye;
    float depth = std::max(dot(d, forward), 0.05f);
    tangent = std::max(
        {tangent, std::abs(dot(d, up)) / depth, std::abs(dot(d, right)) / (depth * aspect)});
  }
  look.fov = 2 * std::atan(tangent / share);
  return look;
}

// Returns how much of the samples is seen, and how squarely, 0 to 1 each.
vec2 seen_from(const World& world, vec3 eye, const Objects& objects,
               const std::vector<SurfaceSample>& samples) {
  float seen = 0, square = 0;
  for (const SurfaceSample& sample : samples) {
    vec3 way = sample.place - eye;
    float distance = glm::length(way);
    if (distance < 1e-3f) continue;
    Hit hit = first_solid(world, {eye, 0, way / distance, distance + 0.02f});
    if (!hit.valid() || hit.t < distance - 0.02f || !has(objects, world.object_of(hit.instance)))
      continue;
    seen++;
    square += std::abs(dot(sample.normal, way / distance));
  }
  return vec2(seen, square) / float(std::max<size_t>(samples.size(), 1));
}

}  // namespace

Hit first_solid(const World& world, Ray ray) {
  for (int i = 0; i < most_panes; i++) {
    Hit hit = world.intersect(ray);
    if (!hit.valid()) return hit;
    if (!is_figure(world, hit.instance) && !is_glass(world.material_of(hit.instance))) return hit;
    ray.t_min = hit.t + 1e-3f;
  }
  return {};
}

std::optional<Pointed> point_at(const Exhibit& exhibit, const World& world, const View& view,
                                vec2 at) {
  const vec2 size(view.width, view.height);
  auto look = [&](vec2 pixel) { return view_ray(view, pixel.x, pixel.y); };
  const Ray ray = look(at * size);
  const Hit hit = first_solid(world, ray);
  if (!hit.valid()) return {};
  Pointed pointed;
  pointed.place = ray.origin + ray.direction * hit.t;
  pointed.point = point_of(exhibit, world.object_of(hit.instance));
  const bool is_ground = normal_of(world, hit).y > steepest_ground;
  pointed.ground = pointed.place;
  if (!is_ground) {
    vec3 before = pointed.place - ray.direction * std::min(0.3f, 0.5f * hit.t);
    Hit below = first_solid(world, {before, 0, {0, -1, 0}, storey});
    pointed.ground = below.valid() ? before - vec3(0, below.t, 0) : before;
  }
  for (int i = 0; i < 8 && pointed.point < 0 && !is_ground; i++) {
    float angle = 0.25f * pi * float(i);
    Ray beside = look(at * size + finger * size.y * vec2(std::cos(angle), std::sin(angle)));
    Hit found = first_solid(world, beside);
    if (!found.valid()) continue;
    pointed.point = point_of(exhibit, world.object_of(found.instance));
    if (pointed.point >= 0) pointed.place = beside.origin + beside.direction * found.t;
  }
  return pointed;
}

std::optional<Viewpoint> good_view(const Exhibit& exhibit, const World& world, const WalkMap& map,
                                   const std::vector<int>& places, int point,
                                   std::optional<vec3> near, const Viewpoint& from, float aspect,
                                   float fov) {
  const PointOfInterest& thing = exhibit.points[size_t(point)];
  const vec3 eye_now = vec3(from.position - exhibit.scene.origin);
  std::vector<SurfaceSample> samples = samples_of(world, thing.objects, {});
  if (samples.empty()) return {};
  Bounds box = bounds_of(samples);
  if (0.5f * glm::length(box.high - box.low) > largest) {
    if (!near)
      near = std::ranges::min_element(samples, {}, [&](const SurfaceSample& sample) {
               return glm::length(sample.place - eye_now);
             })->place;
    if (auto of_part = samples_of(world, thing.objects, near); !of_part.empty())
      samples = std::move(of_part), box = bounds_of(samples);
  }
  const vec3 middle = 0.5f * (box.low + box.high);
  const float direction = std::atan2(eye_now.x - middle.x, eye_now.z - middle.z);
  std::vector<Look> looks;
  for (int i : places) {
    const WalkPlace& place = map.places[size_t(i)];
    const vec3 eye = place.ground + vec3(0, map.eye_height, 0);
    if (glm::length(eye - middle) > farthest_look) continue;
    Look look = look_from(eye, box, aspect);
    float around =
        std::remainder(std::atan2(eye.x - middle.x, eye.z - middle.z) - direction, 2 * pi);
    float too_wide = std::max(0.0f, look.fov / fov - 1);
    // Wishes: as large as it can be without being cut, not seen from above, and the way that it was
    // looked at.
    look.wishes = -6 * too_wide - 0.8f * std::abs(std::log(std::min(look.fov / fov, 1.0f))) -
                  0.6f * std::abs(look.pitch) - 0.25f * std::abs(around);
    looks.push_back(look);
  }
  std::ranges::sort(looks, std::greater<>{}, &Look::wishes);
  if (looks.size() > most_looks) {  // keeps some of all, the best more densely
    for (size_t i = 0; i < most_looks; i++) {
      float t = float(i) / float(most_looks);
      looks[i] = looks[size_t(t * t * float(looks.size() - 1))];
    }
    looks.resize(most_looks);
  }
  samples = thin_out(samples);
  const Look* best = nullptr;
  float most = 0, best_seen = 0;
  for (const Look& look : looks) {
    vec2 seen = seen_from(world, look.eye, thing.objects, samples);
    float score = look.wishes + 4 * seen.x + 1.5f * seen.y;
    if (seen.x > 0 && (!best || score > most)) best = &look, most = score, best_seen = seen.x;
  }
  if (!best || best_seen <= 0) return {};
  Viewpoint view;
  view.position = exhibit.scene.origin + dvec3(best->eye);
  view.yaw = best->yaw;
  view.pitch = std::clamp(best->pitch, -1.45f, 1.45f);
  view.fov = std::clamp(best->fov, std::min(narrowest, fov), fov);
  if (thing.half > 0) {
    const dvec3 way = thing.place - view.position;
    view.yaw = float(std::atan2(-way.x, -way.z));
    view.pitch = std::clamp(float(std::atan2(way.y, length(dvec2(way.x, way.z)))), -1.45f, 1.45f);
    view.fov = std::clamp(2 * std::atan(part_margin * thing.half / float(length(way))),
                          narrowest_part, fov);
  }
  return view;
}

}  // namespace wellspring::show
