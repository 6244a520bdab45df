// SPDX-License-Identifier: Apache-2.0
#include "cache/cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "cache/attention.h"
#include "cache/packing.h"
#include "cache/plan.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/project.h"
#include "cache/reconstruct.h"
#include "cache/remember.h"

namespace wellspring::cache {
namespace {

constexpr int largest_side = 16384;
// Views of up to this many times the pixels there is room for show the same points with what lies
// around: there is no more to remember.
constexpr size_t most_around = 2;
constexpr int still_project_period = 8;  // frames between projections of a view at rest
constexpr uint8_t moving_mean = 48, still_mean = 255;  // samples a point's mean looks back on
constexpr uint8_t moving_specular = 4;  // likewise, for light that moves with the view

}  // namespace

struct CacheWork {
  Scratch scratch;
  std::vector<uint8_t> priority;  // PointImage's priorities, between frames
  std::vector<uint32_t> targets;
  std::vector<uint8_t> occupied;  // cells of the view ahead
};
std::shared_ptr<CacheWork> make_cache_work() { return std::make_shared<CacheWork>(); }

size_t memory_bytes(const CacheWork& work) {
  return work.scratch.bytes() + bytes_of(work.priority, work.targets, work.occupied);
}

struct RenderCache::Impl {
  CacheSettings settings;
  PointCache points;
  PointImage image;
  std::shared_ptr<CacheWork> work;
  bool shares = false;
  // Pixels of the largest picture there is room for, without its surroundings.
  int width = 0, height = 0;
  View view;  // view of the last projection
  bool projected = false;
  uint64_t projection = 0;
  int still_frames = 0;          // projections of the same view before the last
  bool reference = false;        // as set_reference() says
  bool relit = false;            // points may wait for a sample of their new light
  bool image_stale = true;       // points have changed since the image was made
  float new_points = 0;          // new points a frame, smoothed
  int fresh = 0;                 // samples of this frame that show
  std::vector<uint8_t> weights;  // each object's weight, times weight_one; empty: all are 1
  uint32_t turn = 0;             // decides which pixel of a weight cell counts
  CacheStats stats;
  uint64_t paints = 0;  // World::paints() and those of each instance, when last looked at
  std::vector<uint32_t> paints_of;
  std::vector<char> repainted;

  // Forgets points of instances that were repainted since.
  void notice_paint(const World& world);
  void borrow_priority() {
    if (image.priority.empty()) image.priority.swap(work->priority);
    image.priority.resize(image.point.size());
  }
  void begin_view() {
    projection++;
    still_frames = 0;
  }
  void count(const ShownPoints& shown);
  // Makes room in the image for what lies around a picture, as long as that is projected.
  void fit_image(int across, int down);
};

RenderCache::RenderCache(const CacheSettings& settings, std::shared_ptr<CacheWork> shared)
    : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  impl_->shares = shared != nullptr;
  impl_->work = shared ? std::move(shared) : make_cache_work();
}
RenderCache::~RenderCache() = default;
void RenderCache::set_reference(bool on) { impl_->reference = on; }
void RenderCache::set_attention(bool on) { impl_->settings.attention = on; }
void RenderCache::set_weights(std::span<const float> of_object) {
  std::vector<uint8_t>& weights = impl_->weights;
  weights.clear();
  bool all_one = true;
  for (float factor : of_object) {
    if (!std::isfinite(factor)) factor = 1;
    factor = std::clamp(factor, least_weight, most_weight);
    weights.push_back(uint8_t(std::lround(factor * weight_one)));
    all_one &= weights.back() == weight_one;
  }
  if (all_one) weights.clear();
}
RenderCache::RenderCache(RenderCache&&) noexcept = default;
RenderCache& RenderCache::operator=(RenderCache&&) noexcept = default;

void RenderCache::resize(int width, int height) {
  Impl& c = *impl_;
  width = std::clamp(width, 1, largest_side);
  height = std::clamp(height, 1, largest_side);
  if (width == c.width && height == c.height) return;
  c.width = width, c.height = height;
  size_t pixels = size_t(width) * size_t(height);
  double capacity = double(std::max(c.settings.points_per_pixel, 0.1f)) * double(pixels);
  resize_points(c.points, int(std::min(capacity, double(max_capacity))));
  c.image = PointImage{};
  reserve_image(c.image, width, height);
  if (!c.shares) c.work->scratch.release();
  c.work->scratch.start(project_scratch_bytes(c.points.capacity(), width, height));
  c.projected = false;
  c.begin_view();
}

void RenderCache::Impl::fit_image(int across, int down) {
  size_t pixels = size_t(across) * size_t(down), room = size_t(width) * size_t(height);
  if (pixels > image.point.capacity()) {
    reserve_image(image, across, down);
  } else if (pixels <= room && image.point.size() > room) {
    image.width = image.height = 0;
    auto release = [](auto& plane) { std::remove_reference_t<decltype(plane)>().swap(plane); };
    release(image.point), release(image.depth), release(image.renewed), release(image.changed);
    reserve_image(image, width, height);
    projected = false;
  }
}

