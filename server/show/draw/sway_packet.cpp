// SPDX-License-Identifier: Apache-2.0
#include "show/draw/sway_packet.h"

#include <cmath>

namespace wellspring::show {

void add_sway(const SwayImage& image, const View& view, Packet& packet) {
  if (image.code.empty() || packet.empty()) return;
  SwayHeader header{.columns = uint16_t(image.columns),
                    .rows = uint16_t(image.rows),
                    .unit = SwayImage::unit,
                    .time = image.time,
                    .waves = {}};
  for (size_t i = 0; i < header.waves.size(); i++) {
    const WindWave& wave = image.wind.waves[i];
    const double at_eye = dot(dvec2(wave.wave), dvec2(view.position.x, view.position.z));
    const double phase = std::remainder(wave.phase - wave.rate * image.time + at_eye, 2 * M_PI);
    header.waves[i] = {wave.push, wave.wave, float(wave.rate), float(phase)};
  }
  wire::add_sway(header, image.code, packet);
}

}  // namespace wellspring::show
