// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_skin.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "avatar/load/x3d_reader.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

vec3 linear_from_srgb(vec3 c) {
  vec3 result;
  for (int i = 0; i < 3; i++) {
    float v = glm::clamp(c[i], 0.0f, 1.0f);
    result[i] = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  }
  return result;
}

// Returns the first picture of `url` that lies beside the file or below it.
std::string find_picture(X3dFile& file, const X3dNode& node) {
  namespace fs = std::filesystem;
  std::vector<std::string> urls = strings_of(node, "url");
  for (std::string url : urls) {
    for (char& c : url)
      if (c == '\\') c = '/';
    fs::path path(url);
    bool foreign = url.find("://") != std::string::npos || path.is_absolute();
    for (const fs::path& part : path) foreign = foreign || part == "..";
    if (url.empty() || foreign) continue;
    fs::path full = fs::path(file.path).parent_path() / path;
    std::error_code error;
    if (fs::is_regular_file(full, error)) return full.string();
  }
  if (!urls.empty())
    warn_once(file.warnings,
              where(node) + ": no picture '" + urls[0].substr(0, 80) + "' beside the file");
  return "";
}

mat3 texture_transform(X3dFile& file, const X3dNode& node) {
  auto vec2_of = [&](const char* name, vec2 otherwise) {
    std::vector<float> v = floats_of(file, node, name);
    return v.size() < 2 ? otherwise : vec2(v[0], v[1]);
  };
  vec2 center = vec2_of("center", vec2(0)), scale = vec2_of("scale", vec2(1));
  vec2 translation = vec2_of("translation", vec2(0));
  float angle = float_of(file, node, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  mat3 to(1), turn(1), size(1), back(1), move(1);  // X3D 4, 18.4.10: -C S R C T
  to[2] = vec3(center, 1);
  back[2] = vec3(-center, 1);
  move[2] = vec3(translation, 1);
  turn[0] = vec3(c, s, 0);
  turn[1] = vec3(-s, c, 0);
  size[0].x = scale.x;
  size[1].y = scale.y;
  return back * size * turn * to * move;
}

// Returns the path of the picture that `field` names; empty: none.
std::string picture_of(X3dFile& file, const X3dNode& material, const char* field) {
  int picture = find_child(file, material, field, {});
  if (picture < 0) return "";
  const X3dNode& node = file.nodes[size_t(picture)];
  if (node.type == "ImageTexture") return find_picture(file, node);
  warn_once(file.warnings, "texture of type " + node.type + " is not used");
  return "";
}

// Uses vertex colours in place of the material's.
void use_colors(X3dFile& file, Appearance& appearance, bool glows, bool covered,
                std::vector<vec4>& colors) {
  if (colors.empty()) return;
  if (glows) warn_once(file.warnings, "colours of vertices are not used with an UnlitMaterial");
  if (glows || covered) return colors.clear();
  appearance.base_color = vec3(1);
  bool clear = false;
  for (vec4& color : colors) {
    color = vec4(linear_from_srgb(vec3(color)), color.w);
    clear |= color.w < 1;
  }
  if (!clear) return;
  appearance.alpha = 1;  // the colours' alpha counts (X3D 4, 17.2.2.3)
  appearance.clear_colors = true;
}

}  // namespace

