// SPDX-License-Identifier: Apache-2.0
// A pass's point lights in clusters of eight neighbours, to find out quickly what each may do to a
// few places: clusters far away are asked as one light, near ones light by light. After Walter et
// al., "Lightcuts: A Scalable Approach to Illumination" (2005), with one level; what comes out is a
// chance to be chosen, never light.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/instant/instant_pass.h"
#include "light/instant/point_lights_simd.h"

namespace wellspring::light {

// An order of a pass's point lights in which neighbours do much the same to a picture: on one
// surface and near each other. Every so many-th of them then stands for all, as systematic sampling
// wants it.

// Numbers of all lights of `pass` that are not exact: those from infinity, those without a side and
// those that face each of six ways apart from each other, and each of these along the curve of
// Morton (1966) through the box around them.
std::vector<uint32_t> order_lights(const InstantPass& pass);

// Of eight clusters what takes the place of their lights, as LightLanes has it.
struct ClusterRow {
  Lanes x{}, y{}, z{}, nx{}, ny{}, nz{}, near{}, back{}, even{};
  Lanes power{};   // of all its lights; 0: they are too different, ask each
  Lanes radius{};  // around x, y, z
  Lanes spread{};  // largest distance of a light's normal from n
};

struct LightClusters {
  LightLanes lights;  // as order_lights has them; a group of eight is a cluster
  size_t number = 0;  // of lights
  std::vector<ClusterRow> rows;
  std::vector<float> inverse_power;  // of each cluster: 1 / power, or 0
  std::vector<uint8_t> held;         // lights in it
  size_t size() const { return lights.x.size(); }
};
// Of all lights that are not exact.
LightClusters make_light_clusters(const LightTables& tables, const InstantPass& pass);

// Shares of clusters in what places get, nothing in between; all shares together are 1.
struct ClusterShares {
  std::vector<float> of_cluster;    // whole rows
  std::vector<uint32_t> detail_of;  // number in `details`; none: by power
  std::vector<Lanes> details;       // shares of the lights of a cluster
  static constexpr uint32_t none = 0xffffffffu;
  std::vector<Lanes> scratch;
};
// Each place counts for as much as any other. False: nothing is lit.
bool share_lights(const LightClusters& clusters, float clip, std::span<const LitPoint> points,
                  ClusterShares& shares);
// Shares of the lights of cluster c.
inline Lanes shares_in(const LightClusters& clusters, const ClusterShares& shares, size_t c) {
  uint32_t detail = shares.detail_of[c];
  if (detail != ClusterShares::none) return shares.details[detail];
  return clusters.lights.power[c] * (shares.of_cluster[c] * clusters.inverse_power[c]);
}

}  // namespace wellspring::light
