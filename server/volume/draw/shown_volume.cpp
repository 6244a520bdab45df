// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/shown_volume.h"

#include <algorithm>
#include <stdexcept>

#include "base/load_error.h"
#include "base/parallel.h"
#include "volume/format/open_volume.h"

namespace wellspring::volume {
namespace {

constexpr size_t most_whole = size_t(1) << 21;  // samples of a level of bricks that is whole, too

void add_normals_and_ranges(VolumeLevel& level) {
  Grid grid(level.size);
  std::ranges::copy(level.codes, grid.values.begin());
  level.normals = make_normals(grid);
  level.cells = cells_of(level.size);
  const size_t layer = size_t(level.cells.x) * size_t(level.cells.y);
  level.ranges.resize(layer * size_t(level.cells.z));
  parallel_each(level.cells.z, [&](int cz) {
    std::vector<const uint16_t*> slices;
    for (int z = cz * cell_side; z < std::min((cz + 1) * cell_side + 1, level.size.z); z++)
      slices.push_back(&level.codes[grid.index(0, 0, z)]);
    find_ranges(slices, level.size, &level.ranges[size_t(cz) * layer]);
  });
}

std::vector<uint16_t> halve(const std::vector<uint16_t>& from, glm::ivec3 large, glm::ivec3 size) {
  std::vector<uint16_t> to(size_t(size.x) * size_t(size.y) * size_t(size.z));
  const size_t slice = size_t(large.x) * size_t(large.y);
  parallel_each(size.z, [&](int z) {
    const uint16_t* front = &from[size_t(2 * z) * slice];
    const uint16_t* behind = &from[size_t(std::min(2 * z + 1, large.z - 1)) * slice];
    for (int y = 0; y < size.y; y++)
      halve_row(front, behind, large, y,
                &to[(size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x)]);
  });
  return to;
}

VolumeLevel halve_level(const VolumeLevel& from, glm::ivec3 size) {
  VolumeLevel to;
  to.size = size;
  to.codes = halve(from.codes, from.size, size);
  return to;
}

std::array<std::vector<uint16_t>, 3> color_planes(const Volume& volume) {
  std::array<std::vector<uint16_t>, 3> planes;
  for (int channel = 0; channel < 3; channel++) {
    std::vector<uint16_t>& plane = planes[size_t(channel)];
    plane.resize(volume.samples());
    parallel_each(volume.size.z * volume.size.y, [&](int row) {
      color_row(volume, channel, row % volume.size.y, row / volume.size.y,
                &plane[size_t(row) * size_t(volume.size.x)]);
    });
  }
  return planes;
}

size_t sample_count(const VolumeLevel& level) {
  return size_t(level.size.x) * size_t(level.size.y) * size_t(level.size.z);
}

double least_distance(const glm::dmat4& to_metres) {
  return std::min({glm::length(glm::dvec3(to_metres[0])), glm::length(glm::dvec3(to_metres[1])),
                   glm::length(glm::dvec3(to_metres[2]))});
}

ShownVolume show_bricks(BrickFile file, std::shared_ptr<BrickPool> pool) {
  ShownVolume shown;
  static_cast<CodeScale&>(shown) = file.scale;
  shown.to_metres = file.to_metres;
  shown.voxel = least_distance(file.to_metres);
  shown.code_counts = file.code_counts;
  for (size_t k = 0; k < file.levels.size(); k++) {
    VolumeLevel& level = shown.levels.emplace_back();
    level.size = file.levels[k].size, level.cells = cells_of(level.size);
    level.ranges = std::move(file.ranges[k]);
  }
  file.ranges.clear();
  while (shown.whole_level + 1 < int(shown.levels.size()) &&
         sample_count(shown.levels[size_t(shown.whole_level)]) > most_whole)
    shown.whole_level++;
  for (int k = shown.whole_level; k < int(shown.levels.size()); k++) {
    VolumeLevel& level = shown.levels[size_t(k)];
    level.codes = read_level_codes(file, k);
    add_normals_and_ranges(level);
  }
  shown.bricks =
      std::make_shared<ResidentBricks>(std::move(file), pool ? pool : shared_brick_pool());
  return shown;
}

}  // namespace

ShownVolume make_shown_volume(const Volume& volume) {
  if (volume.samples() >= size_t(1) << 31)
    throw std::length_error("a volume of 2^31 samples or more cannot be shown");
  ShownVolume shown;
  static_cast<CodeScale&>(shown) = code_scale_of(volume);
  shown.to_metres = volume.to_metres;
  shown.voxel = least_distance(volume.to_metres);
  VolumeLevel& finest = shown.levels.emplace_back();
  finest.size = volume.size;
  finest.codes.resize(volume.samples());
  parallel_each(volume.size.z, [&](int z) {
    size_t index = size_t(z) * size_t(volume.size.x) * size_t(volume.size.y);
    for (int y = 0; y < volume.size.y; y++, index += size_t(volume.size.x))
      code_row(volume, shown, y, z, &finest.codes[index]);
  });
  shown.code_counts.resize(code_bins);
  for (const uint16_t code : finest.codes) shown.code_counts[code * size_t(code_bins) / 65536]++;
  const std::vector<glm::ivec3> sizes = level_sizes(volume.size);
  for (size_t k = 1; k < sizes.size(); k++)
    shown.levels.push_back(halve_level(shown.levels.back(), sizes[k]));
  if (volume.channels == 3) set_colors(color_planes(volume), shown);
  for (VolumeLevel& level : shown.levels) add_normals_and_ranges(level);
  return shown;
}

ShownVolume coarser(const ShownVolume& volume, int level) {
  ShownVolume shown;
  static_cast<CodeScale&>(shown) = volume;
  const double apart = std::ldexp(1.0, level);
  shown.to_metres = volume.to_metres;
  shown.to_metres[3] = volume.to_metres * glm::dvec4(glm::dvec3(0.5 * apart - 0.5), 1);
  for (int axis = 0; axis < 3; axis++) shown.to_metres[axis] *= apart;
  shown.voxel = volume.voxel * apart;
  shown.levels.assign(volume.levels.begin() + level, volume.levels.end());
  shown.code_counts = volume.code_counts;
  return shown;
}

void set_colors(std::array<std::vector<uint16_t>, 3> planes, ShownVolume& volume) {
  for (size_t channel = 0; channel < 3; channel++) {
    volume.levels.front().colors[channel] = std::move(planes[channel]);
    for (size_t k = 1; k < volume.levels.size(); k++)
      volume.levels[k].colors[channel] = halve(volume.levels[k - 1].colors[channel],
                                               volume.levels[k - 1].size, volume.levels[k].size);
  }
}

ShownVolume open_shown_volume(const std::string& path, std::shared_ptr<BrickPool> pool) {
  if (is_brick_file(path)) return show_bricks(open_bricks(path), std::move(pool));
  const Volume volume = open_volume(path);
  try {
    return make_shown_volume(volume);
  } catch (const std::length_error& error) {
    throw LoadError(path, "", std::string(error.what()) + " without bricks");
  }
}

}  // namespace wellspring::volume
