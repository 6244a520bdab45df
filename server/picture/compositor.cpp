// SPDX-License-Identifier: Apache-2.0
#include "picture/compositor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "frame/tonemap.h"
#include "picture/compose_drawn.h"
#include "picture/keyframe.h"
#include "picture/soften_edges.h"
#include "world/texture.h"

namespace wellspring::picture {

ShownPoints read_surface(const WindowView& view, const PointCache& points, const PointImage& image,
                         Cells& cells, Frame& frame) {
  std::atomic<int64_t> shown{0}, converged{0};
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    thread_local SurfaceRows rows;
    rows.start(image.width, 2 * cell_size);
    ShownPoints here;
    int next = begin * cell_size - 1, last = end * cell_size;
    for (int cy = begin; cy < end; cy++) {
      int top = cy * cell_size, bottom = top + cell_size;
      for (; next <= bottom; next++) {
        int enough = read_points(points, image, next, rows);
        if (next >= begin * cell_size && next < last) here.converged += enough;
      }
      build_cells(view, rows, cy, cells);
      for (int y = top; y < std::min(bottom, image.height); y++)
        here.points += fill_from_neighbours(rows, y, frame);
    }
    shown += here.points;
    converged += here.converged;
  });
  return {shown, converged};
}

namespace {

constexpr float unseen = 1 / 4096.0f;  // light that changes no code

std::array<float, 256> decoded() {
  std::array<float, 256> shown;
  for (size_t i = 0; i < shown.size(); i++) shown[i] = decode_srgb(uint8_t(i));
  return shown;
}

// Returns the radiance times exposure that a colour shows; for white the least.
vec3 light_of(uint32_t color) {
  static const std::array<float, 256> shown = decoded();
  const vec3 linear(shown[color & 255], shown[color >> 8 & 255], shown[color >> 16 & 255]);
  const float peak = max_component(linear);
  if (peak <= shoulder_start) return linear;
  static constexpr float most = 0.995f;  // codes above say nothing
  const LaneMask code = eval_peak_codes(all_lanes(invert_shoulder(std::min(peak, most))));
  return invert_tone_curve(linear, uint8_t(code[0]));
}

// Puts up to eight pixels, the keyframe's colours with the light that is `added`.
void put_lanes(const Keyframe& keyframe, const Lanes3& added, size_t at, int count, Image8& picture,
               std::vector<uint8_t>& peaks) {
  float light[3][lane_count] = {};
  for (int k = 0; k < count; k++) {
    const vec3 own = light_of(keyframe.color[at + size_t(k)]);
    light[0][k] = own.x, light[1][k] = own.y, light[2][k] = own.z;
  }
  const Lanes3 sum =
      Lanes3{load_lanes(light[0]), load_lanes(light[1]), load_lanes(light[2])} + added;
  uint8_t bytes[3 * lane_count];
  store_pixels(bytes, eval_tone_curve(sum));
  const LaneMask peak = eval_peak_codes(max_component(sum));
  std::copy_n(bytes, 3 * count, &picture.rgb[3 * at]);
  for (int k = 0; k < count; k++) peaks[at + size_t(k)] = uint8_t(peak[k]);
}

// Lays grass over pixels of a window whose surfaces, still and moving, are not nearer.
void lay_grass_over(const GrassView& grass, const PictureWindow& window, const Tonemap& tonemap,
                    std::span<const float> still, std::span<const float> moving, Image8& image) {
  parallel_ranges(window.height, 4, [&](int begin, int end) {
    for (int y = window.top + begin; y < window.top + end; y++)
      for (int x = window.left; x < window.left + window.width; x += lane_count) {
        if (!grass.shows(x, y, lane_count)) continue;
        const SeenLawn seen = grass.look(x, y);
        const int count = std::min(lane_count, window.left + window.width - x);
        for (int k = 0; k < count; k++) {
          const size_t i = size_t(y) * size_t(image.width) + size_t(x + k);
          const float nearest = std::max(still[i], moving[i]);
          if (!(seen.cover[k] > 0) || !(seen.depth[k] * nearest < 1)) continue;
          uint8_t* rgb = &image.rgb[3 * i];
          const vec3 behind = light_of(uint32_t(rgb[0] | rgb[1] << 8 | rgb[2] << 16));
          const vec3 light = (1 - seen.cover[k]) * behind + tonemap.exposure * seen.light.at(k);
          uint8_t bytes[3 * lane_count];
          store_pixels(bytes, eval_tone_curve(all_lanes(light)));
          std::copy_n(bytes, 3, rgb);
        }
      }
  });
}

}  // namespace