X3dAppearance make_x3d_appearance(X3dFile& file, int appearance_node, std::vector<vec4>& colors) {
  X3dAppearance result;
  Appearance& appearance = result.appearance;
  if (appearance_node < 0) {
    use_colors(file, appearance, false, false, colors);
    return result;
  }
  bool glows = false, covered = false;
  const X3dNode& node = file.nodes[size_t(appearance_node)];
  appearance.name = node.def;
  int picture = find_child(file, node, "texture", {"ImageTexture"});
  int material = find_child(file, node, "material",
                            {"Material", "PhysicalMaterial", "UnlitMaterial", "TwoSidedMaterial"});
  if (material >= 0) {
    const X3dNode& m = file.nodes[size_t(material)];
    if (!m.def.empty()) appearance.name = m.def;
    appearance.alpha = 1 - glm::clamp(float_of(file, m, "transparency", 0), 0.0f, 1.0f);
    vec3 emissive = glm::max(vec3_of(file, m, "emissiveColor", vec3(0)), vec3(0));
    if (m.type == "PhysicalMaterial") {
      appearance.base_color = glm::clamp(vec3_of(file, m, "baseColor", vec3(1)), vec3(0), vec3(1));
      appearance.metallic = glm::clamp(float_of(file, m, "metallic", 1), 0.0f, 1.0f);
      appearance.roughness = glm::clamp(float_of(file, m, "roughness", 1), 0.0f, 1.0f);
      appearance.emission = emissive;
      int base = find_child(file, m, "baseTexture", {});
      if (base >= 0) picture = base;
      appearance.normal_texture = picture_of(file, m, "normalTexture");
      appearance.normal_scale = glm::clamp(float_of(file, m, "normalScale", 1), 0.0f, 100.0f);
      appearance.metallic_roughness_texture = picture_of(file, m, "metallicRoughnessTexture");
      appearance.emission_texture = picture_of(file, m, "emissiveTexture");
      if (find_child(file, m, "occlusionTexture", {}) >= 0)
        warn_once(file.warnings,
                  "occlusionTexture of a PhysicalMaterial is not used: shadows are traced");
    } else if (m.type == "UnlitMaterial") {
      glows = true;
      appearance.base_color = vec3(0);
      appearance.emission = linear_from_srgb(vec3_of(file, m, "emissiveColor", vec3(1)));
    } else {
      appearance.base_color = linear_from_srgb(vec3_of(file, m, "diffuseColor", vec3(0.8f)));
      appearance.emission = linear_from_srgb(emissive);
      // Blinn-Phong's exponent 128 * shininess becomes a GGX roughness, as far as there is a
      // highlight at all.
      float exponent = 128 * glm::clamp(float_of(file, m, "shininess", 0.2f), 0.0f, 1.0f);
      float shiny = std::sqrt(std::sqrt(2 / (exponent + 2)));
      float highlight =
          glm::clamp(2 * max_component(vec3_of(file, m, "specularColor", vec3(0))), 0.0f, 1.0f);
      appearance.roughness = glm::mix(0.9f, shiny, highlight);
      int diffuse = find_child(file, m, "diffuseTexture", {});
      if (diffuse >= 0) picture = diffuse;
      appearance.double_sided = m.type == "TwoSidedMaterial";
      appearance.normal_texture = picture_of(file, m, "normalTexture");
      appearance.normal_scale = glm::clamp(float_of(file, m, "normalScale", 1), 0.0f, 100.0f);
      appearance.emission_texture = picture_of(file, m, "emissiveTexture");
      for (const char* other : {"specularTexture", "shininessTexture", "ambientTexture"})
        if (find_child(file, m, other, {}) >= 0)
          warn_once(file.warnings, std::string(other) + " of a Material is not used");
    }
  }
  if (picture >= 0) {
    const X3dNode& p = file.nodes[size_t(picture)];
    if (p.type == "ImageTexture") {
      appearance.texture = find_picture(file, p);
      // A texture takes the place of the older Material's colour (X3D 4, 17.2.2.3).
      bool physical = material >= 0 && file.nodes[size_t(material)].type == "PhysicalMaterial";
      covered = !appearance.texture.empty() && !physical;
      if (covered) appearance.base_color = vec3(1);
    } else {
      warn_once(file.warnings, "texture of type " + p.type + " is not used");
    }
  }
  int transform = find_child(file, node, "textureTransform", {"TextureTransform"});
  if (transform >= 0 && file.nodes[size_t(transform)].type == "TextureTransform")
    result.uv_transform = texture_transform(file, file.nodes[size_t(transform)]);
  use_colors(file, appearance, glows, covered, colors);
  return result;
}

