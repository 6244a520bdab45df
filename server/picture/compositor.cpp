// SPDX-License-Identifier: Apache-2.0
#include "picture/compositor.h"

#include <algorithm>

#include "base/clock.h"
#include "base/memory.h"
#include "base/rng.h"
#include "base/spread.h"
#include "picture/compose_drawn.h"
#include "picture/keyframe.h"
#include "picture/moving_picture.h"
#include "picture/read_surface.h"
#include "picture/relight.h"
#include "picture/soften_edges.h"

namespace wellspring::picture {

// Of a pixel: until then aimed ones count, too.
static constexpr int few_samples = 4;

size_t memory_bytes(const CompositorWork& work) {
  return memory_bytes(work.light) + bytes_of(work.peaks, work.shares);
}

Compositor::Compositor(std::shared_ptr<CompositorWork> shared)
    : shares_(shared != nullptr),
      work_(shares_ ? std::move(shared) : std::make_shared<CompositorWork>()) {}

// Of another view nothing is kept.
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

// Finds the light of `view`, which is projected, then calls compose() and takes the time.
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

void Compositor::draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                      Frame& frame) {
  if (!cache.has_projected(view)) cache.project(view);
  begin(cache);
  fit_frame(view.width, view.height, frame);
  draw(cache, view,
       [&](float) { compose_drawn(view, visibility, cells_, known_, work_->light, kept_, frame); });
}

void Compositor::draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                      const Tonemap& tonemap, Image8& image, std::vector<float>* depth) {
  if (!cache.has_projected(view)) cache.project(view);
  begin(cache);
  draw(cache, view, [&](float) {
    compose_drawn(view, visibility, cells_, known_, work_->light, kept_, tonemap, work_->peaks,
                  image, depth);
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

void Compositor::draw_moving(const World& world, const Keyframe& backdrop,
                             const BackdropLight* relit, const VisibilityPass& visibility,
                             const Tonemap& tonemap, bool in_layer, MovingLight& work,
                             MovingPicture& picture) {
  const View& view = backdrop.view;
  const PictureWindow all{0, 0, view.width, view.height}, moves = moving_window(world, view);
  MovingLayer& layer = picture.layer;
  picture.view = view;
  picture.window = relit ? all : in_layer ? PictureWindow{} : moves;
  layer.window = in_layer ? moves : PictureWindow{};
  if (relit) relight(backdrop, *relit, tonemap, work.picture, work.peaks);
  if (relit && in_layer) take_window(work.picture, all, picture.rgb);
  if (!moves.empty()) {
    const PictureWindow runs = whole_runs(moves, view);
    if (!relit) {
      copy_colors(backdrop, runs, work.picture);
      guess_peaks(work.picture, runs, work.peaks);
    }
    still_.count.resize(backdrop.disparity.size(), 0);
    work.disparity.assign(in_layer ? backdrop.disparity.size() : 0, 0.0f);
    compose_moving(view, visibility, runs, tonemap, backdrop.disparity, still_.count, kept_, work);
  }
  if (!in_layer && !picture.empty()) take_window(work.picture, picture.window, picture.rgb);
  if (layer.window.empty()) return;
  take_window(work.picture, layer.window, layer.rgb);
  layer.disparity.resize(size_t(moves.width) * size_t(moves.height));
  for (int y = 0; y < moves.height; y++)
    std::copy_n(&work.disparity[size_t(moves.top + y) * size_t(view.width) + size_t(moves.left)],
                moves.width, &layer.disparity[size_t(y) * size_t(moves.width)]);
}

size_t Compositor::memory_bytes() const {
  size_t sum = bytes_of(still_.count) + samples_bytes(samples_);
  for (const auto& plane : still_.mean) sum += bytes_of(plane);
  return sum + (shares_ ? 0 : wellspring::picture::memory_bytes(*work_));
}

}  // namespace wellspring::picture
