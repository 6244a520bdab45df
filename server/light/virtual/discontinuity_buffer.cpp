// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/discontinuity_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "light/sample/sample_light.h"
#include "light/virtual/caustic_photons.h"
#include "light/virtual/eye_light.h"
#include "light/walk/first_surface.h"
#include "light/walk/trace_lambert.h"

namespace wellspring::light {
namespace {

// Difference of albedo between pixels beyond which there is an edge.
constexpr float color_step = 0.1f;

// Flags of a pixel of the picture; 0 outside.
constexpr int32_t inside = 1, hit = 2, smooth = 4;  // smooth: irradiance is known there

// Neighbours of a row are shifted copies of it: eight pixels are compared at once. Rows have room
// before and behind them.
constexpr int margin = 16;

struct Plane {
  std::vector<float> values;
  Lanes at(size_t i) const { return load_lanes(values.data() + i); }
};
struct Plane3 {
  Plane x, y, z;
  Lanes3 at(size_t i) const { return {x.at(i), y.at(i), z.at(i)}; }
  void set(size_t i, const Lanes3& v) {
    store_lanes(&x.values[i], v.x), store_lanes(&y.values[i], v.y), store_lanes(&z.values[i], v.z);
  }
};
LaneMask load_mask(const int32_t* from) {
  LaneMask mask;
  std::memcpy(&mask, from, sizeof mask);
  return mask;
}

struct Offset {
  int across = 0, down = 0;
  bool in_window = false, neighbour = false;
};

// Returns half of a window's offsets and half of the eight neighbours': comparisons are mutual.
std::vector<Offset> make_offsets(int across, int down, int step, bool edges) {
  std::vector<Offset> offsets;
  int widest = std::max(across, 1), highest = std::max(down, 1);
  for (int v = 0; v <= highest; v++)
    for (int u = -widest; u <= widest; u++) {
      if (v == 0 && u <= 0) continue;
      bool in_window = std::abs(u) <= across && v <= down,
           neighbour = edges && std::abs(u) <= 1 && v <= 1;
      if (in_window && step > 1) offsets.push_back({u * step, v * step, true, false});
      in_window &= step == 1;
      if (in_window || neighbour) offsets.push_back({u, v, in_window, neighbour});
    }
  return offsets;
}

// Holds some rows of a picture, each part of the samples by itself.
struct Band {
  int first_row, rows, width;
  size_t stride;
  Plane3 position, normal, albedo, smooth;
  Plane distance;
  std::vector<int32_t> object, known;
  std::vector<std::vector<int32_t>> joined;  // for each offset and pixel; -1: light is shared
  std::vector<float> number;                 // number of pixels that each pixel shares with
  std::vector<int32_t> edge;                 // not 0: there is an edge

