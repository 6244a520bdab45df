// SPDX-License-Identifier: Apache-2.0
#include "show/check/check_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/unicode.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "show/check/footing.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/pieces/exhibit_lawns.h"
#include "world/view.h"

namespace wellspring::show {
namespace {

constexpr int directions = 64;
constexpr float solid_share = 0.85f;  // share of the directions that meet backs first
// These are shares of all directions from all viewpoints, and of those that meet the object.
constexpr float much_in_view = 0.01f, much_of_it = 0.25f;
constexpr float too_bright = 200;  // light on a surface, of which 3.14 makes white paper white
constexpr float white_light = pi;
constexpr float off_exposure = 30;  // so many times more or less is a mistake
// Feet stand on the ground around them, and eyes see from so many metres on that they do not.
constexpr float footprint = 0.2f, off_ground = 0.02f;

// Evenly over the sphere (Fibonacci).
vec3 direction_of(int i, int count) {
  float y = 1 - 2 * (float(i) + 0.5f) / float(count), r = std::sqrt(std::max(0.0f, 1 - y * y));
  float turn = float(i) * pi * (3 - std::sqrt(5.0f));
  return {r * std::cos(turn), y, r * std::sin(turn)};
}

// The nearest hit on what stands still and is no glass.
Hit first_solid(const World& world, vec3 from, vec3 way) {
  Ray ray{from, 0, way};
  for (int passed = 0; passed < 32; passed++) {
    Hit hit = world.intersect(ray);
    if (!hit.valid()) return hit;
    if (!world.is_moving(hit.instance) && world.material_of(hit.instance).transmission == 0)
      return hit;
    ray.t_min = hit.t * 1.0001f + 1e-5f;
  }
  return {};
}

bool is_back(const World& world, const Hit& hit, vec3 way) {
  const Mesh& mesh = world.mesh_of(hit.instance);
  const uvec3 corner = mesh.triangles[hit.triangle];
  vec3 normal = world.normal_to_world(hit.instance) *
                cross(mesh.positions[corner.y] - mesh.positions[corner.x],
                      mesh.positions[corner.z] - mesh.positions[corner.x]);
  return dot(normal, way) > 0;
}

// Finds what shows its back first from there. If faces of two things lie in one plane, as a table's
// underside on a floor, chance decides which of them a ray meets, so both count.
Hit first_back(const World& world, vec3 from, vec3 way) {
  const Hit hit = first_solid(world, from, way);
  if (!hit.valid() || is_back(world, hit, way)) return hit;
  const float gap = 1e-4f * hit.t;
  std::array<Hit, 8> near;
  const int count =
      world.find_near(from + hit.t * way, way, gap, gap, near.data(), int(near.size()));
  for (int i = 0; i < count; i++)
    if (near[i].instance != hit.instance && !world.is_moving(near[i].instance) &&
        world.material_of(near[i].instance).transmission == 0 && is_back(world, near[i], way)) {
      near[i].t = hit.t;
      return near[i];
    }
  return {};
}

float eye_height_of(const Exhibit& exhibit) {
  return exhibit.walk ? exhibit.walk->eye_height : WalkSettings{}.eye_height;
}

struct Noter {
  const Exhibit& exhibit;
  std::vector<Problem>& problems;
  void note(const std::string& where, const std::string& what) {
    problems.push_back({exhibit.folder + "/exhibit.json", where, what, false});
  }
};

void check_size(const Exhibit& exhibit, Noter& noter) {
  const Bounds bounds = scene_bounds(exhibit.scene);
  const vec3 size = bounds.high - bounds.low;
  if (!is_finite(size)) return noter.note("/scene", "there is nothing to see in the scene");
  const float largest = max_component(size), eye = eye_height_of(exhibit);
  const double factor = propose_scale(largest, eye);
  if (largest <= 0) noter.note("/scene", "the whole scene is one point");
  else if (largest < eye && factor != 1)
    noter.note("/scene", fmt::format("the whole scene is {:.3g} m across, and a visitor's eye is "
                                     "{:.3g} m high: were these metres? Else try \"scale\": {:g}",
                                     largest, eye, factor));
  else if (largest > eye && factor != 1)
    noter.note("/scene", fmt::format("the scene is {:.4g} m across, and a visitor's eye is {:.3g} "
                                     "m high: were these metres? Else try \"scale\": {:g}",
                                     largest, eye, factor));
}

void check_view(const Exhibit& exhibit, const World& world, const ExhibitViewpoint& viewpoint,
                Noter& noter) {
  const Viewpoint& at = viewpoint.view;
  const std::string where = viewpoint.where.empty() ? "/scene" : viewpoint.where + "/position";
  const std::string who = (viewpoint.where.empty() ? "camera '" : "viewpoint '") + at.name + "'";
  std::string inside;
  vec3 eye = vec3(at.position - exhibit.scene.origin);
  if (is_in_solid(world, eye, inside))
    return noter.note(where,
                      who + " is inside '" + inside +
                          "', whose surfaces show it their backs; if that is your room, turn "
                          "its faces inwards (Blender: Mesh > Normals > Flip)");
  if (!sees_something(world, at)) noter.note(where, "nothing of the scene is in view of " + who);
}

void check_storyteller(const Exhibit& exhibit, const World& world, size_t index, Noter& noter) {
  const StorytellerPlace& place = exhibit.storytellers[index];
  for (float height : {0.9f, 1.5f}) {
    std::string inside;
    vec3 body = vec3(place.position - exhibit.scene.origin) + vec3(0, height, 0);
    if (!is_in_solid(world, body, inside)) continue;
    return noter.note("/storyteller", "'" + place.id + "' stands inside '" + inside + "'");
  }
  const vec3 feet(place.position - exhibit.scene.origin);
  const std::optional<float> ground = find_footing(world, feet, footprint);
  if (!ground)
    return noter.note("/storyteller", fmt::format("there is no ground within {:g} m of the feet of "
                                                  "'{}'",
                                                  foot_reach, place.id));
  const float gap = feet.y - *ground;
  if (std::abs(gap) < off_ground) return;
  noter.note("/storyteller", fmt::format("'{}' {} {:.3f} m: the ground is at a height of {:.3f} m",
                                         place.id, gap > 0 ? "floats by" : "sinks in by",
                                         std::abs(gap), place.position.y - double(gap)));
}

// Light that falls on what the lamp reaches: its median over the directions it shines in.
float light_on_surfaces(const World& world, const PunctualLight& light) {
  const float strength = max_component(light.intensity);
  if (light.type == PunctualType::directional) return strength;
  std::vector<float> found;
  for (int i = 0; i < directions * 4; i++) {
    vec3 way = direction_of(i, directions * 4);
    if (light.type == PunctualType::spot && dot(way, light.direction) < std::cos(light.outer_cone))
      continue;
    Hit hit = world.intersect({light.position, 0.02f, way});
    if (hit.valid() && hit.t < light.range) found.push_back(strength / (hit.t * hit.t));
  }
  if (found.empty()) return 0;
  auto middle = found.begin() + std::ptrdiff_t(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return *middle;
}

}  // namespace

bool is_in_solid(const World& world, vec3 place, std::string& inside) {
  int backs = 0;
  Hit nearest;
  for (int i = 0; i < directions; i++) {
    vec3 way = direction_of(i, directions);
    Hit hit = first_back(world, place, way);
    if (!hit.valid()) continue;
    backs++;
    if (hit.t < nearest.t) nearest = hit;
  }
  if (float(backs) < solid_share * directions) return false;
  inside = world.scene().objects[world.object_of(nearest.instance)];
  return true;
}

bool sees_something(const World& world, const Viewpoint& viewpoint) {
  constexpr int width = 96, height = 56;  // wires are seen, too
  View view = make_view(world.scene(), viewpoint, width, height);
  for (int i = 0; i < width * height; i++) {
    Ray ray = view_ray(view, float(i % width) + 0.5f, float(i / width) + 0.5f);
    Hit hit = world.intersect(ray);
    if (hit.valid() && !world.is_moving(hit.instance)) return true;
  }
  return false;
}

void check_places(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems) {
  Noter noter{exhibit, problems};
  check_size(exhibit, noter);
  if (exhibit.scene.instances.empty()) return;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    check_view(exhibit, world, viewpoint, noter);
  for (size_t i = 0; i < exhibit.storytellers.size(); i++)
    check_storyteller(exhibit, world, i, noter);
}

void check_lawns(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems) {
  for (const ExhibitLawn& lawn : exhibit.lawns) {
    if (grow_lawn(lawn, world)->blades > 0) continue;
    const std::string on =
        lawn.ground.empty() ? "no ground" : "no ground of " + list_names(lawn.ground, 8);
    problems.push_back(
        {exhibit.folder + "/exhibit.json", lawn.where,
         fmt::format(
             "nothing grows of the lawn '{}': within {:g} m above and below its place there "
             "is {} that faces up, or its mask is black there",
             lawn.id, lawn.reach, on),
         false});
  }
}

void check_sides(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems) {
  std::vector<int> backs(exhibit.scene.objects.size(), 0), hits = backs;
  int all = 0;
  std::string inside;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints) {
    const vec3 eye = vec3(viewpoint.view.position - exhibit.scene.origin);
    if (is_in_solid(world, eye, inside)) continue;
    for (int i = 0; i < directions; i++) {
      const vec3 way = direction_of(i, directions);
      const Hit hit = first_solid(world, eye, way);
      if (!hit.valid()) continue;
      const uint32_t object = world.object_of(hit.instance);
      all++, hits[object]++;
      if (!world.material_of(hit.instance).double_sided && is_back(world, hit, way))
        backs[object]++;
    }
  }
  std::vector<std::string> names;
  for (size_t i = 0; i < backs.size(); i++)
    if (float(backs[i]) > std::max(much_in_view * float(all), much_of_it * float(hits[i])))
      names.push_back("'" + exhibit.scene.objects[i] + "'");
  if (names.empty()) return;
  Noter{exhibit, problems}.note(
      "/scene", fmt::format("visitors see these from behind, where no light is baked: {}. Turn "
                            "their faces (Blender: Mesh > Normals > Flip), or make the material "
                            "double-sided",
                            list_names(names, 8)));
}

void check_shipped_light(const Exhibit& exhibit, std::vector<Problem>& problems) {
  const std::string file = shipped_light(exhibit.folder);
  switch (find_map(file, hash_scene(exhibit.scene))) {
    case KeyedFile::read:
    case KeyedFile::missing: return;
    case KeyedFile::damaged:
      return problems.push_back({file, "",
                                 "is damaged, or of another version: ./wellspring bake " +
                                     exhibit.folder + " makes it anew",
                                 false});
    case KeyedFile::another_key:
      return problems.push_back({file, "",
                                 "is stale: the scene has changed since, so light is only "
                                 "right after a while. ./wellspring bake " +
                                     exhibit.folder + " makes it anew",
                                 false});
  }
}

void check_light(const Exhibit& exhibit, World& world, std::vector<Problem>& problems) {
  Noter noter{exhibit, problems};
  std::vector<std::string> names;
  float strongest = 0;
  for (const PunctualLight& light : exhibit.scene.lights) {
    float here = light_on_surfaces(world, light) * exhibit.exposure;
    if (here < too_bright) continue;
    names.push_back("'" + light.name + "'");
    strongest = std::max(strongest, here);
  }
  if (!names.empty())
    noter.note("/scene",
               fmt::format("these lamps are up to {:.0f} times too bright, pictures are white: {}. "
                           "Export them with the lighting mode Unitless; or write "
                           "\"light_scale\": {:.2g}{}",
                           strongest / white_light, list_names(names, 8),
                           names.size() == 1 ? white_light / strongest : 1.0f / 683,
                           exhibit.auto_exposure ? "" : ", or \"exposure\": \"auto\""));
  if (exhibit.auto_exposure) return;
  std::optional<float> wanted = measure_exposure(exhibit, world);
  if (!wanted) return noter.note("/exposure", "no light falls on anything in view");
  float off = exhibit.exposure / *wanted;
  if (off > off_exposure || off < 1 / off_exposure)
    noter.note("/exposure", fmt::format("pictures will be {}: {:.2g} would suit the light that is "
                                        "there (\"exposure\": \"auto\" measures it)",
                                        off > 1 ? "white" : "black", *wanted));
}

}  // namespace wellspring::show
