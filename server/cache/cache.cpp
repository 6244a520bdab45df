// SPDX-License-Identifier: Apache-2.0
#include "cache/cache.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "cache/attention.h"
#include "cache/cells.h"
#include "cache/compose_drawn.h"
#include "cache/correct_still.h"
#include "cache/looks.h"
#include "cache/moving_picture.h"
#include "cache/packing.h"
#include "cache/plan.h"
#include "cache/point_cache.h"
#include "cache/point_glow.h"
#include "cache/point_image.h"
#include "cache/predict.h"
#include "cache/project.h"
#include "cache/reconstruct.h"
#include "cache/remember.h"
#include "cache/scratch.h"
#include "cache/soften_edges.h"
#include "cache/still_image.h"
#include "cache/still_samples.h"

namespace wellspring {
namespace {

constexpr int largest_side = 16384;
constexpr size_t most_around =
    2;  // times the pixels of a picture: what lies around is no more to remember
constexpr int still_project_period = 8;  // frames
constexpr int enough_moving = 64;  // points on what moves, that it can be drawn by these alone
constexpr uint8_t moving_mean = 48, still_mean = 255;  // samples a point's mean looks back on
constexpr uint8_t moving_specular = 4;  // of what moves with the view and lies nowhere

}  // namespace

struct CacheWork {
  Scratch scratch;
  Frame light;  // packed, of a picture that is drawn
  StillCorrection correction;
  std::vector<uint8_t> priority;  // PointImage's, between frames
  std::vector<uint32_t> targets;
  std::vector<uint8_t> occupied;  // cells of the view ahead
  std::vector<uint8_t> peaks;     // of a picture for the eye: light beyond white
  std::vector<uint32_t> looked;  // pixels whose looks were asked for
  std::vector<LookedPixel> looked_pixels;
};
std::shared_ptr<CacheWork> make_cache_work() { return std::make_shared<CacheWork>(); }

size_t memory_bytes(const CacheWork& work) {
  return work.scratch.bytes() + memory_bytes(work.light) + memory_bytes(work.correction) +
         bytes_of(work.priority, work.targets, work.occupied, work.peaks, work.looked,
                  work.looked_pixels);
}

struct RenderCache::Impl {
  CacheSettings settings;
  PointCache points;
  PointImage image;
  StillImage still;
  StillSamples still_samples;
  bool corrects =
      false;    // the last picture was drawn at rest, and its samples are kept by themselves
  Cells cells;  // in the work's scratch
  std::shared_ptr<CacheWork> work;
  bool shares = false;
  int width = 0, height = 0;  // of the largest picture there is room for, but for its surroundings
  View view;  // of the last projection
  bool projected = false;
  bool reference = false;  // set_reference()
  bool drawn = false;      // set_drawn()
  bool glow_unknown = false;  // points are to tell what they emit, and what they say is old
  bool relit = false;  // points may wait for a sample of their new light
  bool image_stale = true;  // points have changed since, and the image was not told
  int still_frames = 0;  // projections of the same view before the last
  float new_points = 0;  // a frame, smoothed
  int fresh = 0;         // samples of this frame that show
  uint32_t frames = 0;
  bool known = false;  // anything, in the last survey
  CacheStats stats;
  uint64_t paints = 0;  // World::paints() and those of each instance, when last looked at
  std::vector<uint32_t> paints_of;
  std::vector<char> repainted;

