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

std::unique_ptr<FaceFinder> make_face_finder(const FaceSettings& settings) {
  const std::string folder = weights_folder(settings);
  try {
    if (!folder.empty() && std::filesystem::exists(folder)) {
      auto finder = make_network_finder(folder);
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
