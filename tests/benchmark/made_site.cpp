// SPDX-License-Identifier: Apache-2.0
#include "made_site.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/rng.h"

namespace wellspring::test {
namespace {

using scan::PointBlock;

constexpr float hall_half_width = 12, hall_half_depth = 8, hall_top = 6;  // metres
constexpr float column_radius = 0.4f, hall_noise = 0.0015f;
constexpr int hall_columns = 12;

struct Part {
  float area;
  // Returns a place for two numbers from 0 to 1, and whether anything is there.
  vec3 (*place)(int number, float u, float v);
  vec3 (*normal)(int number, vec3 place);
  bool has_windows = false;
  int count = 1;
};

vec3 floor_place(int, float u, float v) {
  return {(2 * u - 1) * hall_half_width, 0, (2 * v - 1) * hall_half_depth};
}
vec3 long_wall(int number, float u, float v) {
  return {(2 * u - 1) * hall_half_width, v * hall_top, number ? hall_half_depth : -hall_half_depth};
}
vec3 short_wall(int number, float u, float v) {
  return {number ? hall_half_width : -hall_half_width, v * hall_top, (2 * u - 1) * hall_half_depth};
}
vec3 column_place(int number, float u, float v) {
  const float angle = 2 * pi * u;
  const vec3 middle(float(number % 6) * 3.6f - 9, 0, number < 6 ? -3.5f : 3.5f);
  return middle +
         vec3(column_radius * std::cos(angle), v * hall_top, column_radius * std::sin(angle));
}

vec3 floor_normal(int, vec3) { return {0, 1, 0}; }
vec3 long_normal(int, vec3) { return {0, 0, 1}; }
vec3 short_normal(int, vec3) { return {1, 0, 0}; }
vec3 column_normal(int number, vec3 place) {
  vec3 way = place - column_place(number, 0, 0);
  way += vec3(column_radius, 0, 0), way.y = 0;
  return way / column_radius;
}

const std::array<Part, 4> hall_parts = {
    {{4 * hall_half_width * hall_half_depth, floor_place, floor_normal},
     {2 * hall_half_width * hall_top, long_wall, long_normal, true, 2},
     {2 * hall_half_depth * hall_top, short_wall, short_normal, false, 2},
     {2 * pi * column_radius * hall_top, column_place, column_normal, false, hall_columns}}};

bool is_window(vec3 p) {
  const float across = std::abs(std::remainder(p.x, 4.0f));
  const float arch = p.y < 3.5f ? 0.7f : 0.7f - (p.y - 3.5f);
  return p.y > 1.2f && across < arch;
}

// Returns the colour of stones, sRGB codes.
std::array<uint16_t, 3> stone(vec3 p) {
  const float row = std::floor(p.y / 0.35f);
  const float along = p.x + p.z + 0.3f * std::fmod(row, 2.0f);
  const uint64_t stone = mix64(uint64_t(int64_t(row) * 7919 + int64_t(std::floor(along / 0.6f))));
  const bool joint = std::abs(std::remainder(p.y, 0.35f)) < 0.012f ||
                     std::abs(std::remainder(along, 0.6f)) < 0.012f;
  const float tone = (joint ? 95.0f : 140 + float(stone % 50)) +
                     float(mix64(uint64_t(int64_t(p.x * 400) * 31 + int64_t(p.y * 400) * 17 +
                                          int64_t(p.z * 400))) %
                           24);
  return {uint16_t(tone), uint16_t(0.92f * tone), uint16_t(0.8f * tone)};
}

// Returns the share of a place's points that stations keep: as many lines of theirs meet it, all
// being at least two metres away.
float scanned_share(vec3 place, vec3 normal) {
  constexpr vec3 stations[] = {{-7.5f, 1.6f, 1}, {4, 1.6f, -1.5f}};
  constexpr float nearest = 2;
  float share = 0;
  for (const vec3& station : stations) {
    const vec3 way = station - place;
    const float far2 = dot(way, way);
    share += std::abs(dot(normal, way)) / std::sqrt(far2) * nearest * nearest / far2;
  }
  return share;
}

class Site : public scan::PointSource {
 public:
  Site(uint64_t points, SiteScan scan) : left_(points), scan_(scan) {
    info_.file = "made", info_.format = "made";
    info_.points = points, info_.is_counted = true;
    info_.fields.color = true, info_.color_max = 255;
    for (const Part& part : hall_parts) area_ += part.area * float(part.count);
  }
  bool read(PointBlock& block, size_t most) override {
    block.clear();
    while (left_ > 0 && block.size() < most) {
      vec3 place;
      if (!find(place)) continue;
      left_--;
      block.color.push_back(stone(place));
      const vec3 off(random_.uniform(), random_.uniform(), random_.uniform());
      block.place.push_back(dvec3(place + hall_noise * (2.0f * off - 1.0f)));
    }
    return block.size() > 0;
  }

 private:
  bool find(vec3& place) {
    float at = area_ * random_.uniform();
    for (const Part& part : hall_parts) {
      const float area = part.area * float(part.count);
      if (at >= area) {
        at -= area;
        continue;
      }
      const int number = std::min(int(at / part.area), part.count - 1);
      place = part.place(number, random_.uniform(), random_.uniform());
      if (part.has_windows && is_window(place)) return false;
      return scan_ == SiteScan::everywhere ||
             random_.uniform() < scanned_share(place, part.normal(number, place));
    }
    return false;
  }
  uint64_t left_;
  SiteScan scan_;
  float area_ = 0;
  Rng random_{1};
};

}  // namespace

std::unique_ptr<scan::PointSource> made_site(uint64_t points, SiteScan scan) {
  return std::make_unique<Site>(points, scan);
}

scan::ScanCamera made_site_view() {
  scan::ScanCamera view;
  view.eye = dvec3(-9.5, 1.65, 6.5);
  view.forward = normalize(vec3(0.9f, 0.02f, -0.6f));
  view.right = normalize(cross(view.forward, vec3(0, 1, 0)));
  view.up = cross(view.right, view.forward);
  view.tan_half_fov = std::tan(0.5f * glm::radians(60.0f));
  view.width = 1280, view.height = 720;
  return view;
}

}  // namespace wellspring::test
