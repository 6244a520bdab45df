// SPDX-License-Identifier: Apache-2.0
// Reads the description of a scan that is made of a scene: which one, and where the scanner stood.
#pragma once
#include <string>
#include <vector>

#include "show/exhibit/json_fields.h"

namespace wellspring::show {

inline constexpr std::string_view scanner_ending = ".scanner.json";

struct ScannerStation {
  std::string name;
  dvec3 position{0};  // its mirror's, metres, in the scene's coordinates
  // Somebody moved the tripod: all that it measured lies off by this, metres and radians about +Y.
  vec3 shift{0};
  float turn = 0;
};

struct ScannerFile {
  std::string file, scene;  // paths
  uint64_t points = 0;      // about as many the whole scan has
  uint32_t seed = 1;
  float noise = 0.002f;  // metres, standard deviation of a distance, seen squarely
  float range = 80;      // metres; what is farther sends nothing back
  float shade = 0;       // share of an overcast sky's light in the colours; 0: reflectance alone
  std::vector<ScannerStation> stations;
  uint64_t key = 0;  // hash of all bytes that the scan is made of
};

// Reads a .scanner.json. Its scene must lie in its folder or below. Problems name file and place.
ScannerFile read_scanner_file(const std::string& path, std::vector<Problem>& problems);

// Returns the path, with this ending, of the tree of points of a scan of so many points: it has
// another name when anything has changed that it was made of.
std::string scanned_name(const ScannerFile& scanner, uint64_t most_points);

}  // namespace wellspring::show
