// SPDX-License-Identifier: Apache-2.0
// The techniques, one explicit list. A technique turns requests into samples; it has no state of
// its own beyond Lights, so samples can be computed on any thread, in any order, and replayed one
// by one.
#pragma once
#include <span>
#include <string_view>

#include "frame/frame.h"
#include "light/lights.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring {

struct TransportSettings {
  int max_depth = 8;  // path edges counted from the eye; 1: emission only, 2: direct light
  float clamp = 0;    // >0: bound of one sample's radiance (biased, for display); 0: none
};

struct Technique {
  const char* name;
  const char* summary;
  // Never throws; results are finite and not negative (dropped samples count in
  // Lights::bad_samples).
  Sample (*trace)(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request);
  // What must be known before the first sample, for eyes near `places` (scene coordinates); may
  // take seconds. nullptr: nothing.
  void (*prepare)(const World& world, std::span<const vec3> places, Lights& lights) = nullptr;
  // What is drawn anew for each pass over a picture (point lights, photons), from the pass's seed
  // alone; the samples traced until the next call use it. nullptr: nothing.
  void (*begin_pass)(const World& world, const TransportSettings& settings, const View& view,
                     uint64_t seed, Lights& lights) = nullptr;
  // Filters a whole pass, samples[y * width + x], in place. nullptr: nothing.
  void (*finish_pass)(const World& world, const Lights& lights, const View& view,
                      std::span<Sample> samples) = nullptr;
};

std::span<const Technique> techniques();
const Technique* find_technique(std::string_view name);  // nullptr: no such name

// samples[i] answers requests[i]; all cores.
void trace(const Technique& technique, const World& world, const Lights& lights,
           const TransportSettings& settings, std::span<const Request> requests,
           std::span<Sample> samples);

// A whole picture, `spp` samples a pixel, box filter over the pixel, all cores; the same bits
// whatever the thread count. A technique of passes draws `spp` of them, one sample a pixel each;
// `lights` is changed by nothing else.
struct StillSettings {
  int spp = 16;
  uint64_t seed = 1;
  TransportSettings transport;
};
// Sample `index` of pixel (x, y) as render_still asks for it: tracing it alone gives the same bits.
Request pixel_request(const View& view, uint64_t seed, int x, int y, int index);
uint64_t pass_seed(uint64_t seed, int index);  // of the pass that traces sample `index`
Frame render_still(const Technique& technique, const World& world, const Lights& lights,
                   const View& view, const StillSettings& settings);

}  // namespace wellspring
