// SPDX-License-Identifier: Apache-2.0
#include "show/scanner/scanner_file.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/rng.h"
#include "show/exhibit/exhibit_files.h"

namespace wellspring::show {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t scanner_version = 1;  // changes when the same file gives other points
constexpr size_t most_stations = 200, most_scene_bytes = size_t(1) << 30;
constexpr double most_shift = 1000, most_turn = 600;  // millimetres, minutes of arc

void read_station(FieldReader& fields, ScannerStation& station) {
  fields.text("name", station.name, "for people");
  fields.vector("position", most_metres, station.position, "of its mirror", Need::required);
  vec3 shift(0);
  fields.vector("shift_mm", most_shift, shift, "by which all that it measured lies off");
  station.shift = shift / 1000.0f;
  float minutes = 0;
  fields.number("turn_arcmin", -most_turn, most_turn, minutes, "by which it is turned");
  station.turn = minutes / 60 * pi / 180;
}

uint64_t hash_file(const std::string& path, uint64_t hash) {
  for (const char byte : read_file(path, most_scene_bytes)) hash = mix64(hash ^ uint8_t(byte));
  return hash;
}

}  // namespace

ScannerFile read_scanner_file(const std::string& path, std::vector<Problem>& problems) {
  ScannerFile scanner;
  scanner.file = path;
  read_fields(path, problems, [&](FieldReader& fields) {
    std::string scene;
    fields.text("scene", scene, "a glTF file", Need::required);
    scanner.scene = package_file(fields, "scene", fs::path(path).parent_path().string(), scene);
    fields.integer("points", 1000, 2e9, scanner.points, "of the whole scan, about", Need::required);
    fields.u32("seed", scanner.seed, "of its noise");
    float noise = 1000 * scanner.noise;
    fields.number("noise_mm", 0, 100, noise, "standard deviation of a distance");
    scanner.noise = noise / 1000;
    fields.number("range_m", 1, 1000, scanner.range, "beyond which nothing comes back");
    fields.number("shade", 0, 1, scanner.shade, "share of an overcast sky's light in the colours");
    fields.parts(
        "stations", most_stations, "where it stood",
        [&](FieldReader& one) { read_station(one, scanner.stations.emplace_back()); },
        Need::required);
    if (scanner.stations.empty()) fields.fail("stations", "must name at least one station");
  });
  try {
    scanner.key = hash_file(path, scanner_version);
    if (!scanner.scene.empty()) scanner.key = hash_file(scanner.scene, scanner.key);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  }
  return scanner;
}

std::string scanned_name(const ScannerFile& scanner, uint64_t most_points) {
  std::string name = fs::path(scanner.file).filename().string();
  if (name.ends_with(scanner_ending)) name.resize(name.size() - scanner_ending.size());
  const uint64_t points = std::min(most_points, scanner.points);
  return fmt::format("{}-{:08x}.points", name, mix64(scanner.key ^ points) >> 32);
}

}  // namespace wellspring::show
