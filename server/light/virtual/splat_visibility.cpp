// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/splat_visibility.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "light/virtual/splat_lights.h"

namespace wellspring::light {

namespace {
constexpr float lift = 3e-4f;                 // distance off the surface, as a share of its depth
constexpr float apart_share = -4 * 0x1p-23f;  // so many steps of a coordinate, in metres
}  // namespace

vec3 shadow_origin(vec3 place, vec3 normal, float depth, bool apart) {
  SurfacePlace surface;
  surface.position = place + normal * (lift * depth);
  surface.geometric_normal = normal;
  surface.extent = max_component(glm::abs(place));
  if (apart) surface.extent *= apart_share;
  return offset_origin(surface, normal);
}

void ShadowPacket::add(vec3 from, vec3 target, uint32_t item) {
  const int i = count_++;
  vec3 way = target - from;
  rays_.origin_x[i] = from.x, rays_.origin_y[i] = from.y;
  rays_.origin_z[i] = from.z;
  rays_.direction_x[i] = way.x, rays_.direction_y[i] = way.y, rays_.direction_z[i] = way.z;
  rays_.t_max[i] = 1;
  item_[i] = item;
}

uint32_t ShadowPacket::find_blocked() const {
  return transport_.world.occluded_each(rays_, uint32_t((1u << count_) - 1));
}

namespace {

constexpr uint32_t none = 0xffffffffu;
constexpr int most_probe_rays = 32, most_shadow_rays = 256;
constexpr int finest_probed = 2;  // level below which nothing is refined for its shadows

// Holds a subsplat's lit pixel.
struct LitPixel {
  vec3 place{0}, normal{0, 1, 0};
  float depth = 0;
};
bool look_at(const SplatPixels& pixels, const PixelGrid& grid, const Subsplat& one, LitPixel& to) {
  int x, y;
  if (!find_lit_pixel(pixels, one, x, y)) return false;
  const size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  to.place = pixels.view.position + place_from_eye(pixels, grid, x, y);
  to.normal = {pixels.nx[i], pixels.ny[i], pixels.nz[i]};
  to.depth = pixels.depth[i];
  return true;
}

// Leaves each square of each level without an owner.
void start_owners(const MinMaxPyramid& pyramid, SplatShadowRoom& room) {
  size_t total = 0;
  room.first_owner.clear();
  for (const MinMaxLevel& level : pyramid.levels) {
    room.first_owner.push_back(total);
    total += size_t(level.columns) * size_t(level.rows);
  }
  if (room.owner.size() < total) room.owner.resize(total);
  parallel_ranges(int(total), 1 << 16, [&](int begin, int end) {
    std::fill(room.owner.begin() + begin, room.owner.begin() + end, none);
  });
}
uint32_t& owner_of(const MinMaxPyramid& pyramid, SplatShadowRoom& room, int level, int x, int y) {
  size_t row = size_t(y) * size_t(pyramid.levels[size_t(level)].columns);
  return room.owner[room.first_owner[size_t(level)] + row + size_t(x)];
}
bool inside(const MinMaxLevel& level, int x, int y) {
  return x >= 0 && y >= 0 && x < level.columns && y < level.rows;
}

// Tells whether a discontinuity parts two squares of a level.
class Continuity {
 public:
  Continuity(const SplatPixels& pixels, const MinMaxPyramid& pyramid, const SplatSettings& settings)
      : pixels_(pixels), pyramid_(pyramid), settings_(settings), grid_(make_pixel_grid(pixels)) {}
  MinMaxCell cell(int level, int x, int y) const {
    return level > 0 ? pyramid_.at(level, x, y) : look_at_pixel(pixels_, grid_, x, y);
  }
  bool joins(const MinMaxCell& a, const MinMaxCell& b) const {
    return !is_discontinuous(join_cells(a, b), settings_);
  }

