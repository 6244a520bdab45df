// SPDX-License-Identifier: Apache-2.0
#include "light/known/radiance_grid_file.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <type_traits>
#include <vector>

#include "base/load_error.h"
#include "base/rng.h"
#include "base/write_file.h"
#include "light/sample/lamps_seen.h"

namespace wellspring {
namespace {

constexpr uint64_t format = 0x3144495247535701;  // changes with what is written
constexpr uint64_t most_items = 1 << 28;         // of an array

uint64_t checksum(const std::string& bytes) {
  uint64_t sum = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<size_t>(8, bytes.size() - i));
    sum = mix64(sum ^ word);
  }
  return sum;
}

// The same list of fields for both directions: Put appends, Take reads.
struct Put {
  std::string bytes;
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <class T>
  void array(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(uint64_t(v.size()));
    bytes.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
  }
};
struct Take {
  const std::string& bytes;
  size_t at = 0;
  bool good = true;
  void copy(void* to, size_t size) {
    good = good && size <= bytes.size() - at;
    if (!good || size == 0) return;
    std::memcpy(to, bytes.data() + at, size);
    at += size;
  }
  template <class T>
  void value(T& v) {
    copy(&v, sizeof v);
  }
  template <class T>
  void array(std::vector<T>& v) {
    uint64_t count = 0;
    value(count);
    good = good && count <= most_items && count * sizeof(T) <= bytes.size() - at;
    if (!good) return;
    v.resize(size_t(count));
    copy(v.data(), v.size() * sizeof(T));
  }
};

void list_fields(auto& to, auto& grid, auto& lamps, auto& parts, auto& lights) {
  to.value(grid.cell);
  to.array(grid.keys);
  to.array(grid.light);
  to.array(grid.count);
  to.array(grid.keeps);
  to.value(lamps.cell);
  to.array(lamps.keys);
  to.array(lamps.shares);
  to.array(parts.slots);
  to.array(parts.albedo);
  for (auto& light : lights) to.array(light);
}

bool fits(const RadianceGrid& grid, const LampsSeen& lamps, const RadianceGrid::Parts& parts) {
  bool good = grid.light.size() == grid.keys.size() && grid.count.size() == grid.keys.size() &&
              lamps.shares.size() == lamps.keys.size() && grid.cell > 0 &&
              parts.albedo.size() == parts.slots.size();
  for (const auto& light : parts.light) good = good && light.size() == parts.slots.size();
  for (uint32_t slot : parts.slots) good = good && slot < grid.keys.size();
  return good;
}

}  // namespace

std::shared_ptr<const RadianceGrid> load_radiance_grid(const std::string& file, uint64_t key) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  std::ifstream in(file, std::ios::binary);
  if (none || !in || size < 32 || size > (uint64_t(1) << 32)) return nullptr;
  uint64_t head[4] = {};  // format, key, checksum, number of parts + 1; 0: there are none
  in.read(reinterpret_cast<char*>(head), sizeof head);
  if (head[0] != format || head[1] != key || head[3] > 256) return nullptr;
  std::string bytes(size_t(size) - sizeof head, '\0');
  if (!in.read(bytes.data(), std::streamsize(bytes.size())) || checksum(bytes) != head[2])
    return nullptr;
  auto grid = std::make_shared<RadianceGrid>();
  auto lamps = std::make_shared<LampsSeen>();
  auto parts = std::make_shared<RadianceGrid::Parts>();
  if (head[3] > 0) parts->light.resize(size_t(head[3] - 1));
  Take take{bytes};
  list_fields(take, *grid, *lamps, *parts, parts->light);
  if (!take.good || take.at != bytes.size() || !fits(*grid, *lamps, *parts)) return nullptr;
  if (!lamps->keys.empty()) grid->lamps = lamps;
  if (head[3] > 0) grid->parts = parts;
  return grid;
}

bool save_radiance_grid(const RadianceGrid& grid, const std::string& file, uint64_t key) {
  static const LampsSeen no_lamps;
  static const RadianceGrid::Parts no_parts;
  const LampsSeen& lamps = grid.lamps ? *grid.lamps : no_lamps;
  const RadianceGrid::Parts& parts = grid.parts ? *grid.parts : no_parts;
  Put put;
  list_fields(put, grid, lamps, parts, parts.light);
  const uint64_t head[4] = {format, key, checksum(put.bytes),
                            grid.parts ? parts.light.size() + 1 : 0};
  put.bytes.insert(0, reinterpret_cast<const char*>(head), sizeof head);
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), code);
  try {
    write_file(file, put.bytes);
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace wellspring
