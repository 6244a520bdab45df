// SPDX-License-Identifier: Apache-2.0
#include "world/load/credit.h"

#include <filesystem>

#include "base/layers.h"
#include "gltf/file.h"

namespace wellspring::world {

using namespace gltf;

Credit load_credit(const std::string& path, const std::string& package) {
  File file = load_gltf(path, package);
  Credit credit;
  credit.file = std::filesystem::path(path).filename().string();
  const json& asset = file.root["asset"];
  credit.copyright = text(asset, "copyright");
  const json* extras = find(asset, "extras");
  if (!extras || !extras->is_object()) return credit;
  // Extras may hold anything: what is no text is passed over.
  auto read = [&](const char* key) {
    const json* value = find(*extras, key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
  };
  credit.title = read("title");
  credit.author = read("author");
  credit.licence = read("license");
  if (credit.licence.empty()) credit.licence = read("licence");
  credit.source = read("source");
  return credit;
}

}  // namespace wellspring::world
