// SPDX-License-Identifier: Apache-2.0
#include "light/instant/view_probes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/walk/first_surface.h"
#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr int most_mirrors = 4;
// Share of the choice that does not ask for the effect: lights that no probe happens to see.
constexpr double blind = 0.1;

// Of so many candidates one is asked first what it does, to tell whether choosing pays.
constexpr int pilot = 16;

// Choosing by effect keeps what most candidates do together when few of them do most of it. The
// effective number of those asked first, as a share of them (Kong 1992), tells.
bool is_even(const std::vector<double>& effect) {
  constexpr double enough = 0.35;
  double sum = 0, squares = 0, number = 0;
  for (size_t k = 0; k < effect.size(); k += pilot, number++)
    sum += effect[k], squares += effect[k] * effect[k];
  return sum * sum > enough * number * squares;
}

// Follows mirrors until something rough; false: nothing is there.
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
    constexpr size_t turns = 2;  // candidates in turn ask one half of the probes and the other
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
  for (double& e : effect)  // becomes how often a light is wanted
    e = double(wanted) * (total > 0 ? (1 - blind) * e / total + blind / number : 1 / number);
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

}  // namespace wellspring::light
