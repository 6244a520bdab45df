// SPDX-License-Identifier: Apache-2.0
#include "show/visit/walk_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <fmt/format.h>

#include "base/parallel.h"
#include "base/worker.h"

namespace wellspring::show {

namespace {

constexpr std::array<std::array<int, 2>, 8> around = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
constexpr float head_room = 0.15f;         // metres above the eyes
constexpr float knee = walk_step + 0.05f;  // metres; lower things stop nobody

// Returns the height of the ground below a point, not farther down than `reach`; NaN: none.
float ground_below(const World& world, vec3 from, float reach) {
  for (int passes = 0; passes < 4; passes++) {
    Hit hit = world.intersect({from, 0, {0, -1, 0}, reach});
    if (!hit.valid()) return NAN;
    if (!world.is_moving(hit.instance)) return from.y - hit.t;
    from.y -= hit.t + 1e-3f;
    reach -= hit.t + 1e-3f;
  }
  return NAN;
}

struct Cells {
  const WalkMap& map;
  int cell_of(int x, int z) const { return z * map.width + x; }
  bool inside(int x, int z) const { return x >= 0 && z >= 0 && x < map.width && z < map.depth; }
  int x_of(float x) const { return int(std::floor((x - map.corner.x) / map.cell + 0.5f)); }
  int z_of(float z) const { return int(std::floor((z - map.corner.z) / map.cell + 0.5f)); }

