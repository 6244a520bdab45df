// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/region_lights.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "light/virtual/light_clusters.h"
#include "light/random/warp.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {
namespace {

constexpr int most_mirrors = 4;
// Share of the choice that does not depend on the effect: for lights that no probe happens to see.
constexpr double unseen_share = 0.1;

// One of so many candidates is tried on the probes first, to find out whether choosing pays.
constexpr int pilot = 16;

// Returns whether effects are too even for a choice. Choosing by effect keeps what most candidates
// do together if few of them do most of it; this is measured by the effective number of the
// candidates tried first, as a share of them (Kong 1992).
bool is_even(const std::vector<double>& effect) {
  constexpr double enough = 0.35;
  double sum = 0, squares = 0, number = 0;
  for (size_t k = 0; k < effect.size(); k += pilot, number++)
    sum += effect[k], squares += effect[k] * effect[k];
  return sum * sum > enough * number * squares;
}

// Follows mirrors until something rough; returns false if nothing is there.
bool look_behind_mirrors(const Transport& transport, FirstSurface& first, Sampler& sampler) {
  while (first.scatters && first.walk.depth <= most_mirrors) {
    if (has_rough(first.bsdf, mirror_alpha)) return true;
    if (!advance(first.walk, first.surface, sample_bsdf(first.bsdf, Lobes::specular, sampler)))
      return false;
    Hit hit = transport.world.intersect(first.walk.ray);
    if (!hit.valid()) return false;
    first.surface = meet_surface(transport, first.walk.ray, hit, first.walk.media);
    const Material& material = transport.world.material_of(hit.instance);
    first.scatters = !material.unlit;
    first.bsdf = make_bsdf_in(transport, first.walk.media, first.surface, material,
                              first.walk.ray.direction);
  }
  return false;
}

}  // namespace

ViewProbes probe_view(const Transport& transport, const View& view, int max_depth, int count,
                      uint64_t seed, uint32_t index) {
  ViewProbes probes;
  std::vector<FirstSurface> found(size_t(std::max(count, 0)));
  for (int i = 0; i < count; i++) {
    Sampler sampler(seed, index * uint32_t(count) + uint32_t(i));
    vec2 u = sampler.next2();
    Request request;
    request.ray = view_ray(view, u.x * float(view.width), u.y * float(view.height));
    Sample sample;
    FirstSurface first = find_first_surface(transport, max_depth, request, sampler, sample);
    if (!look_behind_mirrors(transport, first, sampler)) continue;
    probes.surfaces.push_back(first.surface);
    probes.bsdfs.push_back(first.bsdf);
    // Any light matters, however many edges it is away.
    probes.media.push_back(first.walk.media);
    probes.places.push_back({});
  }
  for (size_t i = 0; i < probes.places.size(); i++) {
    probes.places[i].surface = &probes.surfaces[i];
    probes.places[i].bsdf = &probes.bsdfs[i];
    probes.places[i].media = &probes.media[i];
  }
  return probes;
}

float probe_free_path(const Transport& transport, const ViewProbes& probes) {
  constexpr uint32_t rays = 4;
  std::vector<float> lengths;
  for (size_t i = 0; i < probes.places.size(); i++)
    for (uint32_t k = 0; k < rays; k++) {
      Sampler sampler(mix64(0x66726565ull), uint32_t(i) * rays + k);
      const Surface& surface = probes.surfaces[i];
      vec3 normal = surface.geometric_normal, tangent, bitangent;
      make_frame_axes(normal, tangent, bitangent);
      vec3 local = sample_cosine_hemisphere(sampler.next2());
      Ray ray;
      ray.direction = tangent * local.x + bitangent * local.y + normal * local.z;
      ray.origin = offset_origin(surface, ray.direction);
      Hit hit = transport.world.intersect(ray);
      if (hit.valid()) lengths.push_back(hit.t);
    }
  if (lengths.empty()) return 0;
  std::nth_element(lengths.begin(), lengths.begin() + long(lengths.size() / 2), lengths.end());
  return lengths[lengths.size() / 2];
}

