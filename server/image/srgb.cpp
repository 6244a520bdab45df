// SPDX-License-Identifier: Apache-2.0
#include "image/srgb.h"

#include <cmath>

namespace wellspring::image {
namespace {

std::array<float, 256> make_srgb_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; i++) {
    double s = i / 255.0;
    table[size_t(i)] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return table;
}

}  // namespace

const std::array<float, 256> srgb_table = make_srgb_table();

}  // namespace wellspring::image
