// SPDX-License-Identifier: Apache-2.0
// Antialiases pictures that have one sampling place a pixel: pixels that an edge cuts take their
// share of the colour beyond it.
#pragma once
#include <span>
#include <vector>

#include "frame/frame.h"
#include "world/raster/raster.h"

namespace wellspring::picture {

// Softens the edges of linear light. `edges`: Raster::edges() of the picture. If several cut a
// pixel, such as both of a bar, their shares add up, to all of it at most.
void soften_edges(std::span<const std::vector<EdgeShare>> edges, std::vector<vec3>& color);
// Softens the edges of a picture that has been through the tone curve (frame/tonemap.h): its
// light is mixed as it was before, since half a pixel of bright sky is white already. `peaks`: the
// code of each pixel's light, which is changed with it.
void soften_edges(std::span<const std::vector<EdgeShare>> edges, Image8& image,
                  std::span<uint8_t> peaks);

}  // namespace wellspring::picture
