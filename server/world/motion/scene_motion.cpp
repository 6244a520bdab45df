// SPDX-License-Identifier: Apache-2.0
#include "world/motion/scene_motion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "gltf/animation.h"

namespace wellspring::world {

namespace {

vec3 unit_or(const dvec3& v, const vec3& otherwise) {
  const double length = glm::length(v);
  return length > 1e-150 && std::isfinite(length) ? vec3(v / length) : otherwise;
}

// Returns the inverse transpose times the determinant: for normals.
glm::dmat3 cofactor(const dmat4& m) {
  const glm::dmat3 linear(m);
  return {cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1])};
}

bool is_below(const std::vector<gltf::Node>& nodes, int node, size_t above) {
  for (; node >= 0; node = nodes[size_t(node)].parent)
    if (size_t(node) == above) return true;
  return false;
}

void set_face_normals(const Mesh& mesh, const std::vector<vec3>& positions,
                      std::vector<vec3>& normals) {
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
    vec3 normal = unit_or(cross(b - a, c - a), normals[t.x]);
    if (dot(normal, normals[t.x]) < 0) normal = -normal;
    normals[t.x] = normals[t.y] = normals[t.z] = normal;
  }
}

// Holds how places and normals go from one space to another.
struct Turn {
  dmat4 places{1};
  glm::dmat3 normals{1};
};

Turn make_turn(const dmat4& m) {
  const double mirrored = glm::determinant(glm::dmat3(m)) < 0 ? -1 : 1;
  return {m, mirrored * cofactor(m)};
}

// Returns the joints' matrices; a skinned mesh's own node does not move it: section 3.7.3.
std::vector<dmat4> joint_matrices(const ScenePose& pose, const Mover& mover,
                                  const dmat4& to_scene) {
  std::vector<dmat4> joints;
  for (const MoverJoint& joint : mover.joints)
    joints.push_back(to_scene * pose.nodes[joint.node].global * joint.bind);
  return joints;
}

}  // namespace

bool moves(const SceneMotion& motion, const gltf::Clip& clip, const Mover& mover) {
  return std::ranges::any_of(clip.tracks, [&](const gltf::Track& track) {
    if (track.path == gltf::Path::weights) return track.node == mover.node;
    if (mover.joints.empty()) return is_below(motion.nodes, int(mover.node), track.node);
    return std::ranges::any_of(mover.joints, [&](const MoverJoint& joint) {
      return is_below(motion.nodes, int(joint.node), track.node);
    });
  });
}

void pose_motion(const SceneMotion& motion, const std::vector<double>& times, ScenePose& pose) {
  pose.nodes = motion.nodes;
  for (size_t i = 0; i < motion.clips.size() && i < times.size(); i++)
    if (times[i] >= 0) gltf::move_nodes(motion.clips[i], times[i], pose.nodes);
  gltf::place_nodes(motion.order, pose.nodes);
}

void pose_mover(const ScenePose& pose, const Mover& mover, const dmat4& to_scene,
                std::vector<vec3>& positions, std::vector<vec3>& normals) {
  const Mesh& mesh = mover.mesh;
  const gltf::Node& node = pose.nodes[mover.node];
  const size_t count = mesh.positions.size();
  positions.resize(count), normals.resize(count);
  const std::vector<dmat4> joints = joint_matrices(pose, mover, to_scene);
  Turn turn;  // for the whole mesh, or, with a skin, for each vertex
  if (joints.empty()) turn = make_turn(to_scene * node.global);
  for (size_t v = 0; v < count; v++) {
    dvec3 p(mesh.positions[v]), n(mesh.normals[v]);
    for (size_t t = 0; t < std::min(mover.targets.size(), node.weights.size()); t++) {
      const MorphTarget& target = mover.targets[t];
      if (!target.positions.empty()) p += node.weights[t] * dvec3(target.positions[v]);
      if (!target.normals.empty()) n += node.weights[t] * dvec3(target.normals[v]);
    }
    if (!joints.empty()) {
      dmat4 blend(0);
      for (uint32_t i = mover.first_influence[v]; i < mover.first_influence[v + 1]; i++)
        blend += joints[mover.influences[i].joint] * double(mover.influences[i].weight);
      turn = make_turn(blend);
    }
    positions[v] = vec3(turn.places * dvec4(p + mover.centre, 1));
    normals[v] = unit_or(turn.normals * n, mesh.normals[v]);
  }
  if (mover.flat) set_face_normals(mesh, positions, normals);
}

namespace {

template <class T>
void add_middle(std::vector<T>& values, uint32_t a, uint32_t b) {
  if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
}

// Adds a vertex between two.
uint32_t split(Mover& mover, uint32_t a, uint32_t b) {
  Mesh& mesh = mover.mesh;
  const uint32_t made = uint32_t(mesh.positions.size());
  add_middle(mesh.positions, a, b);
  add_middle(mesh.normals, a, b);
  mesh.normals.back() = unit_or(dvec3(mesh.normals.back()), mesh.normals[a]);
  add_middle(mesh.tangents, a, b);
  if (!mesh.tangents.empty()) mesh.tangents.back().w = mesh.tangents[a].w;
  add_middle(mesh.uv[0], a, b);
  add_middle(mesh.uv[1], a, b);
  add_middle(mesh.colors, a, b);
  for (MorphTarget& target : mover.targets) {
    add_middle(target.positions, a, b);
    add_middle(target.normals, a, b);
  }
  return made;
}

}  // namespace

void subdivide(Mover& mover, double scale, double longest, size_t most_triangles) {
  if (!mover.joints.empty() || !(scale > 0)) return;
  Mesh& mesh = mover.mesh;
  auto metres = [&](uint32_t a, uint32_t b) {
    const vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return glm::length(dvec3(p) - dvec3(q)) * scale;
  };
  for (bool changed = true; changed && 2 * mesh.triangles.size() <= most_triangles;) {
    changed = false;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    auto middle = [&](uint32_t a, uint32_t b) {
      auto [found, added] = middles.try_emplace(std::minmax(a, b), 0);
      if (added) found->second = split(mover, a, b);
      return found->second;
    };
    std::vector<uvec3> triangles;
    for (const uvec3& t : mesh.triangles) {
      // Find the longest edge, if it is too long. In the end all edges that were too long are
      // halved, from both sides.
      int worst = -1;
      double length = longest;
      for (int e = 0; e < 3; e++)
        if (double l = metres(t[e], t[(e + 1) % 3]); l > length) worst = e, length = l;
      if (worst < 0) {
        triangles.push_back(t);
        continue;
      }
      changed = true;
      const uint32_t a = t[worst], b = t[(worst + 1) % 3], c = t[(worst + 2) % 3];
      const uint32_t m = middle(a, b);
      triangles.push_back({a, m, c});
      triangles.push_back({m, b, c});
    }
    mesh.triangles = std::move(triangles);
  }
}

}  // namespace wellspring::world