namespace {

// Gathers skinCoordIndex/skinCoordWeight of all joints by point, normalised.
SkinPoints read_weights(X3dFile& file, const std::vector<int>& joint_node, int coordinate,
                        size_t count) {
  struct Entry {
    uint32_t point;
    JointWeight weight;
  };
  std::vector<Entry> entries;
  size_t outside = 0, negative = 0, unequal = 0;
  for (size_t j = 0; j < joint_node.size(); j++) {
    const X3dNode& node = file.nodes[size_t(joint_node[j])];
    std::vector<int> index = ints_of(file, node, "skinCoordIndex");
    std::vector<float> weight = floats_of(file, node, "skinCoordWeight");
    unequal += index.size() != weight.size();
    for (size_t i = 0; i < index.size(); i++) {
      float w = i < weight.size() ? weight[i] : 1;
      if (index[i] < 0 || size_t(index[i]) >= count) outside++;
      else if (w < 0) negative++;
      else if (w > 0) entries.push_back({uint32_t(index[i]), {uint16_t(j), w}});
    }
  }
  auto say = [&](size_t n, const char* what) {
    if (n) warn_once(file.warnings, std::to_string(n) + what);
  };
  say(outside, " entries of skinCoordIndex are out of range, left out");
  say(negative, " skin weights are negative, left out");
  say(unequal, " joints have skinCoordIndex and skinCoordWeight of different length");

  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.point < b.point; });
  SkinPoints skin;
  skin.coordinate = coordinate;
  skin.count = count;
  skin.first.reserve(count + 1);
  size_t without = 0, off = 0, next = 0;
  for (size_t p = 0; p < count; p++) {
    skin.first.push_back(uint32_t(skin.weights.size()));
    float sum = 0;
    size_t begin = skin.weights.size();
    for (; next < entries.size() && entries[next].point == p; next++) {
      sum += entries[next].weight.weight;
      JointWeight* same = nullptr;
      for (size_t k = begin; k < skin.weights.size(); k++)
        if (skin.weights[k].joint == entries[next].weight.joint) same = &skin.weights[k];
      if (same) same->weight += entries[next].weight.weight;
      else skin.weights.push_back(entries[next].weight);
    }
    if (!(sum > 1e-6f) || !std::isfinite(sum)) {
      skin.weights.resize(begin);
      skin.weights.push_back({0, 1});
      without++;
      continue;
    }
    off += std::abs(sum - 1) > 0.02f;
    for (size_t k = begin; k < skin.weights.size(); k++) skin.weights[k].weight /= sum;
  }
  skin.first.push_back(uint32_t(skin.weights.size()));
  say(without, " points of the skin have no weight: they follow the root joint");
  say(off, " points of the skin have weights that do not sum to 1: made so");
  return skin;
}

vec3 safe_normal(const mat4& matrix, vec3 normal) {
  vec3 a(matrix[0]), b(matrix[1]), c(matrix[2]);
  vec3 n = cross(b, c) * normal.x + cross(c, a) * normal.y + cross(a, b) * normal.z;  // cofactors
  if (dot(cross(a, b), c) < 0) n = -n;
  float length = glm::length(n);
  return length > 1e-30f && std::isfinite(length) ? n / length : normal;
}

}  // namespace

