// SPDX-License-Identifier: Apache-2.0
// The render cache of one visitor (Walter, Drettakis, Parker 1999, "Interactive Rendering using the
// Render Cache"): samples as points in space, reprojected every frame, and where to look next. One
// frame: project -> attend -> plan -> (trace) -> remember -> reconstruct. All functions use all
// cores, never fail and never block; memory is bounded by the room asked for with resize().
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "light/sample.h"
#include "light/see_picture.h"
#include "world/view.h"

namespace wellspring {

struct CacheSettings {
  float points_per_pixel = 1.0625f;  // capacity over pixels (paper, section 4.3: slightly larger)
  float depth_threshold = 0.1f;      // paper, section 3.1
  float color_change = 0.25f;  // relative change of a resampled point that ages its neighbours
  float budget_share_old = 1;  // weight of age against emptiness in the priority
  bool attention = true;       // false: samples spread evenly
  // What mirrors show is kept where its image lies, not on them. For pictures made of points alone:
  // where shapes are drawn, light is looked for on the surfaces.
  bool images = false;
};

struct Tonemap;
struct Keyframe;       // cache/keyframe.h
struct MovingPicture;  // cache/moving_picture.h: what moves in a picture at rest
struct MovingLight;
enum class StillShows : uint8_t { all, backdrop };  // backdrop: but for what moves
struct PointCache;  // cache/point_cache.h: the points
struct PointImage;  // cache/point_image.h: what projects where, priorities

// What the last frame looked like, in numbers (for /metrics, the status page and tests).
struct CacheStats {
  int points = 0;                                           // in use
  float fresh = 0, reprojected = 0, filled = 0, empty = 0;  // shares of the picture's pixels
  float drawing_ms =
      0;  // of the last picture that was drawn: PictureSight, and light put on what it sees
  float mean_age = 0;   // of the visible points, 0 (new) to 254; see age_points()
  float converged = 0;  // share of pixels whose point has reached its sample goal
};

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
  // The object was carried off as a whole, by `moved` (rigid) from where it was: its points go
  // along.
  void move_object(uint32_t object, const mat4& moved);
  // Where every point falls in `view`; depth cull. Views of less than the room there is, such as
  // light_view()'s, cost no memory and no point. Those of up to twice as many pixels have a larger
  // image, and larger ones room for more points.
  void project(const View& view);
  // About the share of pixels that a point shows in, from every eighth row.
  float covered() const;
  // Priority of every pixel (paper, section 4).
  void attend();
  // Exactly `budget` (or fewer when there is nothing left to learn) requests by error diffusion;
  // resampled points are passed exactly. `seed` makes the choice and the samples repeatable.
  void plan(const View& view, int budget, uint64_t seed, std::vector<Request>& requests);
  // Appends requests for what the view `ahead` will show and no point is near (cache/predict.h), at
  // most `most`; their answers are to be remembered with the others.
  void predict(const View& ahead, int most, uint64_t seed, std::vector<Request>& requests);
  // Puts answers into the cache and into the current projection.
  void remember(const View& view, std::span<const Request> requests,
                std::span<const Sample> samples);
  // The picture of points alone: overwrites `frame` (color, confidence; depth and object for those
  // who ask later).
  void reconstruct(const View& view, Frame& frame);
  // The same in two steps, for sharper edges: survey() asks what rays (at most `most`) see, and
  // answers to all of them are shown. The frame must not be touched in between.
  void survey(const View& view, int most, Frame& frame, std::vector<Ray>& looks);
  void reconstruct(const View& view, std::span<const Seen> seen, Frame& frame);
  // A picture of `view` drawn in the light of `view` or of light_view(view)
  // (cache/compose_drawn.h), whichever all of the frame before has been done for (neither: the
  // latter); needs sight.rasterises(view). The second for the eye at once, and of a `depth` that is
  // not null metres along the viewing axis, infinity: nothing there. `calm`: of pixels so large
  // that a point's own light would show as a square.
  void draw(const View& view, const PictureSight& sight, Frame& frame);
  void draw(const View& view, const PictureSight& sight, const Tonemap& tonemap, Image8& image,
            std::vector<float>* depth = nullptr, bool calm = false);
  // The same at rest, in light of the view's own resolution, for which all of the frame before has
  // been done: what does not move is antialiased in time, seen at another place of the pixels each
  // time.
  void draw_still(const View& view, const PictureSight& sight, Frame& frame,
                  StillShows shows = StillShows::all);
  // Whether enough points that show lie on what moves.
  bool knows_moving() const;
  // Whether it asks for exactly a point on what moves, which is elsewhere soon.
  bool follows_moving(const Request& request) const;
  // What moves, as the world is now, to be laid over the last draw_still() without it, of which
  // `backdrop` is the keyframe; needs no projection. False: no point lies on it. An empty picture:
  // it is not to be seen.
  bool draw_moving(const World& world, const Keyframe& backdrop, const PictureSight& sight,
                   const Tonemap& tonemap, MovingLight& work, MovingPicture& picture);
  // Answers come from the reference from now on, or no longer (else that they differ from earlier
  // ones might be taken for a change of the light). Its light is not expected to be that of others.
  void set_reference(bool on);
  void set_attention(bool on);  // CacheSettings::attention
  // From now on pictures are drawn (draw(), draw_still()): points remember no light that surfaces
  // emit themselves, as these pictures know it exactly, from texel to texel (Sample::glow). Or are
  // no longer: the next move_points() finds out what all points emit that are known.
  void set_drawn(bool on);
  // A lamp was switched, dimmed or moved, and is much of the light where `changes` says so of a
  // surface, on many threads: what was remembered of the light there counts no more, and is asked
  // for first. Until newer light is known, `kept` of it, 1 unless changed, and the light `added`
  // are shown. Not where the lamp is little of the light: there a change that resampling finds
  // costs less.
  using Changes = std::function<bool(vec3 place, vec3 normal, vec3& kept, vec3& added)>;
  void relight(const Changes& changes);
  // Forgets everything (another exhibit).
  void clear();

  const CacheSettings& settings() const;
  const CacheStats& stats() const;
  size_t memory_bytes() const;  // without work that is shared

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
