// SPDX-License-Identifier: Apache-2.0
#include "show/visit/walk.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace wellspring::show {

namespace {

constexpr float step_height = 0.4f;   // what a visitor climbs without thinking
constexpr float fall_distance = 4;    // deeper gaps are treated as edges: no step is taken
constexpr float settle_time = 0.12f;  // seconds for the eye to follow the ground

bool blocked(const World& world, vec3 from, vec3 direction, float distance) {
  Ray ray{from, 0.001f, direction, distance};
  return world.occluded(ray);
}

// Free to go `distance` along horizontal `direction`, for a body from above step height to the eye?
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

// Height of the ground under `eye`, relative to the scene's origin; NaN: none within reach.
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
