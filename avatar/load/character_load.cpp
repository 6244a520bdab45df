// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/character_load.h"

#include <algorithm>

#include "avatar/load/bvh_load.h"
#include "avatar/load/gltf_figure.h"
#include "avatar/load/x3d_humanoid.h"
#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::avatar {
namespace {

// Returns whether this is a GLB container, or JSON whose first word is not X3D's and that has
// glTF's "asset".
bool is_gltf(const std::string& text) {
  if (text.compare(0, 4, "glTF") == 0) return true;
  size_t brace = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (brace == std::string::npos || text[brace] != '{') return false;
  size_t word = text.find_first_not_of(" \t\r\n", brace + 1);
  return word != std::string::npos && text.compare(word, 5, "\"X3D\"") != 0 &&
         text.find("\"asset\"") != std::string::npos;
}

}  // namespace

Character load_character(const std::string& path) {
  std::string text = read_file(path, x3d_max_bytes);
  if (text.empty()) throw LoadError(path, "", "is empty");
  if (is_bvh(text)) return character_from_bvh(path, text);
  if (is_gltf(text)) return character_from_gltf(path);
  if (text.size() > 2 && text[0] == '\x1f' && text[1] == '\x8b')
    throw LoadError(path, "", "is compressed with gzip: unpack it first");
  X3dFile file = parse_x3d(path, text);
  text = std::string();
  return character_from_x3d(file);
}

int find_joint(const Character& character, std::string_view name) {
  for (size_t i = 0; i < character.joints.size(); i++)
    if (character.joints[i].name == name) return int(i);
  return -1;
}

int find_displacer(const Character& character, std::string_view name) {
  for (size_t i = 0; i < character.displacers.size(); i++)
    if (character.displacers[i].name == name) return int(i);
  return -1;
}

}  // namespace wellspring::avatar
