// SPDX-License-Identifier: Apache-2.0
#include "light/kept/stand_in_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/memory.h"
#include "light/random/warp.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float reach_in_sides = 0.85f;  // in sides of the mean square
constexpr float least_facing = 0.2f;     // cosine between a place's normal and a square's

// Returns the key of a cell, which is not 0.
uint64_t key_of(glm::ivec3 cell) {
  constexpr int bits = 21, half = 1 << (bits - 1);
  auto part = [&](int x) { return uint64_t(uint32_t(x + half) & ((1u << bits) - 1)); };
  return uint64_t(1) << 63 | part(cell.x) << (2 * bits) | part(cell.y) << bits | part(cell.z);
}

}  // namespace

StandInLight::StandInLight(const World& world, uint32_t instance, const IlluminationMap& map) {
  const Mesh& mesh = world.mesh_of(instance);
  const IlluminationCharts& charts = *map.places;
  std::vector<Square> squares;
  squares.reserve(mesh.triangles.size() / 2);
  double sides = 0;
  // Two triangles are a square, whose middle lies on their common edge.
  for (uint32_t triangle = 0; triangle + 1 < mesh.triangles.size(); triangle += 2) {
    Square square;
    float area = 0;
    square.place = eval_position(world, instance, triangle, {0, 0.5f});
    square.normal = eval_face(world, instance, triangle, &area);
    bool any = false;
    for (const bool front : {true, false}) {
      const uint32_t number = charts.find(instance, triangle, front);
      if (number == no_chart) continue;
      const IlluminationTaps taps = find_taps(map, charts.charts[number], square.place);
      Side& side = front ? square.front : square.back;
      side.light = eval_illumination(map.nodes, taps);
      if (!map.nodes.slope.empty()) side.slope = eval_illumination_slope(map.nodes, taps);
      any |= taps.weight[0] + taps.weight[1] + taps.weight[2] + taps.weight[3] > 0;
    }
    if (!any || !is_finite(square.place)) continue;
    sides += std::sqrt(2.0 * double(area));
    squares.push_back(square);
  }
  if (squares.empty()) return;
  reach_ = std::max(reach_in_sides * float(sides / double(squares.size())), 1e-6f);
  sort_into_cells(std::move(squares));
}

void StandInLight::sort_into_cells(std::vector<Square> squares) {
  std::vector<uint64_t> key(squares.size());
  for (size_t i = 0; i < squares.size(); i++)
    key[i] = key_of(glm::ivec3(glm::floor(squares[i].place / (2 * reach_))));
  std::vector<uint32_t> order(squares.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](uint32_t i) { return key[i]; });
  size_t cells = 1;
  for (size_t i = 1; i < order.size(); i++) cells += key[order[i]] != key[order[i - 1]];
  keys_.assign(std::bit_ceil(2 * cells), 0);
  begin_.resize(keys_.size()), end_.resize(keys_.size());
  squares_.reserve(squares.size());
  for (const uint32_t i : order) {
    const uint32_t slot = find_place_slot(keys_, key[i]);
    if (keys_[slot] == 0) keys_[slot] = key[i], begin_[slot] = uint32_t(squares_.size());
    squares_.push_back(squares[i]);
    end_[slot] = uint32_t(squares_.size());
  }
}

void StandInLight::add(const Square& square, vec3 place, vec3 normal, float& weights,
                       StandInLit& sum) const {
  const vec3 way = square.place - place;
  const float far = dot(way, way) / (reach_ * reach_);
  if (far >= 1) return;
  const float cosine = dot(square.normal, normal), facing = std::abs(cosine) - least_facing;
  if (facing <= 0) return;
  const float weight = (1 - far) * (1 - far) * facing;
  const Side& side = cosine > 0 ? square.front : square.back;
  const vec3 own = cosine > 0 ? square.normal : -square.normal;
  const vec3 light = side.light * eval_slope(side.slope, own, normal);
  sum.light += weight * light;
  sum.slope += weight * luminance(side.light) * side.slope;
  weights += weight;
}

StandInLit StandInLight::find(vec3 place, vec3 normal) const {
  StandInLit sum;
  if (squares_.empty() || !is_finite(place)) return sum;
  float weights = 0;
  // Cells are twice as wide as the reach: eight of them hold all that is near.
  const glm::ivec3 first(glm::floor(place / (2 * reach_) - 0.5f));
  for (int i = 0; i < 8; i++) {
    const uint64_t key = key_of(first + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
    const uint32_t slot = find_place_slot(keys_, key);
    if (keys_[slot] == 0) continue;
    for (uint32_t k = begin_[slot]; k < end_[slot]; k++)
      add(squares_[k], place, normal, weights, sum);
  }
  if (!(weights > 0)) return {};
  sum.light /= weights;
  sum.slope /= weights * std::max(luminance(sum.light), 1e-12f);
  sum.known = true;
  return sum;
}

size_t StandInLight::memory_bytes() const { return bytes_of(squares_, keys_, begin_, end_); }

}  // namespace wellspring::light