 private:
  const SplatPixels& pixels_;
  const MinMaxPyramid& pyramid_;
  const SplatSettings& settings_;
  PixelGrid grid_;
};

// Casts shadow rays of the subsplats `room.current` to probe lights, which are evenly spread over
// all.
void cast_probes(const Transport& transport, const SplatPixels& pixels, const VirtualLights& lights,
                 const Subsplats& subsplats, int probes, int count, SplatShadowRoom& room) {
  const PixelGrid grid = make_pixel_grid(pixels);
  parallel_ranges(count, 16, [&](int begin, int end) {
    ShadowPacket packet(transport);
    auto arrive = [&](uint32_t item, vec3) {
      room.seen[item / uint32_t(probes)] |= 1u << item % uint32_t(probes);
    };
    for (int k = begin; k < end; k++) {
      room.seen[size_t(k)] = 0;
      float* weight = &room.weight[size_t(k) * size_t(probes)];
      std::fill_n(weight, probes, 0.0f);
      LitPixel lit;
      if (!look_at(pixels, grid, subsplats.list[room.current[size_t(k)]], lit)) continue;
      vec3 from = shadow_origin(lit.place, lit.normal, lit.depth, transport.world.any_apart());
      for (int p = 0; p < probes; p++) {
        size_t light = size_t((2 * p + 1) * int64_t(lights.count) / (2 * probes));
        weight[p] = luminance(eval_virtual_light(lights, light, lit.place, lit.normal));
        if (!(weight[p] > 0)) continue;
        if (packet.full()) packet.cast(arrive);
        packet.add(from, lights.target[light], uint32_t(k * probes + p));
      }
    }
    packet.cast(arrive);
  });
}

// Returns the share of the probe lights' light that arrives at only one of both.
float differing_share(const SplatShadowRoom& room, uint32_t a, uint32_t b, int probes) {
  float all = 0, differs = 0;
  for (int p = 0; p < probes; p++) {
    float both =
        room.weight[a * size_t(probes) + size_t(p)] + room.weight[b * size_t(probes) + size_t(p)];
    all += both;
    if ((room.seen[a] ^ room.seen[b]) >> p & 1) differs += both;
  }
  return all > 0 ? differs / all : 0;
}

// Returns the start in a picture's pattern of random numbers: neighbours differ much (interleaved
// gradient noise: Jimenez 2014), passes complement each other (golden ratio).
float start_of(const Subsplat& one, SplatSeed seed) {
  auto fraction = [](double v) { return v - std::floor(v); };
  double place = fraction(0.06711056 * one.x + 0.00583715 * one.y);
  double level = 0.37 * one.level + double(seed.seed % 1024) / 1024;
  return float(fraction(fraction(52.9829189 * place) + level + 0.6180339887498949 * seed.pass));
}

int rays_of(const Subsplat& one, const SplatSettings& settings) {
  int rays = std::clamp(settings.shadow_rays, 1, most_shadow_rays);
  return std::max(1, one.level >= 2 ? rays : one.level == 1 ? rays / 2 : rays / 4);
}

// Chooses the lights that one subsplat's rays go to by what they would add: at even steps of the
// running sum. Neighbours in the list of lights are near each other, so the chosen lights are
// spread everywhere.
template <class Ask>
void choose_asked(const VirtualLights& lights, const float* each, double step, int rays,
                  float start, const Ask& ask) {
  double passed = 0, next = double(start) * step;
  for (size_t i = 0; i < lights.padded(); i += lane_count) {
    const double group = double(lanes_sum(load_lanes(each + i)));
    if (passed + group <= next) {
      passed += group;
      continue;
    }
    for (size_t k = i; k < i + lane_count; k++) {
      passed += double(each[k]);
      for (; next < passed && rays > 0; next += step, rays--)
        if (each[k] > 0) ask(k);
    }
  }
}

// Sends the light of subsplats through shadow rays.
class ShadowedSplats {
 public:
  ShadowedSplats(const Transport& transport, const VirtualLights& lights, SplatShadowRoom& room)
      : lights_(lights), room_(room), packet_(transport) {}
  // Adds a ray. `step`: luminance that each ray stands for.
  void ask(vec3 from, size_t light, uint32_t subsplat, double step) {
    if (packet_.full()) cast();
    packet_.add(from, lights_.target[light], waiting_);
    vec3 intensity = lights_.intensity(light);
    asked_[waiting_++] = {intensity * float(step / double(luminance(intensity))), subsplat};
  }
  void cast() {
    rays_ += waiting_;
    packet_.cast([&](uint32_t item, vec3 tint) {
      SplatShadowRoom::Share& share = room_.shares[asked_[item].subsplat];
      vec3 light = asked_[item].light * tint;
      share.red += light.x, share.green += light.y, share.blue += light.z;
    });
    waiting_ = 0;
  }
  uint64_t rays() const { return rays_; }

