// SPDX-License-Identifier: Apache-2.0
#include "scan/format/gltf_points.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "base/load_error.h"
#include "gltf/animation.h"
#include "gltf/data.h"
#include "gltf/primitive.h"

namespace wellspring::scan {
namespace {

// Encodes linear light as sRGB (IEC 61966-2-1) of 16 bits.
uint16_t encode_color(float linear) {
  const double light = std::clamp(double(linear), 0.0, 1.0);
  const double code = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return uint16_t(std::lround(code * 65535));
}

class GltfPoints : public PointSource {
 public:
  explicit GltfPoints(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    File file = load_gltf(path, folder.empty() ? "." : folder, {"KHR_gaussian_splatting"});
    info_.file = path;
    info_.format = "glTF";
    info_.color_max = 65535;
    const std::vector<Node> nodes = make_pose(file, 0);
    for (size_t i = 0; i < nodes.size(); i++)
      if (const gltf::json* mesh = find(items(file.root, "nodes")[i], "mesh");
          mesh && nodes[i].shown)
        read_mesh(file, mesh->get<size_t>(), read_instances(file, i), nodes[i].global);
    if (!has_primitives_) {
      if (has_splats_) refuse(file, "/meshes", "holds Gaussian splats, which are no points");
      refuse(file, "/meshes", "has no points: no primitive of mode 0 is shown");
    }
    info_.notices.insert(info_.notices.end(), file.warnings.begin(), file.warnings.end());
    info_.points = points_.size();
    info_.is_counted = true;
    info_.fields.color = has_color_;
    info_.fields.normal = has_normal_;
    if (!has_color_) points_.color.clear();
    if (!has_normal_) points_.normal.clear();
  }

  bool read(PointBlock& block, size_t most) override {
    block.clear();
    for (; next_ < points_.size() && block.size() < most; next_++) {
      const dvec3 place = points_.place[next_];
      if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
        dropped_++;
        continue;
      }
      block.place.push_back(place);
      if (has_color_) block.color.push_back(points_.color[next_]);
      if (has_normal_) block.normal.push_back(points_.normal[next_]);
    }
    return block.size() > 0;
  }

 private:
  void read_mesh(File& file, size_t mesh, const std::vector<dmat4>& copies, const dmat4& global) {
    const gltf::json& primitives = items(items(file.root, "meshes")[mesh], "primitives");
    for (size_t p = 0; p < primitives.size(); p++) {
      if (integer(primitives[p], "mode", 4) != 0) continue;
      if (extension(primitives[p], "KHR_gaussian_splatting")) {
        has_splats_ = true;
        continue;
      }
      read_primitive(file, primitives[p], at(at("/meshes", mesh) + "/primitives", p), copies,
                     global);
    }
  }

  void read_primitive(File& file, const gltf::json& primitive, const std::string& where,
                      const std::vector<dmat4>& copies, const dmat4& global) {
    check_primitive(file, primitive, where);
    const gltf::json& attributes = primitive["attributes"];
    const gltf::json* position = find(attributes, "POSITION");
    if (!position) return;
    has_primitives_ = true;
    const size_t count = size_t(form_of(file, position->get<size_t>()).count);
    Used used(count);
    std::iota(used.begin(), used.end(), 0u);
    if (const gltf::json* indices = find(primitive, "indices")) {
      used = read_integers(file, indices->get<size_t>());
      if (std::ranges::any_of(used, [count](uint32_t index) { return index >= count; }))
        refuse(file, where + "/indices", "names a point that is not there");
    }
    file.vertices_made += int64_t(used.size()) * int64_t(copies.size());
    if (file.vertices_made > vertices_limit)
      refuse_beyond(file, where, vertices_limit, "points in all", "cut it into several files");
    const std::vector<vec3> places = read_vec3s(file, attributes, "POSITION", used);
    const std::vector<vec4> colors = read_vec4s(file, attributes, "COLOR_0", used);
    const std::vector<vec3> normals = read_vec3s(file, attributes, "NORMAL", used);
    has_color_ = has_color_ || !colors.empty();
    has_normal_ = has_normal_ || !normals.empty();
    for (const dmat4& copy : copies) {
      const dmat4 to_file = global * copy;
      const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(to_file)));
      for (size_t i = 0; i < used.size(); i++) {
        points_.place.push_back(dvec3(to_file * glm::dvec4(dvec3(places[i]), 1)));
        const vec4 color = colors.empty() ? vec4(1) : colors[i];
        points_.color.push_back(
            {encode_color(color.x), encode_color(color.y), encode_color(color.z)});
        const dvec3 normal = normals.empty() ? dvec3(0) : turn * dvec3(normals[i]);
        const double length = glm::length(normal);
        points_.normal.push_back(length > 0 && std::isfinite(length) ? vec3(normal / length)
                                                                     : vec3(0));
      }
    }
  }

  PointBlock points_;
  size_t next_ = 0;
  bool has_primitives_ = false, has_splats_ = false, has_color_ = false, has_normal_ = false;
};

}  // namespace

std::unique_ptr<PointSource> open_gltf_points(const std::string& path) {
  return std::make_unique<GltfPoints>(path);
}

}  // namespace wellspring::scan
