// SPDX-License-Identifier: Apache-2.0
// Turns a checked glTF file into a Scene: nodes to instances and objects, lights, cameras, and the
// origin.
#include "world/load/scene_load.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/worker.h"
#include "gltf/animation.h"
#include "gltf/data.h"
#include "gltf/primitive.h"
#include "image/image.h"
#include "world/load/gltf_material.h"
#include "world/load/gltf_mesh.h"
#include "world/mesh_finish.h"

namespace wellspring::world {
namespace {

using nlohmann::json;

using namespace gltf;

// Holds an instance before the origin is chosen.
struct Placement {
  int mesh = 0;
  dmat4 to_world{1};
  uint32_t object = 0;
};

class Builder {
 public:
  Builder(File& file, Scene& scene, double time) : file_(file), scene_(scene) {
    load_materials(file, scene);
    const json& meshes = items(file.root, "meshes");
    used_.assign(meshes.size(), 0);
    int64_t vertices = 0;
    for (size_t m = 0; m < meshes.size(); m++)
      for (size_t p = 0; p < meshes[m]["primitives"].size(); p++) {
        const std::string where = at(at("/meshes", m) + "/primitives", p);
        check_primitive(file, meshes[m]["primitives"][p], where);
        vertices += vertex_bound(file, meshes[m]["primitives"][p]);
        if (vertices > vertices_limit)
          refuse_beyond(file, where, vertices_limit, "vertices in all", fewer_vertices);
      }
    nodes_ = make_pose(file, time);
    for (const Node& node : nodes_) global_.push_back(node.global);
    scene.objects.push_back("");
    scene.object_nodes.push_back(-1);
    const json& list = items(file.root, "nodes");
    for (size_t i = 0; i < nodes_.size(); i++)
      scene.nodes.push_back({text(list[i], "name"), nodes_[i].parent});
  }

  // Makes build() note what clips move; called before it.
  void keep_motion() { motion_.emplace(file_, nodes_); }

  void build() {
    for (size_t i = 0; i < nodes_.size(); i++)
      if (nodes_[i].shown) build_node(i);
    check_unused();
    choose_origin();
    for (const Placement& p : placements_) {
      Instance instance;
      instance.mesh = p.mesh;
      instance.object = p.object;
      instance.to_world = mat4(glm::translate(dmat4(1), -scene_.origin) * p.to_world);
      scene_.instances.push_back(instance);
    }
    for (size_t i = 0; i < scene_.lights.size(); i++)
      scene_.lights[i].position = vec3(light_positions_[i] - scene_.origin);
    if (motion_) motion_->finish(scene_);
    if (scene_.instances.empty() && scene_.lights.empty())
      warn(file_, "", "there is nothing to see in this file");
  }

 private:
  void build_node(size_t index) {
    check_cancelled();
    const json& object = items(file_.root, "nodes")[index];
    if (find(object, "mesh")) build_mesh(index, object);
    if (const json* camera = find(object, "camera")) build_camera(index, camera->get<size_t>());
    if (const json* light = extension(object, "KHR_lights_punctual"))
      build_light(index, size_t(integer(*light, "light", 0)));
  }

  static bool is_skinned(const json& primitive) {
    return find(primitive["attributes"], "JOINTS_0") != nullptr;
  }

