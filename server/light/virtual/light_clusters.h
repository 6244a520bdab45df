// SPDX-License-Identifier: Apache-2.0
// Groups a pass's VPLs in clusters of eight neighbours, to find out quickly what each may
// do to a few places: clusters far away are asked as one light, near ones light by light. After
// Walter et al., "Lightcuts: A Scalable Approach to Illumination" (2005), with one level; the
// result is a chance to be chosen, never light.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/virtual/instant_pass.h"
#include "light/virtual/virtual_lights.h"

namespace wellspring::light {

// Orders a pass's VPLs so that neighbours do much the same to a picture: they are on one
// surface and near each other. Every so many-th of them then stands for all, as systematic sampling
// needs it.

// Returns the numbers of all lights of `pass` that are not exact: those from infinity, those
// without a side and those that face each of six ways apart from each other, and each of these
// groups along the curve of Morton (1966) through the box around it.
std::vector<uint32_t> order_lights(const InstantPass& pass);

// Holds the lights that stand for eight clusters, as LightLanes has lights.
struct ClusterRow : VplGroup {
  Lanes near{}, back{}, even{};
  Lanes power{};   // power of all its lights; 0: they are too different, each is asked
  Lanes radius{};  // radius of a cluster around its position
  Lanes spread{};  // largest distance of a light's normal from the cluster's
};

struct LightClusters {
  LightLanes lights;  // as order_lights has them; a group of eight is a cluster
  size_t number = 0;  // number of lights
  std::vector<ClusterRow> rows;
  std::vector<float> inverse_power;  // 1 / power of each cluster, or 0
  std::vector<uint8_t> held;         // lights in each cluster
  size_t size() const { return lights.groups.size(); }
};
// Makes clusters of all lights that are not exact.
LightClusters make_light_clusters(const LightTables& tables, const InstantPass& pass);

// Holds the shares of clusters in the light of places, nothing in between; all shares together are
// 1.
struct ClusterShares {
  std::vector<float> of_cluster;    // one for each cluster, in whole rows
  std::vector<uint32_t> detail_of;  // index in `details`; none: a cluster's lights share by power
  std::vector<Lanes> details;       // shares of the lights of a cluster
  static constexpr uint32_t none = 0xffffffffu;
  std::vector<Lanes> scratch;
};
// Finds the clusters' shares; each place counts for as much as any other. Returns false if nothing
// is lit.
bool share_lights(const LightClusters& clusters, float clip, std::span<const LitPoint> points,
                  ClusterShares& shares);
// Returns the shares of the lights of cluster c.
inline Lanes shares_in(const LightClusters& clusters, const ClusterShares& shares, size_t c) {
  uint32_t detail = shares.detail_of[c];
  if (detail != ClusterShares::none) return shares.details[detail];
  return clusters.lights.power[c] * (shares.of_cluster[c] * clusters.inverse_power[c]);
}

}  // namespace wellspring::light
