// SPDX-License-Identifier: Apache-2.0
// Lists the techniques explicitly. A technique turns requests into samples; it has no state of its
// own beyond Lights, so samples can be computed on any thread, in any order, and replayed one by
// one.
#pragma once
#include <functional>
#include <span>
#include <string_view>

#include "frame/frame.h"
#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"
#include "world/view.h"

namespace wellspring::light {

// Makes the requests for a still picture's pixels, eight side by side.

// Names sample `index` of the picture's pixel (x, y).
struct PixelSample {
  int x = 0, y = 0, index = 0;
};
// Makes requests[i] ask for which[i], with the pixel's seed. The other requests of a call do not
// change it.
void make_pixel_requests(const View& view, uint64_t seed, std::span<const PixelSample> which,
                         std::span<Request> requests);

// Declares the trace functions that technique.cpp lists, one file each; those of instant_radiosity
// are in light/virtual/instant_radiosity.h.

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request);
void trace_many_path(const World& world, const Lights& lights, const TransportSettings& settings,
                     std::span<const Request> requests, std::span<Sample> samples);
Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
void trace_many_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples);
Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
void trace_many_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples);
void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights);

struct Technique {
  const char* name;
  const char* summary;
  // Answers a request. Never throws; results are finite and not negative (dropped samples count in
  // Lights::bad_samples).
  Sample (*trace)(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request);
  // Prepares `lights` before the first sample, for eyes near `places` (scene coordinates); may take
  // seconds. nullptr: nothing to prepare.
  void (*prepare)(const World& world, std::span<const vec3> places, Lights& lights) = nullptr;
  // Draws the point lights or photons of a pass over a picture, from seed and index alone: passes
  // of one seed complement each other, those of different seeds are independent. The samples traced
  // until the next call use them; without the call they lack that light. Takes milliseconds.
  // nullptr: nothing to draw.
  void (*begin_pass)(const World& world, const TransportSettings& settings, const View& view,
                     uint64_t seed, uint32_t index, Lights& lights) = nullptr;
  // Filters a whole pass, samples[y * width + x], in place. nullptr: no filter.
  void (*finish_pass)(const World& world, const Lights& lights, const View& view,
                      std::span<Sample> samples) = nullptr;
  // Does trace() for neighbouring requests at once, with the same bits, if that is quicker.
  // nullptr: one by one.
  void (*trace_many)(const World& world, const Lights& lights, const TransportSettings& settings,
                     std::span<const Request> requests, std::span<Sample> samples) = nullptr;
  // Its samples give diffuse light in multiples of Lights::maps where the maps have it.
  bool uses_maps = false;
};

std::span<const Technique> techniques();
const Technique* find_technique(std::string_view name);  // nullptr: no such name

// Traces the answers: samples[i] answers requests[i]. Runs on all cores.
void trace(const Technique& technique, const World& world, const Lights& lights,
           const TransportSettings& settings, std::span<const Request> requests,
           std::span<Sample> samples);

// A whole picture has `spp` samples a pixel and a box filter over the pixel, is made on all cores,
// and has the same bits whatever the thread count. A technique of passes draws `spp` of them, one
// sample a pixel each; `lights` is changed by nothing else.
struct StillSettings {
  int spp = 16;
  uint64_t seed = 1;
  TransportSettings transport;
  // Called with the share that is done, 0 to 1, by any thread; or empty
  std::function<void(double)> progress;
};
// Returns the request for sample `index` of pixel (x, y) as render_still makes it: tracing it alone
// gives the same bits.
Request pixel_request(const View& view, uint64_t seed, int x, int y, int index);
uint64_t pass_seed(uint64_t seed);  // seed of its passes; sample `index` is traced in pass `index`
// Traces that sample alone, as it was before any finish_pass.
Sample replay_sample(const Technique& technique, const World& world, Lights lights,
                     const View& view, const StillSettings& settings, int x, int y, int index);
Frame render_still(const Technique& technique, const World& world, const Lights& lights,
                   const View& view, const StillSettings& settings);

}  // namespace wellspring::light
