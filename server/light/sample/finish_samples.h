// SPDX-License-Identifier: Apache-2.0
// The gate that every sample passes.
#pragma once
#include <span>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"

namespace wellspring::light {

// Makes samples fit for a Frame: light that is NaN, infinite or negative is dropped (black) and
// counted; settings.clamp is applied.
void finish_samples(const Lights& lights, const TransportSettings& settings,
                    std::span<Sample> samples);
inline Sample finish_sample(const Lights& lights, const TransportSettings& settings,
                            Sample sample) {
  finish_samples(lights, settings, std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