 private:
  struct Asked {
    vec3 light;
    uint32_t subsplat;
  };
  const VirtualLights& lights_;
  SplatShadowRoom& room_;
  ShadowPacket packet_;
  Asked asked_[RayPacket::lanes];
  uint32_t waiting_ = 0;
  uint64_t rays_ = 0;
};

// Returns the share of all light that has arrived; -1 if there is none.
SplatShadowRoom::Share share_of(SplatShadowRoom::Share arrived, const IlluminationTexel& all) {
  if (!(all.red + all.green + all.blue > 0)) return {-1, -1, -1};
  auto share = [](float part, float whole) {
    float s = part / whole;
    return s >= 0 && s < 1e6f ? s : 1;  // numbers are too large or too small for a share
  };
  return {share(arrived.red, all.red), share(arrived.green, all.green),
          share(arrived.blue, all.blue)};
}

// Returns the mean share of a subsplat and those around it that it may be mixed with.
vec3 smooth_share(const MinMaxPyramid& pyramid, const Continuity& continuity, const Subsplat& one,
                  int reach, SplatShadowRoom& room) {
  const MinMaxCell own = continuity.cell(one.level, one.x, one.y);
  vec3 sum(0);
  int number = 0;
  for (int y = one.y - reach; y <= one.y + reach; y++)
    for (int x = one.x - reach; x <= one.x + reach; x++) {
      if (!inside(pyramid.levels[one.level], x, y)) continue;
      uint32_t other = owner_of(pyramid, room, one.level, x, y);
      if (other == none || room.shares[other].red < 0) continue;
      bool self = x == one.x && y == one.y;
      if (!self && !continuity.joins(own, continuity.cell(one.level, x, y))) continue;
      const SplatShadowRoom::Share& share = room.shares[other];
      sum += vec3(share.red, share.green, share.blue);
      number++;
    }
  return number > 0 ? sum / float(number) : vec3(1);
}

}  // namespace

uint64_t refine_by_visibility(const Transport& transport, const SplatPixels& pixels,
                              const MinMaxPyramid& pyramid, const VirtualLights& lights,
                              const SplatSettings& settings, Subsplats& subsplats,
                              SplatShadowRoom& room) {
  const int probes = std::clamp(settings.probe_rays, 0, std::min(most_probe_rays, lights.count));
  if (probes == 0) return 0;
  const Continuity continuity(pixels, pyramid, settings);
  uint64_t rays = 0;
  start_owners(pyramid, room);
  for (int level = subsplats.coarsest; level >= finest_probed; level--) {
    room.current.resize(0);
    for (size_t i = 0; i < subsplats.count; i++) {
      const Subsplat& one = subsplats.list[i];
      if (one.level != level) continue;
      owner_of(pyramid, room, level, one.x, one.y) = uint32_t(room.current.size());
      room.current.push_back(uint32_t(i));
    }
    const int count = int(room.current.size());
    if (count == 0) continue;
    room.seen.resize(size_t(count)), room.weight.resize(size_t(count) * size_t(probes));
    subsplats.split.resize(subsplats.count);
    std::fill(subsplats.split.begin(), subsplats.split.end(), uint8_t(0));
    cast_probes(transport, pixels, lights, subsplats, probes, count, room);
    for (float weight : room.weight) rays += weight > 0;
    bool any = false;
    for (uint32_t k = 0; k < uint32_t(count); k++) {
      const Subsplat& one = subsplats.list[room.current[k]];
      const MinMaxCell own = pyramid.at(level, one.x, one.y);
      for (int way = 0; way < 2; way++) {
        int x = one.x + (way == 0), y = one.y + (way == 1);
        if (!inside(pyramid.levels[size_t(level)], x, y)) continue;
        uint32_t other = owner_of(pyramid, room, level, x, y);
        if (other == none || !continuity.joins(own, pyramid.at(level, x, y))) continue;
        if (!(differing_share(room, k, other, probes) > settings.visibility_threshold)) continue;
        subsplats.split[room.current[k]] = subsplats.split[room.current[other]] = 1;
        any = true;
      }
    }
    if (any) part_subsplats(pixels, subsplats);
  }
  return rays;
}

uint64_t splat_shadowed_lights(const Transport& transport, const SplatPixels& pixels,
                               const MinMaxPyramid& pyramid, const VirtualLights& lights,
                               const SplatSettings& settings, SplatSeed seed,
                               const Subsplats& subsplats, SplatShadowRoom& room,
                               IlluminationPyramid& to) {
  const PixelGrid grid = make_pixel_grid(pixels);
  const int count = int(subsplats.count);
  std::atomic<uint64_t> all_rays = 0;
  room.shares.resize(subsplats.count);
  start_owners(pyramid, room);
  parallel_ranges(count, 64, [&](int begin, int end) {
    thread_local RawVector<float> each;
    if (each.size() < lights.padded()) each.resize(lights.padded());
    ShadowedSplats shadowed(transport, lights, room);
    for (int i = begin; i < end; i++) {
      const Subsplat& one = subsplats.list[size_t(i)];
      room.shares[size_t(i)] = {0, 0, 0};
      LitPixel lit;
      if (!look_at(pixels, grid, one, lit)) continue;
      vec3 light = bounded_light(sum_virtual_lights(lights, lit.place, lit.normal, each.data()));
      to.levels[one.level].at(one.x, one.y) = {light.x, light.y, light.z, 1};
      owner_of(pyramid, room, one.level, one.x, one.y) = uint32_t(i);
      double sum = double(luminance(light));
      if (!(sum > 0) || !std::isfinite(sum)) continue;
      const int rays = rays_of(one, settings);
      const double step = sum / rays;
      vec3 from = shadow_origin(lit.place, lit.normal, lit.depth, transport.world.any_apart());
      choose_asked(lights, each.data(), step, rays, start_of(one, seed),
                   [&](size_t chosen) { shadowed.ask(from, chosen, uint32_t(i), step); });
    }
    shadowed.cast();
    all_rays += shadowed.rays();
    for (int i = begin; i < end; i++) {
      const Subsplat& one = subsplats.list[size_t(i)];
      room.shares[size_t(i)] =
          share_of(room.shares[size_t(i)], to.levels[one.level].at(one.x, one.y));
    }
  });
  const Continuity continuity(pixels, pyramid, settings);
  const int reach = std::clamp(settings.smooth_visibility, 0, 8);
  parallel_ranges(count, 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const Subsplat& one = subsplats.list[size_t(i)];
      vec3 share = smooth_share(pyramid, continuity, one, reach, room);
      IlluminationTexel& texel = to.levels[one.level].at(one.x, one.y);
      texel.red *= share.x, texel.green *= share.y, texel.blue *= share.z;
    }
  });
  return all_rays;
}

