// SPDX-License-Identifier: Apache-2.0
#include "picture/still/reconstruct_still.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "light/technique/technique.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::picture {
namespace {

struct GuidePass {
  const World& world;
  const Lights& lights;
  const View& view;
  vec2 place;
  bool first;  // whether this is the first pass
  GuidePlanes& planes;
  std::vector<uint8_t>& followed;

  void add(size_t pixel, const Guide& guide) const {
    constexpr float share = 1 / float(guide_places);
    planes.albedo[pixel] += guide.albedo * share;
    planes.normal[pixel] += guide.normal * share;
  }
  void take(const VisibleRun& run) const;
  void follow(const VisibleRun& run, uint64_t polished, size_t begin) const;
};

// Sends rays to polished surfaces that the run shows.
void GuidePass::follow(const VisibleRun& run, uint64_t polished, size_t begin) const {
  Ray rays[RasterRun::most];
  Guide guides[RasterRun::most];
  int pixel[RasterRun::most], count = 0;
  for (; polished != 0; polished &= polished - 1) {
    int i = pixel[count] = std::countr_zero(polished);
    rays[count++] = view_ray(view, float(run.x + i) + place.x, float(run.y) + place.y);
  }
  eval_guides(world, lights, std::span(rays, size_t(count)), std::span(guides, size_t(count)));
  for (int k = 0; k < count; k++) {
    const size_t at = begin + size_t(pixel[k]);
    planes.albedo[at] = guides[k].albedo, planes.normal[at] = guides[k].normal;
    followed[at] = 1;
  }
}

void GuidePass::take(const VisibleRun& run) const {
  RunPixels p;
  const RunGlow emitting = describe_run(run, p);
  const uint64_t polished = first ? run.polished() : 0;
  const size_t begin = size_t(run.y) * size_t(view.width) + size_t(run.x);
  for (int i = 0; i < run.count; i++) {
    const uint64_t bit = uint64_t(1) << i;
    if ((polished & bit) || followed[begin + size_t(i)]) continue;
    Guide guide;
    if (!(emitting.only & bit))
      guide.albedo = vec3(p.surface.red[i], p.surface.green[i], p.surface.blue[i]);
    if (emitting.some & bit) guide.albedo += vec3(p.glow_red[i], p.glow_green[i], p.glow_blue[i]);
    guide.albedo = clamp(guide.albedo, vec3(0), vec3(1));
    if (std::isfinite(run.depth[i])) {
      vec3 n(p.surface.nx[i], p.surface.ny[i], p.surface.nz[i]);
      float length2 = dot(n, n);
      if (length2 > 1e-12f) guide.normal = n / std::sqrt(length2);
    }
    add(begin + size_t(i), guide);
  }
  if (polished) follow(run, polished, begin);
}

}  // namespace

void add_still_guides(const World& world, const Lights& lights, const VisibilityPass& visibility,
                      const View& view, RasterShows shows, int place, GuidePlanes& planes,
                      std::vector<uint8_t>& followed) {
  const size_t pixels = size_t(view.width) * size_t(view.height);
  if (place == 0) {
    planes.albedo.assign(pixels, vec3(0)), planes.normal.assign(pixels, vec3(0));
    followed.assign(pixels, uint8_t(0));
  }
  GuidePass pass{world, lights, view, spread_in_pixel(place), place == 0, planes, followed};
  visibility.see(
      view, pass.place, [&](const VisibleRun& run) { pass.take(run); }, shows);
}

namespace {

constexpr float prior_weight = 0.5f;  // samples that the drawn picture counts as
}  // namespace

size_t memory_bytes(const StillReconstruction& work) {
  return bytes_of(work.guides.albedo, work.guides.normal, work.followed, work.color, work.shares);
}

double mean_count(const StillSamples& samples) {
  if (samples.count.empty()) return 0;
  std::atomic<uint64_t> sum{0};
  parallel_ranges(int(samples.count.size()), 1 << 16, [&](int begin, int end) {
    uint64_t here = 0;
    for (size_t i = size_t(begin); i < size_t(end); i++) here += samples.count[i];
    sum += here;
  });
  return double(sum) / double(samples.count.size());
}