  // Points of what was repainted since are forgotten.
  void notice_paint(const World& world);
  bool is_still() const { return still_frames >= 2; }
  void borrow_priority() {
    if (image.priority.empty()) image.priority.swap(work->priority);
    image.priority.resize(image.point.size());
  }
  void end_frame() {
    work->priority = std::exchange(image.priority, {});
  }
  // The surface that points of the current projection show, packed into `frame`, and its cells.
  void read_light(const View& of, Frame& frame);
  void begin_still() {  // its means are kept only while there are any
    for (auto& plane : still.mean) plane.resize(still.count.size());
  }
  void forget_still() {
    still_frames = 0;
    std::fill(still.count.begin(), still.count.end(), uint8_t(0));
    for (auto& plane : still.mean) std::vector<uint16_t>().swap(plane);
    end_correction();
  }
  void end_correction() {
    still_samples = {};
    corrects = false;
  }
  void start_correction() {
    if (!corrects && still_samples.count.empty()) resize_samples(still_samples, still.count.size());
    else if (!corrects) forget_samples(still_samples);
    corrects = true;
  }
  void count(const SurfaceCounts& counts, bool known);
  // The image has room for what lies around a picture, as long as that is projected.
  void fit_image(int across, int down);
  // Coarser, unless the view itself is projected.
  View light_of(const View& drawn) const {
    return projected && drawn == view ? view : light_view(drawn);
  }
  template <class Compose>
  void draw(const View& lit, const Compose& compose);
};

RenderCache::RenderCache(const CacheSettings& settings, std::shared_ptr<CacheWork> shared)
    : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  impl_->shares = shared != nullptr;
  impl_->work = shared ? std::move(shared) : make_cache_work();
}
RenderCache::~RenderCache() = default;
void RenderCache::set_reference(bool on) { impl_->reference = on; }
void RenderCache::set_drawn(bool on) {
  Impl& c = *impl_;
  if (on == c.drawn) return;
  c.drawn = on;
  c.glow_unknown = !on;
  if (on) forget_glow(c.points);
}
void RenderCache::set_attention(bool on) { impl_->settings.attention = on; }
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
  c.still.count = std::vector<uint8_t>(pixels);
  c.still_samples = {};
  c.corrects = false;
  if (!c.shares) c.work->scratch.release();
  c.work->scratch.start(std::max(project_scratch_bytes(c.points.capacity(), width, height),
                                 cells_bytes(width, height)));
  c.projected = false;
  c.forget_still();
}

