// SPDX-License-Identifier: Apache-2.0
// Draws one visitor's pictures: what is visible (light/visible/visibility.h), in the light that the
// points of a render cache remember (picture/compose_drawn.h). While the view stands still it keeps
// the mean of its pictures and of their samples.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "cache/cache.h"
#include "cache/reconstruct.h"
#include "frame/tonemap.h"
#include "light/virtual/dynamic_image.h"
#include "light/visible/visibility.h"
#include "picture/cells/cells.h"
#include "picture/compose_drawn.h"
#include "picture/keyframe.h"
#include "picture/still/still_samples.h"
#include "picture/cells/surface_image.h"
#include "picture/laid_view.h"

namespace wellspring::picture {

// Turns the points that a picture shows into its cells and its packed surface, once a picture.

// Reads every visible point once: builds the cells, fills holes from their neighbours and leaves
// the surface packed in the frame's planes. Pixels far from any point stay unknown.
ShownPoints read_surface(const WindowView& view, const PointCache& points, const PointImage& image,
                         Cells& cells, Frame& frame);

// Adds dynamic light to a picture at rest, which shows the light that stays, as often as what moves
// is drawn: the lights' irradiance times the reflectance of what each pixel shows, added before the
// tone curve.

// Holds the surfaces of a picture that stand still, and the light that falls there.
struct BackdropLight {
  const BackdropSurfaces& surfaces;
  const LightPlanes& light;
};
// Overwrites `picture` with what the keyframe, whose view is that of the surfaces, shows with that
// light, and `peaks` with the light beyond white (frame/tonemap.h). Pixels that emit light by
// themselves stay as they are.
void relight(const Keyframe& keyframe, const BackdropLight& backdrop, const Tonemap& tonemap,
             Image8& picture, std::vector<uint8_t>& peaks);

struct BackdropLight;  // picture/compositor.h
struct Keyframe;       // picture/keyframe.h
struct MovingPicture;  // picture/keyframe.h: the moving part of a picture at rest
struct MovingLight;
enum class StillShows : uint8_t { all, backdrop };  // backdrop: all that does not move

// Holds memory that is needed only while a picture is drawn. Compositors that are never at work at
// the same time may share it.
struct CompositorWork {
  Frame light;                 // packed (picture/cells/surface_image.h)
  std::vector<uint8_t> peaks;  // light beyond white of a picture for the eye
  std::vector<float> shares;   // shares of means in a picture at rest (mix_in_means())
  LaidWork laid;
  std::vector<float> depth;  // a picture's for the eye, whose caller wants none
};
size_t memory_bytes(const CompositorWork& work);

class Compositor {
 public:
  explicit Compositor(std::shared_ptr<CompositorWork> shared = nullptr);

