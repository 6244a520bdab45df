// SPDX-License-Identifier: Apache-2.0
// One visitor's pictures: what is visible (light/visible/visibility.h), in the light that the
// points of a render cache remember (picture/compose_drawn.h). While the view stands still it keeps
// the mean of its pictures and of their samples.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "cache/cache.h"
#include "cache/reconstruct.h"
#include "frame/tonemap.h"
#include "light/dynamic/backdrop_surfaces.h"
#include "light/visible/visibility.h"
#include "picture/cells.h"
#include "picture/compose_drawn.h"
#include "picture/keyframe.h"
#include "picture/still/still_samples.h"
#include "picture/surface_image.h"

namespace wellspring::picture {

// From the points that a picture shows to its cells and its packed surface, once a picture.

// Reads every visible point once: builds the cells, fills holes from their neighbours and leaves
// the surface packed in the frame's planes. Pixels far from any point stay unknown.
ShownPoints read_surface(const WindowView& view, const PointCache& points, const PointImage& image,
                         Cells& cells, Frame& frame);

// A picture at rest shows the light that stays; what lights that move or change add is put over it
// as often as what moves is drawn: their light times the reflectance of what each pixel shows,
// added before the tone curve.

// What stands still of a picture, and what falls there.
struct BackdropLight {
  const BackdropSurfaces& surfaces;
  const LightPlanes& light;
};
// Overwrites `picture` by what the keyframe, of the view of those surfaces, shows with that light,
// and `peaks` by the light beyond white (frame/tonemap.h). What emits light by itself stays as
// it is.
void relight(const Keyframe& keyframe, const BackdropLight& backdrop, const Tonemap& tonemap,
             Image8& picture, std::vector<uint8_t>& peaks);

struct BackdropLight;  // picture/compositor.h
struct Keyframe;       // picture/keyframe.h
struct MovingPicture;  // picture/keyframe.h: what moves in a picture at rest
struct MovingLight;
enum class StillShows : uint8_t { all, backdrop };  // backdrop: but for what moves

// What a picture needs and nobody afterwards. Those that are never under way at the same time may
// share it.
struct CompositorWork {
  Frame light;                 // packed (picture/surface_image.h)
  std::vector<uint8_t> peaks;  // of a picture for the eye: light beyond white
  std::vector<float> shares;   // of a picture at rest (mix_in_means())
};
size_t memory_bytes(const CompositorWork& work);

class Compositor {
 public:
  explicit Compositor(std::shared_ptr<CompositorWork> shared = nullptr);

  // Moving meshes are lit by it from now on (borrowed; null: by points like everything else), and
  // what of that is smooth shows `lights` (borrowed).
  void set_skin(const SkinLight* skin, const Lights* lights) {
    kept_.skin = skin, kept_.lights = lights;
  }
  // Still surfaces are lit by these as far as points do not say otherwise, whose light counts in
  // multiples of theirs (Sample::known); null: by points alone.
  void set_maps(std::shared_ptr<const IlluminationMap> maps) {
    kept_.maps = maps.get();
    maps_ = std::move(maps);
  }
  // Pictures show what lights that move or change add from now on (borrowed; null: nothing); of
  // each view it is to be computed before. Pictures at rest, which become means, are without.
  void set_dynamic(const DynamicImage* image) { kept_.dynamic = image; }
  // A picture of `view`, which is projected if it is not. The second for the eye at once, and of a
  // `depth` that is not null metres along the viewing axis, infinity: nothing there.
  void draw(RenderCache& cache, const View& view, const VisibilityPass& visibility, Frame& frame);
  void draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
            const Tonemap& tonemap, Image8& image, std::vector<float>* depth = nullptr);
  // The same at rest: what does not move is antialiased in time, seen at another place of the
  // pixels each time.
  void draw_still(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                  Frame& frame, StillShows shows = StillShows::all);
  // At rest, after RenderCache::remember(): samples of pixels whose light it found changed since
  // the last picture are forgotten.
  void follow_changes(const RenderCache& cache);
  // At rest: answers to requests of `view` are kept for each pixel by itself, until the view is
  // another. Those that are aimed at a point, not anywhere in the pixel, are not; but see below.
  void add_samples(const View& view, std::span<const Request> requests,
                   std::span<const Sample> samples);
  void invalidate_samples();  // other light
  // Pictures at rest serve as what reconstruction begins with (picture/still/reconstruct_still.h):
  // means of samples are not mixed into them, and while a pixel has few of these, aimed ones count,
  // too.
  void set_reconstructed(bool on) { reconstructed_ = on; }
  // What moves, as the world is now, to be laid over the last draw_still() without it, of which
  // `backdrop` is the keyframe; in the light that is kept on its skin, and that of set_dynamic().
  // Needs sight.rasterises(backdrop.view) and set_skin(). An empty picture: it is not to be seen.
  // `relit`: not null, all of the picture is drawn, the backdrop with that light. in_layer: what
  // moves goes into the picture's layer instead.
  void draw_moving(const World& world, const Keyframe& backdrop, const BackdropLight* relit,
                   const VisibilityPass& visibility, const Tonemap& tonemap, bool in_layer,
                   MovingLight& work, MovingPicture& picture);

  // What the pixels of a view at rest have been found to be by samples; empty before.
  const StillSamples& samples() const { return samples_; }
  float drawing_ms() const { return drawing_ms_; }  // visibility and shading of the last picture
  size_t memory_bytes() const;                      // without work that is shared

 private:
  template <class Compose>
  void draw(RenderCache& cache, const View& view, const Compose& compose);
  void begin(const RenderCache& cache);
  void begin_still(const RenderCache& cache);

  bool shares_;
  std::shared_ptr<CompositorWork> work_;
  KeptLight kept_;
  std::shared_ptr<const IlluminationMap> maps_;  // keeps those of kept_
  Cells cells_;                                  // in the cache's scratch
  bool known_ = false;                           // any light
  StillImage still_;
  StillSamples samples_;
  View sampled_;  // the view of samples_
  bool reconstructed_ = false;
  uint64_t projection_ = 0;  // RenderCache::projection() of what is kept
  uint32_t pictures_ = 0;
  float drawing_ms_ = 0;
};

}  // namespace wellspring::picture
