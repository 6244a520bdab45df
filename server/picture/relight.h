// SPDX-License-Identifier: Apache-2.0
// A picture at rest shows the light that stays; what lights that move or change add is put over it
// as often as what moves is drawn: their light times the reflectance of what each pixel shows,
// added before the tone curve.
#pragma once
#include "frame/tonemap.h"
#include "light/dynamic/backdrop_surfaces.h"
#include "picture/keyframe.h"

namespace wellspring::picture {

// What stands still of a picture, and what falls there.
struct BackdropLight {
  const BackdropSurfaces& surfaces;
  const LightPlanes& light;
};
// Overwrites `picture` by what the keyframe, of the view of those surfaces, shows with that light,
// and `peaks` by the light beyond white (frame/tone_curve.h). What emits light by itself stays as
// it is.
void relight(const Keyframe& keyframe, const BackdropLight& backdrop, const Tonemap& tonemap,
             Image8& picture, std::vector<uint8_t>& peaks);

}  // namespace wellspring::picture
