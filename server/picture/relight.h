// SPDX-License-Identifier: Apache-2.0
// A picture at rest shows the light that stays; what lights that move or change add is put over it
// as often as what moves is drawn: their light times the reflectance of what each pixel shows,
// added before the tone curve.
#pragma once
#include "frame/tonemap.h"
#include "light/dynamic/dynamic_image.h"
#include "light/visible/visibility.h"
#include "picture/keyframe.h"

namespace wellspring {

// Overwrites `picture` by what the keyframe shows with that light, which was computed for its view,
// and `peaks` by the light beyond white (frame/tone_curve.h). What emits light by itself stays as
// it is. Needs visibility.rasterises() of the view.
void relight(const Keyframe& keyframe, const VisibilityPass& visibility, const DynamicImage& light,
             const Tonemap& tonemap, Image8& picture, std::vector<uint8_t>& peaks);

}  // namespace wellspring