  int find(int x, int z, float height, float reach) const {
    if (!inside(x, z)) return -1;
    for (int p = map.column[size_t(cell_of(x, z))]; p >= 0; p = map.place_after[size_t(p)])
      if (std::abs(map.places[size_t(p)].ground.y - height) <= reach) return p;
    return -1;
  }
};

// Adds a place to the column at (x, z).
int add_place(WalkMap& map, int x, int z, float height) {
  int p = int(map.places.size());
  WalkPlace place;
  place.ground = {map.corner.x + float(x) * map.cell, height, map.corner.z + float(z) * map.cell};
  place.clear = map.farthest;
  size_t cell = size_t(z) * size_t(map.width) + size_t(x);
  map.places.push_back(place);
  map.place_after.push_back(map.column[cell]);
  map.column[cell] = p;
  return p;
}

// Finds the ground that can be walked to from the seeds, whatever stands on it.
void flood(const World& world, const std::vector<vec3>& seeds, WalkMap& map) {
  Cells cells{map};
  std::deque<std::array<int, 3>> open;  // place, x, z
  for (vec3 eye : seeds) {
    int x = cells.x_of(eye.x), z = cells.z_of(eye.z);
    float height = ground_below(world, eye, map.eye_height + 1);
    if (!cells.inside(x, z) || std::isnan(height) || cells.find(x, z, height, walk_step) >= 0)
      continue;
    open.push_back({add_place(map, x, z, height), x, z});
  }
  while (!open.empty()) {
    auto [place, x, z] = open.front();
    open.pop_front();
    vec3 ground = map.places[size_t(place)].ground;
    for (size_t way = 0; way < around.size(); way++) {
      int nx = x + around[way][0], nz = z + around[way][1];
      if (!cells.inside(nx, nz)) continue;
      // Steps up and down are climbed; anything higher than a step is an obstacle on the ground
      // below it.
      vec3 from(map.corner.x + float(nx) * map.cell, ground.y + knee,
                map.corner.z + float(nz) * map.cell);
      float height = ground_below(world, from, knee + walk_step);
      if (std::isnan(height) || std::abs(height - ground.y) > walk_step) continue;
      int next = cells.find(nx, nz, height, 0.5f * map.eye_height);
      if (next < 0) {
        if (int(map.places.size()) >= most_walk_places) continue;
        next = add_place(map, nx, nz, height);
        open.push_back({next, nx, nz});
      }
      map.places[size_t(place)].next[way] = next;
    }
  }
}

// Returns the distance from a point to a polygon in the plane of the ground; 0 inside it.
float distance_to(vec2 p, const vec2* corner, int count) {
  float least = 1e30f;
  bool left = true, right = true;
  for (int i = 0; i < count; i++) {
    vec2 a = corner[i], b = corner[(i + 1) % count], ab = b - a, ap = p - a;
    float length2 = dot(ab, ab);
    float t = length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0f, 1.0f) : 0;
    least = std::min(least, glm::length(ap - t * ab));
    float side = ab.x * ap.y - ab.y * ap.x;
    left &= side >= 0;
    right &= side <= 0;
  }
  bool solid = count >= 3 && left != right;  // both: no area
  return solid && (left || right) ? 0 : least;
}

// Finds the part of a triangle between two heights, seen from above: up to five corners.
int clip(const std::array<vec3, 3>& triangle, float low, float high, std::array<vec2, 8>& out) {
  std::array<vec3, 8> from, to;
  int count = 3;
  std::copy(triangle.begin(), triangle.end(), from.begin());
  for (int side = 0; side < 2; side++) {
    auto depth = [&](vec3 p) { return side == 0 ? p.y - low : high - p.y; };
    int kept = 0;
    for (int i = 0; i < count; i++) {
      vec3 a = from[size_t(i)], b = from[size_t((i + 1) % count)];
      float da = depth(a), db = depth(b);
      if (da >= 0) to[size_t(kept++)] = a;
      if ((da >= 0) != (db >= 0)) to[size_t(kept++)] = a + (b - a) * (da / (da - db));
    }
    from = to;
    count = kept;
  }
  for (int i = 0; i < count; i++) out[size_t(i)] = {from[size_t(i)].x, from[size_t(i)].z};
  return count;
}

// Lowers the clearance of the places in rows [row, end) that a triangle comes near to.
void mark(const Cells& cells, WalkMap& map, const std::array<vec3, 3>& t, int row, int end) {
  vec3 low = min(t[0], min(t[1], t[2])) - map.farthest,
       high = max(t[0], max(t[1], t[2])) + map.farthest;
  if (!is_finite(low) || !is_finite(high)) return;
  auto limit = [](int value, int most) { return std::clamp(value, 0, most); };
  int x0 = limit(cells.x_of(std::max(low.x, map.corner.x)), map.width - 1);
  int z0 = std::max(row, limit(cells.z_of(std::max(low.z, map.corner.z)), map.depth - 1));
  float right = map.corner.x + float(map.width) * map.cell,
        back = map.corner.z + float(map.depth) * map.cell;
  if (high.x < map.corner.x || high.z < map.corner.z || low.x > right || low.z > back) return;
  int x1 = limit(cells.x_of(std::min(high.x, right)), map.width - 1);
  int z1 = std::min(end - 1, limit(cells.z_of(std::min(high.z, back)), map.depth - 1));
  float lowest = low.y + map.farthest, highest = high.y - map.farthest;
  std::array<vec2, 8> polygon;
  int corners = 0;
  float clipped_at = NAN;
  for (int z = z0; z <= z1; z++)
    for (int x = x0; x <= x1; x++)
      for (int p = map.column[size_t(cells.cell_of(x, z))]; p >= 0;
           p = map.place_after[size_t(p)]) {
        WalkPlace& place = map.places[size_t(p)];
        float foot = place.ground.y + knee, head = place.ground.y + map.eye_height + head_room;
        if (highest < foot || lowest > head) continue;
        if (clipped_at != place.ground.y) {
          corners = clip(t, foot, head, polygon);
          clipped_at = place.ground.y;
        }
        if (corners == 0) continue;
        float distance = distance_to({place.ground.x, place.ground.z}, polygon.data(), corners);
        place.clear = std::min(place.clear, distance);
      }
}

}  // namespace

WalkMap make_walk_map(const World& world, const WalkSettings& rules, const std::vector<vec3>& seeds,
                      const std::vector<WalkObstacle>& obstacles) {
  WalkMap map;
  map.eye_height = rules.eye_height;
  map.radius = rules.radius;
  map.farthest = rules.radius + 0.35f;
  const Scene& scene = world.scene();
  Bounds bounds = scene_bounds(scene);
  if (rules.bounds) {
    bounds.low = max(bounds.low, vec3(dvec3(rules.bounds->low) - scene.origin));
    bounds.high = min(bounds.high, vec3(dvec3(rules.bounds->high) - scene.origin));
  }
  vec3 size = bounds.high - bounds.low;
  if (!is_finite(size) || size.x <= 0 || size.z <= 0) return map;
  map.cell = std::max(0.1f, std::sqrt(size.x * size.z / (0.25f * float(most_walk_places))));
  map.corner = bounds.low;
  map.width = int(size.x / map.cell) + 1;
  map.depth = int(size.z / map.cell) + 1;
  map.column.assign(size_t(map.width) * size_t(map.depth), -1);
  flood(world, seeds, map);
  check_cancelled();

  Cells cells{map};
  const int strip = 8;  // rows; each strip is one thread's
  parallel_for((map.depth + strip - 1) / strip, [&](int s) {
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
      for (uvec3 corner : mesh.triangles) {
        std::array<vec3, 3> t;
        for (int i = 0; i < 3; i++)
          t[size_t(i)] = vec3(instance.to_world * vec4(mesh.positions[corner[i]], 1));
        mark(cells, map, t, s * strip, std::min((s + 1) * strip, map.depth));
      }
    }
  });
  for (WalkPlace& place : map.places)
    for (const WalkObstacle& obstacle : obstacles) {
      vec3 way = place.ground - obstacle.ground;
      if (std::abs(way.y) > map.eye_height) continue;
      float distance = glm::length(vec2(way.x, way.z)) - obstacle.radius;
      place.clear = std::min(place.clear, std::max(distance, 0.0f));
    }
  return map;
}

