// SPDX-License-Identifier: Apache-2.0
// What a picture may cost: where line, encoder or decoder cannot follow, quality falls first, then
// the rate, then resolution (in whole JPEG blocks; the page scales it up). Each of the three has a
// pressure, and the highest counts. A pressure rises at once as far as the model of costs says, and
// falls by steps: each is a probe, and where the pressure has to rise again within a second the
// wait for the next one doubles. Nothing falls to zero. Pure values: tests simulate the links.
#pragma once
#include <array>

#include "show/visit/flow.h"

namespace wellspring::show {

enum class Limit : uint8_t { none, network, server, browser };
inline constexpr const char* limit_names[] = {"none", "network", "server", "browser"};

// What the visitor and the show would have.
struct FlowWishes {
  int quality = 82;        // of JPEGs, at most
  double rate = 60;        // pictures a second, at most
  double pixels = 921600;  // of a whole picture
  double bandwidth = 0;    // bytes a second, at most; 0: no limit
};

struct Pressure {
  float value = 0;  // 0..1: quality falls, 1..2: rate, 2..3: resolution
  double next_probe = 0, fell = -1e9;
  double wait = 0;  // seconds between probes; 0: the shortest
};

struct GiveWay {
  std::array<Pressure, 3> pressures;  // of Limit, from network on
  double updated_at = -1e9;
};

struct PicturePlan {
  int quality = 82;
  double rate = 60;
  int eighths = 8;  // of width and height
};

// Once a tick.
// encode_ms: of late, for a whole picture.
void update(GiveWay& way, const Flow& flow, const FlowWishes& wishes, float encode_ms, double now);
float pressure(const GiveWay& way);
Limit limit(const GiveWay& way);
PicturePlan plan_picture(const GiveWay& way, const Flow& flow, const FlowWishes& wishes);

// Pixels of a whole picture that has been made smaller, as they count for its bytes: each takes
// more.
double counted_pixels(double pixels, int eighths);
// Bytes a second that may be used; a guess while nothing is known of the line.
double usable_rate(const Flow& flow, const FlowWishes& wishes);
// That one message may have, so that what follows it is not late.
double usable_bytes(const Flow& flow);
// JPEG quality, at most `best`, for `pixels` in so many bytes.
int quality_within(const Flow& flow, double bytes, double pixels, int best, bool full_chroma);

}  // namespace wellspring::show