  size_t at(int x, int y) const { return size_t(y - first_row) * stride + size_t(x + margin); }
};

// Sets eight pixels from samples, each of whose halves is eight numbers side by side.
void set_pixels(const Sample* const (&from)[lane_count], unsigned within, size_t i, Band& band) {
  static_assert(offsetof(Sample, distance) == 6 * sizeof(float));
  static_assert(offsetof(Sample, smooth) == offsetof(Sample, albedo) + 3 * sizeof(float));
  static_assert(offsetof(Sample, flags) >= offsetof(Sample, albedo) + 8 * sizeof(float));
  Lanes first[lane_count], second[lane_count];
  LaneMask object, flags;
  for (int k = 0; k < lane_count; k++) {
    first[k] = load_lanes(&from[k]->position.x);
    second[k] = load_lanes(&from[k]->albedo.x);
    object[k] = int32_t(from[k]->object), flags[k] = from[k]->flags;
  }
  transpose_lanes(first);
  transpose_lanes(second);
  band.position.set(i, {first[0], first[1], first[2]});
  band.normal.set(i, {first[3], first[4], first[5]});
  store_lanes(&band.distance.values[i], first[6]);
  const Lanes3 albedo{second[0], second[1], second[2]};
  band.albedo.set(i, albedo);
  band.smooth.set(i, {second[3], second[4], second[5]});
  store_lanes(&band.object[i], object);
  const LaneMask is_hit = (flags & int32_t(sample_hit)) != 0;
  const LaneMask is_lit = is_hit & (max_component(albedo) > Lanes{});
  const LaneMask known = (is_hit & hit) | (is_lit & smooth) | inside;
  store_lanes(&band.known[i], lanes_of_bits(within) & known);
}

Band make_band(const View& view, std::span<const Sample> samples, int first_row, int rows,
               size_t offsets) {
  Band band;
  band.first_row = first_row, band.rows = rows, band.width = view.width;
  band.stride = size_t(view.width + 3 * margin);
  size_t size = band.stride * size_t(rows);
  for (Plane3* p : {&band.position, &band.normal, &band.albedo, &band.smooth})
    for (Plane* q : {&p->x, &p->y, &p->z}) q->values.assign(size, 0.0f);
  band.distance.values.assign(size, 0.0f);
  band.object.assign(size, 0);
  band.known.assign(size, 0);
  band.joined.assign(offsets, std::vector<int32_t>(size, 0));
  band.number.assign(size, 0);
  band.edge.assign(size, 0);
  for (int y = std::max(first_row, 0); y < std::min(first_row + rows, view.height); y++)
    for (int x = 0; x < view.width; x += lane_count) {
      const Sample* row = &samples[size_t(y) * size_t(view.width)];
      const Sample* from[lane_count];
      for (int k = 0; k < lane_count; k++) from[k] = row + std::min(x + k, view.width - 1);
      int within = std::min(view.width - x, lane_count);
      set_pixels(from, (1u << within) - 1, band.at(x, y), band);
    }
  return band;
}

// Returns is_continuous for eight pixels from i on and those from j on.
LaneMask are_continuous(const Band& band, size_t i, size_t j, const DiscontinuitySettings& settings,
                        float pixel) {
  Lanes3 n = band.normal.at(i), m = band.normal.at(j);
  Lanes3 step = band.position.at(j) - band.position.at(i);
  Lanes apart = lanes_max(lanes_abs(dot(step, n)), lanes_abs(dot(step, m)));
  Lanes most = lanes_min(band.distance.at(i), band.distance.at(j)) * (settings.distance * pixel);
  return (load_mask(&band.object[i]) == load_mask(&band.object[j])) &
         (dot(n, m) >= all_lanes(settings.normal)) & (apart <= most);
}

void add_mask(std::vector<float>& number, size_t i, LaneMask mask) {
  store_lanes(&number[i], load_lanes(&number[i]) - __builtin_convertvector(mask, Lanes));
}
void add_bits(std::vector<int32_t>& bits, size_t i, LaneMask mask) {
  store_lanes(&bits[i], load_mask(&bits[i]) | mask);
}

// Compares the pixels of a row with those at an offset.
void compare_row(Band& band, int y, const Offset& offset, std::vector<int32_t>& joined,
                 const DiscontinuitySettings& settings, float pixel) {
  for (int x = 0; x < band.width; x += lane_count) {
    size_t i = band.at(x, y), j = band.at(x + offset.across, y + offset.down);
    LaneMask a = load_mask(&band.known[i]), b = load_mask(&band.known[j]);
    LaneMask both = (a & b & inside) != 0;
    if (!negative_lanes(both)) continue;
    LaneMask goes_on = are_continuous(band, i, j, settings, pixel), seen = (a & b & hit) != 0;
    if (offset.in_window) {
      LaneMask join = goes_on & ((a & b & smooth) != 0);
      store_lanes(&joined[i], join);
      add_mask(band.number, i, join);
      add_mask(band.number, j, join);
    }
    if (offset.neighbour) {
      Lanes3 change = band.albedo.at(i) - band.albedo.at(j);
      Lanes most =
          lanes_max(lanes_abs(change.x), lanes_max(lanes_abs(change.y), lanes_abs(change.z)));
      LaneMask edge = both & ((((a ^ b) & hit) != 0) | (seen & ((most > color_step) | ~goes_on)));
      add_bits(band.edge, i, edge);
      add_bits(band.edge, j, edge);
    }
  }
}

// Computes the weighted means of a row's pixels.
void filter_row(const Band& band, int y, std::span<const Offset> offsets, Plane3& filtered) {
  for (int x = 0; x < band.width; x += lane_count) {
    size_t i = band.at(x, y);
    Lanes3 own = band.smooth.at(i), sum;
    Lanes rest = all_lanes(1), mine = load_lanes(&band.number[i]);
    auto add = [&](size_t j, LaneMask join) {
      if (!negative_lanes(join)) return;
      Lanes weight = 1 / (1 + lanes_max(mine, load_lanes(&band.number[j])));
      weight = join ? weight : Lanes{};
      sum = sum + band.smooth.at(j) * weight;
      rest -= weight;
    };
    for (size_t k = 0; k < offsets.size(); k++) {
      const Offset& o = offsets[k];
      if (!o.in_window) continue;
      size_t before = band.at(x - o.across, y - o.down);
      add(band.at(x + o.across, y + o.down), load_mask(&band.joined[k][i]));
      add(before, load_mask(&band.joined[k][before]));
    }
    filtered.set(i, sum + own * rest);
  }
}

struct Window {
  DiscontinuitySettings settings;
  std::vector<Offset> offsets;
  int reach = 1;  // rows to the farthest neighbour
  int later = 0;  // rows beyond a band that later windows read
  // Returns the rows before a band that it needs: a pixel's neighbours count by their numbers of
  // continuous pixels, which reach as far again.
  int before() const { return later + 2 * reach; }
};

std::vector<Window> make_windows(std::span<const DiscontinuitySettings> all, bool edges) {
  std::vector<Window> windows;
  for (const DiscontinuitySettings& one : all) {
    Window window{one, {}, 1, 0};
    int across = std::clamp(one.columns / 2, 0, 3), down = std::clamp(one.rows / 2, 0, 3),
        step = std::clamp(one.step, 1, 3);
    window.offsets = make_offsets(across, down, step, edges && windows.empty());
    window.reach = std::max(down * step, 1);
    for (Window& earlier : windows) earlier.later += window.reach;
    windows.push_back(window);
  }
  return windows;
}

// Applies all windows to the rows [top, bottom) of a band.
void filter_band(std::span<const Window> windows, int top, int bottom, float pixel, Band& band) {
  Plane3 filtered = band.smooth;
  for (const Window& window : windows) {
    if (window.offsets.empty()) continue;
    if (&window != &windows[0]) band.number.assign(band.number.size(), 0.0f);
    int first = top - window.later, last = bottom + window.later;
    for (size_t k = 0; k < window.offsets.size(); k++) {
      if (&window != &windows[0]) band.joined[k].assign(band.joined[k].size(), 0);
      for (int y = first - 2 * window.reach; y < last + window.reach; y++)
        compare_row(band, y, window.offsets[k], band.joined[k], window.settings, pixel);
    }
    for (int y = first; y < last; y++) filter_row(band, y, window.offsets, filtered);
    std::swap(band.smooth, filtered);
  }
}

}  // namespace

bool is_continuous(const Sample& a, const Sample& b, const DiscontinuitySettings& settings,
                   float pixel) {
  if (a.object != b.object) return false;
  if (!(dot(a.normal, b.normal) >= settings.normal)) return false;
  vec3 step = b.position - a.position;
  float apart = std::max(std::abs(dot(step, a.normal)), std::abs(dot(step, b.normal)));
  return apart <= settings.distance * pixel * std::min(a.distance, b.distance);
}

bool is_edge(const Sample& a, const Sample& b, const DiscontinuitySettings& settings, float pixel) {
  if ((a.flags & sample_hit) != (b.flags & sample_hit)) return true;
  if (!(a.flags & sample_hit)) return false;
  if (max_component(glm::abs(a.albedo - b.albedo)) > color_step) return true;
  return !is_continuous(a, b, settings, pixel);
}

void filter_windows(const View& view, std::span<const DiscontinuitySettings> windows,
                    std::span<Sample> samples, std::vector<uint8_t>* edges) {
  if (samples.size() != size_t(view.width) * size_t(view.height))
    throw std::invalid_argument("discontinuity buffer: one sample a pixel");
  constexpr int band_rows = 16;
  const std::vector<Window> all = make_windows(windows, edges != nullptr);
  if (edges) edges->assign(samples.size(), 0);
  size_t offsets = 0;
  int before = 0;
  for (const Window& window : all) {
    offsets = std::max(offsets, window.offsets.size());
    before = std::max(before, window.before());
  }
  if (offsets == 0) return;
  float pixel = 2 * view.tan_half_fov / float(view.height);
  RawVector<vec3> filtered(samples.size());
  const int parts = (view.height + band_rows - 1) / band_rows;
  parallel_each(parts, [&](int part) {
    int top = part * band_rows, bottom = std::min(top + band_rows, view.height);
    Band band = make_band(view, samples, top - before, bottom - top + 2 * before, offsets);
    filter_band(all, top, bottom, pixel, band);
    for (int y = top; y < bottom; y++)
      for (int x = 0; x < view.width; x++) {
        size_t i = band.at(x, y), k = size_t(y) * size_t(view.width) + size_t(x);
        filtered[k] = {band.smooth.x.values[i], band.smooth.y.values[i], band.smooth.z.values[i]};
        if (edges) (*edges)[k] = band.edge[i] != 0;
      }
  });
  parallel_ranges(int(samples.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; i++) samples[size_t(i)].smooth = filtered[size_t(i)];
  });
}

