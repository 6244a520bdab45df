// SPDX-License-Identifier: Apache-2.0
#include "show/moving/figure.h"

#include <map>

#include "avatar/face/expression_rules.h"
#include "avatar/load/vrm_extension.h"
#include "base/load_error.h"
#include "base/read_file.h"
#include "gltf/file.h"
#include "world/load/gltf_material.h"
#include "world/load/scene_join.h"
#include "world/mesh_finish.h"
#include "world/texture.h"

namespace wellspring::show {
namespace {

// Index of the scene's texture for a picture file; -1 where it cannot be read.
int add_picture(Scene& scene, const std::string& path, bool srgb, int64_t& texels_left) {
  Image image;
  std::string problem;
  try {
    const auto bytes = read_file<std::vector<uint8_t>>(path, file_bytes_limit);
    problem = decode_image(bytes, srgb, image, texels_left);
  } catch (const LoadError& error) {
    problem = error.what_;
  }
  if (!problem.empty()) {
    scene.warnings.push_back(path + ": " + problem);
    return -1;
  }
  image.name = path;
  scene.images.push_back(std::move(image));
  scene.textures.push_back({.image = int(scene.images.size()) - 1});
  return int(scene.textures.size()) - 1;
}

// The pictures of a figure that has them as files, each read once for each of its meanings.
struct Pictures {
  Scene& scene;
  std::map<std::pair<std::string, bool>, int> known;
  int64_t texels_left = image_texel_limit;

