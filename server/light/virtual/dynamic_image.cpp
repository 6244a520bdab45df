// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/dynamic_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "light/virtual/direct_light.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {
namespace {

constexpr int bounce_probes = 64;
// Most of what the sun shines on is nowhere near the visible surfaces.
constexpr int parallel_more = 4;  // times as many texels and virtual lights to choose among

void add_irradiance(const RawVector<vec3>& irradiance, LightPlanes& to) {
  parallel_ranges(int(irradiance.size()), 8192, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      to.red[i] += irradiance[i].x * (1 / pi);
      to.green[i] += irradiance[i].y * (1 / pi);
      to.blue[i] += irradiance[i].z * (1 / pi);
    }
  });
}

SplatPixels pixels_of(const SurfaceBuffer& surfaces) {
  SplatPixels pixels;
  pixels.view = surfaces.view;
  pixels.depth = surfaces.depth.data();
  pixels.nx = surfaces.nx.data(), pixels.ny = surfaces.ny.data(), pixels.nz = surfaces.nz.data();
  return pixels;
}

bool is_parallel(const DynamicLight& one) { return one.light.type == PunctualType::directional; }

}  // namespace

size_t memory_bytes(const DynamicImage& image) {
  const DynamicBounce& bounce = image.bounce;
  return memory_bytes(image.surfaces) + memory_bytes(image.light) +
         bytes_of(bounce.sources, bounce.probes) + memory_bytes(bounce.lights) +
         memory_bytes(bounce.picture);
}

SplatSettings dynamic_splat_settings() {
  SplatSettings settings;
  settings.virtual_lights = 512;
  settings.texels = 2048;
  settings.light_rays = 16;
  // Shadows take three times the time of a picture, and look no better under a torch
  // (docs/tried.md).
  settings.visibility = false;
  return settings;
}

void begin_bounce(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                  const SurfaceBuffer& seen, const SplatSettings& settings, SplatSeed seed,
                  DynamicBounce& bounce) {
  bounce.sources.clear();
  if (from.empty() || settings.virtual_lights == 0) return;
  for (const DynamicLight& one : from) {
    bounce.sources.push_back(make_splat_source(one.light, one.id));
    bounce.sources.back().radius = one.radius;
  }
  const Transport transport{world, *lights.tables};
  find_splat_probes(pixels_of(seen), bounce_probes, bounce.probes);
  SplatSettings used = settings;
  if (std::ranges::any_of(from, [](const DynamicLight& one) { return is_parallel(one); }))
    used.texels *= parallel_more, used.virtual_lights *= parallel_more;
  draw_virtual_lights(transport, bounce.sources, used, seed, bounce.probes, bounce.lights);
}

void add_bounce(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
                const SplatSettings& settings, SplatSeed seed, DynamicBounce& bounce,
                LightPlanes& light) {
  if (bounce.sources.empty()) return;
  const Transport transport{world, *lights.tables};
  splat_picture(transport, bounce.lights, pixels_of(surfaces), settings, seed, bounce.picture);
  add_irradiance(bounce.picture.irradiance, light);
}

void light_others(const World& world, const Lights& lights, const DynamicImage& image,
                  std::span<const DynamicLight> from, const SurfaceBuffer& surfaces,
                  SplatPicture& bounce, LightPlanes& light) {
  clear_planes(surfaces, light);
  add_direct_light(world, lights, from, surfaces, light);
  if (image.bounce.sources.empty()) return;
  splat_picture({world, *lights.tables}, image.bounce.lights, pixels_of(surfaces), image.settings,
                {}, bounce);
  add_irradiance(bounce.irradiance, light);
}

void light_surfaces(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                    const SurfaceBuffer& surfaces, const SplatSettings& settings,
                    DynamicBounce& bounce, LightPlanes& light) {
  clear_planes(surfaces, light);
  add_direct_light(world, lights, from, surfaces, light);
  add_bounce(world, lights, surfaces, settings, {}, bounce, light);
}

void compute_dynamic_light(const World& world, const Lights& lights,
                           const VisibilityPass& visibility, const View& view,
                           std::span<const DynamicLight> from, const SplatSettings& settings,
                           DynamicImage& image) {
  image.from.assign(from.begin(), from.end());
  image.settings = settings;
  see_surfaces(visibility, dynamic_light_view(view, passing_dynamic_pixels), image.surfaces);
  begin_bounce(world, lights, from, image.surfaces, settings, {}, image.bounce);
  light_surfaces(world, lights, from, image.surfaces, settings, image.bounce, image.light);
}