  void build_mesh(size_t index, const json& object) {
    size_t mesh_index = size_t(integer(object, "mesh", 0));
    const json& mesh = items(file_.root, "meshes")[mesh_index];
    used_[mesh_index] = 1;
    std::string name = text(object, "name", text(mesh, "name"));
    scene_.objects.push_back(name);
    scene_.object_nodes.push_back(int(index));
    uint32_t id = uint32_t(scene_.objects.size() - 1);
    Deformation deformation;
    deformation.weights = nodes_[index].weights;
    std::vector<dmat4> joints;
    if (const json* skin = find(object, "skin"))
      joints = joint_matrices(file_, skin->get<size_t>(), global_);
    const std::vector<dmat4> copies = read_instances(file_, index);
    for (size_t p = 0; p < mesh["primitives"].size(); p++) {
      const json& primitive = mesh["primitives"][p];
      bool skinned = !joints.empty() && is_skinned(primitive);
      if (!joints.empty() && !skinned)
        warn(file_, at("/nodes", index), "a skin on a mesh without joints is ignored");
      deformation.joints = skinned ? joints : std::vector<dmat4>();
      deformation.mirrored = skinned && is_mirrored(nodes_[index].global);
      // Nodes share a mesh as long as nothing bends it differently.
      int made = -1;
      auto key = std::make_tuple(mesh_index, p, deformation.weights);
      auto known = skinned ? built_.end() : built_.find(key);
      if (known != built_.end()) {
        made = known->second;
      } else {
        made = add_mesh(mesh_index, p, deformation);
        if (!skinned) built_[key] = made;
      }
      if (made < 0) continue;
      // A skinned mesh's own node does not move it: section 3.7.3.
      Placement placement;
      placement.mesh = made;
      placement.object = id;
      const bool many = !skinned && extension(object, "EXT_mesh_gpu_instancing");
      for (size_t i = 0; many && i < copies.size(); i++) {
        placement.to_world =
            glm::translate(nodes_[index].global * copies[i], centres_[size_t(made)]);
        placements_.push_back(placement);
      }
      if (many) continue;  // animations do not move them
      placement.to_world =
          glm::translate(skinned ? dmat4(1) : nodes_[index].global, centres_[size_t(made)]);
      if (motion_) {
        const json* skin = skinned ? find(object, "skin") : nullptr;
        motion_->note({int(placements_.size()), index, mesh_index, p, skin ? skin->get<int>() : -1,
                       tangent_uv(material_of(mesh_index, p))});
      }
      placements_.push_back(placement);
    }
  }

  // Adds a mesh and returns its index in the scene, -1 if it has no triangles.
  int add_mesh(size_t mesh, size_t primitive, const Deformation& deformation) {
    BuiltMesh built = build_primitive(file_, mesh, primitive, deformation,
                                      tangent_uv(material_of(mesh, primitive)));
    if (built.mesh.triangles.empty()) return -1;
    check_texture_coordinates(built.mesh, mesh, primitive);
    scene_.meshes.push_back(std::move(built.mesh));
    centres_.push_back(built.centre);
    return int(scene_.meshes.size()) - 1;
  }

  const Material& material_of(size_t mesh, size_t primitive) const {
    const json& object = items(file_.root, "meshes")[mesh]["primitives"][primitive];
    return scene_.materials[size_t(integer(object, "material", -1) + 1)];
  }

  void check_texture_coordinates(const Mesh& mesh, size_t index, size_t primitive) {
    const Material& m = scene_.materials[size_t(mesh.material)];
    for (const TextureRef* reference :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
          &m.emission_texture, &m.transmission_texture, &m.thickness_texture, &m.specular_texture,
          &m.specular_color_texture, &m.clearcoat_texture, &m.clearcoat_roughness_texture,
          &m.clearcoat_normal_texture, &m.sheen_color_texture, &m.sheen_roughness_texture,
          &m.anisotropy_texture})
      if (reference->texture >= 0 && mesh.uv[reference->uv_set].empty())
        warn(file_, at(at("/meshes", index) + "/primitives", primitive),
             "a texture without texture coordinates shows one texel everywhere");
  }

