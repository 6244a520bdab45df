// SPDX-License-Identifier: Apache-2.0
// A picture drawn anew every frame (light/visible/visibility.h) in light that points remember:
// shapes and reflectances are what has to be sharp, light is smoother than both.
#pragma once
#include "frame/tonemap.h"
#include "light/visible/visibility.h"
#include "picture/keyframe.h"

namespace wellspring::light {
struct DynamicImage;     // light/dynamic/dynamic_image.h
struct IlluminationMap;  // light/sample/illumination_map.h
struct SkinLight;        // light/known/skin_light.h
}  // namespace wellspring::light

namespace wellspring::picture {

// Light that need not be found, borrowed; null: all is lit by points.
struct KeptLight {
  const SkinLight* skin = nullptr;        // what moves is lit by, and its smooth gloss by
  const Lights* lights = nullptr;         // these, where that is not null
  const IlluminationMap* maps = nullptr;  // what still surfaces' points count in multiples of
  // What lights that move or change add, computed for pictures of the view that is drawn.
  const DynamicImage* dynamic = nullptr;
};

// Overwrites all planes of `frame`. `light`: its planes packed as read_surface() leaves them, with
// `cells` filled from it; `known`: what fill_cells() said.
void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, Frame& frame);
// The same for the eye at once, as frame/tonemap.h would show it: writing colours to memory and
// reading them again takes longer than the curve. Resizes `image` and `depth` (null: not wanted;
// metres along the viewing axis, infinity: nothing there). `peaks` is scratch: light beyond white,
// until edges are softened.
void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, const Tonemap& tonemap,
                   std::vector<uint8_t>& peaks, Image8& image, std::vector<float>* depth);

// Draws what does not move of a picture at rest, seen at one place of every pixel, `offset` (0 to
// 1): the mean over several such pictures is antialiased. `guessed`: the share of its light that no
// point tells, by which a pixel's own few samples are doubted as they are while the visitor moves.
void compose_still(const View& view, const VisibilityPass& visibility, vec2 offset,
                   const Cells& cells, bool known, const Frame& light, const KeptLight& kept,
                   float guessed, Frame& frame);
// What moves, laid over that, always at the middle of the pixels, so that nothing trembles. Returns
// its edges, good until the sight's next picture: see soften_edges().
std::span<const std::vector<EdgeShare>> compose_moving(const View& view,
                                                       const VisibilityPass& visibility,
                                                       const Cells& cells, bool known,
                                                       const Frame& light, const KeptLight& kept,
                                                       float guessed, Frame& frame);

// The same over what the eye sees already, in the light that is kept on its skin (kept.skin is not
// null) and that of lights that move, where it is nearer than `disparity` (as Keyframe's) says of
// the picture. Of pixels that it covers `covered` becomes 0, and light.disparity, unless it is
// empty, that of what moves. light.picture and light.peaks: what the eye sees already, of which the
// window (whole_runs()) counts.
void compose_moving(const View& view, const VisibilityPass& visibility, const PictureWindow& window,
                    const Tonemap& tonemap, std::span<const float> disparity,
                    std::span<uint8_t> covered, const KeptLight& kept, MovingLight& light);

}  // namespace wellspring::picture
