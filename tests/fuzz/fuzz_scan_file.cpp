// SPDX-License-Identifier: Apache-2.0
// Files of scanned points, and of Gaussian splats. The first byte chooses the file's name; pages of
// E57 are sealed with their checksums, or nothing else of them would be reached.
#include <cmath>

#include "fuzz/fuzz.h"
#include "scan/format/e57_pages.h"
#include "scan/format/open_scan.h"
#include "scan/splats/splat_file.h"

namespace wellspring::fuzz {
namespace {

constexpr const char* scan_names[] = {"scan.e57", "scan.ply",   "scan.pcd",    "scan.pts",
                                      "scan.csv", "scan.gltf",  "scan.glb",    "scan.spz",
                                      "scan.ply", "scan.splat", "scan.ksplat", "scan.xyz"};

std::vector<uint8_t> sealed(Bytes bytes) {
  std::vector<uint8_t> pages(bytes.begin(), bytes.end());
  for (size_t page = 0; page + 1024 <= pages.size(); page += 1024) {
    const uint32_t crc = scan::crc_32c(reinterpret_cast<const char*>(pages.data() + page), 1020);
    for (size_t i = 0; i < 4; i++) pages[page + 1020 + i] = uint8_t(crc >> (24 - 8 * i));
  }
  return pages;
}

void read_points(const std::string& file) {
  const std::unique_ptr<scan::PointSource> source = scan::open_scan(file);
  const scan::PointFields fields = source->info().fields;
  scan::PointBlock block;
  uint64_t points = 0;
  while (source->read(block, 1000)) {
    points += block.size();
    require(block.size() > 0 && block.size() <= 1000, "a block is as large as was asked for");
    for (const dvec3 place : block.place)
      require(std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z),
              "points are somewhere");
    const auto fits = [&](const auto& column, bool is_there) {
      require(column.size() == (is_there ? block.size() : 0), "columns are as long as places");
    };
    fits(block.color, fields.color), fits(block.intensity, fields.intensity);
    fits(block.normal, fields.normal), fits(block.time, fields.time);
    fits(block.classification, fields.classification);
  }
  require(!source->info().is_counted || points <= source->info().points, "no more than promised");
}

void read_splats(const std::string& file) {
  const scan::SplatSet set = scan::load_splats(file);
  const size_t count = set.size();
  require(set.scale.size() == count && set.turn.size() == count && set.opacity.size() == count &&
              set.color.size() == count &&
              set.harmonics.size() == count * size_t(scan::splat_harmonics[set.degree]),
          "columns are as long as places");
  for (size_t i = 0; i < count; i++) {
    require(is_finite(set.place[i]) && is_finite(set.color[i]), "splats are somewhere");
    require(std::abs(glm::length(set.turn[i]) - 1) < 1e-4f, "turns are unit");
    require(set.opacity[i] >= 0 && set.opacity[i] <= 1, "opacity is a share");
  }
}

}  // namespace

void fuzz_scan_file(Bytes bytes) {
  if (bytes.empty()) return;
  const size_t name = bytes[0] % std::size(scan_names);
  const std::string file = name == 0 ? write_file(scan_names[0], sealed(bytes.subspan(1)))
                                     : write_file(scan_names[name], bytes.subspan(1));
  load([&] {
    if (scan::holds_splats(file)) read_splats(file);
    else read_points(file);
  });
  std::error_code error;
  std::filesystem::remove(file, error);
}

}  // namespace wellspring::fuzz
