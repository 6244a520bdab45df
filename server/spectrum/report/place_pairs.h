// SPDX-License-Identifier: Apache-2.0
// Finds metamers in a picture of many bands: two places that look alike under one lamp and unlike
// under another, as paint and its retouching do.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/shard.h"
#include "spectrum/report/lamp_report.h"

namespace wellspring::spectrum {

// Names two places, by their number, and how far their colours are apart under each lamp.
struct PlacePair {
  size_t first = 0, second = 0, near_lamp = 0, far_lamp = 0;
  std::vector<double> de00;  // CIEDE2000, for each lamp
};

// Returns the pairs of places that are nearer than `settings.near_de00` under one of the lamps and
// farther than `settings.far_de00` under another, those whose first place is of the shard.
// `places`: reflectances at each of `nm`, which rise. Takes half a microsecond for each two places
// and lamp.
using Places = std::pair<size_t, size_t>;
std::vector<Places> find_unlike_places(const std::vector<double>& nm,
                                       const std::vector<std::vector<double>>& places,
                                       const std::vector<LampSpectrum>& lamps,
                                       const LampReportSettings& settings, const Shard& shard = {});

// Returns those of `unlike`, which holds all shards' pairs in whatever order, with the largest gap
// between the two lamps first, at most `settings.most_pairs`. A pair that repeats one before it,
// since each of its places looks like one of that pair under all lamps, is left out.
std::vector<PlacePair> choose_place_pairs(const std::vector<double>& nm,
                                          const std::vector<std::vector<double>>& places,
                                          const std::vector<LampSpectrum>& lamps,
                                          const LampReportSettings& settings,
                                          std::vector<Places> unlike);

// Writes a table of pairs for a terminal; `names` are those of the places.
std::string place_pairs_text(const std::vector<PlacePair>& pairs,
                             const std::vector<std::string>& names,
                             const std::vector<LampSpectrum>& lamps);

}  // namespace wellspring::spectrum
