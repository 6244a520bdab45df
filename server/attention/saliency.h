// SPDX-License-Identifier: Apache-2.0
// Where a picture draws the eye by itself: the model of Itti, Koch, Niebur 1998 ("A model of
// saliency-based visual attention for rapid scene analysis") without orientations, as Haber,
// Myszkowski, Yamauchi, Seidel 2001 ("Perceptually guided corrective splatting", section 3) use it.
//
//   picture -> intensity, R-G, B-Y -> Gaussian pyramids -> centre-surround: feature maps
//   -> N -> sums over scales: conspicuity maps of intensity and of colour -> N -> mean: saliency
//
// A feature map holds |centre - surround| as in the paper, but where the centre has more (bright on
// dark, R-G, B-Y) and where it has less (dark on bright, G-R, Y-B) N promotes apart, as Frintrop
// 2006 ("VOCUS") does: else one red thing among green ones would be one of many alike. Both keep
// their common scale.
//
// Deterministic for any number of threads; a mirrored picture has the mirrored map.
#pragma once
#include <array>

#include "attention/pyramid.h"
#include "frame/frame.h"

namespace wellspring::attention {

// Of the pyramids, scale 0 is the picture. Centres are the scales 2, 3 and 4, surrounds are 3 and 4
// scales coarser. The maps of all scales are added at scale 4, a sixteenth of the picture's size.
inline constexpr int scale_count = 9, saliency_scale = 4;
inline constexpr int channel_count = 3;  // intensity, R-G, B-Y
inline constexpr int maps_a_channel = 6, feature_count = channel_count * maps_a_channel;

// 0 (nothing to see) to 1 (the picture's most salient place). An evenly coloured picture has 0
// everywhere.
struct SaliencyMap {
  Plane map;
  // Pixel (x, y) of the picture, counted by its middle, lies at `offset` + (x, y) / 16 in the map.
  vec2 offset{0};
};
// What the computation keeps from picture to picture: pictures of one size allocate once.
struct SaliencyWork {
  struct Feature {
    Plane narrow, one, other, map;
    Plane less;  // where the centre has less than the surround
    Plane sum;   // the promoted map at scale 4
  };
  std::array<std::array<Plane, scale_count>, channel_count> pyramid;  // [0] is not filled
  std::array<Plane, channel_count> narrow;
  std::array<Feature, feature_count> feature;
  std::array<Plane, 2> conspicuity;  // intensity, colour
};
size_t memory_bytes(const SaliencyWork& work);

// Overwrites `saliency`. An empty picture has an empty map.
void eval_saliency(const Image8& picture, SaliencyWork& work, SaliencyMap& saliency);

// --- Parts of it, for tests ------------------------------------------------------------------

// The operator N: the map's values become 0 to 1, then are multiplied by (M - m)^2, where M is the
// largest and m the mean of the other local maxima. It promotes maps with few strong peaks and
// suppresses maps with many alike. A map whose values differ by less than `least_range` is noise
// rather than signal: it is scaled as if they differed by that much.
inline constexpr float least_range = 0.01f;
void promote_peaks(Plane& map);

}  // namespace wellspring::attention
