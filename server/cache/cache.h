// SPDX-License-Identifier: Apache-2.0
// The render cache of one visitor (Walter, Drettakis, Parker 1999, "Interactive Rendering using the
// Render Cache"): samples as points in space, reprojected every frame, and where to look next. One
// frame: project -> attend -> plan -> (trace) -> remember, then a picture of what the points say:
// somebody else's, or reconstruct() as published. All functions use all cores, never fail and never
// block; memory is bounded by the room asked for with resize().
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "cache/attention.h"
#include "cache/reconstruct.h"
#include "frame/frame.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring::cache {

struct PointCache;  // cache/point_cache.h: the points
struct PointImage;  // cache/point_image.h: what projects where, priorities
class Scratch;

// What is needed from project() until the picture is there and means nothing afterwards. Caches
// whose frames are never under way at the same time may share it.
struct CacheWork;
std::shared_ptr<CacheWork> make_cache_work();
size_t memory_bytes(const CacheWork& work);

class RenderCache {
 public:
  explicit RenderCache(const CacheSettings& settings = {},
                       std::shared_ptr<CacheWork> shared = nullptr);
  ~RenderCache();
  RenderCache(RenderCache&&) noexcept;
  RenderCache& operator=(RenderCache&&) noexcept;

  // Makes room for pictures of this size and smaller ones; keeps the points that still fit. Nothing
  // happens when there is such room already.
  void resize(int width, int height);
  // Points on moving meshes follow their triangles, and are forgotten where these were repainted;
  // ages advance. Call once a frame after World::commit().
  void move_points(const World& world);
  // Finds where every point falls in `view`, and which of them are hidden. Views of less than the
  // room there is cost no memory and no point. Those of up to twice as many pixels have a larger
  // image, and larger ones room for more points.
  void project(const View& view);
  // About the share of pixels that a point shows in, from every eighth row.
  float covered() const;
  // Priority of every pixel (paper, section 4).
  void attend();
  // Exactly `budget` (or fewer when there is nothing left to learn) requests by error diffusion;
  // resampled points are passed exactly. `seed` makes the choice and the samples repeatable.
  void plan(const View& view, int budget, uint64_t seed, std::vector<Request>& requests);
  // Appends requests for what the view `ahead` will show and no point is near (cache/plan.h), at
  // most `most`; their answers are to be remembered with the others.
  void predict(const View& ahead, int most, uint64_t seed, std::vector<Request>& requests);
  // Puts answers into the cache and into the current projection. Returns the point that each went
  // to, or no_point: good until the next call of any cache of this work.
  std::span<const uint32_t> remember(const View& view, std::span<const Request> requests,
                                     std::span<const Sample> samples);
  // The picture as published: of points alone, holes filled from 3x3 pixels (cache/reconstruct.h).
  // Projects `view` if it is not projected. Pixels without points around stay as they were.
  void reconstruct(const View& view, Frame& frame);
  // Answers come from the reference from now on, or no longer (else that they differ from earlier
  // ones might be taken for a change of the light). Its light is not expected to be that of others.
  void set_reference(bool on);
  void set_attention(bool on);  // CacheSettings::attention
  // Of each object, by its number: a factor of the priority of the pixels that show it, counted
  // from least_weight to most_weight. Others', and what is not a number, is 1; where all are 1 they
  // change nothing. Of the objects' points: where nothing is known yet, and while attention is off,
  // there are no weights.
  static constexpr float least_weight = 0.25f, most_weight = 8;
  void set_weights(std::span<const float> of_object);
  // A lamp was switched, dimmed or moved, and is much of the light where `changes` says so of a
  // surface, on many threads: what was remembered of the light there counts no more, and is asked
  // for first. Until newer light is known, `kept` of it, 1 unless changed, and the light `added`
  // are shown. Not where the lamp is little of the light: there a change that resampling finds
  // costs less.
  struct Surface {
    vec3 place, normal;
    uint32_t object = 0;
  };
  using Changes = std::function<bool(const Surface& surface, vec3& kept, vec3& added)>;
  void relight(const Changes& changes);
  // Forgets everything (another exhibit).
  void clear();

  const CacheSettings& settings() const;
  const CacheStats& stats() const;
  size_t memory_bytes() const;  // without work that is shared

  // For whoever makes the picture of the last projection:
  bool has_projected(const View& view) const;
  uint64_t projection() const;  // another number for every view, and after clear() and resize()
  int still_frames() const;     // projections of that view before the last
  bool is_still() const { return still_frames() >= 2; }
  const PointCache& points() const;
  const PointImage& image() const;
  Scratch& scratch();
  // Points whose light was forgotten are lent that of newer ones around.
  void lend_light();
  // The picture is made: what only it needed is given back. Counts what it has shown.
  void end_frame(const ShownPoints& shown);
  void end_frame();  // none was made

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::cache
