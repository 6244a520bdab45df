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

constexpr uint32_t region_probes = 8;
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

// Shares of the lights in what a few places of the region get, in the mean; false: nothing is lit.
bool probe_region(const Transport& transport, const View& view, int max_depth, const Choice& choice,
                  const InstantPass& pass, int region, uint64_t seed, uint32_t first_sample,
                  std::vector<Lanes>& effect, std::vector<Lanes>& share) {
  const RegionLights& regions = pass.regions;
  std::fill(share.begin(), share.end(), all_lanes(0));
  int met = 0;
  for (uint32_t p = 0; p < region_probes; p++) {
    Sampler sampler(seed, first_sample + p);
    vec2 u = sampler.next2();
    float x = (float(region % regions.columns) + u.x) * float(regions.width),
          y = (float(region / regions.columns) + u.y) * float(regions.height);
    if (x >= float(view.width) || y >= float(view.height)) continue;
    Request request;
    request.ray = view_ray(view, x, y);
    Sample sample;
    FirstSurface seen = find_first_surface(transport, max_depth, request, sampler, sample);
    if (!seen.scatters) continue;
    float total = eval_unshadowed(choice.lights, 0, choice.groups(), seen.surface.position,
                                  seen.bsdf, pass.clip * pass.clip, effect.data());
    if (!(total > 0) || !std::isfinite(total)) continue;
    met++;
    for (size_t g = 0; g < choice.groups(); g++) share[g] += effect[g] / total;
  }
  for (Lanes& s : share) s /= float(std::max(met, 1));
  return met > 0;
}

// Deals about `wanted` choices to the sets in turn, parts[set]. Systematic sampling: neighbours in the
// order of lights complement each other, and so do those chosen.
void deal_lights(const Choice& choice, const std::vector<Lanes>& share, bool lit, double wanted,
                 float choose_u, float deal_u, std::span<std::vector<RegionLight>> parts) {
  uint32_t slot = 0, sets = uint32_t(parts.size()),
           deal = std::min(uint32_t(deal_u * float(sets)), sets - 1);
  double sum = 0, even = (lit ? blind : 1) / double(choice.number);
  for (size_t k = 0; k < choice.lights.number.size(); k++) {
    if (choice.lights.number[k] == LightLanes::none) continue;
    double part = lit ? (1 - blind) * double(share[k / lane_count][k % lane_count]) : 0;
    double often = wanted * (part + even);
    sum += often;
    for (; double(slot) + double(choose_u) < sum; slot++)
      parts[(slot + deal) % sets].push_back({choice.lights.number[k], float(1 / often)});
  }
}

}  // namespace

void choose_region_lights(const Transport& transport, const View& view, int max_depth, int asked,
                          uint64_t seed, uint32_t index, InstantPass& pass) {
  RegionLights& regions = pass.regions;
  regions = {};
  size_t sets = size_t(pass.sets());
  Choice choice = lights_to_choose(pass);
  if (asked < 1 || choice.number <= size_t(asked) * sets) return;
  regions.width = pass.columns * RegionLights::across;
  regions.height = pass.rows * RegionLights::across;
  regions.columns = (view.width + regions.width - 1) / regions.width;
  int rows = (view.height + regions.height - 1) / regions.height, count = regions.columns * rows;
  std::vector<std::vector<RegionLight>> chosen(size_t(count) * sets);
  parallel_ranges(count, 4, [&](int first, int last) {
    std::vector<Lanes> effect(choice.groups()), share(choice.groups());
    for (int r = first; r < last; r++) {
      Sampler sampler(seed, index * uint32_t(count) + uint32_t(r));
      float choose_u = sampler.next(), deal_u = sampler.next();
      bool lit = probe_region(transport, view, max_depth, choice, pass, r,
                              mix64(seed ^ uint64_t(r + 1) << 32), index * region_probes, effect,
                              share);
      deal_lights(choice, share, lit, double(asked) * double(sets), choose_u, deal_u,
                  std::span(chosen).subspan(size_t(r) * sets, sets));
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
