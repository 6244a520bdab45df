// SPDX-License-Identifier: Apache-2.0
#include "light/region_lights.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "light/first_surface.h"
#include "light/light_lanes.h"

namespace wellspring {
namespace {

constexpr uint32_t region_probes = 16;
// Share of the choice that asks for no effect: surfaces that no probe met, and gloss.
constexpr double blind = 0.15f;

// The lights to choose among: of those that a set has besides, only the place is left.
struct Choice {
  LightLanes lights;
  size_t number = 0;
  size_t groups() const { return lights.x.size(); }
};

Choice lights_to_choose(const InstantPass& pass) {
  Choice choice{*pass.lanes};
  for (size_t i = 0; i < choice.lights.number.size(); i++) {
    uint32_t& number = choice.lights.number[i];
    if (number != LightLanes::none && !pass.lights[number].exact) {
      choice.number++;
    } else {
      number = LightLanes::none;
      choice.lights.power[i / lane_count][i % lane_count] = 0;
    }
  }
  return choice;
}

// Places that a region shows.
int probe_region(const Transport& transport, const View& view, int max_depth,
                 const RegionLights& regions, int region, uint64_t seed, uint32_t first_sample,
                 LitPoint* points) {
  int met = 0, left = region % regions.columns * regions.width,
      top = region / regions.columns * regions.height;
  vec2 size(float(std::min(regions.width, view.width - left)),
            float(std::min(regions.height, view.height - top)));
  for (uint32_t p = 0; p < region_probes; p++) {
    Sampler sampler(seed, first_sample + p);
    vec2 place = vec2(float(left), float(top)) + size * sampler.next2();
    Request request;
    request.ray = view_ray(view, place.x, place.y);
    Sample sample;
    FirstSurface seen = find_first_surface(transport, max_depth, request, sampler, sample);
    if (seen.scatters) points[met++] = make_lit_point(seen.surface.position, seen.bsdf);
  }
  return met;
}

// Shares of the lights in what the places get, each place counting for as much as any other; false:
// nothing is lit.
bool share_lights(const Choice& choice, float clip, const LitPoint* points, int count,
                  std::vector<Lanes>& share) {
  // Of every so many groups, what all do to a place is guessed: it is only their weight.
  constexpr size_t guessed = 8;
  const float most = most_of_clip(clip);
  float weight[region_probes];
  for (int p = 0; p < count; p++) {
    Lanes total{};
    for (size_t g = 0; g < choice.groups(); g += guessed)
      total += eval_unshadowed(choice.lights, g, points[p], most);
    float sum = lanes_sum(total);
    weight[p] = sum > 0 && std::isfinite(1 / sum) ? 1 / sum : 0;
  }
  Lanes total{};
  for (size_t g = 0; g < choice.groups(); g++) {
    Lanes sum{};
    for (int p = 0; p < count; p++)
      sum += weight[p] * eval_unshadowed(choice.lights, g, points[p], most);
    share[g] = sum;
    total += sum;
  }
  float all = lanes_sum(total);
  if (!(all > 0) || !std::isfinite(all)) return false;
  for (Lanes& s : share) s *= 1 / all;
  return true;
}

// The k-th chosen light's list: of any window as large as the pattern of sets, lists get lights from all
// over the order.
size_t list_of_turn(const InstantPass& pass, size_t turn) {
  constexpr size_t finer = RegionLights::finer;
  size_t columns = size_t(pass.columns), sets = size_t(pass.sets());
  size_t set = turn % sets, copy = turn / sets % (finer * finer);
  size_t x = copy % finer * columns + set % columns,
         y = copy / finer * size_t(pass.rows) + set / columns;
  return y * columns * finer + x;
}

// Deals about `asked` lights to each list, parts[list]. Systematic sampling: neighbours in the order of
// lights complement each other, and so do those chosen.
void deal_lights(const InstantPass& pass, const Choice& choice, const std::vector<Lanes>& share, bool lit,
                 double asked, float choose_u, float deal_u,
                 std::span<std::vector<RegionLight>> parts) {
  size_t lists = parts.size(), turn = std::min(size_t(deal_u * float(lists)), lists - 1);
  const double wanted = asked * double(lists), worth = double(lists) / double(pass.sets());
  const Lanes even = all_lanes(float(wanted * (lit ? blind : 1) / double(choice.number)));
  const float by_share = float(wanted * (1 - blind));
  double sum = double(choose_u) - 1;  // whole numbers that it passes are choices
  for (size_t g = 0; g < choice.groups(); g++) {
    const uint32_t* numbers = &choice.lights.number[g * lane_count];
    Lanes often = lit ? share[g] * by_share + even : even;
    for (int lane = 0; lane < lane_count; lane++)
      if (numbers[lane] == LightLanes::none) often[lane] = 0;
    double all = double(lanes_sum(often));
    if (sum + all <= 0) {
      sum += all;
      continue;
    }
    for (int lane = 0; lane < lane_count; lane++)
      for (sum += double(often[lane]); sum > 0; sum--, turn++)
        parts[list_of_turn(pass, turn % lists)].push_back(
            {numbers[lane], float(worth / double(often[lane]))});
  }
}

}  // namespace

void choose_region_lights(const Transport& transport, const View& view, int max_depth, int asked,
                          uint64_t seed, uint32_t index, InstantPass& pass) {
  RegionLights& regions = pass.regions;
  regions = {};
  size_t lists = size_t(pass.lists());
  Choice choice = lights_to_choose(pass);
  if (asked < 1 || choice.number <= size_t(asked) * size_t(pass.sets())) return;
  regions.width = pass.columns * RegionLights::finer * RegionLights::across;
  regions.height = pass.rows * RegionLights::finer * RegionLights::across;
  regions.columns = (view.width + regions.width - 1) / regions.width;
  int rows = (view.height + regions.height - 1) / regions.height, count = regions.columns * rows;
  std::vector<std::vector<RegionLight>> chosen(size_t(count) * lists);
  parallel_ranges(count, 1, [&](int first, int last) {
    std::vector<Lanes> share(choice.groups());
    for (int r = first; r < last; r++) {
      Sampler sampler(seed, index * uint32_t(count) + uint32_t(r));
      float choose_u = sampler.next(), deal_u = sampler.next();
      LitPoint points[region_probes];
      int met = probe_region(transport, view, max_depth, regions, r, mix64(seed ^ uint64_t(r + 1) << 32),
                             index * region_probes, points);
      bool lit = met > 0 && share_lights(choice, pass.clip, points, met, share);
      deal_lights(pass, choice, share, lit, double(asked), choose_u, deal_u,
                  std::span(chosen).subspan(size_t(r) * lists, lists));
    }
  });
  regions.first.reserve(chosen.size() + 1);
  for (const std::vector<RegionLight>& part : chosen) {
    regions.first.push_back(uint32_t(regions.lights.size()));
    regions.lights.insert(regions.lights.end(), part.begin(), part.end());
  }
  regions.first.push_back(uint32_t(regions.lights.size()));
}

}  // namespace wellspring
