// SPDX-License-Identifier: Apache-2.0
#include "show/moving/exhibit_scene.h"

#include <algorithm>

#include "avatar/mind/storyteller.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/moving/figure.h"
#include "show/moving/movers.h"
#include "show/moving/play.h"

namespace wellspring::show {

mat4 place_storyteller(const StorytellerPlace& place, const Scene& scene) {
  // A humanoid faces +Z, a yaw of 0 faces -Z: half a turn between them.
  return glm::rotate(glm::translate(mat4(1), vec3(place.position - scene.origin)), place.yaw + pi,
                     vec3(0, 1, 0));
}

Scene make_exhibit_scene(Exhibit exhibit, double time) {
  Scene& scene = exhibit.scene;
  scene.viewpoints.clear();
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    scene.viewpoints.push_back(viewpoint.view);
  std::vector<double> times;
  for (const ExhibitAnimation& animation : exhibit.animations)
    times.push_back(time_of(animation, {}, time));
  for (size_t i = 0; i < exhibit.movers.size(); i++) {
    scene.instances.push_back({int(scene.meshes.size()), mat4(1), exhibit.movers[i].object});
    scene.meshes.push_back(mover_mesh(exhibit, i, times));
  }
  put_lights(exhibit.lights, time, scene);
  if (exhibit.storytellers.empty()) return std::move(scene);
  const StorytellerPlace& place = exhibit.storytellers.front();
  const Character& character = place.character;
  std::vector<Mesh> meshes;
  std::vector<uint32_t> objects;
  Figure figure = make_figure(character, scene, meshes, objects);
  Storyteller storyteller;
  storyteller.character = &character;
  storyteller.placement = place_storyteller(place, scene);
  StorytellerState state;
  StorytellerEvents events;
  Pose pose = make_rest_pose(character);
  constexpr float step = 1 / 30.0f;
  int steps = int(std::clamp(time, 0.0, 600.0) / double(step));
  for (int i = 0; i <= steps; i++) {
    StorytellerInput input;
    input.dt = i == 0 ? 0 : step;
    input.time = i * double(step);
    tick_storyteller(state, storyteller, input, pose, events);
  }
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  skin(character, pose, storyteller.placement, scratch, positions, normals);
  for (const FigurePart& part : figure.parts) {
    Mesh mesh = meshes[size_t(part.moving)];
    for (size_t v = 0; v < part.vertices.size(); v++) {
      mesh.positions[v] = positions[part.vertices[v]];
      mesh.normals[v] = normals[part.vertices[v]];
    }
    scene.instances.push_back({int(scene.meshes.size()), mat4(1), figure.object});
    scene.meshes.push_back(std::move(mesh));
  }
  return std::move(scene);
}

}  // namespace wellspring::show
