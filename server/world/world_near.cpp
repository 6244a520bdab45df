// SPDX-License-Identifier: Apache-2.0
// Triangles around a place, by Embree's point queries.
#include <cmath>

#include "world/world.h"
#include "world/world_impl.h"

namespace wellspring::world {
namespace {

struct Search {
  const World* world;
  glm::dvec3 from, way;  // unit
  double before, after, slack;
  uint32_t first_moving, is_moving;
  const uint32_t* still_instance;
  Hit* hits;
  int most, count = 0;
};

// Where the line from `from` along `way` crosses the triangle, as far as `slack` beside it.
bool cross_triangle(const Search& s, uint32_t instance, uint32_t triangle, Hit& hit) {
  const PlacedMesh& placed = s.world->placed(instance);
  uvec3 index = placed.mesh->triangles[triangle];
  glm::dvec3 c[3];
  for (int i = 0; i < 3; i++) {
    vec3 p = placed.mesh->positions[index[i]];
    glm::dvec3 from = s.from;
    if (placed.apart) {
      p = mat3(placed.to_world) * p;
      from -= glm::dvec3(placed.to_world[3]);
    } else if (!placed.in_place) {
      p = vec3(placed.to_world * vec4(p, 1));  // rounded as the tree has it
    }
    c[i] = glm::dvec3(p) - from;
  }
  glm::dvec3 normal = cross(c[1] - c[0], c[2] - c[0]);
  double area = length(normal);
  if (!(area > 0)) return false;
  double slope = dot(normal, s.way) / area;
  if (std::abs(slope) < 0.05) return false;  // stands across: the next ray meets it
  double along = dot(normal, c[0]) / (area * slope);
  if (!(along >= -s.before && along <= s.after)) return false;
  glm::dvec3 at = along * s.way;
  double weight[3];
  for (int i = 0; i < 3; i++) {
    glm::dvec3 a = c[(i + 1) % 3], edge = c[(i + 2) % 3] - a;
    // Distance to the edge times its length.
    double inside = dot(cross(edge, at - a), normal) / area;
    if (!(inside >= -s.slack * length(edge))) return false;
    weight[i] = glm::clamp(inside / area, 0.0, 1.0);
  }
  hit.t = float(along);
  hit.instance = instance;
  hit.triangle = triangle;
  hit.barycentric = vec2(float(weight[1]), float(weight[2]));
  return true;
}

bool collect(RTCPointQueryFunctionArguments* a) {
  Search& s = *static_cast<Search*>(a->userPtr);
  uint32_t instance =
      s.is_moving
          ? s.first_moving + a->geomID
          : s.still_instance[a->context->instStackSize > 0 ? a->context->instID[0] : a->geomID];
  Hit hit;
  if (s.count < s.most && cross_triangle(s, instance, a->primID, hit)) s.hits[s.count++] = hit;
  return false;  // the radius stays
}

}  // namespace

int World::find_near(vec3 place, vec3 way, float before, float after, Hit* hits, int most) const {
  const Impl& w = *impl_;
  float radius = std::max(before, after);
  constexpr float farthest = 1e17f;
  vec3 size = glm::abs(place);
  if (!(size.x <= farthest && size.y <= farthest && size.z <= farthest && radius <= farthest))
    return 0;
  Search search{this,
                glm::dvec3(place),
                glm::dvec3(way),
                double(before),
                double(after),
                double(radius),
                uint32_t(w.scene->instances.size()),
                0,
                w.still_instance.data(),
                hits,
                most};
  RTCPointQuery query;
  query.x = place.x, query.y = place.y, query.z = place.z;
  query.radius = radius;
  query.time = 0;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(w.still_scene, &query, &context, collect, &search);
  const Bounds& box = w.moving_bounds;
  vec3 reach(radius);
  if (box.low.x <= box.high.x && glm::all(glm::lessThanEqual(box.low - reach, place)) &&
      glm::all(glm::lessThanEqual(place, box.high + reach))) {
    search.is_moving = 1;
    rtcPointQuery(w.moving_scene, &query, &context, collect, &search);
  }
  return search.count;
}

}  // namespace wellspring::world
