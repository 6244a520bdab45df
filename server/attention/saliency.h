// SPDX-License-Identifier: Apache-2.0
// Finds where a picture draws the eye by itself: the model of Itti, Koch, Niebur 1998 ("A model of
// saliency-based visual attention for rapid scene analysis") without orientations, as Haber,
// Myszkowski, Yamauchi, Seidel 2001 ("Perceptually guided corrective splatting", section 3) use it.
//
//   picture -> intensity, R-G, B-Y -> Gaussian pyramids -> centre-surround: feature maps
//   -> N -> sums over scales: conspicuity maps of intensity and of colour -> N -> mean: saliency
//
// A feature map holds |centre - surround| as in the paper, but N promotes its two parts apart, as
// Frintrop 2006 ("VOCUS") does: the places at which the centre has more (bright on dark, R-G, B-Y)
// and those at which it has less (dark on bright, G-R, Y-B). Else one red thing among green ones
// would be one of many alike. Both keep their common scale.
//
// The result is the same for any number of threads; a mirrored picture has the mirrored map.
#pragma once
#include <array>
#include <vector>

#include "base/vec.h"
#include "frame/frame.h"

namespace wellspring::attention {

// Computes the intensity of a colour given as 8-bit codes, and the differences of its opponent
// colours.

// Sets `out` to the intensity (r + g + b) / 3, 0 to 1, and the differences of the broadly tuned
// colours R, G, B and Y, each colour over r + g + b, so that hue counts and brightness does not.
// Hue cannot be seen in the dark: both differences are 0 if r + g + b <= `dark`. T is a number, or
// eight lanes. Y = (r + g) / 2 - |r - g| / 2 - b = min(r, g) - b.
template <class T, class Least, class Positive, class Choose>
void eval_channels(T r, T g, T b, T dark, const Least& least, const Positive& positive,
                   const Choose& choose, T (&out)[3]) {
  T sum = r + g + b;
  T red = positive(r - 0.5f * (g + b)), green = positive(g - 0.5f * (r + b)),
    blue = positive(b - 0.5f * (r + g)), yellow = positive(least(r, g) - b);
  out[0] = sum * (1 / 765.0f);
  out[1] = choose(sum > dark, (red - green) / sum);
  out[2] = choose(sum > dark, (blue - yellow) / sum);
}

// Builds Gaussian pyramids (Burt, Adelson 1983): each scale is the one before, low-pass filtered
// and of half its size, odd sizes rounded up. The binomial (1 5 10 10 5 1)/32 filters a side of
// even length, so that its pixels lie between two finer ones; (1 4 6 4 1)/16 filters one of odd
// length, so that its pixels lie on every second finer one. So a mirrored plane has a mirrored
// pyramid, whatever its size. Beyond its border a plane goes on as at the border.

// Holds one number a pixel, top row first.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> value;
  float* row(int y) { return value.data() + size_t(y) * size_t(width); }
  const float* row(int y) const { return value.data() + size_t(y) * size_t(width); }
};
// Gives the plane that size; its contents mean nothing.
inline void fit_plane(int width, int height, Plane& plane) {
  plane.width = width;
  plane.height = height;
  plane.value.resize(size_t(width) * size_t(height));
}

inline int half_size(int size) { return (size + 1) / 2; }
// Returns where pixel `x` of a side of that many pixels lies at the next coarser scale.
inline float coarser_place(float x, int size) {
  return size % 2 == 0 ? 0.5f * x - 0.25f : 0.5f * x;
}

// Computes `count` neighbours of a filtered row, at most piece_size, of a side of `size` pixels.
// The first lies at pixel 2 i of the finer row or just right of it, and `fine` holds that row from
// pixel 2 i - 2 on, 2 * count + 4 of them.
inline constexpr int piece_size = 128, fine_piece_size = 2 * piece_size + 4;
void reduce_piece(const float* fine, int size, int count, float* coarse);
// Makes the next scale of rows that are filtered so.
void reduce_rows(const Plane& narrow, Plane& coarse);

// Computes the next coarser scale. `narrow` is scratch.
void reduce(const Plane& fine, Plane& narrow, Plane& coarse);
// Computes the next finer scale, of that size, interpolated linearly: each coarser pixel lies where
// reduce() put it. `narrow` is scratch.
void expand(const Plane& coarse, int width, int height, Plane& narrow, Plane& fine);

// Scale 0 of the pyramids is the picture. Centres are the scales 2, 3 and 4, surrounds are 3 and 4
// scales coarser. The maps of all scales are added at scale 4, a sixteenth of the picture's size.
inline constexpr int scale_count = 9, saliency_scale = 4;
inline constexpr int channel_count = 3;  // intensity, R-G, B-Y
inline constexpr int maps_a_channel = 6, feature_count = channel_count * maps_a_channel;

// Holds 0 (nothing to see) to 1 (the picture's most salient place). An evenly coloured picture has
// 0 everywhere.
struct SaliencyMap {
  Plane map;
  // Pixel (x, y) of the picture, counted by its middle, lies at `offset` + (x, y) / 16 in the map.
  vec2 offset{0};
};
// Holds memory that is kept from picture to picture: pictures of one size allocate once.
struct SaliencyWork {
  struct Feature {
    Plane narrow, one, other, map;
    Plane less;  // places at which the centre has less than the surround
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

// Applies the operator N: the map's values become 0 to 1, then are multiplied by (M - m)^2, where M
// is the largest and m the mean of the other local maxima. It promotes maps with few strong peaks
// and suppresses maps with many alike. A map whose values differ by less than `least_range` is
// noise rather than signal: it is scaled as if they differed by that much.
inline constexpr float least_range = 0.01f;
void promote_peaks(Plane& map);

}  // namespace wellspring::attention
