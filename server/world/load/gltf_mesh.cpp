// SPDX-License-Identifier: Apache-2.0
#include "world/load/gltf_mesh.h"

#include <algorithm>
#include <cmath>

#include "gltf/animation.h"
#include "gltf/data.h"
#include "gltf/primitive.h"
#include "world/mesh_finish.h"

namespace wellspring::world {
namespace {

using nlohmann::json;

constexpr float farthest = 1e15f;  // metres; beyond, squares of distances leave the range of float

// Holds a primitive on its way to a mesh; positions in double until the joints have moved them.
struct Draft {
  Mesh mesh;
  std::vector<dvec3> positions;
  Used used;  // vertex i of the mesh is the file's vertex used[i]
};

template <class Values, class Deltas>
void add_scaled(Values& values, const Deltas& deltas, double weight) {
  for (size_t i = 0; i < std::min(values.size(), deltas.size()); i++)
    for (int c = 0; c < std::min(int(values[i].length()), int(deltas[i].length())); c++)
      values[i][c] = typename Values::value_type::value_type(double(values[i][c]) +
                                                             weight * double(deltas[i][c]));
}

void apply_targets(File& file, const json& primitive, const std::vector<double>& weights,
                   Draft& draft) {
  const json& targets = items(primitive, "targets");
  Mesh& mesh = draft.mesh;
  for (size_t i = 0; i < std::min(targets.size(), weights.size()); i++) {
    if (weights[i] == 0) continue;
    add_scaled(draft.positions, read_vec3s(file, targets[i], "POSITION", draft.used), weights[i]);
    add_scaled(mesh.normals, read_vec3s(file, targets[i], "NORMAL", draft.used), weights[i]);
    add_scaled(mesh.tangents, read_vec3s(file, targets[i], "TANGENT", draft.used), weights[i]);
    add_scaled(mesh.uv[0], read_vec2s(file, targets[i], "TEXCOORD_0", draft.used), weights[i]);
    add_scaled(mesh.uv[1], read_vec2s(file, targets[i], "TEXCOORD_1", draft.used), weights[i]);
    add_scaled(mesh.colors, read_vec4s(file, targets[i], "COLOR_0", draft.used), weights[i]);
  }
}

// Skins by linear blending, section 3.7.3.3: weights that do not add to one are scaled to do so.
void apply_skin(File& file, const json& primitive, const std::string& where,
                const std::vector<dmat4>& joints, Draft& draft) {
  const json& attributes = primitive["attributes"];
  std::vector<dmat4> blend(draft.positions.size(), dmat4(0));
  std::vector<double> sum(draft.positions.size(), 0);
  for (int set = 0;; set++) {
    const std::string name = numbered("JOINTS_", set);
    const json* accessor = find(attributes, name.c_str());
    if (!accessor) break;
    std::vector<uint32_t> all = read_integers(file, accessor->get<size_t>());
    std::vector<float> weight =
        read_attribute(file, attributes, numbered("WEIGHTS_", set), draft.used);
    for (size_t i = 0; i < weight.size(); i++) {
      if (!(weight[i] > 0) || !std::isfinite(weight[i])) continue;
      uint32_t joint = all[draft.used[i / 4] * size_t(4) + i % 4];
      if (joint >= joints.size())
        refuse(file, where + "/attributes/" + name,
               "vertex " + std::to_string(draft.used[i / 4]) + " hangs on joint " +
                   std::to_string(joint) + " of " + std::to_string(joints.size()));
      blend[i / 4] += joints[joint] * double(weight[i]);
      sum[i / 4] += double(weight[i]);
    }
  }
  Mesh& mesh = draft.mesh;
  for (size_t i = 0; i < blend.size(); i++) {
    dmat4 m = sum[i] > 0 ? blend[i] * (1 / sum[i]) : joints[0];
    draft.positions[i] = dvec3(m * glm::dvec4(draft.positions[i], 1));
    glm::dmat3 linear(m);
    if (!mesh.normals.empty()) {
      glm::dmat3 cofactor(cross(linear[1], linear[2]), cross(linear[2], linear[0]),
                          cross(linear[0], linear[1]));
      const double side = is_mirrored(m) ? -1 : 1;  // outside stays outside
      mesh.normals[i] = vec3(cofactor * dvec3(mesh.normals[i]) * side);
    }
    if (!mesh.tangents.empty())
      mesh.tangents[i] = vec4(vec3(linear * dvec3(vec3(mesh.tangents[i]))), mesh.tangents[i].w);
  }
}

// Drops triangles with a corner at no finite place and mends values of the other lists that are not
// finite.
void drop_bad_values(File& file, const std::string& where, Draft& draft) {
  Mesh& mesh = draft.mesh;
  auto is_bad = [&](uint32_t i) {
    dvec3 p = glm::abs(draft.positions[i]);
    return !(p.x < farthest && p.y < farthest && p.z < farthest);
  };
  size_t before = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](uvec3 t) { return is_bad(t.x) || is_bad(t.y) || is_bad(t.z); });
  if (mesh.triangles.size() < before)
    warn(file, where,
         std::to_string(before - mesh.triangles.size()) +
             " triangles with a corner at no finite place are dropped");
  for (uint32_t i = 0; i < draft.positions.size(); i++)
    if (is_bad(i)) draft.positions[i] = dvec3(0);
  bool mended = false;
  for (std::vector<vec2>& set : mesh.uv)
    for (vec2& uv : set)
      if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = vec2(0), mended = true;
  for (vec4& color : mesh.colors)
    for (int c = 0; c < 4; c++) {
      if (!std::isfinite(color[c])) color[c] = 1, mended = true;
      color[c] = glm::clamp(color[c], 0.0f, 1e6f);
    }
  if (mended) warn(file, where, "texture coordinates or colours that are not finite are replaced");
}

