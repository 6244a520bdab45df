// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_appearance.h"

#include <filesystem>

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

// The first picture of `url` that lies beside the file or below it.
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

// Path of the picture that `field` names; empty: none.
std::string picture_of(X3dFile& file, const X3dNode& material, const char* field) {
  int picture = find_child(file, material, field, {});
  if (picture < 0) return "";
  const X3dNode& node = file.nodes[size_t(picture)];
  if (node.type == "ImageTexture") return find_picture(file, node);
  warn_once(file.warnings, "texture of type " + node.type + " is not used");
  return "";
}

// Vertex colours in place of the material's.
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
  appearance.alpha = 1;  // that of the colours counts (X3D 4, 17.2.2.3)
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
      // Blinn-Phong exponent 128 * shininess as a GGX roughness, as far as there is a highlight at
      // all.
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

}  // namespace wellspring::avatar
