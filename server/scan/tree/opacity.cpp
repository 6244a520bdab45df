// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/opacity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/rng.h"

namespace wellspring::scan {
namespace {

struct Line {
  vec3 from, along;  // along: unit
  float length;      // to where it leaves the box
};

Line sample_line(const Box& box, Rng& rng) {
  const vec3 size = box.high - box.low;
  const vec3 areas(size.y * size.z, size.z * size.x, size.x * size.y);
  // Pairs of faces are chosen by area, then one of the two.
  float which = rng.uniform() * (areas.x + areas.y + areas.z);
  int axis = 0;
  while (axis < 2 && which >= areas[axis]) which -= areas[axis++];
  const bool is_high = rng.uniform() < 0.5f;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Line line;
  line.from[axis] = is_high ? box.high[axis] : box.low[axis];
  line.from[u] = box.low[u] + rng.uniform() * size[u];
  line.from[v] = box.low[v] + rng.uniform() * size[v];
  const float square = rng.uniform(), angle = 2 * pi * rng.uniform();
  const float inward = std::sqrt(1 - square), aside = std::sqrt(square);
  line.along[axis] = is_high ? -inward : inward;
  line.along[u] = aside * std::cos(angle), line.along[v] = aside * std::sin(angle);
  line.length = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; i++) {
    if (line.along[i] == 0) continue;
    const float to = line.along[i] > 0 ? box.high[i] : box.low[i];
    line.length = std::min(line.length, std::max((to - line.from[i]) / line.along[i], 0.0f));
  }
  return line;
}

bool stops(const Sphere& sphere, const Line& line) {
  const vec3 to = sphere.place - line.from;
  const float nearest = glm::dot(to, line.along);
  const float square = sphere.radius * sphere.radius - (glm::dot(to, to) - nearest * nearest);
  if (square < 0) return false;
  const float half = std::sqrt(square);
  return nearest + half >= 0 && nearest - half <= line.length;
}

// Holds spheres by the cells that their bounds touch.
class SphereGrid {
 public:
  SphereGrid(const Box& box, std::span<const Sphere> spheres) : box_(box), spheres_(spheres) {
    double radius = 0;
    for (const Sphere& sphere : spheres) radius += sphere.radius;
    radius /= std::max<double>(double(spheres.size()), 1);
    const vec3 size = box.high - box.low;
    // On a surface so many cells have about eight, and a sphere touches eight cells or fewer.
    const float wanted =
        max_component(size) / std::clamp(std::sqrt(float(spheres.size()) / 8), 1.0f, 32.0f);
    const float edge = std::max(wanted, float(2 * radius));
    for (int i = 0; i < 3; i++) {
      sides_[i] = std::clamp(int(size[i] / edge), 1, 32);
      scale_[i] = size[i] > 0 ? float(sides_[i]) / size[i] : 0;
    }
    starts_.assign(size_t(sides_.x) * size_t(sides_.y) * size_t(sides_.z) + 1, 0);
    each_touch([&](size_t cell, uint32_t) { starts_[cell + 1]++; });
    for (size_t c = 1; c < starts_.size(); c++) starts_[c] += starts_[c - 1];
    numbers_.resize(starts_.back());
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    each_touch([&](size_t cell, uint32_t sphere) { numbers_[next[cell]++] = sphere; });
  }

  bool stops_line(const Line& line) const {
    glm::ivec3 cell = cell_of(line.from);
    vec3 next, step;  // along the line, to the next wall and between walls
    for (int i = 0; i < 3; i++) {
      const float speed = line.along[i] * scale_[i];
      step[i] = speed != 0 ? std::abs(1 / speed) : std::numeric_limits<float>::infinity();
      const float at = (line.from[i] - box_.low[i]) * scale_[i] - float(cell[i]);
      next[i] = speed > 0 ? (1 - at) * step[i] : speed < 0 ? at * step[i] : step[i];
    }
    for (;;) {
      const size_t c = index(cell);
      for (uint32_t i = starts_[c]; i < starts_[c + 1]; i++)
        if (stops(spheres_[numbers_[i]], line)) return true;
      const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
      if (next[axis] >= line.length) return false;
      cell[axis] += line.along[axis] > 0 ? 1 : -1;
      if (cell[axis] < 0 || cell[axis] >= sides_[axis]) return false;
      next[axis] += step[axis];
    }
  }

 private:
  size_t index(glm::ivec3 cell) const {
    return size_t((cell.z * sides_.y + cell.y) * sides_.x + cell.x);
  }
  glm::ivec3 cell_of(vec3 place) const {
    return glm::clamp(glm::ivec3(glm::floor((place - box_.low) * scale_)), glm::ivec3(0),
                      sides_ - 1);
  }
  template <class Take>
  void each_touch(const Take& take) const {
    for (uint32_t i = 0; i < spheres_.size(); i++) {
      const Sphere& sphere = spheres_[i];
      const glm::ivec3 from = cell_of(sphere.place - sphere.radius),
                       to = cell_of(sphere.place + sphere.radius);
      for (int z = from.z; z <= to.z; z++)
        for (int y = from.y; y <= to.y; y++)
          for (int x = from.x; x <= to.x; x++) take(index({x, y, z}), i);
    }
  }

  const Box box_;
  const std::span<const Sphere> spheres_;
  glm::ivec3 sides_{1};
  vec3 scale_{0};
  std::vector<uint32_t> starts_, numbers_;
};

}  // namespace

float sample_opacity(const Box& box, std::span<const Sphere> spheres, int lines, uint64_t seed,
                     float least) {
  if (spheres.empty() || lines <= 0) return 0;
  const SphereGrid grid(box, spheres);
  Rng rng(seed);
  int stopped = 0, thrown = 0;
  while (thrown < lines) {
    stopped += grid.stops_line(sample_line(box, rng));
    thrown++;
    if (thrown == std::max(lines / 8, 1) && float(stopped) < least * float(thrown)) break;
  }
  return float(stopped) / float(thrown);
}

}  // namespace wellspring::scan