int find_place(const WalkMap& map, vec3 ground, float reach, float clear) {
  Cells cells{map};
  if (!is_finite(ground)) return -1;
  float limit = float(std::max(map.width, map.depth)) * map.cell;
  if (std::abs(ground.x - map.corner.x) > 2 * limit ||
      std::abs(ground.z - map.corner.z) > 2 * limit)
    return -1;
  int rings = int(std::ceil(std::min(reach, limit) / map.cell)) + 1;
  int x = cells.x_of(ground.x), z = cells.z_of(ground.z), best = -1;
  float least = reach;
  for (int dz = -rings; dz <= rings; dz++)
    for (int dx = -rings; dx <= rings; dx++) {
      int p = cells.find(x + dx, z + dz, ground.y, walk_step);
      if (p < 0 || map.places[size_t(p)].clear < clear) continue;
      vec3 way = map.places[size_t(p)].ground - ground;
      float distance = glm::length(vec2(way.x, way.z));
      if (distance <= least) least = distance, best = p;
    }
  return best;
}

float clear_at(const WalkMap& map, vec3 ground) {
  int p = find_place(map, ground, map.cell, 0);
  if (p < 0) return 0;
  vec3 way = map.places[size_t(p)].ground - ground;
  return std::max(0.0f, map.places[size_t(p)].clear - glm::length(vec2(way.x, way.z)));
}

float ground_at(const WalkMap& map, float x, float z, float near) {
  Cells cells{map};
  float sum = 0, weights = 0;
  float fx = (x - map.corner.x) / map.cell, fz = (z - map.corner.z) / map.cell;
  for (int dz = 0; dz < 2; dz++)
    for (int dx = 0; dx < 2; dx++) {
      int cx = int(std::floor(fx)) + dx, cz = int(std::floor(fz)) + dz;
      int p = cells.find(cx, cz, near, 2 * walk_step);
      float weight = (1 - std::abs(fx - float(cx))) * (1 - std::abs(fz - float(cz)));
      if (p < 0 || weight <= 0) continue;
      sum += weight * map.places[size_t(p)].ground.y;
      weights += weight;
    }
  return weights > 1e-6f ? sum / weights : near;
}

namespace {

constexpr float step_height = 0.4f;   // metres that a visitor climbs without thinking
constexpr float fall_distance = 4;    // metres; deeper gaps are treated as edges: no step is taken
constexpr float settle_time = 0.12f;  // seconds for the eye to follow the ground

bool blocked(const World& world, vec3 from, vec3 direction, float distance) {
  Ray ray{from, 0.001f, direction, distance};
  return world.occluded(ray);
}

// Returns whether a body, from above step height to the eye, can go `distance` along horizontal
// `direction`.
bool body_fits(const World& world, vec3 eye, float eye_height, vec3 direction, float distance,
               float radius) {
  vec3 side(-direction.z, 0, direction.x);
  for (float height : {step_height + 0.05f, 0.6f * eye_height, eye_height})
    for (float offset : {-0.7f, 0.0f, 0.7f}) {
      vec3 from = eye + vec3(0, height - eye_height, 0) + side * (offset * radius);
      if (blocked(world, from, direction, distance + radius)) return false;
    }
  return true;
}

// Returns the height of the ground under `eye`, relative to the scene's origin; NaN: none within
// reach.
float ground_under(const World& world, vec3 eye, float eye_height) {
  Ray ray{eye, 0, {0, -1, 0}, eye_height + fall_distance};
  Hit hit = world.intersect(ray);
  return hit.valid() && !world.is_moving(hit.instance) ? eye.y - hit.t : NAN;
}

}  // namespace