void RenderCache::Impl::notice_paint(const World& world) {
  if (world.paints() == paints) return;
  paints = world.paints();
  size_t count = size_t(world.instance_count());
  paints_of.resize(count, 0);
  repainted.assign(count, 0);
  for (size_t i = 0; i < count; i++) {
    uint32_t now = world.placed(uint32_t(i)).paints;
    repainted[i] = now != paints_of[i];
    paints_of[i] = now;
  }
  relit |= invalidate_paint(points, world, repainted);
}

void RenderCache::move_points(const World& world) {
  Impl& c = *impl_;
  c.image_stale |= !c.points.anchors.empty();
  move_anchored_points(c.points, world);
  c.notice_paint(world);
  age_points(c.points, c.new_points);
}

void RenderCache::project(const View& view) {
  Impl& c = *impl_;
  int width = std::clamp(view.width, 1, largest_side),
      height = std::clamp(view.height, 1, largest_side);
  if (size_t(width) * size_t(height) > most_around * size_t(c.width) * size_t(c.height))
    resize(std::max(width, c.width), std::max(height, c.height));
  c.fit_image(width, height);
  c.borrow_priority();
  resize_image(c.image, width, height);
  bool same = c.projected && view == c.view;
  if (same) c.still_frames = std::min(c.still_frames + 1, 1 << 20);
  else c.begin_view();
  c.view = view;
  c.projected = true;
  c.fresh = 0;
  // At rest remember() keeps the image up to date. Only a point that was hidden by another one,
  // which has been overwritten since, has to wait until all are projected again.
  if (same && !c.image_stale && c.still_frames % still_project_period != 0) return;
  project_points(c.points, view, same, c.work->scratch, c.image);
  depth_cull(c.points, c.settings.depth_threshold, c.image);
  c.image_stale = false;
}

float RenderCache::covered() const {
  const PointImage& image = impl_->image;
  size_t width = size_t(image.width), shown = 0, asked = 0;
  for (size_t y = 0; y < size_t(image.height); y += 8, asked += width)
    for (size_t x = 0; x < width; x++) shown += image.point[y * width + x] != no_point;
  return asked > 0 ? float(shown) / float(asked) : 0.0f;
}

void RenderCache::attend() {
  Impl& c = *impl_;
  c.borrow_priority();
  c.relit |= age_changed(c.points, c.view, c.image);
  prioritise(c.points, c.settings, c.image);
  using Weights = std::span<const uint8_t>;
  weigh(c.points, c.settings.attention ? Weights(c.weights) : Weights(), c.turn++, c.image);
}

void RenderCache::plan(const View& view, int budget, uint64_t seed,
                       std::vector<Request>& requests) {
  Impl& c = *impl_;
  if (view.width != c.image.width || view.height != c.image.height) {
    requests.clear();
    return;
  }
  c.borrow_priority();
  plan_requests(c.points, view, {budget, seed, is_still()}, c.image, requests);
}

void RenderCache::predict(const View& ahead, int most, uint64_t seed,
                          std::vector<Request>& requests) {
  predict_requests(impl_->points, ahead, most, seed, impl_->work->occupied, requests);
}

std::span<const uint32_t> RenderCache::remember(const View& view, std::span<const Request> requests,
                                                std::span<const Sample> samples) {
  Impl& c = *impl_;
  RememberSettings settings;
  settings.color_change = c.settings.color_change;
  settings.current = has_projected(view);
  settings.still = settings.current && is_still();
  c.image_stale |= !settings.current;
  settings.longest_mean = settings.still ? still_mean : moving_mean;
  settings.longest_specular = settings.still ? still_mean : moving_specular;
  settings.reference = c.reference;
  Remembered result =
      remember_samples(c.points, view, requests, samples, settings, c.image, c.work->targets);
  // Moving points may have been seen elsewhere than they are now, and samples without a pixel may
  // have one.
  c.image_stale |= !c.points.anchors.empty() || result.unplaced > 0;
  c.new_points += (float(result.kept) - c.new_points) * 0.1f;
  if (settings.current) c.fresh += result.kept - result.unplaced;
  return c.work->targets;
}

void RenderCache::reconstruct(const View& view, Frame& frame) {
  Impl& c = *impl_;
  if (!has_projected(view)) project(view);
  end_frame(reconstruct_points(c.points, c.image, frame));
}

bool RenderCache::has_projected(const View& view) const {
  return impl_->projected && view == impl_->view;
}
uint64_t RenderCache::projection() const { return impl_->projection; }
int RenderCache::still_frames() const { return impl_->still_frames; }
const PointCache& RenderCache::points() const { return impl_->points; }
const PointImage& RenderCache::image() const { return impl_->image; }
Scratch& RenderCache::scratch() { return impl_->work->scratch; }