namespace {

// Holds what the additional samples of a pixel have found.
struct Refined {
  size_t pixel = 0;
  int lit = 0;       // samples besides the pixel's own
  vec3 radiance{0};  // sum over these samples
};

struct Refining {
  const World& world;
  const Lights& lights;
  const TransportSettings& settings;
  const View& view;
  const DiscontinuitySettings& continuity;
  int rays;
  uint64_t seed;
  uint32_t index;
  std::span<const uint8_t> edges;
  std::span<const Sample> samples;
  float pixel_angle;
};

// Returns the pixel nearest to (x, y) in the picture that shows the surface of `sample`; null:
// none.
const Sample* find_same(const Refining& r, const Sample& sample, float x, float y) {
  const Sample* best = nullptr;
  float nearest = std::numeric_limits<float>::infinity();
  int column = int(x), row = int(y);
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, r.view.height - 1); v++)
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, r.view.width - 1); u++) {
      float dx = float(u) + 0.5f - x, dy = float(v) + 0.5f - y, away = dx * dx + dy * dy;
      const Sample& other = r.samples[size_t(v) * size_t(r.view.width) + size_t(u)];
      if (away >= nearest || !(other.flags & sample_hit)) continue;
      if (!is_continuous(sample, other, r.continuity, r.pixel_angle)) continue;
      nearest = away;
      best = &other;
    }
  return best;
}

