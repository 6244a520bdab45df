// SPDX-License-Identifier: Apache-2.0
// Turns the codes of a picture into sRGB by its ICC profile (Little CMS). Several threads may use
// one profile at once.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/layers.h"

namespace wellspring::store {

enum class ColorKind : uint8_t { grey, rgb, cmyk };

class ColorProfile {
 public:
  ColorProfile();
  ~ColorProfile();
  ColorProfile(const ColorProfile&) = delete;
  ColorProfile& operator=(const ColorProfile&) = delete;

  // Converts texels of 4 bytes: RGBA, grey in all of RGB, or CMYK (255: full ink), into the RGB of
  // RGBA. `to` may be `from` but for CMYK; alpha in `to` stays.
  void convert(const uint8_t* from, uint8_t* to, size_t count) const;

 private:
  friend std::shared_ptr<const ColorProfile> make_color_profile(std::span<const uint8_t> icc,
                                                                ColorKind kind);
  struct Transform;
  std::unique_ptr<Transform> transform_;
};

// Returns null for a profile that is broken or of another kind of picture: browsers, too, then show
// the codes as they are.
std::shared_ptr<const ColorProfile> make_color_profile(std::span<const uint8_t> icc,
                                                       ColorKind kind);

// Converts CMYK likewise; without a profile inks absorb as in a textbook.
void convert_cmyk(const ColorProfile* profile, const uint8_t* cmyk, uint8_t* rgba, size_t count);

}  // namespace wellspring::store