void begin_reconstruction(const StillSamples& samples, const Frame& drawn, Denoiser& denoiser,
                          StillReconstruction& work) {
  const size_t pixels = drawn.color.size();
  work.width = drawn.width, work.height = drawn.height;
  work.color.resize(pixels);
  parallel_ranges(int(pixels), 1 << 14, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      float n = samples.count[i];
      work.color[i] = drawn.color[i];
      const float share = n / (n + prior_weight);
      if (n > 0) work.color[i] += (mean_of(samples, i) - drawn.color[i]) * share;
    }
  });
  denoiser.start({work.width, work.height, work.color, work.guides.albedo, work.guides.normal});
}

void finish_reconstruction(const StillSamples& samples, const Denoiser& denoiser,
                           StillReconstruction& work, Frame& frame) {
  denoiser.finish(work.color);
  mix_in_means(samples, {work.width, work.height}, work.shares, work.color);
  frame.color = work.color;
}

namespace {

// Returns pixel k of a square, in an order of the square's own, so that no direction is preferred.
ivec2 pixel_of_square(uint64_t seed, int column, int row, int k) {
  constexpr uint8_t orders[8][4] = {{0, 3, 1, 2}, {0, 3, 2, 1}, {1, 2, 0, 3}, {1, 2, 3, 0},
                                    {2, 1, 0, 3}, {2, 1, 3, 0}, {3, 0, 1, 2}, {3, 0, 2, 1}};
  uint64_t hash = mix64(seed ^ (uint64_t(uint32_t(row)) << 32 | uint32_t(column)));
  int pixel = orders[hash & 7][k];
  return {2 * column + (pixel & 1), 2 * row + (pixel >> 1)};
}

// A sample of the view's sequence: its pixel, and how often that pixel has had its turn.
struct Turn {
  ivec2 pixel;
  uint64_t before;
};
struct Turns {
  int columns, rows;  // number of squares
  uint64_t step;
  uint64_t seed;
  Turns(const View& view, uint64_t seed)
      : columns((view.width + 1) / 2),
        rows((view.height + 1) / 2),
        step(golden_step(uint64_t(rows))),
        seed(seed) {}
  uint64_t squares() const { return uint64_t(columns) * uint64_t(rows); }
  Turn at(uint64_t i) const {
    uint64_t round = i / squares(), square = i % squares();
    int column = int(square % uint64_t(columns));
    int row = int(square / uint64_t(columns) * step % uint64_t(rows));
    return {pixel_of_square(seed, column, row, int(round % 4)), round / 4};
  }
};

bool is_in(const View& view, ivec2 pixel) { return pixel.x < view.width && pixel.y < view.height; }

void append_requests(const View& view, uint64_t seed, const std::vector<PixelSample>& which,
                     std::vector<Request>& requests) {
  const size_t before = requests.size();
  requests.resize(before + which.size());
  make_pixel_requests(view, seed, which, std::span(requests).subspan(before));
}

}  // namespace

void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests) {
  const Turns turns(view, seed);
  std::vector<PixelSample> which;
  which.reserve(size_t(count));
  for (uint64_t i = first; i < first + uint64_t(count); i++) {
    const Turn turn = turns.at(i);
    if (is_in(view, turn.pixel)) which.push_back({turn.pixel.x, turn.pixel.y, int(turn.before)});
  }
  append_requests(view, seed, which, requests);
}

uint64_t plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                    const PointImage& image, const StillSamples& kept,
                    std::vector<Request>& requests) {
  const Turns turns(view, seed);
  const size_t cells = size_t(weight_cells(view.width));
  std::vector<PixelSample> which;
  uint64_t i = first;
  for (; i < first + 4 * turns.squares() && which.size() < size_t(std::max(count, 0)); i++) {
    const Turn turn = turns.at(i);
    if (!is_in(view, turn.pixel)) continue;
    const size_t x = size_t(turn.pixel.x), y = size_t(turn.pixel.y);
    const size_t pixel = y * size_t(view.width) + x;
    const int known = pixel < kept.count.size() ? kept.count[pixel] : 0;
    const uint64_t weight = image.weight[y / weight_cell * cells + x / weight_cell];
    // Pixels that count less than one do not all have a sample in the same turn.
    const uint64_t phase = mix64(seed ^ pixel) % weight_one, done = turn.before * weight + phase;
    int samples = int((done + weight) / weight_one - done / weight_one);
    samples = std::min(samples, most_still_samples - known);
    for (int k = 0; k < samples && which.size() < size_t(count); k++)
      which.push_back({turn.pixel.x, turn.pixel.y, known + k});
  }
  append_requests(view, seed, which, requests);
  return i;
}

}  // namespace wellspring::picture