void relight(const Keyframe& keyframe, const BackdropLight& backdrop, const Tonemap& tonemap,
             Image8& picture, std::vector<uint8_t>& peaks) {
  const View& view = keyframe.view;
  const PictureWindow whole{0, 0, view.width, view.height};
  copy_colors(keyframe, whole, picture);
  guess_peaks(picture, whole, peaks);
  parallel_for(view.height, [&](int y) {
    RunKnown reflected;
    for (int x = 0; x < view.width; x += RasterRun::most) {
      const int count = std::min(RasterRun::most, view.width - x);
      reflect_light(backdrop.surfaces, backdrop.light, x, y, count, reflected);
      const size_t at = size_t(y) * size_t(view.width) + size_t(x);
      for (int i = 0; i < count; i += lane_count) {
        const Lanes3 added = Lanes3{load_lanes(reflected.red + i), load_lanes(reflected.green + i),
                                    load_lanes(reflected.blue + i)} *
                             all_lanes(tonemap.exposure);
        const int here = std::min(count - i, lane_count);
        const unsigned lit = negative_lanes(max_component(added) > unseen) & ((1u << here) - 1);
        if (lit) put_lanes(keyframe, added, at + size_t(i), here, picture, peaks);
      }
    }
  });
}

// Samples of a pixel below which aimed ones count, too.
static constexpr int few_samples = 4;

size_t memory_bytes(const CompositorWork& work) {
  return memory_bytes(work.light) + bytes_of(work.peaks, work.shares, work.depth) +
         work.laid.memory_bytes();
}

Compositor::Compositor(std::shared_ptr<CompositorWork> shared)
    : shares_(shared != nullptr),
      work_(shares_ ? std::move(shared) : std::make_shared<CompositorWork>()) {}

// Drops the means of another view.
void Compositor::begin(const RenderCache& cache) {
  if (projection_ == cache.projection()) return;
  projection_ = cache.projection();
  still_ = {};
  if (!cache.has_projected(sampled_)) samples_ = {};
}

void Compositor::begin_still(const RenderCache& cache) {
  begin(cache);
  const size_t pixels = cache.image().point.size();
  for (auto& plane : still_.mean) plane.resize(pixels);
  still_.count.resize(pixels, 0);
  for (size_t i = 0; i < pixels; i++)
    if (cache.image().renewed[i]) still_.count[i] = 0;
}

void Compositor::follow_changes(const RenderCache& cache) {
  if (!cache.has_projected(sampled_)) return;
  for (size_t i = 0; i < samples_.count.size(); i++)
    if (cache.image().renewed[i]) samples_.count[i] = 0;
}

// Finds the light of `view`, which is projected, then calls compose() and measures its time.
template <class Compose>
void Compositor::draw(RenderCache& cache, const View& view, const Compose& compose) {
  Frame& light = work_->light;
  fit_frame(view.width, view.height, light);
  cache.lend_light();
  cache.scratch().start(cells_bytes(view.width, view.height));
  take_cells(cells_, view.width, view.height, cache.scratch());
  ShownPoints shown = read_surface(view, cache.points(), cache.image(), cells_, light);
  known_ = fill_cells(view, cells_);
  if (known_) filter_cells(view, cells_);
  const double began = seconds_now();
  compose(float(shown.points) / float(light.color.size()));
  drawing_ms_ = float(1000 * (seconds_now() - began));
  pictures_++;
  cache.end_frame(shown);
}

// Does the same for a picture that is soon replaced, in which things are laid.
template <class Compose>
void Compositor::draw_laid(RenderCache& cache, const View& view, const Compose& compose) {
  draw(cache, view, [&](float) {
    KeptLight kept = kept_;
    std::optional<LaidView> laid;
    if (!laid_.empty())
      kept.laid = &laid.emplace(laid_, view, vec2(0.5f), false, 0, work_->laid,
                                std::span<const float>(), kept.dynamic);
    compose(kept);
  });
}

void Compositor::draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                      Frame& frame) {
  if (!cache.has_projected(view)) cache.project(view);
  begin(cache);
  fit_frame(view.width, view.height, frame);
  draw_laid(cache, view, [&](const KeptLight& kept) {
    compose_drawn(view, visibility, cells_, known_, work_->light, kept, frame);
  });
}

void Compositor::draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                      const Tonemap& tonemap, Image8& image, std::vector<float>* depth) {
  if (!cache.has_projected(view)) cache.project(view);
  begin(cache);
  const bool splats = has_splats(laid_.scans.all());
  if (!depth && splats) depth = &work_->depth;
  draw_laid(cache, view, [&](const KeptLight& kept) {
    compose_drawn(view, visibility, cells_, known_, work_->light, kept, tonemap, work_->peaks,
                  image, depth);
    if (splats) lay_splats_over(laid_.scans, view, work_->laid.splats, image, *depth);
  });
}

