// SPDX-License-Identifier: Apache-2.0
#include "world/load/scene_files.h"

#include <algorithm>

#include "base/layers.h"
#include "gltf/uri.h"

namespace wellspring::world {

using namespace gltf;

std::vector<std::string> list_scene_files(const std::string& path) {
  File file = load_gltf(path, "");
  std::vector<std::string> names;
  for (const char* kind : {"buffers", "images"}) {
    const json& list = items(file.root, kind);
    for (size_t i = 0; i < list.size(); i++) {
      const std::string uri = text(list[i], "uri"), where = at(std::string("/") + kind, i);
      if (uri.empty() || is_data_uri(uri)) continue;
      const auto found = find_uri(file, where, uri);
      if (!found) continue;
      const std::string name = found->lexically_relative(file.package).string();
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

}  // namespace wellspring::world
