// SPDX-License-Identifier: Apache-2.0
#include "show/show.h"

#include <stdexcept>

#include "base/log.h"

namespace wellspring {

void Arrivals::put(std::shared_ptr<Link> link) {
  std::lock_guard lock(mutex_);
  links_.push_back(std::move(link));
}

std::vector<std::shared_ptr<Link>> Arrivals::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(links_, {});
}

mat4 place_storyteller(const StorytellerPlace& place, const Scene& scene) {
  // A humanoid faces +Z, a yaw of 0 faces -Z: half a turn between them.
  return glm::rotate(glm::translate(mat4(1), vec3(place.position - scene.origin)), place.yaw + pi,
                     vec3(0, 1, 0));
}

std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings) {
  auto show = std::make_unique<Show>();
  show->settings = settings;
  show->technique = find_technique(settings.technique);
  if (!show->technique) throw std::invalid_argument("unknown technique '" + settings.technique + "'");
  show->exhibit = std::move(exhibit);
  Scene& scene = show->exhibit.scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  if (show->exhibit.character) {
    show->figure = make_figure(*show->exhibit.character, scene, moving, moving_object);
    show->storyteller.character = &*show->exhibit.character;
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
  show->lights = make_lights(*show->world);
  log::info("exhibit '{}': {} triangles, {} viewpoints, {} materials", show->exhibit.id,
            triangle_count(scene), show->exhibit.viewpoints.size(), scene.materials.size());
  return show;
}

}  // namespace wellspring