// Returns the place of the mesh's own zero: the old one, unless the mesh is small against its
// distance from it.
dvec3 choose_centre(const Draft& draft) {
  dvec3 low(1e300), high(-1e300);
  for (const uvec3& t : draft.mesh.triangles)
    for (int corner = 0; corner < 3; corner++) {
      low = glm::min(low, draft.positions[t[corner]]);
      high = glm::max(high, draft.positions[t[corner]]);
    }
  if (draft.mesh.triangles.empty()) return dvec3(0);
  dvec3 middle = (low + high) * 0.5, half = (high - low) * 0.5;
  double distance = std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
  double size = std::max({half.x, half.y, half.z});
  // The result is rounded to float, so that subtracting it from float positions is exact.
  return distance > 64 * size ? dvec3(vec3(middle)) : dvec3(0);
}

std::vector<uint32_t> chosen(const std::vector<uint32_t>& values,
                             const std::vector<uint32_t>& indices) {
  std::vector<uint32_t> result;
  result.reserve(indices.size());
  for (uint32_t i : indices) result.push_back(values[i]);
  return result;
}

// Keeps or makes tangents. `from`: each vertex's number in the file, kept up to date.
void finish_tangents(File& file, const std::string& where, int tangent_uv, Mesh& mesh,
                     std::vector<uint32_t>& from) {
  bool usable = tangent_uv >= 0 && !mesh.tangents.empty();
  for (vec4& tangent : mesh.tangents) {
    vec3 t(tangent);
    usable = usable && is_finite(t) && dot(t, t) > 1e-20f;
    tangent = vec4(usable ? normalize(t) : t, tangent.w < 0 ? -1.0f : 1.0f);
  }
  if (usable) return;
  mesh.tangents.clear();
  if (tangent_uv < 0) return;
  if (mesh.uv[tangent_uv].empty()) {
    warn(file, where,
         "a normal map or anisotropy without tangents or texture coordinates has no effect");
    return;
  }
  from = chosen(from, make_tangents(mesh, tangent_uv));
}

}  // namespace

