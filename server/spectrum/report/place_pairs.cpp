// SPDX-License-Identifier: Apache-2.0
#include "spectrum/report/place_pairs.h"

#include <algorithm>
#include <fmt/core.h>

#include "base/parallel.h"
#include "spectrum/band_matrix.h"
#include "spectrum/color.h"
#include "spectrum/observer.h"

namespace wellspring::spectrum {
namespace {

// Holds how places look under each lamp: Lab by place, then by lamp.
struct PlaceLooks {
  size_t lamps = 0;
  std::vector<dvec3> lab;

  const dvec3& at(size_t place, size_t lamp) const { return lab[place * lamps + lamp]; }
  double difference(size_t a, size_t b, size_t lamp) const {
    return ciede2000(at(a, lamp), at(b, lamp));
  }
  bool are_alike(size_t a, size_t b, double most) const {
    for (size_t lamp = 0; lamp < lamps; lamp++)
      if (difference(a, b, lamp) > most) return false;
    return true;
  }
};

PlaceLooks look_at(const std::vector<double>& nm, const std::vector<std::vector<double>>& places,
                   const std::vector<LampSpectrum>& lamps, Adaptation adaptation) {
  PlaceLooks looks{lamps.size(), std::vector<dvec3>(places.size() * lamps.size())};
  const dvec3 day = LampObserver(find_lamp(daylight_name)->power).white();
  for (size_t lamp = 0; lamp < lamps.size(); lamp++) {
    const std::vector<dvec3> matrix = band_matrix(nm, lamps[lamp].power);
    const dvec3 white = LampObserver(lamps[lamp].power).white();
    for (size_t place = 0; place < places.size(); place++) {
      dvec3 xyz(0);
      for (size_t band = 0; band < nm.size(); band++) xyz += places[place][band] * matrix[band];
      xyz = glm::max(xyz, dvec3(0));
      if (adaptation == Adaptation::cat16) xyz = adapt_cat16(xyz, white, day);
      looks.lab[place * lamps.size() + lamp] = lab_of(xyz, day);
    }
  }
  return looks;
}

PlacePair compare_places(const PlaceLooks& looks, size_t first, size_t second) {
  PlacePair pair{first, second, 0, 0, {}};
  for (size_t lamp = 0; lamp < looks.lamps; lamp++) {
    pair.de00.push_back(looks.difference(first, second, lamp));
    if (pair.de00[lamp] < pair.de00[pair.near_lamp]) pair.near_lamp = lamp;
    if (pair.de00[lamp] > pair.de00[pair.far_lamp]) pair.far_lamp = lamp;
  }
  return pair;
}

double gap_of(const PlacePair& pair) {
  return pair.de00[pair.far_lamp] - pair.de00[pair.near_lamp];
}

bool repeats(const PlacePair& pair, const PlacePair& before, const PlaceLooks& looks, double most) {
  const auto alike = [&](size_t a, size_t b) { return looks.are_alike(a, b, most); };
  return (alike(pair.first, before.first) && alike(pair.second, before.second)) ||
         (alike(pair.first, before.second) && alike(pair.second, before.first));
}

}  // namespace

std::vector<Places> find_unlike_places(const std::vector<double>& nm,
                                       const std::vector<std::vector<double>>& places,
                                       const std::vector<LampSpectrum>& lamps,
                                       const LampReportSettings& settings, const Shard& shard) {
  const PlaceLooks looks = look_at(nm, places, lamps, settings.adaptation);
  std::vector<std::vector<Places>> found(places.size());
  parallel_ranges(int(places.size()), 8, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      for (size_t k = i + 1; k < places.size() && shard.has(i); k++) {
        const PlacePair pair = compare_places(looks, i, k);
        if (pair.de00[pair.near_lamp] <= settings.near_de00 &&
            pair.de00[pair.far_lamp] >= settings.far_de00)
          found[i].emplace_back(i, k);
      }
  });
  std::vector<Places> all;
  for (const std::vector<Places>& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::vector<PlacePair> choose_place_pairs(const std::vector<double>& nm,
                                          const std::vector<std::vector<double>>& places,
                                          const std::vector<LampSpectrum>& lamps,
                                          const LampReportSettings& settings,
                                          std::vector<Places> unlike) {
  const PlaceLooks looks = look_at(nm, places, lamps, settings.adaptation);
  std::ranges::sort(unlike);
  std::vector<PlacePair> all;
  for (const auto& [first, second] : unlike) all.push_back(compare_places(looks, first, second));
  std::ranges::stable_sort(all, std::greater(), gap_of);
  std::vector<PlacePair> pairs;
  for (PlacePair& pair : all) {
    if (pairs.size() == settings.most_pairs) break;
    const bool is_known = std::ranges::any_of(pairs, [&](const PlacePair& before) {
      return repeats(pair, before, looks, settings.near_de00);
    });
    if (!is_known) pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::string place_pairs_text(const std::vector<PlacePair>& pairs,
                             const std::vector<std::string>& names,
                             const std::vector<LampSpectrum>& lamps) {
  size_t width = 6;
  for (const std::string& name : names) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}  {:<{}}", "place", width, "place", width);
  for (const LampSpectrum& lamp : lamps) text += fmt::format("  {:>7}", lamp.name);
  text += "  alike under, unlike under\n";
  for (const PlacePair& pair : pairs) {
    text += fmt::format("{:<{}}  {:<{}}", names[pair.first], width, names[pair.second], width);
    for (size_t i = 0; i < lamps.size(); i++)
      text += fmt::format("  {:>{}.1f}", pair.de00[i], std::max<size_t>(7, lamps[i].name.size()));
    text += "  " + lamps[pair.near_lamp].name + ", " + lamps[pair.far_lamp].name + "\n";
  }
  return text;
}

}  // namespace wellspring::spectrum
