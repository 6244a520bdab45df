// SPDX-License-Identifier: Apache-2.0
#include "lawn/lawn.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/rng.h"
#include "base/simd.h"

namespace wellspring::lawn {
namespace {

constexpr int blades_a_tile = 256;  // about, where the extent is 1
constexpr int most_tiles = 1 << 20;

float within(float x, float low, float high) {
  return std::isfinite(x) ? std::clamp(x, low, high) : low;
}

// Holds one blade before it has its place in the columns.
struct Blade {
  vec3 root, grow;
  vec2 side;
  float length, width, droop, dry, give;
};

vec3 direction_of(vec3 code) {
  vec3 grow = 2.0f * code - 1.0f;
  if (!(dot(grow, grow) > 1e-4f)) return {0, 1, 0};
  grow = normalize(grow);
  grow.y = std::max(grow.y, 0.1f);  // grass does not grow into the ground
  return normalize(grow);
}

class Sower {
 public:
  Sower(const LawnDescription& description, Lawn& lawn) : from_(description), to_(lawn) {
    height_ = within(from_.height, 0, 100);
    spread_ = within(from_.height_spread, 0, 1);
    width_ = within(from_.width, 0, 10);
    droop_ = within(from_.droop, 0, 4);
  }

  void sow(int index, double density) {
    LawnTile& tile = to_.tile[size_t(index)];
    tile.begin = int(to_.x.size());
    const vec2 corner = to_.low + to_.tile_side * vec2(index % to_.tiles.x, index / to_.tiles.x);
    const vec2 size = min(to_.high - corner, vec2(to_.tile_side));
    Rng random(sample_seed(from_.seed, uint32_t(index), 0, 0));
    if (!(size.x > 0 && size.y > 0)) return;
    const double wanted = density * double(size.x) * double(size.y);
    const int count = int(wanted) + (double(random.uniform()) < wanted - std::floor(wanted));
    // Jittered cells spread blades evenly; chance leaves as many cells empty as are too many.
    const int across = std::max(int(std::ceil(std::sqrt(double(count) * size.x / size.y))), 1);
    const int along = (count + across - 1) / across;
    blades_.clear();
    int left = across * along;
    for (int cell = 0, due = count; cell < across * along; cell++, left--) {
      if (random.uniform() * float(left) >= float(due)) continue;
      due--;
      const vec2 place = {float(cell % across) + random.uniform(),
                          float(cell / across) + random.uniform()};
      grow_one(corner + size * place / vec2(across, along), random);
    }
    for (size_t i = blades_.size(); i > 1; i--)
      std::swap(blades_[i - 1], blades_[random.next() % i]);
    keep(tile);
  }

 private:
  void grow_one(vec2 place, Rng& random) {
    const vec2 share = (place - to_.low) / (to_.high - to_.low);
    // All chances are drawn, so that a change of a map changes no other blade.
    float chance[9];
    for (float& c : chance) c = random.uniform();
    const float extent = from_.extent.at(share).x;
    if (!(chance[0] < extent)) return;
    const float ground = from_.ground(place.x, place.y);
    if (!std::isfinite(ground)) return;
    const float mess = within(from_.messiness.at(share).x, 0, 1);
    const float turn = 2 * pi * chance[1], tilt = mess * std::sqrt(chance[2]);
    Blade blade;
    blade.root = {place.x, ground, place.y};
    blade.grow = direction_of(from_.direction.at(share));
    blade.grow = normalize(blade.grow + tilt * vec3(std::cos(turn), 0, std::sin(turn)));
    const float facing = 2 * pi * chance[3];
    blade.side = {std::cos(facing), std::sin(facing)};
    // Sparse grass is lower, too.
    blade.length = height_ * (1 - spread_ * chance[4]) * (0.5f + 0.5f * std::min(extent, 1.0f));
    blade.width = width_ * (0.7f + 0.3f * chance[5]);
    blade.droop = droop_ * (1 + mess * (2 * chance[6] - 1));
    blade.dry = chance[7] * chance[7];
    blade.give = 0.7f + 0.6f * chance[8];
    blades_.push_back(blade);
  }

