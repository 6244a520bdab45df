// SPDX-License-Identifier: Apache-2.0
#include "store/format/color_profile.h"

#include <array>
#include <cstring>
#include <lcms2.h>
#include <type_traits>

namespace wellspring::store {
namespace {

constexpr size_t most_profile_bytes = size_t(16) << 20;

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using OpenProfile = std::unique_ptr<void, CloseProfile>;
struct DeleteTransform {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};

}  // namespace

struct ColorProfile::Transform {
  ColorKind kind = ColorKind::rgb;
  std::unique_ptr<void, DeleteTransform> lcms;  // knows no cache, so threads may share it
  std::array<uint8_t, 3 * 256> greys = {};      // RGB of each grey
};

ColorProfile::ColorProfile() : transform_(std::make_unique<Transform>()) {}
ColorProfile::~ColorProfile() = default;

void ColorProfile::convert(const uint8_t* from, uint8_t* to, size_t count) const {
  if (transform_->kind != ColorKind::grey)
    return cmsDoTransform(transform_->lcms.get(), from, to, cmsUInt32Number(count));
  for (size_t i = 0; i < count; i++)
    std::memcpy(to + 4 * i, &transform_->greys[3 * size_t(from[4 * i])], 3);
}

std::shared_ptr<const ColorProfile> make_color_profile(std::span<const uint8_t> icc,
                                                       ColorKind kind) {
  if (icc.empty() || icc.size() > most_profile_bytes) return nullptr;
  const OpenProfile from(cmsOpenProfileFromMem(icc.data(), cmsUInt32Number(icc.size())));
  const OpenProfile to(cmsCreate_sRGBProfile());
  const bool is_grey = kind == ColorKind::grey, is_cmyk = kind == ColorKind::cmyk;
  const cmsColorSpaceSignature space = is_grey   ? cmsSigGrayData
                                       : is_cmyk ? cmsSigCmykData
                                                 : cmsSigRgbData;
  if (!from || !to || cmsGetColorSpace(from.get()) != space) return nullptr;
  const auto profile = std::make_shared<ColorProfile>();
  ColorProfile::Transform& made = *profile->transform_;
  made.kind = kind;
  made.lcms.reset(cmsCreateTransform(from.get(),
                                     is_grey   ? TYPE_GRAY_8
                                     : is_cmyk ? TYPE_CMYK_8
                                               : TYPE_RGBA_8,
                                     to.get(), is_grey ? TYPE_RGB_8 : TYPE_RGBA_8,
                                     INTENT_RELATIVE_COLORIMETRIC,
                                     cmsFLAGS_NOCACHE | cmsFLAGS_BLACKPOINTCOMPENSATION));
  if (!made.lcms) return nullptr;
  if (is_grey) {
    std::array<uint8_t, 256> codes;
    for (size_t i = 0; i < codes.size(); i++) codes[i] = uint8_t(i);
    cmsDoTransform(made.lcms.get(), codes.data(), made.greys.data(), 256);
  }
  return profile;
}

void convert_cmyk(const ColorProfile* profile, const uint8_t* cmyk, uint8_t* rgba, size_t count) {
  if (profile) return profile->convert(cmyk, rgba, count);
  for (size_t i = 0; i < count; i++, cmyk += 4, rgba += 4)
    for (size_t c = 0; c < 3; c++)
      rgba[c] = uint8_t(((255 - cmyk[c]) * (255 - cmyk[3]) + 127) / 255);
}

}  // namespace wellspring::store