vec3 move_direction(vec3 move, float yaw) {
  vec3 forward(-std::sin(yaw), 0, -std::cos(yaw)), right(std::cos(yaw), 0, -std::sin(yaw));
  return right * move.x + vec3(0, move.y, 0) + forward * move.z;
}

dvec3 keep_distance(dvec3 from, dvec3 to, dvec3 centre, double distance) {
  glm::dvec2 before(from.x - centre.x, from.z - centre.z), after(to.x - centre.x, to.z - centre.z);
  double was = glm::length(before),
         least = std::min(distance, was);  // never thrown out, never farther in
  glm::dvec2 step = after - before;
  double length = glm::length(step);
  if (!(length > 0)) return to;
  double nearest = std::clamp(-glm::dot(before, step) / (length * length), 0.0, 1.0);
  if (!(glm::length(before + step * nearest) < least - 1e-9)) return to;
  after = before + step * nearest;
  double is = glm::length(after);
  if (is < 1e-9) after = was > 1e-9 ? before : glm::dvec2(1, 0), is = glm::length(after);
  after *= least / is;
  return {centre.x + after.x, to.y, centre.z + after.y};
}

void check_ground(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems) {
  if (!exhibit.walk) return;
  const float eye_height = exhibit.walk->eye_height;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints) {
    vec3 eye = vec3(viewpoint.view.position - exhibit.scene.origin);
    if (!std::isnan(ground_under(world, eye, eye_height))) continue;
    bool camera = viewpoint.where.empty();
    problems.push_back(
        {exhibit.folder + "/exhibit.json", camera ? "/scene" : viewpoint.where + "/position",
         fmt::format("no ground within {:g} m under {} '{}': nobody can walk from there",
                     eye_height + fall_distance, camera ? "camera" : "viewpoint",
                     viewpoint.view.name),
         false});
  }
}

dvec3 walk(const World& world, const std::optional<WalkSettings>& rules, dvec3 position,
           vec3 velocity, float dt) {
  dt = std::clamp(dt, 0.0f, 0.25f);
  if (!is_finite(velocity)) return position;
  if (!rules) return position + dvec3(velocity) * double(dt);
  const dvec3 origin = world.scene().origin;
  vec3 eye = vec3(position - origin);
  vec3 step = vec3(velocity.x, 0, velocity.z) * dt;
  float length = glm::length(step);
  if (length > 1e-6f) {
    vec3 direction = step / length;
    vec3 taken(0);
    if (body_fits(world, eye, rules->eye_height, direction, length, rules->radius)) {
      taken = step;
    } else {
      // Slide: the part of the step along either axis of the wall ahead, if that way is free.
      Ray probe{eye + vec3(0, -0.4f * rules->eye_height, 0), 0.001f, direction,
                length + 2 * rules->radius};
      Hit hit = world.intersect(probe);
      vec3 along[2] = {vec3(step.x, 0, 0), vec3(0, 0, step.z)};
      if (hit.valid()) {
        const Mesh& mesh = world.mesh_of(hit.instance);
        uvec3 corner = mesh.triangles[hit.triangle];
        vec3 normal = world.normal_to_world(hit.instance) *
                      cross(mesh.positions[corner.y] - mesh.positions[corner.x],
                            mesh.positions[corner.z] - mesh.positions[corner.x]);
        normal.y = 0;
        if (glm::length(normal) > 1e-6f) {
          normal = normalize(normal);
          along[0] = step - normal * dot(step, normal);
        }
      }
      for (vec3 slide : along) {
        float slide_length = glm::length(slide);
        if (slide_length > 0.05f * length &&
            body_fits(world, eye, rules->eye_height, slide / slide_length, slide_length,
                      rules->radius)) {
          taken = slide;
          break;
        }
      }
    }
    vec3 next = eye + taken;
    if (!std::isnan(ground_under(world, next, rules->eye_height))) eye = next;
  }
  float ground = ground_under(world, eye, rules->eye_height);
  if (!std::isnan(ground)) {
    float wanted = ground + rules->eye_height;
    eye.y += (wanted - eye.y) * (1 - std::exp(-dt / settle_time));
  }
  dvec3 result = origin + dvec3(eye);
  if (rules->bounds) result = clamp(result, dvec3(rules->bounds->low), dvec3(rules->bounds->high));
  return result;
}

}  // namespace wellspring::show