void read_dynamic_light(const DynamicImage& image, const View& view, const VisibleRun& run,
                        const RunSurface& surface, RunDynamic& to) {
  const View& lit = image.surfaces.view;
  const LightPlanes& light = image.light;
  const float* planes[] = {light.red.data(),         light.green.data(),
                           light.blue.data(),        light.gloss_red.data(),
                           light.gloss_green.data(), light.gloss_blue.data()};
  float* out[] = {to.light.red, to.light.green, to.light.blue,
                  to.gloss.red, to.gloss.green, to.gloss.blue};
  const RawVector<uint32_t>& glossy = image.surfaces.gloss;
  to.any = true, to.any_gloss = !glossy.empty();
  const int count = to.any_gloss ? 6 : 3;
  if (lit == view) {
    const size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x);
    for (int c = 0; c < count; c++)
      std::memcpy(out[c], planes[c] + at, size_t(run.count) * sizeof(float));
    return;
  }
  const PixelGrid grid(lit), own(view);
  const TapPair row = tap_pair(run.y, lit.height);
  const size_t rows[] = {size_t(row.first) * size_t(lit.width),
                         size_t(row.second) * size_t(lit.width)};
  for (int i = 0; i < run.count; i++) {
    const TapPair column = tap_pair(run.x + i, lit.width);
    const SeenPoint seen =
        seen_point(run.depth[i], run.object[i], surface, i, own.at(float(run.x + i), float(run.y)));
    TapWeights weights;
    if (seen.depth < std::numeric_limits<float>::infinity())
      weights = weigh_taps(image.surfaces, grid, column, row, seen);
    for (int c = 0; c < count; c++) {
      float sum = 0;
      for (size_t k = 0; k < 4; k++)
        sum +=
            weights.of[k] * planes[c][rows[k >> 1] + size_t(k & 1 ? column.second : column.first)];
      out[c][i] = sum;
    }
  }
}

namespace {

constexpr int settles_after = 12;  // pictures

bool shine_alike(const DynamicLight& a, const DynamicLight& b) {
  const PunctualLight &one = a.light, &two = b.light;
  return a.id == b.id && a.radius == b.radius && one.type == two.type &&
         one.position == two.position && one.direction == two.direction &&
         one.intensity == two.intensity && one.range == two.range &&
         one.inner_cone == two.inner_cone && one.outer_cone == two.outer_cone;
}

SplatSettings later_passes(SplatSettings settings) {
  settings.visibility = true;
  // In the mean of many passes noise shows less than a lack of light that all of them share.
  settings.shadow_rays = 2, settings.probe_rays = 0, settings.smooth_visibility = 0;
  settings.bound = 0.25f;
  return settings;
}

constexpr RawVector<float> LightPlanes::*planes[] = {&LightPlanes::red, &LightPlanes::green,
                                                     &LightPlanes::blue};

void mix_planes(const LightPlanes& from, float share, LightPlanes& into) {
  for (auto plane : planes) {
    const RawVector<float>& a = from.*plane;
    RawVector<float>& to = into.*plane;
    parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += (a[i] - to[i]) * share;
    });
  }
}

}  // namespace

size_t memory_bytes(const SettledBounce& settled) {
  return bytes_of(settled.last, settled.lights) + memory_bytes(settled.mean);
}

void take_settled(SettledBounce& settled, DynamicLights& from) {
  std::vector<SettledBounce::Unchanged> now;
  DynamicLights stay, others;
  for (const DynamicLight& light : from) {
    const auto before =
        std::find_if(settled.last.begin(), settled.last.end(),
                     [&](const auto& one) { return shine_alike(one.light, light); });
    const int pictures = before == settled.last.end() ? 0 : before->pictures + 1;
    now.push_back({light, pictures});
    (pictures >= settles_after ? stay : others).push_back(light);
  }
  settled.last = std::move(now);
  if (!std::equal(stay.begin(), stay.end(), settled.lights.begin(), settled.lights.end(),
                  shine_alike))
    settled.pictures = -1, settled.passes = 0;
  settled.pictures++;
  settled.lights = std::move(stay);
  from = std::move(others);
}

bool wants_pass(const SettledBounce& settled) {
  if (settled.lights.empty()) return false;
  return settled.pictures % (settled.passes < most_passes ? between_passes : between_late) == 0;
}

void add_pass(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
              const SplatSettings& settings, SettledBounce& settled, DynamicBounce& bounce) {
  const int pass = settled.passes++;
  const SplatSeed seed{1, uint32_t(pass)};
  const SplatSettings used = pass > 0 ? later_passes(settings) : settings;
  LightPlanes light;
  clear_planes(surfaces, light);
  begin_bounce(world, lights, settled.lights, surfaces, used, seed, bounce);
  add_bounce(world, lights, surfaces, used, seed, bounce, light);
  LightPlanes& mean = settled.mean;
  if (pass == 0) {
    mean = std::move(light);
    return;
  }
  const float share = 1 / float(first_weight + std::min(pass, most_passes));
  mix_planes(light, share, mean);
}

void add_settled(const SettledBounce& settled, LightPlanes& light) {
  if (settled.lights.empty()) return;
  for (auto plane : planes) {
    const RawVector<float>& from = settled.mean.*plane;
    RawVector<float>& to = light.*plane;
    parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += from[i];
    });
  }
}

namespace {

uint8_t code_of(float reflectance) {
  return uint8_t(255 * std::sqrt(std::clamp(reflectance, 0.0f, 1.0f)) + 0.5f);
}

uint32_t shares_of(const TapWeights& weights) {
  uint32_t packed = 0;
  for (int k = 0; k < 4; k++) packed |= uint32_t(255 * weights.of[k] + 0.5f) << (8 * k);
  return packed;
}

}  // namespace