namespace {

// Returns the share of light `i` that arrives; 1 if it would light no probe.
vec3 find_share(const Transport& transport, std::span<const LitProbe> probes,
                std::span<const vec3> origins, int rays, const VirtualLights& lights, size_t i,
                std::vector<float>& effect) {
  float sum = 0;
  for (size_t k = 0; k < probes.size(); k++)
    sum += effect[k] = luminance(
        bounded_light(eval_virtual_light(lights, i, probes[k].position, probes[k].normal)));
  if (!(sum > 0) || !std::isfinite(sum)) return vec3(1);
  // The numbers are evenly spaced along the running sum, and differ from light to light.
  constexpr double golden = 0.6180339887498949;
  double next = std::fmod(double(i) * golden, 1.0), passed = 0;
  const double step = double(sum) / rays;
  vec3 share(0);
  ShadowPacket packet(transport);
  auto arrive = [&](uint32_t, vec3 tint) { share += tint; };
  for (size_t k = 0; k < probes.size(); k++)
    for (passed += double(effect[k]) / step; next < passed; next++) {
      packet.add(origins[k], lights.target[i], uint32_t(k));
      if (packet.full()) packet.cast(arrive);
    }
  packet.cast(arrive);
  return share / float(rays);
}

void move_light(VirtualLights& lights, size_t from, size_t to, vec3 share) {
  lights.set(to, lights.position(from), lights.normal(from), lights.intensity(from) * share,
             lights.radius2(from));
  lights.target[to] = lights.target[from];
}

}  // namespace

void dim_hidden_lights(const Transport& transport, std::span<const LitProbe> probes, int rays,
                       VirtualLights& lights) {
  if (probes.empty() || rays < 1) return;
  std::vector<vec3> origins;
  const bool apart = transport.world.any_apart();
  for (const LitProbe& probe : probes)
    origins.push_back(shadow_origin(probe.position, probe.normal, probe.depth, apart));
  std::vector<vec3> shares(static_cast<size_t>(lights.count));
  parallel_ranges(lights.count, 16, [&](int begin, int end) {
    std::vector<float> effect(probes.size());
    for (int i = begin; i < end; i++)
      shares[size_t(i)] = find_share(transport, probes, origins, rays, lights, size_t(i), effect);
  });
  int kept = 0;
  for (int i = 0; i < lights.count; i++)
    if (max_component(shares[size_t(i)]) > 0)
      move_light(lights, size_t(i), size_t(kept++), shares[size_t(i)]);
  lights.count = kept;
  fill_up(lights);
}

}  // namespace wellspring::light