BuiltMesh build_primitive(File& file, size_t mesh_index, size_t primitive_index,
                          const Deformation& deformation, int tangent_uv) {
  const json& mesh_object = items(file.root, "meshes")[mesh_index];
  const std::string where = at(at("/meshes", mesh_index) + "/primitives", primitive_index);
  const json& primitive = mesh_object["primitives"][primitive_index];
  const json& attributes = primitive["attributes"];
  Draft draft;
  Mesh& mesh = draft.mesh;
  mesh.name = text(mesh_object, "name");
  mesh.material = int(integer(primitive, "material", -1)) + 1;
  const json* accessor = find(attributes, "POSITION");
  if (!accessor) return {};
  size_t vertex_count = size_t(form_of(file, accessor->get<size_t>()).count);
  Corners corners = read_corners(file, primitive, where, vertex_count);
  if (corners.triangles.empty()) return {};
  mesh.triangles = std::move(corners.triangles);
  draft.used = std::move(corners.used);
  std::vector<vec3> positions = read_vec3s(file, attributes, "POSITION", draft.used);
  draft.positions.assign(positions.begin(), positions.end());
  mesh.normals = read_vec3s(file, attributes, "NORMAL", draft.used);
  if (!mesh.normals.empty()) mesh.tangents = read_vec4s(file, attributes, "TANGENT", draft.used);
  mesh.uv[0] = read_vec2s(file, attributes, "TEXCOORD_0", draft.used);
  mesh.uv[1] = read_vec2s(file, attributes, "TEXCOORD_1", draft.used);
  mesh.colors = read_vec4s(file, attributes, "COLOR_0", draft.used);
  apply_targets(file, primitive, deformation.weights, draft);
  if (!deformation.joints.empty()) apply_skin(file, primitive, where, deformation.joints, draft);
  if (deformation.mirrored) turn_winding(mesh);
  drop_bad_values(file, where, draft);

  BuiltMesh built;
  built.centre = choose_centre(draft);
  mesh.positions.reserve(draft.positions.size());
  for (const dvec3& p : draft.positions) mesh.positions.push_back(vec3(p - built.centre));
  built.from = std::move(draft.used);
  built.flat = mesh.normals.empty();
  if (built.flat) built.from = chosen(built.from, make_flat_normals(mesh));
  else if (int count = repair_normals(mesh); count > 0)
    warn(file, where, std::to_string(count) + " normals without a direction are replaced");
  finish_tangents(file, where, tangent_uv, mesh, built.from);
  built.mesh = std::move(mesh);
  return built;
}

std::vector<dmat4> joint_matrices(File& file, size_t skin, const std::vector<dmat4>& global) {
  const json& object = items(file.root, "skins")[skin];
  const json& joints = object["joints"];
  std::vector<dmat4> result;
  for (const json& joint : joints) result.push_back(global[joint.get<size_t>()]);
  const json* accessor = find(object, "inverseBindMatrices");
  if (!accessor) return result;
  const std::string where = at("/skins", skin) + "/inverseBindMatrices";
  Form form = form_of(file, accessor->get<size_t>());
  if (form.components != 16 || form.component_type != float_component)
    refuse(file, where, "must be MAT4 of FLOAT, not " + describe(file, accessor->get<size_t>()));
  if (form.count < int64_t(joints.size()))
    refuse(file, where,
           "has " + std::to_string(form.count) + " matrices for " + std::to_string(joints.size()) +
               " joints");
  const std::vector<float>& values = *read_floats(file, accessor->get<size_t>());
  for (size_t j = 0; j < result.size(); j++) {
    dmat4 bind(1);
    for (int i = 0; i < 16; i++) {
      float value = values[j * 16 + size_t(i)];
      if (!std::isfinite(value))
        refuse(file, where, "matrix " + std::to_string(j) + " is not finite");
      if (i % 4 < 3) bind[i / 4][i % 4] = double(value);  // the last row is 0 0 0 1 by definition
    }
    result[j] = result[j] * bind;
  }
  return result;
}

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

// Reads the skin's weights. Weights that do not add to one are scaled to do so; a vertex without
// any hangs on the first joint, as in gltf_mesh.cpp.
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