  // Reads meshes that nothing shows, too, so that all faults of a broken file are found.
  void check_unused() {
    for (size_t m = 0; m < used_.size(); m++) {
      if (used_[m]) continue;
      warn(file_, at("/meshes", m), "a mesh that no shown node uses");
      const json& primitives = items(file_.root, "meshes")[m]["primitives"];
      for (size_t p = 0; p < primitives.size(); p++) {
        bool readable = true;
        for (const json& accessor : primitives[p]["attributes"])
          readable = readable && has_data(file_, accessor.get<size_t>());
        if (const json* indices = find(primitives[p], "indices"))
          readable = readable && has_data(file_, indices->get<size_t>());
        if (readable) build_primitive(file_, m, p, {}, -1);
      }
    }
    const json& skins = items(file_.root, "skins");
    for (size_t s = 0; s < skins.size(); s++) {
      const json* matrices = find(skins[s], "inverseBindMatrices");
      if (!matrices || has_data(file_, matrices->get<size_t>())) joint_matrices(file_, s, global_);
    }
  }

  // Adds a viewpoint that looks down the node's -Z.
  void build_camera(size_t index, size_t camera_index) {
    const json& camera = items(file_.root, "cameras")[camera_index];
    const dmat4& m = global_[index];
    Viewpoint viewpoint;
    viewpoint.name = text(items(file_.root, "nodes")[index], "name", text(camera, "name"));
    if (viewpoint.name.empty()) viewpoint.name = "camera " + std::to_string(camera_index);
    viewpoint.position = dvec3(m[3]);
    double length = glm::length(dvec3(m[2]));
    dvec3 forward = length > 0 ? -dvec3(m[2]) / length : dvec3(0, 0, -1);
    dvec3 heading = forward;
    if (std::abs(forward.y) > 0.99999) heading = dvec3(m[1]) * (forward.y < 0 ? 1.0 : -1.0);
    viewpoint.yaw = float(std::atan2(-heading.x, -heading.z));
    viewpoint.pitch = float(std::asin(glm::clamp(forward.y, -1.0, 1.0)));
    // The roll tells how far its own right lies above that of an upright camera.
    const dvec3 right(std::cos(double(viewpoint.yaw)), 0, -std::sin(double(viewpoint.yaw)));
    const dvec3 own = cross(forward, dvec3(m[1])), up = cross(right, forward);
    viewpoint.roll = float(std::atan2(dot(own, up), dot(own, right)));
    if (!(std::abs(viewpoint.roll) > 1e-5f)) viewpoint.roll = 0;
    const json* perspective = find(camera, "perspective");
    const std::string where = at("/cameras", camera_index);
    if (text(camera, "type") == "perspective" && perspective) {
      double fov = number(*perspective, "yfov", 1);
      if (!(fov > 0 && fov < 3.1)) warn(file_, where, "a field of view out of range is clamped");
      viewpoint.fov = float(glm::clamp(fov, 0.01, 3.1));
    } else {
      warn(file_, where, "a camera that is not perspective is shown with 45 degrees");
      viewpoint.fov = pi / 4;
    }
    scene_.viewpoints.push_back(viewpoint);
  }

  void build_light(size_t index, size_t light_index) {
    const json& lights = *extension(file_.root, "KHR_lights_punctual");
    const json& object = lights["lights"][light_index];
    const std::string where = at("/extensions/KHR_lights_punctual/lights", light_index);
    PunctualLight light;
    light.name = text(items(file_.root, "nodes")[index], "name", text(object, "name"));
    std::string type = text(object, "type");
    if (type == "directional") light.type = PunctualType::directional;
    else if (type == "spot") light.type = PunctualType::spot;
    else if (type != "point") {
      warn(file_, where, "a light of unknown type is ignored");
      return;
    }
    vec3 color(1);
    if (const json* list = find(object, "color"))
      for (int i = 0; i < 3; i++) color[i] = to_float((*list)[size_t(i)].get<double>());
    light.intensity = glm::clamp(color * to_float(number(object, "intensity", 1)), 0.0f, 1e15f);
    if (find(object, "range")) {
      light.range = to_float(number(object, "range", 0));
      if (!(light.range > 0)) {
        warn(file_, where, "a range that is not positive is ignored");
        light.range = std::numeric_limits<float>::infinity();
      }
    }
    if (const json* spot = find(object, "spot")) {
      light.outer_cone = float(glm::clamp(number(*spot, "outerConeAngle", pi / 4), 1e-3, pi / 2.0));
      light.inner_cone = float(glm::clamp(number(*spot, "innerConeAngle", 0), 0.0, pi / 2.0));
      if (light.inner_cone >= light.outer_cone) {
        if (light.inner_cone > light.outer_cone)
          warn(file_, where, "an inner cone that is not inside the outer one is narrowed");
        light.inner_cone = light.outer_cone * 0.999f;
      }
    }
    const dmat4& m = global_[index];
    double length = glm::length(dvec3(m[2]));
    if (length > 0) light.direction = vec3(-dvec3(m[2]) / length);
    scene_.lights.push_back(light);
    scene_.light_nodes.push_back(int(index));
    light_positions_.push_back(dvec3(m[3]));
  }