  // Lights moving meshes by `skin` from now on (borrowed; null: by points like everything else);
  // their smooth gloss shows `lights` (borrowed).
  void set_skin(const SkinLight* skin, const Lights* lights) {
    kept_.skin = skin, kept_.lights = lights;
  }
  // Lights still surfaces by these maps as far as points do not say otherwise; the points' light
  // counts in multiples of the maps' (Sample::known). Null: by points alone.
  void set_maps(std::shared_ptr<const IlluminationMap> maps) {
    kept_.maps = maps.get();
    maps_ = std::move(maps);
  }
  // Lays these things over pictures from now on (borrowed).
  void set_laid(const LaidThings& things) { laid_ = things; }
  // Adds dynamic light to pictures from now on (borrowed; null: none); `image` has to be computed
  // for each view before. Pictures at rest, which become means, are drawn without it.
  void set_dynamic(const DynamicImage* image) { kept_.dynamic = image; }
  // Draws a picture of `view`, which is projected if it is not. The second draws for the eye at
  // once, and sets `depth`, unless it is null, to metres along the viewing axis, infinity: nothing
  // there.
  void draw(RenderCache& cache, const View& view, const VisibilityPass& visibility, Frame& frame);
  void draw(RenderCache& cache, const View& view, const VisibilityPass& visibility,
            const Tonemap& tonemap, Image8& image, std::vector<float>* depth = nullptr);
  // Draws the same at rest: what does not move is antialiased in time, seen at another place of the
  // pixels each time.
  void draw_still(RenderCache& cache, const View& view, const VisibilityPass& visibility,
                  Frame& frame, StillShows shows = StillShows::all);
  // Lays them over a picture at rest, the better the more often it is done for a view. `sways`:
  // lawns move, so that they are left to draw_moving().
  void lay_over_still(const View& view, Frame& frame, bool sways = false) {
    sways_ = sways;
    LaidThings things = laid_;
    if (sways) things.lawns = {};
    layer_.lay_over(things, view, 1, work_->laid, frame);
  }
  // Lays scans over what lights that move light of the keyframe.
  void lay_over_backdrop(const Keyframe& keyframe, BackdropSurfaces& backdrop) {
    lay_scans_over(laid_.scans, keyframe, work_->laid.scans, backdrop);
  }
  // Forgets the samples of pixels at which RenderCache::remember(), called before at rest, has
  // found changed light since the last picture.
  void follow_changes(const RenderCache& cache);
  // Keeps answers to requests of `view`, at rest, for each pixel by itself, until the view is
  // another. Requests that are aimed at a point, not anywhere in the pixel, are left out unless
  // set_reconstructed() lets them count.
  void add_samples(const View& view, std::span<const Request> requests,
                   std::span<const Sample> samples);
  void invalidate_samples();  // for a change of the light
  void forget_means();        // at rest, since surfaces look otherwise now
  // Says that pictures at rest are the input of reconstruction (picture/still/reconstruct_still.h):
  // means of samples are not mixed into them, and while a pixel has few samples, aimed ones count,
  // too.
  void set_reconstructed(bool on) { reconstructed_ = on; }
  // Draws what moves, as the world is now, to be laid over the last draw_still() without it, whose
  // keyframe is `backdrop`; in the light that is kept on its skin, and that of set_dynamic(); and
  // lawns that the last lay_over_still() left out, which never go into a layer. Needs
  // visibility.rasterises(backdrop.view) and set_skin(). The picture is empty if nothing that moves
  // shows. `relit`: unless null, all of the picture is drawn, the backdrop with that light.
  // `in_layer`: what moves goes into the picture's layer instead.
  void draw_moving(const World& world, const Keyframe& backdrop, const BackdropLight* relit,
                   const VisibilityPass& visibility, const Tonemap& tonemap, bool in_layer,
                   MovingLight& work, MovingPicture& picture);

  // Returns how wind moves the grass of the picture that draw() has just made, which is now a
  // keyframe.
  SwayImage find_sway(const Keyframe& keyframe) const {
    return picture::find_sway(laid_.lawns, work_->laid.lawns, keyframe);
  }

  // Returns the samples that the pixels of a view at rest have had; empty before.
  const StillSamples& samples() const { return samples_; }
  // Milliseconds of visibility and shading of the last picture.
  float drawing_ms() const { return drawing_ms_; }
  size_t memory_bytes() const;  // without work that is shared

 private:
  template <class Compose>
  void draw(RenderCache& cache, const View& view, const Compose& compose);
  template <class Compose>
  void draw_laid(RenderCache& cache, const View& view, const Compose& compose);
  void begin(const RenderCache& cache);
  void begin_still(const RenderCache& cache);

  bool shares_;
  std::shared_ptr<CompositorWork> work_;
  KeptLight kept_;
  std::shared_ptr<const IlluminationMap> maps_;  // keeps kept_.maps alive
  Cells cells_;                                  // planes in the cache's scratch
  bool known_ = false;                           // whether any light is known
  StillImage still_;
  StillSamples samples_;
  View sampled_;  // the view of samples_
  LaidThings laid_;
  LaidLayer layer_;
  bool sways_ = false;  // lawns are not in the picture at rest
  bool reconstructed_ = false;
  uint64_t projection_ = 0;  // RenderCache::projection() of the means that are kept
  uint32_t pictures_ = 0;
  float drawing_ms_ = 0;
};

}  // namespace wellspring::picture
