// SPDX-License-Identifier: Apache-2.0
#include "light/known/radiance_grid_file.h"

#include "base/keyed_file.h"
#include "light/random/place_key.h"
#include "light/sample/lamps_seen.h"

namespace wellspring {
namespace {

constexpr uint64_t format = 0x3144495247535702;  // changes with what is written

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

// Of cells of this size. Far places are still counted by whole numbers.
bool is_table(const std::vector<uint64_t>& keys, float cell) {
  return is_place_table(keys) && cell > 1e-4f && cell < 1e9f;
}

bool fits(const RadianceGrid& grid, const LampsSeen& lamps, const RadianceGrid::Parts& parts) {
  bool good = grid.light.size() == grid.keys.size() && grid.count.size() == grid.keys.size() &&
              lamps.shares.size() == lamps.keys.size() && is_table(grid.keys, grid.cell) &&
              (lamps.keys.empty() || is_table(lamps.keys, lamps.cell)) &&
              parts.albedo.size() == parts.slots.size();
  for (const auto& light : parts.light) good = good && light.size() == parts.slots.size();
  for (uint32_t slot : parts.slots) good = good && slot < grid.keys.size();
  return good;
}

}  // namespace

std::shared_ptr<const RadianceGrid> load_radiance_grid(const std::string& file, uint64_t key) {
  std::string bytes;
  if (read_keyed(file, format, key, bytes) != KeyedFile::read) return nullptr;
  auto grid = std::make_shared<RadianceGrid>();
  auto lamps = std::make_shared<LampsSeen>();
  auto parts = std::make_shared<RadianceGrid::Parts>();
  TakeBytes take{bytes};
  uint64_t count = 0;  // of parts, and one more; 0: there are none
  take.value(count);
  if (count > 256) return nullptr;
  if (count > 0) parts->light.resize(size_t(count - 1));
  list_fields(take, *grid, *lamps, *parts, parts->light);
  if (!take.complete() || !fits(*grid, *lamps, *parts)) return nullptr;
  if (!lamps->keys.empty()) grid->lamps = lamps;
  if (count > 0) grid->parts = parts;
  return grid;
}

bool save_radiance_grid(const RadianceGrid& grid, const std::string& file, uint64_t key) {
  static const LampsSeen no_lamps;
  static const RadianceGrid::Parts no_parts;
  const LampsSeen& lamps = grid.lamps ? *grid.lamps : no_lamps;
  const RadianceGrid::Parts& parts = grid.parts ? *grid.parts : no_parts;
  PutBytes put;
  put.value(uint64_t(grid.parts ? parts.light.size() + 1 : 0));
  list_fields(put, grid, lamps, parts, parts.light);
  return write_keyed(file, format, key, put.bytes);
}

}  // namespace wellspring