std::vector<ChosenLight> choose_lights(const Transport& transport, const ViewProbes& probes,
                                       const InstantPass& candidates, uint32_t begin, uint32_t end,
                                       int max_depth, int wanted, int sets, float choose_u,
                                       float deal_u) {
  std::vector<ChosenLight> chosen;
  if (end <= begin || wanted < 1 || sets < 1) return chosen;
  std::vector<double> effect(end - begin, 0.0);
  auto ask = [&](int k) {
    PlaceLight light[RayPacket::lanes];
    uint32_t at = begin + uint32_t(k);
    // Groups of candidates are tried on one half of the probes and the other in turn.
    constexpr size_t turns = 2;
    for (size_t p = size_t(k) / pilot % turns * RayPacket::lanes; p < probes.places.size();
         p += turns * RayPacket::lanes) {
      int count = int(std::min<size_t>(RayPacket::lanes, probes.places.size() - p));
      std::fill_n(light, count, PlaceLight{});
      shade_by_point_lights(transport, candidates, {0, at, 1, at + 1}, max_depth, &probes.places[p],
                            count, light);
      for (int i = 0; i < count; i++) {
        double y = double(max_component(light[i].sum()));
        if (std::isfinite(y)) effect[size_t(k)] += y;
      }
    }
  };
  const int number_asked = int(end - begin), pilots = (number_asked + pilot - 1) / pilot;
  parallel_ranges(pilots, 4, [&](int first, int last) {
    for (int k = first; k < last; k++) ask(k * pilot);
  });
  if (is_even(effect)) {
    for (uint32_t k = begin; k < end; k++) chosen.push_back({k, k % uint32_t(sets), float(sets)});
    return chosen;
  }
  parallel_ranges(number_asked, 64, [&](int first, int last) {
    for (int k = first; k < last; k++)
      if (k % pilot != 0) ask(k);
  });
  double total = 0, number = double(effect.size());
  for (double e : effect) total += e;
  for (double& e : effect)  // from here on, how often a light is wanted
    e = double(wanted) *
        (total > 0 ? (1 - unseen_share) * e / total + unseen_share / number : 1 / number);
  // Systematic sampling: neighbours in the sequence of candidates complement each other, and so do
  // those kept.
  uint32_t slot = 0, first_set = std::min(uint32_t(deal_u * float(sets)), uint32_t(sets - 1));
  double sum = 0;
  for (size_t k = 0; k < effect.size(); k++) {
    sum += effect[k];
    for (; double(slot) + double(choose_u) < sum; slot++)
      chosen.push_back({begin + uint32_t(k), (slot + first_set) % uint32_t(sets),
                        float(double(sets) / effect[k])});
  }
  return chosen;
}

