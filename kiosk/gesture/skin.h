// SPDX-License-Identifier: Apache-2.0
// Learns the colour of somebody's skin from the face: one Gaussian over Cb and Cr.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace wellspring::kiosk {

// Follows a coloured region from picture to picture by mean shift over chrominance (Elmezain et al.
// 2009, section 2; Comaniciu, Ramesh, Meer 2003). Brightness is left out, so shadows matter little.

// Holds rows of blue, green, red bytes, top row first; borrowed.
struct ColorView {
  int width = 0, height = 0;
  const uint8_t* bgr = nullptr;
};

// Holds Y, Cb and Cr of ITU-R BT.601. A pixel with `use` 0 is left out of all sums.
struct ChromaPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> y, cb, cr, use;
};
void make_chroma(const ColorView& view, ChromaPicture& out);  // all pixels are in use

// Holds the m bins: 32 by 32 of Cb and Cr. Their sum is 1.
inline constexpr int chroma_bins = 32 * 32;
using ChromaHistogram = std::array<float, chroma_bins>;

// Makes a histogram by equations 1 to 4: pixels count by the Epanechnikov kernel of that radius
// round the centre, in pixels. All bins are 0 if no pixel is in use.
ChromaHistogram make_histogram(const ChromaPicture& picture, vec2 center, float radius);

// Returns equation 5: 1 for equal histograms, 0 for histograms without a common bin.
float bhattacharyya(const ChromaHistogram& a, const ChromaHistogram& b);

struct Shifted {
  vec2 center{0};
  float similarity = 0;  // Bhattacharyya's coefficient at the last place
  int iterations = 0;
};
// Iterates equations 6 to 8, from `center` until a shift is below 0.1 pixel, at most 15 times.
// `emphasis`, one number a pixel, weighs pixels besides; empty: all alike.
Shifted mean_shift(const ChromaPicture& picture, const ChromaHistogram& model, vec2 center,
                   float radius, const std::vector<float>& emphasis = {});

class SkinColor {
 public:
  // Adds the face of that centre and side (pixels) to the colour; the newest second counts most.
  // Eyes, lips and hair are left out as far as they differ from most of it.
  void learn(const ChromaPicture& picture, vec2 center, float side);
  // Returns whether this is skin; never before a face was learnt, and never if it is too dark.
  bool has(uint8_t y, uint8_t cb, uint8_t cr) const;
  vec2 mean() const { return mean_; }  // Cb, Cr

 private:
  bool known_ = false;
  vec2 mean_{0};
  vec3 spread_{0};  // variance of Cb, covariance, variance of Cr
};

}  // namespace wellspring::kiosk