  // Chooses the origin: zero, unless everything visible lies far away from it; then a whole number
  // of metres in its middle.
  void choose_origin() {
    dvec3 low(1e300), high(-1e300);
    for (const Placement& p : placements_) {
      Bounds box;
      const Mesh& mesh = scene_.meshes[size_t(p.mesh)];
      for (const vec3& v : mesh.positions) {
        box.low = glm::min(box.low, v);
        box.high = glm::max(box.high, v);
      }
      for (int corner = 0; corner < 8; corner++) {
        dvec3 v(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                corner & 4 ? box.high.z : box.low.z);
        v = dvec3(p.to_world * glm::dvec4(v, 1));
        if (!(glm::length(v) < 1e15))
          refuse(file_, "",
                 "object \"" + scene_.objects[p.object] + "\" reaches beyond 1e15 metres");
        low = glm::min(low, v);
        high = glm::max(high, v);
      }
    }
    if (placements_.empty()) return;
    dvec3 middle = (low + high) * 0.5, half = (high - low) * 0.5;
    double distance = std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
    double size = std::max({half.x, half.y, half.z});
    if (distance > 1000 && distance > 4 * size) scene_.origin = glm::round(middle);
  }

  File& file_;
  Scene& scene_;
  std::vector<Node> nodes_;
  std::vector<dmat4> global_;
  std::vector<char> used_;
  std::optional<MotionLoad> motion_;
  std::vector<Placement> placements_;
  std::vector<dvec3> centres_;  // centres of scene_.meshes
  std::vector<dvec3> light_positions_;
  std::map<std::tuple<size_t, size_t, std::vector<double>>, int> built_;
};

}  // namespace

Scene load_scene(const std::string& path, const SceneLoadOptions& options) {
  File file = load_gltf(path, options.package);
  Scene scene;
  scene.cull_back_faces = true;
  scene.name = std::filesystem::path(path).stem().string();
  const json& scenes = items(file.root, "scenes");
  if (!scenes.empty())
    scene.name = text(scenes[size_t(integer(file.root, "scene", 0))], "name", scene.name);
  Builder builder(file, scene, options.time);
  if (options.motion) builder.keep_motion();
  builder.build();
  scene.warnings = std::move(file.warnings);
  return scene;
}

void load_environment(const std::string& path, Scene& scene) {
  const LinearImage sky =
      decode_hdr(read_file<Bytes>(path, size_t(1) << 30), image_texel_limit / 4, path);
  Image image;
  image.name = std::filesystem::path(path).filename().string();
  image.width = sky.width, image.height = sky.height;
  for (vec3 color : sky.color) image.texels.emplace_back(color, 1);
  scene.images.push_back(std::move(image));
  scene.environment.image = int(scene.images.size()) - 1;
  if (scene.environment.radiance == vec3(0)) scene.environment.radiance = vec3(1);
}

}  // namespace wellspring::world
