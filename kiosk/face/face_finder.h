// SPDX-License-Identifier: Apache-2.0
// The detectors, and which of them runs.
#pragma once
#include <memory>
#include <string>

#include "kiosk/face/face.h"

namespace wellspring::kiosk {

// Where the networks' weights should be; empty: nobody says.
std::string weights_folder(const FaceSettings& settings);

// By networks where all their weights can be read, else by cascades. The log says which, and why.
// Throws LoadError when a cascade is missing too.
std::unique_ptr<FaceFinder> make_face_finder(const FaceSettings& settings);

// Throws LoadError naming the file with what is wrong in it.
std::unique_ptr<FaceFinder> make_network_finder(const std::string& folder);
// Throws LoadError naming the cascade's path and the package that brings it.
std::unique_ptr<FaceFinder> make_cascade_finder(const FaceSettings& settings = {});

}  // namespace wellspring::kiosk
