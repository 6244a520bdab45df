// SPDX-License-Identifier: Apache-2.0
// Shows codes of bands in three colours: under a lamp, as one band, or in false colours. Each is
// one small matrix, so that nothing has to be stored but the bands.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "store/bands/bands.h"

namespace wellspring::store {

// Says how a picture of bands is shown; at first in the colours of daylight (D65).
struct BandView {
  std::string lamp = {};  // a name that spectrum::find_lamp() knows; empty: daylight
  bool adapted = false;   // whether eyes are used to the lamp (CAT16), else to daylight
  // One wavelength that is shown in grey, or those shown as red, green and blue; empty: the lamp.
  std::vector<double> shown_nm;
  bool operator==(const BandView&) const = default;
};

// Says how much each band adds to linear Rec. 709 red, green and blue.
using BandWeights = std::vector<dvec3>;

// Returns the weights of all bands. Lamps that are shown to eyes used to daylight are dimmed until
// no white surface is cut. Throws LoadError of `file` for wavelengths beyond the bands, lamps that
// are unknown, and bands that tell no colours.
BandWeights weigh_bands(const std::string& file, const Bands& bands, const BandView& view);

// The kind of a file's codes.
enum class BandCode : uint8_t { u8, u16, f32 };
inline int bytes_of(BandCode code) {
  return code == BandCode::u8 ? 1 : code == BandCode::u16 ? 2 : 4;
}

// Makes colours of codes.
class BandMixer {
 public:
  BandMixer(const Bands& bands, const BandWeights& weights, BandCode code);
  // Returns whether a band adds anything; others need not be read.
  bool uses(size_t band) const { return uses_[band]; }
  // Takes codes of a band: `stride` codes from texel to texel; unaligned. They stay borrowed until
  // mix() returns.
  struct Codes {
    const uint8_t* at = nullptr;
    size_t stride = 1;
  };
  // Writes RGBA in sRGB codes of `count` texels. `codes`: of each band, null where it is not used.
  // Returns the band that has a value which is no number, if there is one.
  std::optional<size_t> mix(std::span<const Codes> codes, size_t count, uint8_t* rgba) const;

 private:
  struct Used {
    size_t band;
    vec3 weight;
    float scale, black;
  };
  std::vector<Used> used_;
  std::vector<bool> uses_;
  BandCode code_;
  float gamma_;
};

// Returns the largest code of a kind, which is white where nobody says otherwise.
double largest_code(BandCode code);
// Fills `reflectances` from codes as Bands says, unbounded.
void read_reflectances(const Bands& bands, size_t band, BandCode code, BandMixer::Codes codes,
                       std::span<float> reflectances);

}  // namespace wellspring::store
