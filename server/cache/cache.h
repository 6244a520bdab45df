// SPDX-License-Identifier: Apache-2.0
// The render cache of one visitor (Walter, Drettakis, Parker 1999, "Interactive Rendering using the
// Render Cache") keeps samples as points in space, reprojects them every frame, and chooses where
// to sample next. One frame: project -> attend -> plan -> (trace) -> remember, then a picture made
// of the points: by other code, or by reconstruct() as published. All functions use all cores,
// never fail and never block; memory is bounded by the room asked for with resize().
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
struct PointImage;  // cache/point_image.h: which point shows at each pixel, priorities
class Scratch;

// Holds memory that is needed from project() until the picture is there, and keeps nothing from
// frame to frame. Caches whose frames are never under way at the same time may share it.
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
  // Moves points on moving meshes with their triangles, and forgets those whose meshes were
  // repainted; ages advance. Call once a frame after World::commit().
  void move_points(const World& world);
  // Finds where every point falls in `view`, and which of them are hidden. Views of fewer pixels
  // than there is room for cost no memory and no point. Those of up to twice as many pixels get a
  // larger image, and larger ones get room for more points.
  void project(const View& view);
  // Returns about the share of pixels that show a point, from every eighth row.
  float covered() const;
  // Sets the priority of every pixel (paper, section 4).
  void attend();
  // Chooses exactly `budget` requests (fewer if there is nothing left to learn) by error diffusion;
  // rays that resample a point pass through it exactly. `seed` makes the choice and the samples
  // repeatable.
  void plan(const View& view, int budget, uint64_t seed, std::vector<Request>& requests);
  // Appends at most `most` requests for places that the view `ahead` will show and no point is near
  // (cache/plan.h); their answers are to be remembered with the others.
  void predict(const View& ahead, int most, uint64_t seed, std::vector<Request>& requests);
  // Puts answers into the cache and into the current projection. Returns the point that each went
  // to, or no_point; valid until the next call of any cache that shares this work.
  std::span<const uint32_t> remember(const View& view, std::span<const Request> requests,
                                     std::span<const Sample> samples);
  // Makes the picture as published: of points alone, holes filled from 3x3 pixels
  // (cache/reconstruct.h). Projects `view` if it is not projected. Pixels without points around
  // stay as they were.
  void reconstruct(const View& view, Frame& frame);
  // Says whether answers come from the reference from now on. The reference need not agree with
  // other techniques: without this, the difference might be taken for a change of the light.
  void set_reference(bool on);
  void set_attention(bool on);  // sets CacheSettings::attention
  // Sets for each object, by its number, a factor of the priority of the pixels that show it,
  // clamped to least_weight and most_weight. Other objects, and values that are not numbers, have
  // 1; if all are 1 they change nothing. Weights belong to the objects' points: pixels without a
  // point have none, nor has any pixel while attention is off.
  static constexpr float least_weight = 0.25f, most_weight = 8;
  void set_weights(std::span<const float> of_object);
  // Forgets the light of surfaces for which `changes` returns true, because a lamp that is much of
  // the light there was switched, dimmed or moved; their points are asked for first. Until newer
  // light arrives, they show `kept` (1 unless changed) times the old light plus the light `added`.
  // `changes` should return false if the lamp is little of the light there: a change that
  // resampling finds costs less. It is called on many threads.
  struct Surface {
    vec3 place, normal;
    uint32_t object = 0;
  };
  using Changes = std::function<bool(const Surface& surface, vec3& kept, vec3& added)>;
  void relight(const Changes& changes);
  // Forgets everything (for another exhibit).
  void clear();

  const CacheSettings& settings() const;
  const CacheStats& stats() const;
  size_t memory_bytes() const;  // without work that is shared

  // For the code that makes the picture of the last projection:
  bool has_projected(const View& view) const;
  uint64_t projection() const;  // changes with every view, clear() and resize()
  int still_frames() const;     // projections of that view before the last one
  bool is_still() const { return still_frames() >= 2; }
  const PointCache& points() const;
  const PointImage& image() const;
  Scratch& scratch();
  // Lends points whose light was forgotten that of newer ones around.
  void lend_light();
  // Ends the frame when its picture is made: gives back memory that only the picture needed. Counts
  // what the picture has shown.
  void end_frame(const ShownPoints& shown);
  void end_frame();  // ends a frame for which no picture was made

  // Draws in between a picture of another view: put_aside() takes the projection away, between two
  // frames, and put_back() restores it as it was. Points stay as they are meanwhile.
  struct Projection;
  struct DropProjection {
    void operator()(Projection* projection) const;
  };
  std::unique_ptr<Projection, DropProjection> put_aside();
  void put_back(std::unique_ptr<Projection, DropProjection> projection);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::cache