// Takes the light of a neighbour that shows the same surface; returns false if none does.
bool take_light(const Refining& r, const Sample& sample, vec2 place, vec3& radiance) {
  const Sample* same = find_same(r, sample, place.x, place.y);
  if (same) radiance = sample.albedo * same->smooth + same->rest;
  return same;
}

// Finds the ray's radiance from its neighbours; returns false if they do not suffice.
bool eval_alike(const Refining& r, const Request& request, vec2 place, vec3& radiance) {
  Transport transport{r.world, *r.lights.tables};
  Sampler sampler(request.seed, request.index);
  Sample sample;
  FirstSurface first =
      find_first_surface(transport, r.settings.max_depth, request, sampler, sample);
  if (!first.scatters && !first.mirrored) {
    radiance = sample.rest;
    return true;
  }
  if (!first.scatters || max_component(sample.rest) > 0) return false;
  sample.albedo = demodulated_reflectance(first).albedo * first.tint;
  return take_light(r, sample, place, radiance);
}

// Holds the rays that a row's edges need, and their places in the picture.
struct Looks {
  std::vector<Request> requests;
  std::vector<vec2> places;
  std::vector<size_t> pixels;  // index in the row's list, for each ray
};

Looks look_at_edges(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks;
  for (int x = 0; x < r.view.width; x++) {
    Refined pixel;
    pixel.pixel = size_t(y) * size_t(r.view.width) + size_t(x);
    if (!r.edges[pixel.pixel]) continue;
    pixel.lit = r.rays;
    uint64_t seed = mix64(r.seed + pixel.pixel);
    for (int i = 0; i < r.rays; i++) {
      Request request;
      request.pixel = uint32_t(pixel.pixel);
      request.seed = seed;
      request.index = r.index * uint32_t(r.rays) + uint32_t(i);
      Sampler jitter(mix64(seed ^ 0x6a09e667f3bcc909ull), request.index);
      vec2 place = vec2(float(x), float(y)) + jitter.next2();
      request.ray = view_ray(r.view, place.x, place.y);
      looks.requests.push_back(request);
      looks.places.push_back(place);
      looks.pixels.push_back(refined.size());
    }
    refined.push_back(pixel);
  }
  return looks;
}