size_t memory_bytes(const BackdropSurfaces& backdrop) {
  return memory_bytes(backdrop.surfaces) + bytes_of(backdrop.reflectance, backdrop.shares);
}

void show_pixel(BackdropSurfaces& backdrop, const PixelGrid& grid, int x, int y,
                const SeenPoint& seen, vec3 reflectance) {
  const size_t at = size_t(y) * size_t(backdrop.view.width) + size_t(x);
  for (int c = 0; c < 3; c++) backdrop.reflectance[3 * at + size_t(c)] = code_of(reflectance[c]);
  if (backdrop.shares.empty()) return;
  const View& lit = backdrop.surfaces.view;
  backdrop.shares[at] = shares_of(
      weigh_taps(backdrop.surfaces, grid, tap_pair(x, lit.width), tap_pair(y, lit.height), seen));
}

void find_backdrop_surfaces(const VisibilityPass& visibility, const View& view,
                            BackdropSurfaces& backdrop) {
  backdrop.view = view;
  const size_t pixels = size_t(view.width) * size_t(view.height);
  const View lit = dynamic_light_view(view);
  see_surfaces(visibility, lit, backdrop.surfaces, RasterShows::still);
  backdrop.reflectance.resize(3 * pixels);
  backdrop.shares.resize(lit == view ? 0 : pixels);
  const PixelGrid grid(lit), own(view);
  auto take = [&](const VisibleRun& run) {
    RunPixels p;
    const RunGlow emitting = describe_run(run, p);
    for (int i = 0; i < run.count; i++) {
      const bool reflects = run.object[i] != 0 && !(emitting.only >> i & 1);
      const RunSurface& s = p.surface;
      show_pixel(
          backdrop, grid, run.x + i, run.y,
          seen_point(run.depth[i], run.object[i], s, i, own.at(float(run.x + i), float(run.y))),
          reflects ? vec3(s.red[i], s.green[i], s.blue[i]) : vec3(0));
    }
  };
  visibility.see(view, vec2(0.5f), take, RasterShows::still);
}

namespace {

// Holds where the light of a run's pixels lies: four places each, or one.
struct RunTaps {
  static constexpr int most = RasterRun::most;
  int count, places;
  uint32_t at[4][most];
  float share[4][most];

  RunTaps(const BackdropSurfaces& backdrop, int x, int y, int run)
      : count(run), places(backdrop.shares.empty() ? 1 : 4) {
    const View& lit = backdrop.surfaces.view;
    if (places == 1) {
      for (int i = 0; i < count; i++) at[0][i] = uint32_t(y * lit.width + x + i), share[0][i] = 1;
      return;
    }
    const TapPair row = tap_pair(y, lit.height);
    const uint32_t above = uint32_t(row.first * lit.width),
                   below = uint32_t(row.second * lit.width);
    const uint32_t* shares = &backdrop.shares[size_t(y) * size_t(backdrop.view.width) + size_t(x)];
    for (int i = 0; i < count; i++) {
      const TapPair column = tap_pair(x + i, lit.width);
      const uint32_t first = uint32_t(column.first), second = uint32_t(column.second);
      at[0][i] = above + first, at[1][i] = above + second;
      at[2][i] = below + first, at[3][i] = below + second;
      for (int k = 0; k < 4; k++) share[k][i] = float(shares[i] >> (8 * k) & 255) * (1 / 255.0f);
    }
  }
  void read(const RawVector<float>& plane, float* to) const {
    for (int i = 0; i < count; i++) to[i] = plane[at[0][i]] * share[0][i];
    for (int k = 1; k < places; k++)
      for (int i = 0; i < count; i++) to[i] += plane[at[k][i]] * share[k][i];
  }
  bool any(const RawVector<uint32_t>& codes) const {
    uint32_t found = 0;
    for (int k = 0; k < places; k++)
      for (int i = 0; i < count; i++) found |= codes[at[k][i]];
    return found != 0;
  }
};

}  // namespace

void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to) {
  const RunTaps taps(backdrop, x, y, count);
  const RawVector<float>* planes[] = {&light.red, &light.green, &light.blue};
  const RawVector<float>* gloss[] = {&light.gloss_red, &light.gloss_green, &light.gloss_blue};
  const RawVector<uint32_t>& codes = backdrop.surfaces.gloss;
  const bool glossy = !codes.empty() && taps.any(codes);
  const uint8_t* reflectance =
      &backdrop.reflectance[3 * (size_t(y) * size_t(backdrop.view.width) + size_t(x))];
  float* out[] = {to.red, to.green, to.blue};
  for (size_t c = 0; c < 3; c++) {
    taps.read(*planes[c], out[c]);
    for (int i = 0; i < count; i++) {
      const float root = float(reflectance[3 * size_t(i) + c]) * (1 / 255.0f);
      out[c][i] *= root * root;
    }
    if (!glossy) continue;
    float more[RunTaps::most];
    taps.read(*gloss[c], more);
    for (int i = 0; i < count; i++) out[c][i] += more[i];
  }
}

}  // namespace wellspring::light