void HumanoidReader::add_shape(int shape, const mat4& matrix, int joint, const SkinPoints* skin) {
  const X3dNode& node = file.nodes[size_t(shape)];
  int geometry = -1;
  for (const X3dChild& child : node.children) {
    const std::string& type = file.nodes[size_t(child.node)].type;
    if (child.field == "geometry" ||
        (child.field.empty() && type != "Appearance" && type.rfind("Metadata", 0) != 0))
      geometry = child.node;
  }
  if (geometry < 0) return;
  if (joint < 0 && !skin) {
    warn_once(file.warnings, where(node) + ": a shape of no joint follows the root");
    joint = 0;
  }
  // A shape may be used very often, so the sum of all that is read is bounded.
  for (const X3dField& field : file.nodes[size_t(geometry)].fields) bytes_read += field.text.size();
  for (const X3dChild& child : file.nodes[size_t(geometry)].children)
    for (const X3dField& field : file.nodes[size_t(child.node)].fields)
      bytes_read += field.text.size();
  if (bytes_read > 4 * x3d_max_bytes)
    throw LoadError(file.path, where(node), "shapes used over and over are too large in all");
  X3dMesh mesh = make_x3d_mesh(file, geometry);
  if (mesh.triangles.empty()) return;
  uint32_t first = uint32_t(character.positions.size());
  if (first + mesh.point_of.size() > max_vertices)
    throw LoadError(file.path, where(node),
                    "more than " + std::to_string(max_vertices) + " vertices");
  int appearance_node = find_child(file, node, "appearance", {"Appearance"});
  X3dAppearance appearance = make_x3d_appearance(file, appearance_node, mesh.colors);
  const int colored = mesh.colors.empty() ? 0 : appearance.appearance.clear_colors ? 2 : 1;
  auto [place, added] = appearances.emplace(std::tuple(appearance_node, colored, mesh.solid),
                                            int(character.appearances.size()));
  if (colored) character.colors.resize(character.positions.size(), vec4(1));
  if (added) {
    appearance.appearance.double_sided = appearance.appearance.double_sided || !mesh.solid;
    character.appearances.push_back(appearance.appearance);
  }
  Part part{.name = node.def.empty() ? appearance.appearance.name : node.def,
            .appearance = place->second,
            .triangles = {}};
  if (!character.segments.empty() && !skin && node.def.empty())
    part.name = character.segments.back().name;

  for (size_t v = 0; v < mesh.point_of.size(); v++) {
    uint32_t point = mesh.point_of[v];
    mat4 to_rest = matrix;
    if (skin) {
      mat4 blended(0);
      for (uint32_t k = skin->first[point]; k < skin->first[point + 1]; k++) {
        blended += rest[skin->weights[k].joint] * skin->weights[k].weight;
        character.weights.push_back(skin->weights[k]);
      }
      to_rest = blended * matrix;
    } else {
      character.weights.push_back({uint16_t(joint), 1});
    }
    vec3 position(to_rest * vec4(mesh.points[point], 1));
    if (!is_finite(position))
      throw LoadError(file.path, where(node), "a point lies beyond all numbers");
    character.positions.push_back(position);
    character.normals.push_back(safe_normal(to_rest, mesh.normals[v]));
    vec3 uv = appearance.uv_transform * vec3(mesh.uv[v], 1);
    character.uv.push_back({uv.x, 1 - uv.y});
    if (colored) character.colors.push_back(mesh.colors[v]);
    character.first_weight.push_back(uint32_t(character.weights.size()));
  }
  bool mirrored = glm::determinant(skin ? root * matrix : matrix) < 0;
  part.triangles.reserve(mesh.triangles.size());
  for (uvec3 t : mesh.triangles) {
    if (mirrored) std::swap(t.y, t.z);
    part.triangles.push_back(t + first);
  }
  if (!character.colors.empty()) character.colors.resize(character.positions.size(), vec4(1));
  character.parts.push_back(std::move(part));
  placed.push_back({mesh.coordinate, first, std::move(mesh.point_of), mesh.points.size(), matrix});
}

void HumanoidReader::add_displacers(int index, const mat4& direction, int coordinate) {
  const std::vector<X3dChild> children = file.nodes[size_t(index)].children;
  for (const X3dChild& child : children) {
    const X3dNode& node = file.nodes[size_t(child.node)];
    if (node.type != "HAnimDisplacer") continue;
    Displacer displacer;
    displacer.name = string_of(node, "name");
    if (displacer.name.empty()) displacer.name = node.def;
    std::vector<int> points = ints_of(file, node, "coordIndex");
    std::vector<vec3> moves = points_of(file, node, "displacements");
    if (points.size() != moves.size())
      warn_once(file.warnings, where(node) + ": " + std::to_string(points.size()) +
                                   " indices but " + std::to_string(moves.size()) +
                                   " displacements");
    std::map<uint32_t, vec3> by_point;
    size_t outside = 0, point_count = 0;
    for (const Placed& place : placed)
      if (place.coordinate == coordinate) point_count = std::max(point_count, place.point_count);
    for (size_t i = 0; i < std::min(points.size(), moves.size()); i++) {
      if (points[i] < 0 || size_t(points[i]) >= point_count) outside++;
      else by_point[uint32_t(points[i])] += moves[i];
    }
    if (outside)
      warn_once(file.warnings,
                where(node) + ": " + std::to_string(outside) + " indices out of range, left out");
    for (const Placed& place : placed) {
      if (place.coordinate != coordinate) continue;
      mat3 turn = mat3(direction) * mat3(place.matrix);
      for (size_t v = 0; v < place.point_of.size(); v++) {
        auto found = by_point.find(place.point_of[v]);
        if (found == by_point.end()) continue;
        displacer.vertices.push_back(place.first_vertex + uint32_t(v));
        displacer.displacements.push_back(turn * found->second);
      }
    }
    if (float_of(file, node, "weight", 0) != 0)
      warn_once(file.warnings, where(node) + ": the weight written in the file is not used");
    int same = find_displacer(character, displacer.name);
    if (same >= 0) {  // one control on several surfaces or joints
      Displacer& other = character.displacers[size_t(same)];
      other.vertices.insert(other.vertices.end(), displacer.vertices.begin(),
                            displacer.vertices.end());
      other.displacements.insert(other.displacements.end(), displacer.displacements.begin(),
                                 displacer.displacements.end());
    } else {
      character.displacers.push_back(std::move(displacer));
    }
  }
}

