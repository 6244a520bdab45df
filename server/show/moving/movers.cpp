// SPDX-License-Identifier: Apache-2.0
#include "show/moving/movers.h"

#include <algorithm>
#include <cmath>

#include "world/mesh_finish.h"
#include "world/motion/scene_motion.h"

namespace wellspring {

namespace {

constexpr int reach_steps = 24;  // of an animation, at which its reach is measured

// Of each clip of a motion, from those of the exhibit's animations.
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

  void find(const ExhibitMover& one, std::vector<vec3>& positions, std::vector<vec3>& normals) {
    const PlacedMotion& placed = exhibit_.scene.motions[size_t(one.motion)];
    if (one.motion != posed_)
      pose_motion(*placed.of, clip_times(exhibit_, one.motion, times_), pose_);
    posed_ = one.motion;
    const dmat4 to_scene = glm::translate(dmat4(1), -exhibit_.scene.origin) * placed.to_world;
    pose_mover(pose_, placed.of->movers[size_t(one.mover)], to_scene, positions, normals);
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

// A node that mirrors turns the winding round (glTF 2.0 section 3.7.4): against its normals.
bool is_inside_out(const Mesh& mesh) {
  double sum = 0;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    sum +=
        dot(cross(b - a, c - a), dvec3(mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]));
  }
  return sum < 0;
}

}  // namespace

Mesh mover_mesh(const Exhibit& exhibit, size_t mover, const std::vector<double>& times) {
  const ExhibitMover& one = exhibit.movers[mover];
  Mesh mesh = exhibit.scene.motions[size_t(one.motion)].of->movers[size_t(one.mover)].mesh;
  mesh.material = one.material;
  Poser(exhibit, times).find(one, mesh.positions, mesh.normals);
  if (is_inside_out(mesh))
    for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  const int uv =
      mesh.tangents.empty() ? -1 : tangent_uv(exhibit.scene.materials[size_t(one.material)]);
  if (uv >= 0 && !mesh.uv[uv].empty()) update_tangents(mesh, uv);
  return mesh;
}

Movers make_movers(const Exhibit& exhibit, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object) {
  Movers movers;
  movers.posed.assign(exhibit.animations.size(), 0);
  for (size_t i = 0; i < exhibit.movers.size(); i++) {
    movers.moving.push_back(int(moving.size()));
    moving.push_back(mover_mesh(exhibit, i, movers.posed));
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
    poser.find(one, positions, normals);
    world.move(movers.moving[i], positions, normals);
  }
  movers.posed = times;
  return true;
}

}  // namespace wellspring
