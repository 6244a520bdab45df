// SPDX-License-Identifier: Apache-2.0
// Keeps account of what is on its way to a browser, and of what that says of the line, of the
// browser's decoder and of this server's encoder. At most two pictures are unacknowledged. The line
// is measured as BBR does (Cardwell et al. 2016): its round trip is the smallest of late, its rate
// what was delivered over the time that took. Both come from WebSocket pings behind each picture,
// so a slow decoder is not taken for a slow line. For a client that never acknowledges, the answers
// to pings count instead; a client without either is paced by its socket alone (newest-wins slot).
// show/visit/flow.h decides from this what a picture may cost.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "base/layers.h"
#include "wire/link.h"

namespace wellspring::show {

inline constexpr size_t max_in_flight = 2;

struct Flow {
  struct Sent {
    uint32_t frame = 0;
    double time = 0;
  };
  std::deque<Sent> in_flight;
  bool acknowledges = false;
  double last_ack = 0;
  float round_trip = 0;  // seconds from sending a picture to its acknowledgement, smoothed
  float decode_ms = 0;   // milliseconds as the browser measures them, smoothed
  uint64_t acks = 0, deliveries = 0;
  float line_trip = 0;      // seconds there and back with nothing in the way; 0: not known
  float line_rate = 0;      // bytes a second; 0: not known
  double delivered = -1e9;  // end of the last delivery
  // Smallest trips of the present window and of the last one; 0: none.
  float least_trip = 0, least_trip_before = 0;
  double window_began = 0;
  // Bytes of a pixel at JPEG quality 50, smoothed.
  float bytes_per_pixel = 0.09f;
};

void note_sent(Flow& flow, uint32_t frame, double now);
// Forgets a picture that was not sent after all, as nothing had changed.
void note_unsent(Flow& flow, uint32_t frame);
void note_ack(Flow& flow, uint32_t frame, float decoded_ms, double now);
void note_delivery(Flow& flow, const Delivery& delivery);
// Notes the size of a picture that was made. full_chroma: not subsampled.
void note_encoded(Flow& flow, size_t bytes, double pixels, int quality, bool full_chroma);
// Returns false while too many pictures are under way; true again after 2 s of silence (a trickle,
// so that a browser that lost an acknowledgement is not stuck for ever).
bool may_send(const Flow& flow, double now);

// Returns the bytes of a JPEG over those at quality 50: its quantisation steps to the power of
// -0.6, which is within 10 % of pictures of the castle from 30 to 95.
float size_of_quality(int quality);
// Returns the bytes that the pictures before suggest. `pixels` may be those of a part.
double expected_bytes(const Flow& flow, double pixels, int quality, bool full_chroma);

// Decides what a picture may cost: if line, encoder or decoder cannot follow, quality falls first,
// then the rate, then resolution (in whole JPEG blocks; the page scales it up). Each of the three
// has a pressure, and the highest counts. A pressure rises at once as far as the model of costs
// says, and falls by steps: each step is a probe, and if the pressure has to rise again within a
// second the wait for the next one doubles. Nothing falls to zero. Pure values: tests simulate the
// links.

enum class Limit : uint8_t { none, network, server, browser };
inline constexpr const char* limit_names[] = {"none", "network", "server", "browser"};

// Holds what the visitor and the show wish for.
struct FlowWishes {
  int quality = 82;        // JPEG quality, at most
  double rate = 60;        // pictures a second, at most
  double pixels = 921600;  // pixels of a whole picture
  double bandwidth = 0;    // bytes a second, at most; 0: no limit
};

struct Pressure {
  float value = 0;  // 0..1: quality falls, 1..2: rate, 2..3: resolution
  double next_probe = 0, fell = -1e9;
  double wait = 0;  // seconds between probes; 0: the shortest
};

struct GiveWay {
  std::array<Pressure, 3> pressures;  // one for each Limit, from network on
  double updated_at = -1e9;
};

struct PicturePlan {
  int quality = 82;
  double rate = 60;
  int eighths = 8;  // eighths of width and height
};

// Updates the pressures, once a tick. encode_ms: of late, for a whole picture.
void update(GiveWay& way, const Flow& flow, const FlowWishes& wishes, float encode_ms, double now);
float pressure(const GiveWay& way);
Limit limit(const GiveWay& way);
PicturePlan plan_picture(const GiveWay& way, const Flow& flow, const FlowWishes& wishes);

// Returns the pixels of a whole picture that has been made smaller, as they count for its bytes:
// each takes more.
double counted_pixels(double pixels, int eighths);
// Returns the bytes a second that may be used; a guess while the line is not measured.
double usable_rate(const Flow& flow, const FlowWishes& wishes);
// Returns the bytes that one message may have, so that what follows it is not late.
double usable_bytes(const Flow& flow);
// Returns the JPEG quality, at most `best`, for `pixels` in so many bytes.
int quality_within(const Flow& flow, double bytes, double pixels, int best, bool full_chroma);

}  // namespace wellspring::show
