// SPDX-License-Identifier: Apache-2.0
#include "store/bands/band_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/core.h>

#include "base/load_error.h"
#include "spectrum/band_matrix.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "store/picture/texels.h"

namespace wellspring::store {
namespace {

// Bands have to reach so far, without larger gaps in between, if they are to tell colours.
constexpr double blue_end_nm = 450, red_end_nm = 620, widest_gap_nm = 100;
constexpr size_t texels_at_once = 512;  // whose sums stay in the innermost cache

void check_colors(const std::string& file, const Bands& bands) {
  const auto fail = [&](const std::string& what) {
    throw LoadError(file, "",
                    "tells no colours: " + what +
                        "; colours need bands from 450 to 620 nm, 100 nm apart at most");
  };
  const std::vector<double>& nm = bands.nm;
  if (nm.front() > blue_end_nm) fail(fmt::format("its first band is {:g} nm", nm.front()));
  if (nm.back() < red_end_nm) fail(fmt::format("its last band is {:g} nm", nm.back()));
  for (size_t i = 1; i < nm.size(); i++)
    if (nm[i] - nm[i - 1] > widest_gap_nm && nm[i] > blue_end_nm && nm[i - 1] < red_end_nm)
      fail(fmt::format("bands are missing between {:g} and {:g} nm", nm[i - 1], nm[i]));
}

BandWeights weigh_lamp(const std::string& file, const Bands& bands, const BandView& view) {
  const std::string name = view.lamp.empty() ? "D65" : view.lamp;
  const auto lamp = find_lamp(name);
  if (!lamp)
    throw LoadError(file, "",
                    "there is no lamp '" + name +
                        "'; `./wellspring lamps --list-lamps` lists "
                        "those that have names");
  check_colors(file, bands);
  BandWeights weights = band_matrix(bands.nm, lamp->power);
  const dvec3 white = LampObserver(lamp->power).white();
  const dvec3 day = LampObserver(find_lamp("D65")->power).white();
  for (dvec3& one : weights) one = rgb_of(view.adapted ? adapt_cat16(one, white, day) : one);
  dvec3 shown(0);
  for (const dvec3& one : weights) shown += one;
  const double most = std::max({shown.x, shown.y, shown.z});
  for (dvec3& one : weights) one /= most;
  return weights;
}

// Adds a wavelength to a channel, between the two bands beside it.
void weigh_nm(const std::string& file, const Bands& bands, double nm, const dvec3& channel,
              BandWeights& weights) {
  const std::vector<double>& all = bands.nm;
  if (!(nm >= all.front() && nm <= all.back()))
    throw LoadError(
        file, "",
        fmt::format("has no band at {:g} nm: it has {:g} to {:g} nm", nm, all.front(), all.back()));
  const size_t right = size_t(std::ranges::lower_bound(all, nm) - all.begin());
  const double share = right == 0 ? 1 : (nm - all[right - 1]) / (all[right] - all[right - 1]);
  weights[right] += share * channel;
  if (right > 0) weights[right - 1] += (1 - share) * channel;
}

template <class Code>
void convert(BandMixer::Codes codes, size_t count, float scale, float black, float* values) {
  const auto convert_each = [&](size_t stride) {
    for (size_t i = 0; i < count; i++) {
      Code code;
      std::memcpy(&code, codes.at + i * stride * sizeof(Code), sizeof(Code));
      values[i] = (float(code) - black) * scale;
    }
  };
  // A stride that the compiler knows lets it take several at once.
  if (codes.stride == 1) convert_each(1);
  else convert_each(codes.stride);
}

void convert_kind(BandCode kind, BandMixer::Codes codes, size_t count, float scale, float black,
                  float* values) {
  switch (kind) {
    case BandCode::u8: return convert<uint8_t>(codes, count, scale, black, values);
    case BandCode::u16: return convert<uint16_t>(codes, count, scale, black, values);
    case BandCode::f32: return convert<float>(codes, count, scale, black, values);
  }
}

void raise(float gamma, size_t count, float* values) {
  if (gamma == 1) return;
  for (size_t i = 0; i < count; i++) values[i] = std::max(values[i], 0.0f);
  if (gamma == 2)
    for (size_t i = 0; i < count; i++) values[i] *= values[i];
  else
    for (size_t i = 0; i < count; i++) values[i] = std::pow(values[i], gamma);
}

}  // namespace

BandWeights weigh_bands(const std::string& file, const Bands& bands, const BandView& view) {
  if (view.shown_nm.empty()) return weigh_lamp(file, bands, view);
  BandWeights weights(bands.nm.size(), dvec3(0));
  if (view.shown_nm.size() == 1) {
    weigh_nm(file, bands, view.shown_nm[0], dvec3(1), weights);
    return weights;
  }
  for (int c = 0; c < 3; c++) {
    dvec3 channel(0);
    channel[c] = 1;
    weigh_nm(file, bands, view.shown_nm[size_t(c)], channel, weights);
  }
  return weights;
}

double largest_code(BandCode code) {
  return code == BandCode::u8 ? 255 : code == BandCode::u16 ? 65535 : 1;
}

BandMixer::BandMixer(const Bands& bands, const BandWeights& weights, BandCode code)
    : uses_(weights.size()), code_(code), gamma_(float(bands.gamma)) {
  for (size_t band = 0; band < weights.size(); band++) {
    if (weights[band] == dvec3(0)) continue;
    uses_[band] = true;
    const double white = bands.white_of(band, largest_code(code));
    used_.push_back(
        {band, vec3(weights[band]), float(1 / (white - bands.black)), float(bands.black)});
  }
}

std::optional<size_t> BandMixer::mix(std::span<const Codes> codes, size_t count,
                                     uint8_t* rgba) const {
  std::array<float, texels_at_once> value, red, green, blue;
  for (size_t first = 0; first < count; first += texels_at_once) {
    const size_t some = std::min(texels_at_once, count - first);
    red.fill(0), green.fill(0), blue.fill(0);
    for (const Used& one : used_) {
      Codes from = codes[one.band];
      from.at += first * from.stride * size_t(bytes_of(code_));
      convert_kind(code_, from, some, one.scale, one.black, value.data());
      raise(gamma_, some, value.data());
      if (code_ == BandCode::f32)
        for (size_t i = 0; i < some; i++)
          if (!std::isfinite(value[i])) return one.band;
      for (size_t i = 0; i < some; i++) {
        red[i] += one.weight.x * value[i];
        green[i] += one.weight.y * value[i];
        blue[i] += one.weight.z * value[i];
      }
    }
    write_srgb(red.data(), green.data(), blue.data(), some, rgba + 4 * first);
  }
  return std::nullopt;
}

void read_reflectances(const Bands& bands, size_t band, BandCode code, BandMixer::Codes codes,
                       std::span<float> reflectances) {
  const double white = bands.white_of(band, largest_code(code));
  convert_kind(code, codes, reflectances.size(), float(1 / (white - bands.black)),
               float(bands.black), reflectances.data());
  raise(float(bands.gamma), reflectances.size(), reflectances.data());
}

}  // namespace wellspring::store
