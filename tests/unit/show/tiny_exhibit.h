// SPDX-License-Identifier: Apache-2.0
// A small exhibit made in code: a lit room of 8 x 4 x 8 m with a wall in the middle, two
// viewpoints, a tour and a story.
#pragma once
#include "show/exhibit/exhibit_lights.h"
#include "unit/show/tiny_figure.h"
#include "world/load/lamp.h"

namespace wellspring::test {

inline void add_quad(Mesh& mesh, vec3 corner, vec3 u, vec3 v) {
  uint32_t first = uint32_t(mesh.positions.size());
  for (vec3 p : {corner, corner + u, corner + u + v, corner + v}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(normalize(cross(u, v)));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

inline Exhibit make_tiny_exhibit(dvec3 origin = dvec3(0)) {
  Exhibit exhibit;
  exhibit.id = "tiny";
  exhibit.title = {{"en", "Tiny"}, {"de", "Klein"}};
  exhibit.languages = {"en", "de"};
  Scene& scene = exhibit.scene;
  scene.origin = origin;
  Material grey, lamp;
  grey.base_color = vec4(0.6f, 0.6f, 0.6f, 1);
  grey.metallic = 0;
  grey.double_sided = true;
  lamp.emission = vec3(5);
  lamp.double_sided = true;
  scene.materials = {grey, lamp};
  Mesh room;
  add_quad(room, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});  // floor, facing up
  add_quad(room, {-4, 4, -4}, {8, 0, 0}, {0, 0, 8});  // ceiling
  add_quad(room, {-4, 0, -4}, {8, 0, 0}, {0, 4, 0});  // walls
  add_quad(room, {-4, 0, 4}, {0, 4, 0}, {8, 0, 0});
  add_quad(room, {-4, 0, -4}, {0, 4, 0}, {0, 0, 8});
  add_quad(room, {4, 0, -4}, {0, 0, 8}, {0, 4, 0});
  add_quad(room, {-4, 0, 0}, {5, 0, 0}, {0, 4, 0});    // a wall across, open for x > 1
  add_quad(room, {2, 0, 2}, {0, 0.2f, 0}, {2, 0, 0});  // a step 0.2 m high
  add_quad(room, {2, 0.2f, 2}, {0, 0, 2}, {2, 0, 0});
  Mesh light;
  light.material = 1;
  add_quad(light, {-1, 3.9f, 1}, {2, 0, 0}, {0, 0, 2});
  scene.meshes = {room, light};
  scene.objects = {"", "room", "light"};
  scene.instances = {{0, mat4(1), 1}, {1, mat4(1), 2}};
  auto viewpoint = [&](const char* name, dvec3 position, float yaw) {
    ExhibitViewpoint result;
    result.view.name = name;
    result.view.position = origin + position;
    result.view.yaw = yaw;
    exhibit.viewpoints.push_back(result);
  };
  viewpoint("door", {-2, 1.6, 3}, 0);
  viewpoint("corner", {3, 1.6, -3}, 2);
  TourPlan tour;
  tour.id = "round";
  tour.stops.resize(2);
  tour.stops[0] = {0, 2, 1, {}, {}, {}, {}};
  tour.stops[0].text["en"].emplace_back().text = "Here";
  tour.stops[1] = {1, 2, 1, {}, {}, {}, {}};
  exhibit.tours = {tour};
  StoryText story;
  story.id = "tale";
  for (const char* line : {"One.", "Two."}) story.text["en"].emplace_back().text = line;
  for (const char* line : {"Eins.", "Zwei."}) story.text["de"].emplace_back().text = line;
  exhibit.stories = {story};
  exhibit.walk = WalkSettings{};
  exhibit.walk->eye_height = 1.6f;
  return exhibit;
}

// The room's lamp is its sky, with a sun that stands 45 degrees high in the south at noon. The
// first of the exhibit's lamps.
inline void add_day(Exhibit& exhibit) {
  PunctualLight sun;
  sun.name = "sun";
  sun.type = PunctualType::directional;
  sun.direction = normalize(vec3(0, -1, -1));
  sun.intensity = vec3(9, 8, 7);
  exhibit.scene.lights.push_back(sun);
  add_lamp({"daylight", {"light", "sun"}, {}}, exhibit.scene);
  exhibit.lamps = {{"daylight", {{"en", "Daylight"}}}};
  set_day({}, 0, int(exhibit.scene.lights.size()) - 1, exhibit);
}

inline StorytellerPlace& add_storyteller(Exhibit& exhibit, const std::string& id, dvec3 position) {
  StorytellerPlace& added = exhibit.storytellers.emplace_back();
  added.id = id;
  added.character = make_tiny_figure();
  added.position = position;
  return added;
}

}  // namespace wellspring::test