void Compositor::draw_still(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                            Frame& frame, StillShows shows) {
  if (!cache.has_projected(view)) cache.project(view);
  begin_still(cache);
  fit_frame(view.width, view.height, frame);
  const bool changes = cache.image().alarm > 0;
  draw(cache, view, [&](float told) {
    const float guessed = 1 - told;
    compose_still(view, visibility, spread_in_pixel(cache.still_frames()), cells_, known_,
                  work_->light, kept_, guessed, frame);
    std::span<const std::vector<EdgeShare>> edges;
    if (shows == StillShows::all && visibility.anything_moves())
      edges = compose_moving(view, visibility, cells_, known_, work_->light, kept_, guessed, frame);
    const bool corrects = !reconstructed_ && sampled_ == view && !samples_.count.empty();
    if (corrects) wellspring::picture::invalidate_samples(still_, samples_);
    accumulate_drawn([&](uint32_t object) { return visibility.moves(object); }, changes, pictures_,
                     still_, frame);
    if (corrects) mix_in_means(samples_, {view.width, view.height}, work_->shares, frame.color);
    soften_edges(edges, frame.color);
  });
}

void Compositor::add_samples(const View& view, std::span<const Request> requests,
                             std::span<const Sample> samples) {
  if (requests.empty()) return;
  const size_t pixels = size_t(view.width) * size_t(view.height);
  if (view != sampled_ || samples_.count.size() != pixels) {
    sampled_ = view;
    resize_samples(samples_, pixels);
  }
  for (size_t i = 0; i < requests.size(); i++) {
    const uint32_t pixel = requests[i].pixel;
    if (pixel >= pixels || (samples[i].flags & sample_moving)) continue;
    if (requests[i].resample == no_cache_id ||
        (reconstructed_ && samples_.count[pixel] < few_samples))
      add_sample(samples_, pixel, samples[i].radiance(),
                 uint32_t(mix64(requests[i].seed + requests[i].index)));
  }
}

void Compositor::invalidate_samples() { samples_ = {}; }

void Compositor::forget_means() {
  samples_ = {};
  std::fill(still_.count.begin(), still_.count.end(), uint8_t(0));
}

void Compositor::draw_moving(const World& world, const Keyframe& backdrop,
                             const BackdropLight* relit, const VisibilityPass& visibility,
                             const Tonemap& tonemap, bool in_layer, MovingLight& work,
                             MovingPicture& picture) {
  const View& view = backdrop.view;
  const PictureWindow all{0, 0, view.width, view.height}, moves = moving_window(world, view);
  const PictureWindow sways = sways_ ? lawn_window(laid_.lawns, view) : PictureWindow{};
  MovingLayer& layer = picture.layer;
  picture.view = view;
  picture.window = relit ? all : in_layer ? sways : joined(moves, sways);
  layer.window = in_layer ? moves : PictureWindow{};
  if (relit) relight(backdrop, *relit, tonemap, work.picture, work.peaks);
  if (const PictureWindow some = joined(moves, sways); !relit && !some.empty()) {
    const PictureWindow runs = whole_runs(some, view);
    copy_colors(backdrop, runs, work.picture);
    guess_peaks(work.picture, runs, work.peaks);
  }
  work.disparity.assign(in_layer || !sways.empty() ? backdrop.disparity.size() : 0, 0.0f);
  auto lay_grass = [&] {
    if (sways.empty()) return;
    const GrassView grass(laid_.lawns, {&world, laid_.scans.lights, kept_.dynamic}, view,
                          vec2(0.5f), {}, work_->laid.lawns);
    if (grass.any())
      lay_grass_over(grass, sways, tonemap, backdrop.disparity, work.disparity, work.picture);
  };
  if (in_layer) lay_grass();
  picture.sway = {};
  if (in_layer && !relit && !sways.empty()) picture.sway = find_sway(backdrop);
  if (in_layer && !picture.empty()) take_window(work.picture, picture.window, picture.rgb);
  if (!moves.empty()) {
    still_.count.resize(backdrop.disparity.size(), 0);
    compose_moving(view, visibility, whole_runs(moves, view), tonemap, backdrop.disparity,
                   still_.count, kept_, work);
  }
  if (!in_layer) lay_grass();
  if (!in_layer && !picture.empty()) take_window(work.picture, picture.window, picture.rgb);
  if (layer.window.empty()) return;
  take_window(work.picture, layer.window, layer.rgb);
  layer.disparity.resize(size_t(moves.width) * size_t(moves.height));
  for (int y = 0; y < moves.height; y++)
    std::copy_n(&work.disparity[size_t(moves.top + y) * size_t(view.width) + size_t(moves.left)],
                moves.width, &layer.disparity[size_t(y) * size_t(moves.width)]);
}

size_t Compositor::memory_bytes() const {
  size_t sum = bytes_of(still_.count) + samples_bytes(samples_) + layer_.memory_bytes();
  for (const auto& plane : still_.mean) sum += bytes_of(plane);
  return sum + (shares_ ? 0 : wellspring::picture::memory_bytes(*work_));
}

}  // namespace wellspring::picture
