// SPDX-License-Identifier: Apache-2.0
// A scene of pigments in the light of one lamp: each lit straight, and each in the light that
// another has sent back, so that what a technique makes of it can be compared with sums over every
// nanometre.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace wellspring::test {

// Tells how far colours are off, CIEDE2000 beside the lamp's own white.
struct PigmentErrors {
  // One for each pigment; twice: in light that the next one had sent back.
  std::vector<double> once, twice;
  double negative = 0;  // share of samples of `twice` below zero in a channel
};
// Renders them by `path` with a number of samples for each.
PigmentErrors render_pigments(std::span<const Spectrum> pigments, const std::string& lamp,
                              int samples);
// Bakes them under the first of these lamps, and turns its dial to each. Colours of the truth that
// have a channel below zero are cut there, since maps do so.
std::vector<PigmentErrors> turn_dial(std::span<const Spectrum> pigments,
                                     std::span<const char* const> lamps);

}  // namespace wellspring::test
