// SPDX-License-Identifier: Apache-2.0
#include "show/show.h"

#include <stdexcept>

#include "base/log.h"
#include "show/exhibit_scene.h"

namespace wellspring {

void Arrivals::put(std::shared_ptr<Link> link) {
  std::lock_guard lock(mutex_);
  links_.push_back(std::move(link));
}

std::vector<std::shared_ptr<Link>> Arrivals::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(links_, {});
}

namespace {

// Where visitors' eyes are likely to be: the viewpoints, and places on the way between them.
std::vector<vec3> places_of(const Exhibit& exhibit) {
  std::vector<vec3> places;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    places.push_back(vec3(viewpoint.view.position - exhibit.scene.origin));
  for (size_t i = 1, count = places.size(); i < count; i++)
    places.push_back(0.5f * (places[i - 1] + places[i]));
  return places;
}

}  // namespace

std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings) {
  auto show = std::make_unique<Show>();
  show->settings = settings;
  show->technique = find_technique(settings.technique);
  show->still_technique = find_technique(settings.still_technique);
  for (const auto& [technique, name] : {std::pair(show->technique, settings.technique),
                                        std::pair(show->still_technique, settings.still_technique)})
    if (!technique) throw std::invalid_argument("unknown technique '" + name + "'");
  show->exhibit = std::move(exhibit);
  Scene& scene = show->exhibit.scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  if (show->exhibit.character) {
    show->figure = make_figure(*show->exhibit.character, scene, moving, moving_object);
    show->storyteller.character = &*show->exhibit.character;
    if (show->exhibit.expressions) show->storyteller.expressions = &*show->exhibit.expressions;
    if (show->exhibit.gestures) show->storyteller.gestures = &*show->exhibit.gestures;
    show->storyteller.placement = place_storyteller(*show->exhibit.storyteller, scene);
    show->pose = make_rest_pose(*show->exhibit.character);
  }
  show->world = std::make_unique<World>(scene, std::move(moving), std::move(moving_object));
  if (show->figure) {
    StorytellerEvents events;
    tick_storyteller(show->mind, show->storyteller, StorytellerInput{}, show->pose, events);
    pose_figure(*show->world, *show->figure, *show->exhibit.character, show->pose,
                show->storyteller.placement, show->scratch);
    show->world->commit();
  }
  std::vector<Problem> problems;
  show->roads = make_tour_roads(show->exhibit, *show->world, problems);
  if (!problems.empty()) throw ExhibitError(std::move(problems));
  show->lights = make_lights(*show->world);
  if (settings.draw != DrawShapes::never)
    show->sight = std::make_unique<PictureSight>(*show->world, show->lights);
  std::vector<vec3> places = places_of(show->exhibit);
  for (const Technique* technique : {show->technique, show->still_technique})
    if (technique->prepare) technique->prepare(*show->world, places, show->lights);
  log::info("exhibit '{}': {} triangles, {} viewpoints, {} materials", show->exhibit.id,
            triangle_count(scene), show->exhibit.viewpoints.size(), scene.materials.size());
  return show;
}

}  // namespace wellspring
