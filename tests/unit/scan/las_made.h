// SPDX-License-Identifier: Apache-2.0
// Makes LAS files in memory, and finds those of the shared data.
#pragma once
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scan/las/las_records.h"
#include "scan/points.h"

namespace wellspring::test {

// A text whose bytes are set as numbers.
template <class Value>
void put_at(std::string& bytes, size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

inline constexpr size_t made_record_bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct MadeLas {
  int minor = 2, format = 0;
  dvec3 scale{0.01}, offset{0};
  size_t extra_bytes = 0;
  std::vector<std::pair<int, std::string>> records;  // LASF_Projection's: number and content
  std::vector<glm::ivec3> places;

  size_t header_bytes() const { return minor >= 4 ? 375 : minor == 3 ? 235 : 227; }
  size_t record_bytes() const { return made_record_bytes[format] + extra_bytes; }
  size_t points_begin() const {
    size_t begin = header_bytes();
    for (const auto& [id, content] : records) begin += 54 + content.size();
    return begin;
  }

  // Point i has the intensity 1000 + i, the class i, the colour (i, 2 i, 3 i), the time i + 0.5.
  std::string bytes() const {
    std::string file(points_begin() + places.size() * record_bytes(), '\0');
    file.replace(0, 4, "LASF");
    file[24] = 1, file[25] = char(minor), file[104] = char(format);
    put_at(file, 94, uint16_t(header_bytes()));
    put_at(file, 96, uint32_t(points_begin()));
    put_at(file, 100, uint32_t(records.size()));
    put_at(file, 105, uint16_t(record_bytes()));
    if (minor >= 4) put_at(file, 247, uint64_t(places.size()));
    else put_at(file, 107, uint32_t(places.size()));
    for (int i = 0; i < 3; i++) {
      put_at(file, size_t(131 + 8 * i), scale[i]);
      put_at(file, size_t(155 + 8 * i), offset[i]);
    }
    size_t at = header_bytes();
    for (const auto& [id, content] : records) {
      file.replace(at + 2, 15, "LASF_Projection");
      put_at(file, at + 18, uint16_t(id));
      put_at(file, at + 20, uint16_t(content.size()));
      file.replace(at + 54, content.size(), content);
      at += 54 + content.size();
    }
    for (size_t i = 0; i < places.size(); i++) put_point(file, at + i * record_bytes(), i);
    return file;
  }

 private:
  void put_point(std::string& file, size_t at, size_t i) const {
    put_at(file, at, places[i]);
    put_at(file, at + 12, uint16_t(1000 + i));
    file[at + (format >= 6 ? 16 : 15)] = char(i);
    const int time = format >= 6 ? 22 : format == 1 || format >= 3 ? 20 : -1;
    const int after_time = format >= 6 ? 30 : format == 2 ? 20 : 28;
    const bool has_color =
        format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
    if (time > 0) put_at(file, at + size_t(time), double(i) + 0.5);
    for (size_t channel = 0; has_color && channel < 3; channel++)
      put_at(file, at + size_t(after_time) + 2 * channel, uint16_t((channel + 1) * i));
  }
};

// Returns the folder of scans in the shared data, or an empty path.
inline std::filesystem::path scans_folder() {
  const char* data = std::getenv("WELLSPRING_DATA");
  if (!data) return {};
  const std::filesystem::path folder = std::filesystem::path(data) / "10_exhibits" / "scans";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

// Reads all points of a source, so many at once.
inline scan::PointBlock read_all_points(scan::PointSource& source, size_t at_once = 1000) {
  scan::PointBlock all, block;
  while (source.read(block, at_once)) {
    all.place.insert(all.place.end(), block.place.begin(), block.place.end());
    all.color.insert(all.color.end(), block.color.begin(), block.color.end());
    all.intensity.insert(all.intensity.end(), block.intensity.begin(), block.intensity.end());
    all.classification.insert(all.classification.end(), block.classification.begin(),
                              block.classification.end());
    all.time.insert(all.time.end(), block.time.begin(), block.time.end());
  }
  return all;
}

// Reads all records of a LAS or LAZ file, so many at once.
inline std::vector<uint8_t> read_all_records(const std::string& file, size_t at_once) {
  scan::LasFile las(file);
  std::vector<uint8_t> all;
  for (;;) {
    const auto records = las.records().read(at_once);
    if (records.empty()) return all;
    all.insert(all.end(), records.begin(), records.end());
  }
}

}  // namespace wellspring::test
