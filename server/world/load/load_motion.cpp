// SPDX-License-Identifier: Apache-2.0
#include "world/load/load_motion.h"

#include <algorithm>
#include <cmath>

#include "gltf/animation.h"
#include "gltf/attributes.h"
#include "gltf/data.h"
#include "gltf/pose.h"
#include "world/load/gltf_mesh.h"

namespace wellspring::world {
namespace {

void mend(std::vector<vec3>& differences) {
  for (vec3& d : differences)
    if (!is_finite(d) || glm::length(d) > 1e15f) d = vec3(0);
}

void read_targets(File& file, const json& primitive, const std::vector<uint32_t>& from,
                  Mover& mover) {
  const json& targets = items(primitive, "targets");
  for (size_t i = 0; i < targets.size(); i++) {
    MorphTarget target;
    target.positions = read_vec3s(file, targets[i], "POSITION", from);
    if (!mover.flat) target.normals = read_vec3s(file, targets[i], "NORMAL", from);
    mend(target.positions), mend(target.normals);
    mover.targets.push_back(std::move(target));
  }
}

// Weights that do not add to one are scaled to do so; a vertex without any hangs on the first
// joint, as in gltf_mesh.cpp.
void read_influences(File& file, const json& primitive, const std::vector<uint32_t>& from,
                     Mover& mover) {
  const json& attributes = primitive["attributes"];
  std::vector<std::vector<MoverInfluence>> of(from.size());
  for (int set = 0;; set++) {
    const json* accessor = find(attributes, numbered("JOINTS_", set).c_str());
    if (!accessor) break;
    const std::vector<uint32_t> joints = read_integers(file, accessor->get<size_t>());
    const std::vector<float> weights =
        read_attribute(file, attributes, numbered("WEIGHTS_", set), from);
    for (size_t i = 0; i < weights.size(); i++) {
      if (!(weights[i] > 0) || !std::isfinite(weights[i])) continue;
      const uint32_t joint = joints[from[i / 4] * size_t(4) + i % 4];
      if (joint < mover.joints.size()) of[i / 4].push_back({joint, weights[i]});
    }
  }
  mover.first_influence.push_back(0);
  for (std::vector<MoverInfluence>& list : of) {
    if (list.empty()) list.push_back({0, 1});
    float sum = 0;
    for (const MoverInfluence& one : list) sum += one.weight;
    for (const MoverInfluence& one : list)
      mover.influences.push_back({one.joint, one.weight / sum});
    mover.first_influence.push_back(uint32_t(mover.influences.size()));
  }
}

}  // namespace

MotionLoad::MotionLoad(File& file, const std::vector<Node>& nodes) : file_(file) {
  motion_.file = std::filesystem::path(file.path).filename().string();
  motion_.nodes = nodes;
  motion_.order = parents_first(nodes);
  motion_.clips = read_clips(file, nodes);
  for (size_t i = 0; i < motion_.clips.size(); i++)
    if (motion_.clips[i].name.empty()) motion_.clips[i].name = std::to_string(i);
}

void MotionLoad::note(const Shown& shown) { shown_.push_back(shown); }

Mover MotionLoad::make_mover(const Shown& shown) {
  Mover mover;
  mover.node = uint32_t(shown.node);
  if (shown.skin < 0) return mover;
  const json& joints = items(file_.root, "skins")[size_t(shown.skin)]["joints"];
  // With every node at zero, a joint's matrix is its inverse bind matrix.
  const std::vector<dmat4> zero(motion_.nodes.size(), dmat4(1));
  const std::vector<dmat4> binds = joint_matrices(file_, size_t(shown.skin), zero);
  for (size_t i = 0; i < joints.size(); i++)
    mover.joints.push_back({joints[i].get<uint32_t>(), binds[i]});
  return mover;
}

void MotionLoad::finish(Scene& scene) {
  PlacedMotion placed;
  for (const Shown& shown : shown_) {
    Mover mover = make_mover(shown);
    const bool moved = std::ranges::any_of(
        motion_.clips, [&](const Clip& clip) { return moves(motion_, clip, mover); });
    if (!moved) continue;
    BuiltMesh built = build_primitive(file_, shown.mesh, shown.primitive, {}, shown.tangent_uv);
    mover.mesh = std::move(built.mesh);
    mover.centre = built.centre;
    mover.flat = built.flat;
    const json& primitive = items(file_.root, "meshes")[shown.mesh]["primitives"][shown.primitive];
    read_targets(file_, primitive, built.from, mover);
    if (!mover.joints.empty()) read_influences(file_, primitive, built.from, mover);
    placed.instances.push_back(shown.instance);
    motion_.movers.push_back(std::move(mover));
  }
  if (motion_.movers.empty()) return;
  placed.of = std::make_shared<SceneMotion>(std::move(motion_));
  scene.motions.push_back(std::move(placed));
}

}  // namespace wellspring::world