  void keep(LawnTile& tile) {
    tile.count = int(blades_.size());
    to_.blades += tile.count;
    if (tile.count == 0) return;
    fit_ground(tile);
    vec3 low = blades_[0].root, high = low;
    float longest = 0;
    for (const Blade& b : blades_) {
      low = min(low, b.root), high = max(high, b.root);
      longest = std::max(longest, b.length);
      tile.widest = std::max(tile.widest, b.width);
    }
    tile.low = low - longest, tile.high = high + longest;
    to_.tallest = std::max(to_.tallest, longest);
    const Blade none = {blades_.back().root, {0, 1, 0}, {1, 0}, 0, 0, 0, 0, 0};
    while (blades_.size() % lane_count != 0) blades_.push_back(none);
    for (const Blade& b : blades_) {
      to_.x.push_back(b.root.x), to_.y.push_back(b.root.y), to_.z.push_back(b.root.z);
      to_.grow_x.push_back(b.grow.x), to_.grow_y.push_back(b.grow.y);
      to_.grow_z.push_back(b.grow.z);
      to_.side_x.push_back(b.side.x), to_.side_z.push_back(b.side.y);
      to_.length.push_back(b.length), to_.width.push_back(b.width);
      to_.droop.push_back(b.droop), to_.dry.push_back(b.dry), to_.give.push_back(b.give);
    }
  }

  // Fits a plane to the roots by least squares.
  void fit_ground(LawnTile& tile) const {
    dvec3 mean{0};
    for (const Blade& b : blades_) mean += dvec3(b.root) / double(blades_.size());
    double xx = 0, xz = 0, zz = 0, xy = 0, zy = 0;
    for (const Blade& b : blades_) {
      const dvec3 d = dvec3(b.root) - mean;
      xx += d.x * d.x, xz += d.x * d.z, zz += d.z * d.z, xy += d.x * d.y, zy += d.z * d.y;
    }
    const double det = xx * zz - xz * xz;
    if (!(det > 1e-6 * xx * zz)) return;  // too few: level
    const dvec2 slope = dvec2(xy * zz - zy * xz, zy * xx - xy * xz) / det;
    tile.slope = vec2(glm::clamp(slope, -2.0, 2.0));
  }

  const LawnDescription& from_;
  Lawn& to_;
  float height_, spread_, width_, droop_;
  std::vector<Blade> blades_;
};

}  // namespace

vec3 LawnMap::at(vec2 share) const {
  if (!picture || picture->width < 1 || picture->height < 1) return constant;
  const ivec2 size(picture->width, picture->height);
  const bool wide = !picture->codes16.empty();
  const auto code = [&](int x, int y) {
    x = std::clamp(x, 0, size.x - 1), y = std::clamp(y, 0, size.y - 1);
    const size_t i = 4 * (size_t(y) * size_t(size.x) + size_t(x));
    if (wide) return vec3(picture->codes16[i], picture->codes16[i + 1], picture->codes16[i + 2]);
    return vec3(picture->codes8[i], picture->codes8[i + 1], picture->codes8[i + 2]);
  };
  const vec2 place = clamp(share, 0.0f, 1.0f) * vec2(size) - 0.5f;
  const vec2 first = floor(place), part = place - first;
  const int x = int(first.x), y = int(first.y);
  const vec3 mixed = mix(mix(code(x, y), code(x + 1, y), part.x),
                         mix(code(x, y + 1), code(x + 1, y + 1), part.x), part.y);
  return mixed / (wide ? 65535.0f : 255.0f);
}

Lawn make_lawn(const LawnDescription& description) {
  Lawn lawn;
  lawn.low = description.low, lawn.high = description.high;
  lawn.colors = description.colors;
  const dvec2 size = dvec2(lawn.high) - dvec2(lawn.low);
  const double area = size.x * size.y;
  if (!(size.x > 0 && size.y > 0) || !std::isfinite(area)) {
    lawn.high = lawn.low;
    return lawn;
  }
  double density = within(description.density, 0, 1e7f);
  density = std::min(density, std::max(description.most_blades, 0) / area);
  if (density <= 0) return lawn;
  double side = std::sqrt(blades_a_tile / density);
  side = std::max(side, std::sqrt(area / most_tiles));
  side = std::max(side, std::max(size.x, size.y) / most_tiles);
  lawn.tile_side = float(side);
  lawn.tiles = max(ivec2(glm::ceil(size / double(lawn.tile_side))), ivec2(1));
  lawn.tile.resize(size_t(lawn.tiles.x) * size_t(lawn.tiles.y));
  Sower sower(description, lawn);
  for (int i = 0; i < int(lawn.tile.size()); i++) sower.sow(i, density);
  return lawn;
}

}  // namespace wellspring::lawn
