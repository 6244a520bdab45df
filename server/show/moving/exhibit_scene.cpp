// SPDX-License-Identifier: Apache-2.0
#include "show/moving/exhibit_scene.h"

#include <algorithm>
#include <cmath>

#include "avatar/mind/storyteller.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/moving/figure.h"
#include "world/mesh_finish.h"
#include "world/motion/scene_motion.h"

namespace wellspring::show {

namespace {

constexpr int reach_steps = 24;  // times of an animation at which its reach is measured

// Returns the time of each clip of a motion, from those of the exhibit's animations.
std::vector<double> clip_times(const Exhibit& exhibit, int motion,
                               const std::vector<double>& times) {
  std::vector<double> of(exhibit.scene.motions[size_t(motion)].of->clips.size(), -1);
  for (size_t i = 0; i < exhibit.animations.size(); i++)
    if (exhibit.animations[i].motion == motion) of[size_t(exhibit.animations[i].clip)] = times[i];
  return of;
}

// The vertices of movers, file by file.
class Poser {
 public:
  Poser(const Exhibit& exhibit, const std::vector<double>& times)
      : exhibit_(exhibit), times_(times) {}

  // Answers whether the mover's triangles are turned round there.
  bool find(const ExhibitMover& one, std::vector<vec3>& positions, std::vector<vec3>& normals) {
    const PlacedMotion& placed = exhibit_.scene.motions[size_t(one.motion)];
    if (one.motion != posed_)
      pose_motion(*placed.of, clip_times(exhibit_, one.motion, times_), pose_);
    posed_ = one.motion;
    const dmat4 to_scene = glm::translate(dmat4(1), -exhibit_.scene.origin) * placed.to_world;
    const Mover& mover = placed.of->movers[size_t(one.mover)];
    pose_mover(pose_, mover, to_scene, positions, normals);
    return gltf::is_mirrored(to_scene * pose_.nodes[mover.node].global);
  }

 private:
  const Exhibit& exhibit_;
  const std::vector<double>& times_;
  ScenePose pose_;
  int posed_ = -1;
};

bool moves_it(const Exhibit& exhibit, const ExhibitAnimation& animation, const ExhibitMover& one) {
  if (animation.motion != one.motion) return false;
  const SceneMotion& motion = *exhibit.scene.motions[size_t(one.motion)].of;
  return moves(motion, motion.clips[size_t(animation.clip)], motion.movers[size_t(one.mover)]);
}

Reach find_reach(const Exhibit& exhibit, size_t animation) {
  Bounds bounds;
  std::vector<double> times(exhibit.animations.size(), 0);
  std::vector<vec3> positions, normals;
  for (int step = 0; step <= reach_steps; step++) {
    times[animation] = exhibit.animations[animation].seconds * step / reach_steps;
    Poser poser(exhibit, times);
    for (const ExhibitMover& one : exhibit.movers) {
      if (!moves_it(exhibit, exhibit.animations[animation], one)) continue;
      poser.find(one, positions, normals);
      for (const vec3& p : positions)
        bounds.low = min(bounds.low, p), bounds.high = max(bounds.high, p);
    }
  }
  if (bounds.low.x > bounds.high.x) return {};
  return {0.5f * (bounds.low + bounds.high), 0.55f * glm::length(bounds.high - bounds.low)};
}

Mesh make_mesh(const Exhibit& exhibit, size_t mover, const std::vector<double>& times,
               bool& mirrored) {
  const ExhibitMover& one = exhibit.movers[mover];
  Mesh mesh = exhibit.scene.motions[size_t(one.motion)].of->movers[size_t(one.mover)].mesh;
  mesh.material = one.material;
  mirrored = Poser(exhibit, times).find(one, mesh.positions, mesh.normals);
  if (mirrored) turn_winding(mesh);
  const int uv =
      mesh.tangents.empty() ? -1 : tangent_uv(exhibit.scene.materials[size_t(one.material)]);
  if (uv >= 0 && !mesh.uv[uv].empty()) update_tangents(mesh, uv);
  return mesh;
}

}  // namespace

Mesh mover_mesh(const Exhibit& exhibit, size_t mover, const std::vector<double>& times) {
  bool mirrored = false;
  return make_mesh(exhibit, mover, times, mirrored);
}

Movers make_movers(const Exhibit& exhibit, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object) {
  Movers movers;
  movers.posed.assign(exhibit.animations.size(), 0);
  for (size_t i = 0; i < exhibit.movers.size(); i++) {
    movers.moving.push_back(int(moving.size()));
    bool mirrored = false;
    moving.push_back(make_mesh(exhibit, i, movers.posed, mirrored));
    movers.mirrored.push_back(mirrored);
    moving_object.push_back(exhibit.movers[i].object);
  }
  for (size_t i = 0; i < exhibit.animations.size(); i++)
    movers.reach.push_back(find_reach(exhibit, i));
  return movers;
}

bool pose_movers(const Exhibit& exhibit, const std::vector<double>& times, Movers& movers,
                 World& world) {
  if (times == movers.posed) return false;
  Poser poser(exhibit, times);
  std::vector<vec3> positions, normals;
  for (size_t i = 0; i < exhibit.movers.size(); i++) {
    const ExhibitMover& one = exhibit.movers[i];
    bool moved = false;
    for (size_t a = 0; a < times.size(); a++)
      moved |= times[a] != movers.posed[a] && moves_it(exhibit, exhibit.animations[a], one);
    if (!moved) continue;
    const bool mirrored = poser.find(one, positions, normals);
    world.move(movers.moving[i], positions, normals, mirrored != bool(movers.mirrored[i]));
  }
  movers.posed = times;
  return true;
}

double time_of(const ExhibitAnimation& animation, const Play& play, double now) {
  if (animation.start == ExhibitAnimation::Start::loop)
    return animation.seconds > 0 ? std::fmod(std::max(now, 0.0), animation.seconds) : 0;
  const double way = now - play.since;
  return std::clamp(play.on ? play.from + way : play.from - way, 0.0, animation.seconds);
}

bool is_running(const ExhibitAnimation& animation, const Play& play, double now) {
  if (animation.start == ExhibitAnimation::Start::loop) return true;
  return now - play.since < (play.on ? animation.seconds - play.from : play.from);
}

void set_on(const ExhibitAnimation& animation, bool on, double now, Play& play) {
  if (on == play.on) return;
  play = {on, time_of(animation, play, now), now};
}

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
