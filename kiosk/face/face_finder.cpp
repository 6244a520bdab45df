// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/face_finder.h"

#include <cstdlib>
#include <filesystem>

#include "base/load_error.h"
#include "base/log.h"

namespace wellspring::kiosk {

std::string weights_folder(const FaceSettings& settings) {
  if (!settings.weights.empty()) return settings.weights;
  const char* set = std::getenv("WELLSPRING_WEIGHTS");
  return set ? (std::filesystem::path(set) / "face").string() : "";
}

std::string graphs_folder(const FaceSettings& settings) {
  if (!settings.graphs.empty()) return settings.graphs;
  const std::filesystem::path weights = weights_folder(settings);
  return weights.empty() ? "" : (weights.parent_path() / "human").string();
}

namespace {

std::optional<MeshReader> open_meshes(const std::string& folder) {
  try {
    return MeshReader(folder);
  } catch (const LoadError& error) {
    log::warn("no fine faces: {}", error.what());
    return {};
  }
}

}  // namespace

std::unique_ptr<FaceFinder> make_face_finder(const FaceSettings& settings) {
  const std::string folder = weights_folder(settings);
  try {
    if (!folder.empty() && std::filesystem::exists(folder)) {
      auto finder = make_network_finder(folder, open_meshes(graphs_folder(settings)));
      log::info("faces by networks, weights of {}", folder);
      return finder;
    }
    log::info("faces by cascades: no weights of networks in '{}'", folder);
  } catch (const LoadError& error) {
    log::warn("faces by cascades: {}", error.what());
  }
  return make_cascade_finder(settings);
}

}  // namespace wellspring::kiosk