  TextureRef find(const std::string& path, bool srgb) {
    TextureRef reference;
    if (path.empty()) return reference;
    auto [place, added] = known.emplace(std::pair(path, srgb), -1);
    if (added) place->second = add_picture(scene, path, srgb, texels_left);
    reference.texture = place->second;
    return reference;
  }
};

Material make_material(const Appearance& appearance, Pictures& pictures) {
  Material material;
  material.name = appearance.name;
  material.base_color = vec4(appearance.base_color, appearance.alpha);
  material.base_color_texture = pictures.find(appearance.texture, true);
  material.normal_texture = pictures.find(appearance.normal_texture, false);
  material.normal_scale = appearance.normal_scale;
  material.metallic_roughness_texture = pictures.find(appearance.metallic_roughness_texture, false);
  material.emission_texture = pictures.find(appearance.emission_texture, true);
  material.metallic = appearance.metallic;
  material.roughness = appearance.roughness;
  material.emission = appearance.emission;
  const bool clear = appearance.alpha < 1 || appearance.clear_colors;
  material.alpha_mode = clear ? AlphaMode::blend : AlphaMode::opaque;
  material.double_sided = appearance.double_sided;
  return material;
}

// The materials of the character's glTF file, appended to the scene; index of the first, -1 where
// there is no such file.
int add_file_materials(Scene& scene, const std::string& path) {
  if (path.empty()) return -1;
  Scene own;
  gltf::File file = gltf::load_gltf(path, "", vrm_extensions());
  rewrite_vrm_materials(file);
  file.pictures_may_fail = true;
  world::load_materials(file, own);
  for (const std::string& warning : file.warnings)
    if (warning.rfind("/images", 0) == 0 || warning.rfind("/textures", 0) == 0)
      scene.warnings.push_back(path + ": " + warning);
  return add_materials(scene, own);
}

// Cartoon shading has no gloss; its colours are those of a Lambertian surface.
void make_lambert(Material& material) {
  material.unlit = false;
  material.metallic = 0;
  material.roughness = 1;
  material.specular = 0.25f;
  material.metallic_roughness_texture = {};
}

// Looks that expressions change, where they have changed.
void paint_figure(World& world, Figure& figure, const Character& character, const Pose& pose) {
  if (figure.paints.empty()) return;
  eval_appearance_changes(character, pose, figure.appearance_changes);
  for (FigurePaint& paint : figure.paints) {
    const AppearanceChange& sum = figure.appearance_changes[size_t(paint.appearance)];
    Repaint change{sum.base_color, sum.emission, sum.uv};
    if (change == paint.change) continue;
    paint.change = change;
    world.repaint(paint.material, change);
  }
}

}  // namespace

Figure make_figure(const Character& character, Scene& scene, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object) {
  Figure figure;
  if (scene.objects.empty()) scene.objects.push_back("");
  figure.object = uint32_t(scene.objects.size());
  scene.objects.push_back(character.name.empty() ? "storyteller" : character.name);

  Pictures pictures{scene, {}};
  int first_of_file = add_file_materials(scene, character.material_file);
  int first_material = int(scene.materials.size());
  for (const Appearance& appearance : character.appearances) {
    if (appearance.material >= 0 && first_of_file >= 0) {
      scene.materials.push_back(scene.materials[size_t(first_of_file + appearance.material)]);
      if (appearance.lambertian) make_lambert(scene.materials.back());
      continue;
    }
    scene.materials.push_back(make_material(appearance, pictures));
  }

  std::vector<char> changes(character.appearances.size(), 0);
  for (const AppearanceChange& change : character.appearance_changes)
    changes[size_t(change.appearance)] = 1;
  constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> place_of(character.positions.size(), none);
  for (const Part& part : character.parts) {
    FigurePart made;
    made.moving = int(moving.size());
    Mesh mesh;
    mesh.name = part.name;
    mesh.material = first_material + part.appearance;
    if (changes[size_t(part.appearance)] && !scene.materials[size_t(mesh.material)].repaints) {
      scene.materials[size_t(mesh.material)].repaints = true;
      figure.paints.push_back({part.appearance, mesh.material, {}});
    }
    for (uvec3 t : part.triangles) {
      uvec3 local;
      for (int c = 0; c < 3; c++) {
        uint32_t& place = place_of[t[c]];
        if (place == none) {
          place = uint32_t(made.vertices.size());
          made.vertices.push_back(t[c]);
          mesh.positions.push_back(character.positions[t[c]]);
          mesh.normals.push_back(character.normals[t[c]]);
          if (!character.uv.empty()) mesh.uv[0].push_back(character.uv[t[c]]);
          if (!character.second_uv.empty()) mesh.uv[1].push_back(character.second_uv[t[c]]);
          if (!character.colors.empty()) mesh.colors.push_back(character.colors[t[c]]);
        }
        local[c] = place;
      }
      mesh.triangles.push_back(local);
    }
    for (uint32_t v : made.vertices) place_of[v] = none;
    // Maps of normals need tangents, and vertices split where a picture is mirrored.
    int uv = tangent_uv(scene.materials[size_t(mesh.material)]);
    if (uv >= 0 && !mesh.uv[uv].empty()) {
      std::vector<uint32_t> vertices;
      for (uint32_t from : make_tangents(mesh, uv)) vertices.push_back(made.vertices[from]);
      made.vertices = std::move(vertices);
    }
    moving.push_back(std::move(mesh));
    moving_object.push_back(figure.object);
    figure.parts.push_back(std::move(made));
  }
  return figure;
}

void pose_figure(World& world, Figure& figure, const Character& character, const Pose& pose,
                 const mat4& placement, SkinScratch& scratch) {
  skin(character, pose, placement, scratch, figure.positions, figure.normals);
  paint_figure(world, figure, character, pose);
  for (const FigurePart& part : figure.parts) {
    figure.part_positions.resize(part.vertices.size());
    figure.part_normals.resize(part.vertices.size());
    for (size_t i = 0; i < part.vertices.size(); i++) {
      figure.part_positions[i] = figure.positions[part.vertices[i]];
      figure.part_normals[i] = figure.normals[part.vertices[i]];
    }
    world.move(part.moving, figure.part_positions, figure.part_normals);
  }
}

void show_figure(World& world, const Figure& figure, bool visible) {
  for (const FigurePart& part : figure.parts) world.show(part.moving, visible);
}

}  // namespace wellspring::show
