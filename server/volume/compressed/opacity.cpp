// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/opacity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wellspring::volume {

OpacityTable::OpacityTable(int side, const std::function<float(glm::vec3)>& opacity) {
  if (side < 2 || side > 256) throw std::invalid_argument("opacity tables have sides of 2 to 256");
  side_ = side;
  opacities_.reserve(size_t(side) * size_t(side) * size_t(side));
  const float step = 255.f / float(side - 1);
  for (int blue = 0; blue < side; blue++)
    for (int green = 0; green < side; green++)
      for (int red = 0; red < side; red++)
        opacities_.push_back(std::clamp(opacity(glm::vec3(red, green, blue) * step), 0.f, 1.f));
  find_greatest();
}

float OpacityTable::at(int red, int green, int blue) const {
  return opacities_[(size_t(blue) * size_t(side_) + size_t(green)) * size_t(side_) + size_t(red)];
}

float OpacityTable::nearest(glm::vec3 color) const {
  const glm::vec3 cut = glm::clamp(color, 0.f, 255.f) * (float(side_ - 1) / 255.f);
  const glm::ivec3 place(glm::floor(cut + 0.5f));
  return at(place.x, place.y, place.z);
}

float OpacityTable::trilinear(glm::vec3 color) const {
  const glm::vec3 cut = glm::clamp(color, 0.f, 255.f) * (float(side_ - 1) / 255.f);
  const glm::ivec3 low = glm::min(glm::ivec3(cut), glm::ivec3(side_ - 2));
  const glm::vec3 part = cut - glm::vec3(low);
  const auto row = [&](int y, int z) {
    return glm::mix(at(low.x, y, z), at(low.x + 1, y, z), part.x);
  };
  return glm::mix(glm::mix(row(low.y, low.z), row(low.y + 1, low.z), part.y),
                  glm::mix(row(low.y, low.z + 1), row(low.y + 1, low.z + 1), part.y), part.z);
}

OpacityTable OpacityTable::stretched(float times) const {
  OpacityTable table = *this;
  for (float& opacity : table.opacities_) opacity = 1 - std::pow(1 - opacity, times);
  table.find_greatest();
  return table;
}

void OpacityTable::find_greatest() {
  greatest_ = {opacities_};
  sides_ = {side_};
  while (sides_.back() > 1) {
    const int below = sides_.back(), side = (below + 1) / 2;
    std::vector<float> cells(size_t(side) * size_t(side) * size_t(side), 0);
    const std::vector<float>& from = greatest_.back();
    for (int z = 0; z < below; z++)
      for (int y = 0; y < below; y++)
        for (int x = 0; x < below; x++) {
          float& cell = cells[size_t((z / 2 * side + y / 2) * side + x / 2)];
          cell = std::max(cell, from[size_t((z * below + y) * below + x)]);
        }
    greatest_.push_back(std::move(cells));
    sides_.push_back(side);
  }
}

struct OpacityTable::Search {
  glm::ivec3 least, most;  // places of the table, both within
  float found = 0;
};

void OpacityTable::search(Search& search, int level, glm::ivec3 cell) const {
  const int side = sides_[size_t(level)];
  const glm::ivec3 least = cell << level;
  const glm::ivec3 most = glm::min(least + (1 << level), glm::ivec3(side_)) - 1;
  if (cell.x >= side || cell.y >= side || cell.z >= side) return;
  if (glm::any(glm::greaterThan(least, search.most)) || glm::any(glm::lessThan(most, search.least)))
    return;
  const float here = greatest_[size_t(level)][size_t((cell.z * side + cell.y) * side + cell.x)];
  if (here <= search.found) return;
  if (glm::all(glm::greaterThanEqual(least, search.least)) &&
      glm::all(glm::lessThanEqual(most, search.most))) {
    search.found = here;
    return;
  }
  for (int i = 0; i < 8; i++)
    this->search(search, level - 1, 2 * cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
}

float OpacityTable::greatest(glm::vec3 least, glm::vec3 most) const {
  const float scale = float(side_ - 1) / 255.f;
  Search search;
  search.least = glm::ivec3(glm::floor(glm::clamp(least, 0.f, 255.f) * scale));
  search.most = glm::ivec3(glm::ceil(glm::clamp(most, 0.f, 255.f) * scale));
  search.most = glm::min(search.most, glm::ivec3(side_ - 1));
  this->search(search, int(sides_.size()) - 1, glm::ivec3(0));
  return search.found;
}

float opacity_bound(const CompressedVolume& volume, const OpacityTable& table, glm::ivec3 brick) {
  // Ranges are of rounded samples.
  const SampleRange range = brick_range(volume, brick);
  return table.greatest(glm::vec3(range.least) - 0.5f, glm::vec3(range.greatest) + 0.5f);
}

}  // namespace wellspring::volume