void RenderCache::Impl::fit_image(int across, int down) {
  size_t pixels = size_t(across) * size_t(down), room = size_t(width) * size_t(height);
  if (pixels > still.count.size()) {
    reserve_image(image, across, down);
    still.count.resize(pixels, 0);
  } else if (pixels <= room && still.count.size() > room) {
    still.count = std::vector<uint8_t>(room);
    image.width = image.height = 0;
    auto release = [](auto& plane) { std::remove_reference_t<decltype(plane)>().swap(plane); };
    release(image.point), release(image.depth), release(image.changed);
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
  relit |= forget_paint(points, world, repainted, !drawn);
}

void RenderCache::move_points(const World& world) {
  Impl& c = *impl_;
  c.image_stale |= !c.points.anchors.empty();
  move_anchored_points(c.points, world);
  c.notice_paint(world);
  if (std::exchange(c.glow_unknown, false)) learn_glow(c.points, world);
  age_points(c.points, c.new_points);
}

void RenderCache::move_object(uint32_t object, const mat4& moved) {
  impl_->image_stale |= move_points_of(impl_->points, object, moved) > 0;
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
  if (same)
    c.still_frames = std::min(c.still_frames + 1, 1 << 20);
  else if (c.still_frames > 0 || !c.still.mean[0].empty())
    c.forget_still();
  c.corrects &= same;
  c.view = view;
  c.projected = true;
  c.frames++;
  c.fresh = 0;
  // At rest remember() keeps the image up to date. Only a point that was hidden by one since
  // overwritten has to wait until all are projected again.
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
  c.relit |= age_changed(c.points, c.view, c.image, c.still);
  prioritise(c.points, c.settings, c.image);
}

void RenderCache::plan(const View& view, int budget, uint64_t seed,
                       std::vector<Request>& requests) {
  Impl& c = *impl_;
  if (view.width != c.image.width || view.height != c.image.height) {
    requests.clear();
    return;
  }
  c.borrow_priority();
  plan_requests(c.points, view, {budget, seed, c.is_still()}, c.image, requests);
}

void RenderCache::predict(const View& ahead, int most, uint64_t seed,
                          std::vector<Request>& requests) {
  predict_requests(impl_->points, ahead, most, seed, impl_->work->occupied, requests);
}

void RenderCache::remember(const View& view, std::span<const Request> requests,
                           std::span<const Sample> samples) {
  Impl& c = *impl_;
  RememberSettings settings;
  settings.color_change = c.settings.color_change;
  settings.current = c.projected && view == c.view;
  settings.still = settings.current && c.is_still();
  c.image_stale |= !settings.current;
  settings.longest_mean = settings.still ? still_mean : moving_mean;
  settings.longest_specular = settings.still ? still_mean : moving_specular;
  settings.images = c.settings.images;
  settings.reference = c.reference;
  settings.glow = !c.drawn;
  Remembered result =
      remember_samples(c.points, view, requests, samples, settings, c.image, c.work->targets);
  // What moves may have been seen elsewhere than it is now, and what had no pixel may have one.
  c.image_stale |= !c.points.anchors.empty() || result.unplaced > 0;
  c.new_points += (float(result.kept) - c.new_points) * 0.1f;
  if (settings.current) c.fresh += result.kept - result.unplaced;
  if (!settings.still) return;
  for (uint32_t pixel : result.restarted) c.still.count[pixel] = 0;
  for (size_t i = 0; i < c.work->targets.size(); i++)
    if (c.work->targets[i] != no_point && requests[i].resample != c.work->targets[i] &&
        requests[i].pixel < c.still.count.size() && !(samples[i].flags & sample_moving)) {
      c.still.count[requests[i].pixel] |= still_fresh;
      if (c.corrects)
        add_sample(c.still_samples, requests[i].pixel, samples[i].radiance(),
                   uint32_t(mix64(requests[i].seed)));
    }
}

void RenderCache::reconstruct(const View& view, Frame& frame) {
  std::vector<Ray> looks;
  survey(view, 0, frame, looks);
  reconstruct(view, {}, frame);
}

void RenderCache::Impl::read_light(const View& of, Frame& frame) {
  if (relit) relit = lend_light(points, image);
  work->scratch.start(cells_bytes(frame.width, frame.height));
  take_cells(cells, frame.width, frame.height, work->scratch);
  SurfaceCounts counts = read_surface(of, points, image, cells, frame);
  known = fill_cells(of, cells);
  filter_cells(of, cells);
  count(counts, known);
  work->looked.clear();
}

void RenderCache::survey(const View& view, int most, Frame& frame, std::vector<Ray>& looks) {
  Impl& c = *impl_;
  int width = std::clamp(view.width, 1, largest_side),
      height = std::clamp(view.height, 1, largest_side);
  fit_frame(width, height, frame);
  if (!c.projected || view != c.view) project(view);
  c.end_correction();
  c.read_light(view, frame);
  if (most >= looks_a_pixel) {
    c.borrow_priority();
    find_edges(view, c.cells, c.still, frame, c.image);
    choose_looks(c.image, size_t(most) / looks_a_pixel, mix64(c.frames), c.work->looked);
  }
  make_looks(view, c.work->looked, looks);
}

void RenderCache::reconstruct(const View& view, std::span<const Seen> seen, Frame& frame) {
  Impl& c = *impl_;
  size_t looked = std::min(c.work->looked.size(), seen.size() / looks_a_pixel);
  std::span<const uint32_t> pixels = std::span(c.work->looked).first(looked);
  light_looks(view, c.cells, frame, pixels, seen, c.work->looked_pixels);
  compose(view, c.cells, c.known, frame);
  if (c.is_still()) c.begin_still(), accumulate_still(c.points, c.image, c.frames, c.still, frame);
  show_looks(pixels, c.work->looked_pixels, c.still, frame);
  c.end_frame();
}

// Finds the light of `lit`, then calls compose() and takes the time.
template <class Compose>
void RenderCache::Impl::draw(const View& lit, const Compose& compose) {
  fit_frame(lit.width, lit.height, work->light);
  read_light(lit, work->light);
  double began = seconds_now();
  compose();
  stats.drawing_ms = float(1000 * (seconds_now() - began));
  end_frame();
}

void RenderCache::draw(const View& view, const PictureSight& sight, Frame& frame) {
  Impl& c = *impl_;
  View lit = c.light_of(view);
  if (!c.projected || lit != c.view) project(lit);
  fit_frame(view.width, view.height, frame);
  c.draw(lit, [&] { compose_drawn(view, lit, sight, c.cells, c.known, c.work->light, frame); });
}

void RenderCache::draw(const View& view, const PictureSight& sight, const Tonemap& tonemap,
                       Image8& image, std::vector<float>* depth, bool calm) {
  Impl& c = *impl_;
  View lit = c.light_of(view);
  if (!c.projected || lit != c.view) project(lit);
  c.draw(lit, [&] {
    compose_drawn(view, lit, sight, c.cells, c.known, c.work->light, tonemap, calm,
                  c.work->peaks, image, depth);
  });
}

void RenderCache::draw_still(const View& view, const PictureSight& sight, Frame& frame,
                             StillShows shows) {
  Impl& c = *impl_;
  if (!c.projected || view != c.view) project(view);
  fit_frame(view.width, view.height, frame);
  c.begin_still();
  bool changes = c.image.alarm > 0;  // what samples of the light before say is wrong
  if (changes) c.end_correction();
  else if (c.is_still()) c.start_correction();
  c.draw(view, [&] {
    const vec2 place = still_place(c.still_frames);
    float guessed = c.stats.filled + c.stats.empty;
    compose_still(view, sight, place, c.cells, c.known, c.work->light, guessed, frame);
    std::span<const std::vector<EdgeShare>> edges;
    if (shows == StillShows::all && sight.anything_moves())
      edges = compose_moving(view, sight, c.cells, c.known, c.work->light, guessed, frame);
    if (c.corrects) forget_samples(c.still, c.still_samples);
    accumulate_drawn([&](uint32_t object) { return sight.moves(object); }, changes, c.frames,
                     c.still, frame);
    if (c.corrects) correct_still(c.still_samples, c.still, c.work->correction, frame);
    soften_edges(edges, frame.color);
  });
}

bool RenderCache::knows_moving() const {
  const PointCache& points = impl_->points;
  int shown = 0;
  for (const Anchor& anchor : points.anchors)
    if (points.flags[anchor.point] & point_visible && ++shown >= enough_moving) return true;
  return false;
}

bool RenderCache::follows_moving(const Request& request) const {
  const PointCache& points = impl_->points;
  return request.resample < points.flags.size() && points.flags[request.resample] & point_moving;
}

bool RenderCache::draw_moving(const World& world, const Keyframe& backdrop,
                              const PictureSight& sight, const Tonemap& tonemap, MovingLight& work,
                              MovingPicture& picture) {
  Impl& c = *impl_;
  const View& view = backdrop.view;
  picture.view = view;
  picture.window = moving_window(world, view);
  if (picture.empty()) return true;
  c.image_stale |= !c.points.anchors.empty();
  move_anchored_points(c.points, world);
  const PictureWindow runs = whole_runs(picture.window, view);
  light_moving(c.points, view, runs, c.settings.depth_threshold, work);
  if (!work.known) return false;
  copy_colors(backdrop, runs, work.picture);
  guess_peaks(work.picture, runs, work.peaks);
  compose_moving(view, sight, runs, tonemap, backdrop.disparity, c.still.count, work);
  take_window(work.picture, picture);
  return true;
}

void RenderCache::relight(const Changes& changes) {
  Impl& c = *impl_;
  auto forgotten = [&](uint32_t i, vec3& kept, vec3& added) {
    if (c.points.flags[i] & point_infinite) return false;
    vec3 place(c.points.x[i], c.points.y[i], c.points.z[i]);
    return changes(place, unpack_normal(c.points.normal[i]), kept, added);
  };
  vec3 kept, added;
  relight_still(
      c.points, c.image, [&](uint32_t i) { return forgotten(i, kept, added); }, c.still);
  forget_light(c.points, forgotten);
  c.relit = true;
  c.glow_unknown = !c.drawn;  // the lamp's own, too
}

void RenderCache::clear() {
  Impl& c = *impl_;
  clear_points(c.points);
  c.image_stale = true;
  std::fill(c.image.point.begin(), c.image.point.end(), no_point);
  std::fill(c.image.depth.begin(), c.image.depth.end(), 0.0f);
  c.image.witnesses.clear();
  c.forget_still();
}

void RenderCache::Impl::count(const SurfaceCounts& counts, bool known) {
  float pixels = float(image.point.size()), shown = float(counts.points);
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
  stats.fresh = std::min(float(fresh), shown) / pixels;
  stats.reprojected = shown / pixels - stats.fresh;
  stats.filled = known ? 1 - shown / pixels : 0.0f;
  stats.empty = known ? 0.0f : 1 - shown / pixels;
  stats.mean_age = seen > 0 ? float(ages) / float(seen) : 0.0f;
  stats.converged = float(counts.converged) / pixels;
}

const CacheSettings& RenderCache::settings() const { return impl_->settings; }
const CacheStats& RenderCache::stats() const { return impl_->stats; }

size_t RenderCache::memory_bytes() const {
  const Impl& c = *impl_;
  size_t sum =
      points_bytes(c.points) + bytes_of(c.still.count) + bytes_of(c.paints_of, c.repainted) +
      bytes_of(c.image.point, c.image.depth, c.image.priority, c.image.changed, c.image.witnesses);
  for (const auto& plane : c.still.mean) sum += bytes_of(plane);
  sum += samples_bytes(c.still_samples);
  return sum + (c.shares ? 0 : wellspring::memory_bytes(*c.work));
}

}  // namespace wellspring
