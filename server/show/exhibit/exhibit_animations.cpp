// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_animations.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/near_name.h"
#include "world/motion/scene_motion.h"

namespace wellspring::show {

namespace {

// Of edges of what moves: light is kept at its vertices.
constexpr double longest_edge = 0.12;  // metres
constexpr size_t most_named = 8;       // animations in a message
constexpr size_t most_mover_triangles = 40'000;

// Of one file's, or of all where none is named.
struct Clips {
  const Scene& scene;
  std::string file;
  bool has(const PlacedMotion& motion) const { return file.empty() || motion.of->file == file; }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const PlacedMotion& motion : scene.motions)
      for (const gltf::Clip& clip : motion.of->clips)
        if (has(motion)) names.push_back(clip.name);
    return names;
  }

  bool find(const std::string& name, ExhibitAnimation& animation) const {
    for (size_t m = 0; m < scene.motions.size(); m++) {
      const std::vector<gltf::Clip>& clips = scene.motions[m].of->clips;
      const auto found = std::ranges::find(clips, name, &gltf::Clip::name);
      if (found == clips.end() || !has(scene.motions[m])) continue;
      animation.motion = int(m), animation.clip = int(found - clips.begin());
      animation.seconds = gltf::length_of(*found);
      return true;
    }
    return false;
  }

  std::string unknown(const std::string& name) const {
    const std::vector<std::string> all = names();
    const std::string where = file.empty() ? "the scene" : "'" + file + "'";
    if (all.empty()) return where + " has no animations";
    std::string some;
    for (size_t i = 0; i < all.size() && i < most_named; i++)
      some += (i > 0 ? ", '" : "'") + all[i] + "'";
    return where + " has no animation '" + name + "'" + did_you_mean(name, all) + "; there is " +
           some + (all.size() > most_named ? ", ..." : "");
  }
};

// What it moves besides meshes stays where it is.
void check_lights(const Exhibit& exhibit, const ExhibitAnimation& animation, Fields& fields) {
  const Scene& scene = exhibit.scene;
  const SceneMotion& motion = *scene.motions[size_t(animation.motion)].of;
  const gltf::Clip& clip = motion.clips[size_t(animation.clip)];
  if (std::ranges::none_of(motion.movers,
                           [&](const Mover& one) { return moves(motion, clip, one); }))
    fields.problem("clip", "the animation '" + clip.name + "' moves nothing that can be seen",
                   false);
  for (size_t i = 0; i < motion.movers.size(); i++) {
    const int instance = scene.motions[size_t(animation.motion)].instances[i];
    if (instance < 0 || !moves(motion, clip, motion.movers[i])) continue;
    const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
    const Material& material = scene.materials[size_t(mesh.material)];
    if (material.emission == vec3(0)) continue;
    fields.problem("clip",
                   "'" + scene.objects[scene.instances[size_t(instance)].object] +
                       "' shines and moves: it is seen to shine, and lights nothing",
                   false);
    return;
  }
}

void read_animation(Exhibit& exhibit, Fields fields) {
  ExhibitAnimation animation;
  animation.id = fields.text("id", true);
  if (std::ranges::find(exhibit.animations, animation.id, &ExhibitAnimation::id) !=
      exhibit.animations.end())
    fields.problem("id", "'" + animation.id + "' is taken by another animation");
  animation.title = fields.local_text("title", false);
  const std::string start = fields.text("play", false, "loop");
  if (start != "loop" && start != "touch") fields.problem("play", "is 'loop' or 'touch'");
  if (start == "touch") animation.start = ExhibitAnimation::Start::touch;
  const bool touched = animation.start == ExhibitAnimation::Start::touch;
  animation.shared = fields.flag("shared", !touched);
  if (!animation.shared && !touched)
    fields.problem("shared", "what plays by itself does so for everybody");
  const std::string object = fields.text("object", touched);
  if (const PointOfInterest* point = find_point(exhibit, object))
    animation.point = int(point - exhibit.points.data());
  else if (!object.empty()) fields.problem("object", unknown_object(exhibit, object));
  const std::string clip = fields.text("clip", true);
  const bool loaded = !exhibit.scene.objects.empty();
  const Clips clips{exhibit.scene, fields.text("file", false)};
  if (clips.find(clip, animation)) {
    if (animation.seconds > 0) check_lights(exhibit, animation, fields);
    else fields.problem("clip", "the animation '" + clip + "' takes no time");
  } else if (loaded && !clip.empty()) {
    fields.problem("clip", clips.unknown(clip));
  }
  fields.finish();
  exhibit.animations.push_back(std::move(animation));
}

// Two of them at one node would pull it to and fro.
void check_shared_nodes(const Exhibit& exhibit, Fields& root) {
  for (size_t a = 0; a < exhibit.animations.size(); a++)
    for (size_t b = 0; b < a; b++) {
      const ExhibitAnimation &one = exhibit.animations[a], &other = exhibit.animations[b];
      if (one.seconds <= 0 || other.seconds <= 0 || one.motion != other.motion) continue;
      const SceneMotion& motion = *exhibit.scene.motions[size_t(one.motion)].of;
      for (const gltf::Track& track : motion.clips[size_t(one.clip)].tracks)
        for (const gltf::Track& same : motion.clips[size_t(other.clip)].tracks)
          if (track.node == same.node && track.path == same.path) {
            root.problem(
                "animations",
                "'" + other.id + "' and '" + one.id + "' move the same node: the later one is seen",
                false);
            return;
          }
    }
}

}  // namespace

void read_animations(Exhibit& exhibit, Fields& root) {
  root.objects("animations", false,
               [&](Fields fields) { read_animation(exhibit, std::move(fields)); });
  if (exhibit.animations.size() > most_animations)
    root.problem("animations", fmt::format("are more than {}", most_animations));
  check_shared_nodes(exhibit, root);
}

void take_movers(Exhibit& exhibit) {
  Scene& scene = exhibit.scene;
  std::vector<char> taken(scene.instances.size(), 0);
  for (size_t m = 0; m < scene.motions.size(); m++) {
    PlacedMotion& placed = scene.motions[m];
    auto own = std::make_shared<SceneMotion>(*placed.of);
    own->movers.clear();
    for (size_t i = 0; i < placed.of->movers.size(); i++) {
      const Mover& mover = placed.of->movers[i];
      const bool moved = std::ranges::any_of(exhibit.animations, [&](const auto& animation) {
        return size_t(animation.motion) == m && animation.seconds > 0 &&
               moves(*own, own->clips[size_t(animation.clip)], mover);
      });
      if (!moved) continue;
      const Instance& instance = scene.instances[size_t(placed.instances[i])];
      exhibit.movers.push_back({int(m), int(own->movers.size()),
                                scene.meshes[size_t(instance.mesh)].material, instance.object});
      taken[size_t(placed.instances[i])] = 1;
      own->movers.push_back(mover);
      const dmat4 to_world = placed.to_world * own->nodes[mover.node].global;
      const double scale =
          std::max({glm::length(dvec3(to_world[0])), glm::length(dvec3(to_world[1])),
                    glm::length(dvec3(to_world[2]))});
      subdivide(own->movers.back(), scale, longest_edge, most_mover_triangles);
    }
    placed.instances.assign(own->movers.size(), -1);
    placed.of = std::move(own);
  }
  if (exhibit.movers.empty()) {
    scene.motions.clear();
    return;
  }
  size_t kept = 0;
  for (size_t i = 0; i < taken.size(); i++)
    if (!taken[i]) scene.instances[kept++] = scene.instances[i];
  scene.instances.resize(kept);
}

}  // namespace wellspring::show
