// SPDX-License-Identifier: Apache-2.0
// Which of what keeps light on its skin (light/known/skin_light.h) a view shows, by rays through a
// few places of the window that it lies in.
#pragma once
#include <span>
#include <vector>

#include "light/known/skin_light.h"
#include "world/view.h"

namespace wellspring {

struct SkinSight {
  float pixels = 0;              // of the view that show what moves, about
  std::vector<uint32_t> places;  // one of each ray that met any, in the order of the rays
};
// Other places for each `turn`. Clear panes are seen through. All cores; the same bits whatever the
// number of threads. Call after World::commit(), while nothing moves.
SkinSight see_skin(const World& world, const SkinLight& skin, const View& view, int rays,
                   uint64_t turn);

}  // namespace wellspring