namespace {

constexpr uint32_t region_probes = 16;
// Share of the choice that does not depend on the effect: for surfaces that no probe met, and
// gloss.
constexpr double by_chance = 0.15f;

// Finds places that a region shows; returns how many.
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

// Returns the lists in the order in which they get lights: the lists of any window as large as the
// pattern of sets get lights from all over the order of lights.
std::vector<uint32_t> turns_of_lists(const InstantPass& pass) {
  constexpr int finer = RegionLights::finer;
  std::vector<uint32_t> lists;
  for (int copy = 0; copy < finer * finer; copy++)
    for (int set = 0; set < pass.sets(); set++) {
      int x = copy % finer * pass.columns + set % pass.columns,
          y = copy / finer * pass.rows + set / pass.columns;
      lists.push_back(uint32_t(y * pass.columns * finer + x));
    }
  return lists;
}

// Chooses about `wanted` lights by systematic sampling: neighbours in the order of lights are much
// alike, so that the lights dealt to a list, every so many-th of those chosen, come from
// everywhere.
void choose_lights(const LightClusters& clusters, const ClusterShares& shares, bool lit,
                   double wanted, double worth, float choose_u, std::vector<RegionLight>& chosen) {
  chosen.clear();
  const float even = float(wanted * (lit ? by_chance : 1) / double(clusters.number));
  const float by_share = lit ? float(wanted * (1 - by_chance)) : 0;
  double sum = double(choose_u) - 1;  // each whole number that the sum passes is a choice
  for (size_t c = 0; c < clusters.size(); c++) {
    const int held = clusters.held[c];
    const double all = double((lit ? by_share * shares.of_cluster[c] : 0.0f) + even * float(held));
    if (sum + all <= 0) {
      sum += all;
      continue;
    }
    Lanes often = all_lanes(even);
    if (lit) often += by_share * shares_in(clusters, shares, c);
    float here = float(sum);
    for (int lane = 0; lane < held; lane++)
      for (here += often[lane]; here > 0; here--)
        chosen.push_back(
            {clusters.lights.number[c * lane_count + size_t(lane)], float(worth) / often[lane]});
    sum = double(here);
  }
}

// Holds a region's lights list by list, and how many each list has.
struct Dealt {
  std::vector<RegionLight> lights;
  std::vector<uint32_t> number;
};
Dealt deal_lights(std::span<const uint32_t> turns, std::span<const RegionLight> chosen,
                  float deal_u) {
  const size_t lists = turns.size();
  const size_t start = std::min(size_t(deal_u * float(lists)), lists - 1);
  Dealt dealt;
  dealt.number.assign(lists, 0);
  auto for_each_turn = [&](const auto& body) {
    size_t turn = start;
    for (size_t k = 0; k < chosen.size(); k++, turn = turn + 1 < lists ? turn + 1 : 0)
      body(turns[turn], chosen[k]);
  };
  for_each_turn([&](uint32_t list, const RegionLight&) { dealt.number[list]++; });
  std::vector<uint32_t> next(lists, 0);
  for (size_t l = 1; l < lists; l++) next[l] = next[l - 1] + dealt.number[l - 1];
  dealt.lights.resize(chosen.size());
  for_each_turn([&](uint32_t list, const RegionLight& one) { dealt.lights[next[list]++] = one; });
  return dealt;
}

}  // namespace

void choose_region_lights(const Transport& transport, const View& view, int max_depth, int asked,
                          uint64_t seed, uint32_t index, InstantPass& pass) {
  RegionLights& regions = pass.regions;
  regions = {};
  size_t lists = size_t(pass.lists());
  size_t number = size_t(std::count_if(pass.lights.begin(), pass.lights.end(),
                                       [](const PointLight& light) { return !light.exact; }));
  if (asked < 1 || number <= size_t(asked) * size_t(pass.sets())) return;
  const LightClusters clusters = make_light_clusters(transport.tables, pass);
  regions.width = pass.columns * RegionLights::finer * RegionLights::across;
  regions.height = pass.rows * RegionLights::finer * RegionLights::across;
  regions.columns = (view.width + regions.width - 1) / regions.width;
  int rows = (view.height + regions.height - 1) / regions.height, count = regions.columns * rows;
  const double wanted = double(asked) * double(lists), worth = double(lists) / double(pass.sets());
  const std::vector<uint32_t> turns = turns_of_lists(pass);
  std::vector<Dealt> dealt(static_cast<size_t>(count));
  parallel_ranges(count, 1, [&](int first, int last) {
    ClusterShares shares;
    std::vector<RegionLight> chosen;
    for (int r = first; r < last; r++) {
      Sampler sampler(seed, index * uint32_t(count) + uint32_t(r));
      float choose_u = sampler.next(), deal_u = sampler.next();
      LitPoint points[region_probes];
      int met = probe_region(transport, view, max_depth, regions, r,
                             mix64(seed ^ uint64_t(r + 1) << 32), index * region_probes, points);
      bool lit =
          met > 0 && share_lights(clusters, pass.clip, std::span(points, size_t(met)), shares);
      choose_lights(clusters, shares, lit, wanted, worth, choose_u, chosen);
      dealt[size_t(r)] = deal_lights(turns, chosen, deal_u);
    }
  });
  regions.first.reserve(dealt.size() * lists + 1);
  uint32_t total = 0;
  for (const Dealt& region : dealt)
    for (uint32_t of_list : region.number) {
      regions.first.push_back(total);
      total += of_list;
    }
  regions.first.push_back(total);
  regions.lights.resize(total);
  parallel_ranges(count, 16, [&](int first, int last) {
    for (size_t r = size_t(first); r < size_t(last); r++)
      std::copy(dealt[r].lights.begin(), dealt[r].lights.end(),
                regions.lights.begin() + regions.first[r * lists]);
  });
}

}  // namespace wellspring::light