void RenderCache::lend_light() {
  Impl& c = *impl_;
  if (c.relit) c.relit = wellspring::cache::lend_light(c.points, c.image);
}

void RenderCache::end_frame(const ShownPoints& shown) {
  impl_->count(shown);
  end_frame();
}

void RenderCache::end_frame() {
  Impl& c = *impl_;
  std::fill(c.image.renewed.begin(), c.image.renewed.end(), uint8_t(0));
  c.work->priority = std::exchange(c.image.priority, {});
}

struct RenderCache::Projection {
  PointImage image;
  View view;
  bool projected = false, image_stale = true;
  uint64_t projection = 0;
  int still_frames = 0, fresh = 0;
  CacheStats stats;
  std::vector<uint8_t> flags;  // flags of the points
};
// These flags of points belong to the projection.
static constexpr uint8_t projection_flags = point_visible | point_verified;

void RenderCache::DropProjection::operator()(Projection* projection) const { delete projection; }

std::unique_ptr<RenderCache::Projection, RenderCache::DropProjection> RenderCache::put_aside() {
  Impl& c = *impl_;
  std::unique_ptr<Projection, DropProjection> aside(
      new Projection{std::exchange(c.image, {}), c.view, c.projected, c.image_stale, c.projection,
                     c.still_frames, c.fresh, c.stats, c.points.flags});
  c.projected = false;
  return aside;
}

void RenderCache::put_back(std::unique_ptr<Projection, DropProjection> aside) {
  Impl& c = *impl_;
  c.image = std::move(aside->image);
  c.view = aside->view, c.projected = aside->projected, c.image_stale = aside->image_stale;
  c.projection = aside->projection, c.still_frames = aside->still_frames;
  c.fresh = aside->fresh, c.stats = aside->stats;
  std::vector<uint8_t>& flags = c.points.flags;
  for (size_t i = 0; i < flags.size(); i++)
    flags[i] = uint8_t((flags[i] & ~projection_flags) | (aside->flags[i] & projection_flags));
}

void RenderCache::relight(const Changes& changes) {
  Impl& c = *impl_;
  auto forgotten = [&](uint32_t i, vec3& kept, vec3& added) {
    if (c.points.flags[i] & point_infinite) return false;
    vec3 place(c.points.x[i], c.points.y[i], c.points.z[i]);
    return changes({place, unpack_normal(c.points.normal[i]), c.points.color[i].object}, kept,
                   added);
  };
  invalidate_light(c.points, forgotten);
  c.relit = true;
  for (size_t i = 0; i < c.image.point.size(); i++) {
    uint32_t point = c.image.point[i];
    if (point == no_point || (c.points.flags[point] & point_relit)) c.image.renewed[i] = 1;
  }
}

void RenderCache::clear() {
  Impl& c = *impl_;
  clear_points(c.points);
  c.image_stale = true;
  std::fill(c.image.point.begin(), c.image.point.end(), no_point);
  std::fill(c.image.depth.begin(), c.image.depth.end(), 0.0f);
  c.image.change_samples.clear();
  c.begin_view();
}

void RenderCache::Impl::count(const ShownPoints& shown) {
  float pixels = float(image.point.size()), points_share = float(shown.points) / pixels;
  std::atomic<int> alive{0}, seen{0};
  std::atomic<int64_t> ages{0};
  parallel_ranges(points.capacity(), 1 << 15, [&](int begin, int end) {
    int alive_here = 0, seen_here = 0, ages_here = 0;
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      int visible = points.flags[i] / point_visible & 1, age = points.age[i];
      alive_here += age != evicted_age;
      seen_here += visible;
      ages_here += visible * age;
    }
    alive += alive_here;
    seen += seen_here;
    ages += ages_here;
  });
  stats.points = alive;
  stats.fresh = std::min(float(fresh) / pixels, points_share);
  stats.reprojected = points_share - stats.fresh;
  stats.filled = shown.points > 0 ? 1 - points_share : 0.0f;
  stats.empty = shown.points > 0 ? 0.0f : 1.0f;
  stats.mean_age = seen > 0 ? float(ages) / float(seen) : 0.0f;
  stats.converged = float(shown.converged) / pixels;
}

const CacheSettings& RenderCache::settings() const { return impl_->settings; }
const CacheStats& RenderCache::stats() const { return impl_->stats; }

size_t RenderCache::memory_bytes() const {
  const Impl& c = *impl_;
  size_t sum = points_bytes(c.points) + bytes_of(c.paints_of, c.repainted, c.weights) +
               bytes_of(c.image.point, c.image.depth, c.image.priority, c.image.renewed,
                        c.image.changed, c.image.change_samples, c.image.weight);
  return sum + (c.shares ? 0 : wellspring::cache::memory_bytes(*c.work));
}

}  // namespace wellspring::cache