void refine_row(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks = look_at_edges(r, y, refined);
  std::vector<uint32_t> unknown;
  std::vector<Sample> samples(looks.requests.size());
  LambertHits seen = see_lambert({r.world, *r.lights.tables}, looks.requests, samples);
  vec3 radiance;
  auto answer = [&](uint32_t i, bool known) {
    if (known) refined[looks.pixels[i]].radiance += radiance;
    else unknown.push_back(i);
  };
  for (uint32_t i : seen.nothing) refined[looks.pixels[i]].radiance += samples[i].rest;
  for (const LambertHit& eye : seen.eyes)
    answer(eye.request, take_light(r, samples[eye.request], looks.places[eye.request], radiance));
  for (uint32_t i : seen.others)
    answer(i, eval_alike(r, looks.requests[i], looks.places[i], radiance));
  std::vector<Request> asked;
  for (uint32_t i : unknown) asked.push_back(looks.requests[i]);
  samples.resize(asked.size());
  trace_many_instant(r.world, r.lights, r.settings, asked, samples);
  for (size_t i = 0; i < asked.size(); i++)
    refined[looks.pixels[unknown[i]]].radiance += samples[i].radiance();
}

}  // namespace

void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples) {
  if (rays < 1 || settings.max_depth < 1) return;
  Refining refining{world,
                    lights,
                    settings,
                    view,
                    continuity,
                    rays,
                    seed,
                    index,
                    edges,
                    samples,
                    2 * view.tan_half_fov / float(view.height)};
  std::vector<std::vector<Refined>> rows(size_t(view.height));
  parallel_each(view.height, [&](int y) { refine_row(refining, y, rows[size_t(y)]); });
  parallel_for(view.height, [&](int y) {
    for (const Refined& pixel : rows[size_t(y)]) {
      Sample& sample = samples[pixel.pixel];
      float own = 1 / float(1 + pixel.lit);
      sample.albedo *= own;
      sample.rest = own * (sample.rest + pixel.radiance);
      sample.glow *= own;
      sample = finish_sample(lights, settings, sample);
    }
  });
}

}  // namespace wellspring::light