void HumanoidReader::read_skin(int humanoid) {
  const X3dNode& node = file.nodes[size_t(humanoid)];
  std::vector<std::pair<int, mat4>> shapes, open;
  for (const X3dChild& child : node.children) {
    const std::string& type = file.nodes[size_t(child.node)].type;
    bool skin = child.field == "skin" ||
                ((child.field.empty() || child.field == "children") && type == "Shape");
    if (skin) open.push_back({child.node, mat4(1)});
  }
  for (int guard = 0; !open.empty(); guard++) {
    if (guard > 100'000) throw LoadError(file.path, where(node), "the skin has too many parts");
    auto [index, matrix] = open.front();
    open.erase(open.begin());
    const X3dNode& part = file.nodes[size_t(index)];
    if (part.type == "Shape") {
      if (bool_of(part, "visible", true)) shapes.push_back({index, matrix});
      continue;
    }
    if (!is_x3d_group(part.type)) continue;
    if (part.type == "Transform") matrix = matrix * transform_of(file, part);
    for (int child : shown_children(file, part)) open.push_back({child, matrix});
  }
  auto coordinate_of = [&](int shape) {
    int geometry =
        find_child(file, file.nodes[size_t(shape)], "geometry",
                   {"IndexedFaceSet", "IndexedTriangleSet", "TriangleSet",
                    "IndexedTriangleStripSet", "IndexedTriangleFanSet", "IndexedQuadSet"});
    return geometry < 0 ? -1
                        : find_child(file, file.nodes[size_t(geometry)], "coord",
                                     {"Coordinate", "CoordinateDouble"});
  };
  int skin_coordinate = find_child(file, node, "skinCoord", {"Coordinate", "CoordinateDouble"});
  bool has_weights = false;
  for (int j : joint_node)
    has_weights = has_weights || find_field(file.nodes[size_t(j)], "skinCoordIndex");
  if (skin_coordinate < 0 && has_weights && !shapes.empty()) {
    skin_coordinate = coordinate_of(shapes[0].first);
    warn_once(file.warnings, "the humanoid has no skinCoord: the first skin's Coordinate is taken");
  }
  placed.clear();
  SkinPoints skin;
  if (skin_coordinate >= 0) {
    size_t count = points_of(file, file.nodes[size_t(skin_coordinate)], "point").size();
    skin = read_weights(file, joint_node, skin_coordinate, count);
  }
  for (auto& [shape, matrix] : shapes) {
    int coordinate = coordinate_of(shape);
    bool fits = coordinate >= 0 && coordinate == skin_coordinate;
    if (!fits && coordinate >= 0 && skin_coordinate >= 0) {
      size_t count = points_of(file, file.nodes[size_t(coordinate)], "point").size();
      fits = count == skin.count;
      if (fits)
        warn_once(file.warnings,
                  "the skin's Coordinate is not the skinCoord node but as long: taken as it");
    }
    if (fits) {
      add_shape(shape, matrix, -1, &skin);
    } else {
      const size_t parts = character.parts.size();
      add_shape(shape, rest[0] * matrix, 0, nullptr);
      if (character.parts.size() > parts)
        warn_once(file.warnings, where(file.nodes[size_t(shape)]) +
                                     ": skin without skinCoord follows the root joint");
    }
  }
  // Joint displacers move the skin, in the joint's coordinates.
  std::vector<Placed> skin_places = std::move(placed);
  for (Placed& place : skin_places) place.coordinate = skin_coordinate, place.matrix = mat4(1);
  placed = std::move(skin_places);
  for (size_t j = 0; j < joint_node.size(); j++) {
    bool has = false;
    for (const X3dChild& child : file.nodes[size_t(joint_node[j])].children)
      has = has || file.nodes[size_t(child.node)].type == "HAnimDisplacer";
    if (has) add_displacers(joint_node[j], rest[j], skin_coordinate);
  }
}

}  // namespace wellspring::avatar
