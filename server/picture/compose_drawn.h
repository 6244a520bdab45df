// SPDX-License-Identifier: Apache-2.0
// Draws a picture anew every frame (light/visible/visibility.h) in light that points remember:
// shapes and reflectances have to be sharp, light is smoother than both.
#pragma once
#include <span>

#include "frame/tonemap.h"
#include "light/visible/visibility.h"
#include "picture/keyframe.h"

namespace wellspring::light {
struct DynamicImage;     // light/virtual/dynamic_image.h
struct IlluminationMap;  // light/sample/illumination_map.h
struct SkinLight;        // light/kept/skin/skin_light.h
}  // namespace wellspring::light

namespace wellspring::picture {

class LaidView;  // picture/laid_view.h

// Holds borrowed light that need not be found; with null pointers, points light everything.
struct KeptLight {
  const SkinLight* skin = nullptr;  // light of moving meshes
  const Lights* lights = nullptr;   // lights that their smooth gloss shows, unless skin is null
  const IlluminationMap* maps = nullptr;  // unit of the light in still surfaces' points
  // Dynamic light, computed for pictures of the view that is drawn.
  const DynamicImage* dynamic = nullptr;
  // Is laid over a picture which is soon replaced; others get it later (laid_view.h). Null:
  // nothing.
  const LaidView* laid = nullptr;
};

// Overwrites all planes of `frame`. `light`: its planes are packed as read_surface() leaves them,
// with `cells` filled from it; `known`: the result of fill_cells().
void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, Frame& frame);
// Draws the same for the eye at once, as frame/tonemap.h would show it: writing colours to memory
// and reading them again takes longer than the curve. Resizes `image` and `depth` (null: not
// wanted; metres along the viewing axis, infinity: nothing there). `peaks` is scratch: light beyond
// white, until edges are softened.
void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, const Tonemap& tonemap,
                   std::vector<uint8_t>& peaks, Image8& image, std::vector<float>* depth);

// Draws the parts of a picture at rest that do not move, seen at one place of every pixel, `offset`
// (0 to 1): the mean over several such pictures is antialiased. `guessed`: the share of its light
// that no point holds; the larger it is, the more a pixel's own few samples are doubted, as they
// are while the visitor moves.
void compose_still(const View& view, const VisibilityPass& visibility, vec2 offset,
                   const Cells& cells, bool known, const Frame& light, const KeptLight& kept,
                   float guessed, Frame& frame);
// Lays moving meshes over that picture, always seen at the middle of the pixels, so that nothing
// trembles. Returns their edges, good until the next picture of `visibility`: see soften_edges().
std::span<const std::vector<EdgeShare>> compose_moving(const View& view,
                                                       const VisibilityPass& visibility,
                                                       const Cells& cells, bool known,
                                                       const Frame& light, const KeptLight& kept,
                                                       float guessed, Frame& frame);

// Lays moving meshes over a picture for the eye, in the light that is kept on their skin (kept.skin
// is not null) and that of dynamic lights, where they are nearer than `disparity` (as Keyframe's)
// says of the picture. Pixels that they cover get 0 in `covered`, and their disparity in
// light.disparity unless that is empty. light.picture and light.peaks hold the picture for the eye;
// only its window (whole_runs()) counts.
void compose_moving(const View& view, const VisibilityPass& visibility, const PictureWindow& window,
                    const Tonemap& tonemap, std::span<const float> disparity,
                    std::span<uint8_t> covered, const KeptLight& kept, MovingLight& light);

}  // namespace wellspring::picture
