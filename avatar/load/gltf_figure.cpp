// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/gltf_figure.h"

#include <algorithm>
#include <filesystem>

#include "avatar/figure/face_names.h"
#include "avatar/figure/figure_check.h"
#include "avatar/figure/hanim_names.h"

namespace wellspring::avatar {
namespace {

// A figure brings no light and no eye of its own.
void note_left_out(gltf::File& file) {
  auto note = [&](size_t count, const char* where, const char* what) {
    if (count > 0)
      gltf::warn(file, where, "left out, as a figure has none: " + std::to_string(count) + what);
  };
  note(gltf::items(file.root, "cameras").size(), "/cameras", " camera(s)");
  if (const auto* lights = gltf::extension(file.root, "KHR_lights_punctual"))
    note(gltf::items(*lights, "lights").size(), "/extensions/KHR_lights_punctual", " light(s)");
}

}  // namespace

Character character_from_gltf(const std::string& path) {
  GltfFigure figure;
  figure.file = gltf::load_gltf(path, "", vrm_extensions());
  figure.vrm = read_vrm(figure.file);
  figure.nodes = gltf::make_pose(figure.file, 0);
  Character& character = figure.character;
  character.first_weight = {0};
  character.material_file = path;
  character.eye_ranges = figure.vrm.eye_ranges;
  character.metadata = figure.vrm.metadata;
  for (const auto& [key, value] : character.metadata)
    if (key == "title" || (key == "name" && character.name.empty())) character.name = value;
  if (character.name.empty()) character.name = std::filesystem::path(path).stem().string();
  read_gltf_joints(figure);
  read_gltf_surfaces(figure);
  read_gltf_expressions(figure);
  read_gltf_constraints(figure);
  read_gltf_springs(figure);
  read_gltf_motions(figure);
  std::vector<std::string_view> names;
  for (const Joint& joint : character.joints) names.push_back(joint.name);
  character.loa = level_of_articulation(names);
  if (character.parts.empty())
    gltf::warn(figure.file, "",
               figure.vrm.animation ? "a motion without a figure" : "the figure has no surface");
  note_left_out(figure.file);
  for (std::string& warning : figure.file.warnings)
    character.warnings.push_back(std::move(warning));
  complete_face(character);
  check_figure(character);
  return std::move(character);
}

}  // namespace wellspring::avatar
