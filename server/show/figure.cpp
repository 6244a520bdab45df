// SPDX-License-Identifier: Apache-2.0
#include "show/figure.h"

#include <fstream>
#include <iterator>
#include <map>

#include "world/gltf_image.h"

namespace wellspring {
namespace {

// Index of the scene's texture for a picture file; -1 where it cannot be read.
int add_picture(Scene& scene, const std::string& path, int64_t& texels_left) {
  std::ifstream file(path, std::ios::binary);
  std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  Image image;
  std::string problem =
      file.is_open() ? decode_image(bytes, true, image, texels_left) : "cannot be read";
  if (!problem.empty()) {
    scene.warnings.push_back(path + ": " + problem);
    return -1;
  }
  image.name = path;
  scene.images.push_back(std::move(image));
  scene.textures.push_back({.image = int(scene.images.size()) - 1});
  return int(scene.textures.size()) - 1;
}

Material make_material(const Look& look, int texture) {
  Material material;
  material.name = look.name;
  material.base_color = vec4(look.base_color, look.alpha);
  material.base_color_texture.texture = texture;
  material.metallic = look.metallic;
  material.roughness = look.roughness;
  material.emission = look.emission;
  material.alpha_mode = look.alpha < 1 ? AlphaMode::blend : AlphaMode::opaque;
  material.double_sided = look.double_sided;
  return material;
}

}  // namespace

Figure make_figure(const Character& character, Scene& scene, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object) {
  Figure figure;
  if (scene.objects.empty()) scene.objects.push_back("");
  figure.object = uint32_t(scene.objects.size());
  scene.objects.push_back(character.name.empty() ? "storyteller" : character.name);

  std::map<std::string, int> textures;
  int64_t texels_left = image_texel_limit;
  int first_material = int(scene.materials.size());
  for (const Look& look : character.looks) {
    int texture = -1;
    if (!look.texture.empty()) {
      auto [place, added] = textures.emplace(look.texture, -1);
      if (added) place->second = add_picture(scene, look.texture, texels_left);
      texture = place->second;
    }
    scene.materials.push_back(make_material(look, texture));
  }

  constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> place_of(character.positions.size(), none);
  for (const Part& part : character.parts) {
    FigurePart made;
    made.moving = int(moving.size());
    Mesh mesh;
    mesh.name = part.name;
    mesh.material = first_material + part.look;
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
        }
        local[c] = place;
      }
      mesh.triangles.push_back(local);
    }
    for (uint32_t v : made.vertices) place_of[v] = none;
    moving.push_back(std::move(mesh));
    moving_object.push_back(figure.object);
    figure.parts.push_back(std::move(made));
  }
  return figure;
}

void pose_figure(World& world, Figure& figure, const Character& character, const Pose& pose,
                 const mat4& placement, SkinScratch& scratch) {
  skin(character, pose, placement, scratch, figure.positions, figure.normals);
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

}  // namespace wellspring
