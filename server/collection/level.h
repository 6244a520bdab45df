// SPDX-License-Identifier: Apache-2.0
// Maps from the whole collection down to a few objects (P06, section 4): each level shows a
// subsample of its region, a step chooses the next region among all objects, not only those that
// are shown.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collection/circle.h"
#include "collection/clusters.h"
#include "collection/collection.h"
#include "collection/layout.h"

namespace wellspring::collection {

inline constexpr size_t most_steps = 24;

// Says how visitors go on from a level: a circle around an object that is shown, or clusters of the
// level that are looked at alone.
struct MapStep {
  int pivot = -1;     // an item of the collection; -1: the step is clusters
  double radius = 0;  // on the map
  std::vector<int> clusters;
};

// Tells what the objects of a cluster have more often than the others on the map.
struct ClusterNature {
  std::vector<uint32_t> terms;     // the most telling ones, at most 3
  std::optional<int> first, last;  // years in which four of five lie
  int count = 0;                   // counts objects that are shown
};

struct MapLevel {
  std::vector<int> among;   // objects that circles choose from
  std::vector<int> region;  // objects that the level is about
  std::vector<int> shown;   // drawn from the region, in the order of `layout`
  Distances distances;      // between those that are shown
  Layout layout;
  Clusters clusters;  // indices count `shown`
  std::vector<ClusterNature> natures;
  double ball = 0;   // the radius by which the region was chosen; 0: by none
  int outliers = 0;  // objects in that circle which the map had shown too near
};

struct MapChoice {
  int most_shown = most_on_map;
  int most_clusters = 6;
  uint64_t seed = 1;
  CircleChoice circle{1, 0.75};  // the least similar quarter would widen balls a lot
};

// Makes the map of all objects.
MapLevel make_first_level(const Collection& collection, const MapChoice& choice = {});
// Makes the map of the next region. Returns none if the level has no such object or cluster.
std::optional<MapLevel> take_step(const Collection& collection, const MapLevel& level,
                                  const MapStep& step, const MapChoice& choice = {});

// Reads steps as addresses have them: "12@0.35;c0,2" is a circle of 0.35 around object 12, then
// clusters 0 and 2. Returns none if the text is anything else, or has too many steps.
std::optional<std::vector<MapStep>> read_trail(std::string_view text);

}  // namespace wellspring::collection
