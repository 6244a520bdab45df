// SPDX-License-Identifier: Apache-2.0
#include "show/visit/flow.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {
constexpr double silence = 2;       // seconds without an acknowledgement before a trickle is sent
constexpr double trip_window = 10;  // seconds; the smallest trip is of this one or the last
constexpr double shortest_busy = 2e-3;    // seconds: what is shorter is not measured well
constexpr double sure_busy = 0.1;         // seconds, likewise
constexpr size_t small_bytes = 1500;      // one packet of the network: its trip is the line's
constexpr size_t telling_bytes = 2000;    // fewer do not tell a rate
constexpr float full_chroma_size = 1.3f;  // over 4:2:0, of pictures of the castle

void note_trip(Flow& flow, float trip, double now) {
  if (now - flow.window_began > trip_window) {
    flow.window_began = now;
    flow.least_trip_before = flow.least_trip;
    flow.least_trip = 0;
  }
  flow.least_trip = flow.least_trip > 0 ? std::min(flow.least_trip, trip) : trip;
  flow.line_trip = flow.least_trip_before > 0 ? std::min(flow.least_trip, flow.least_trip_before)
                                              : flow.least_trip;
}
}  // namespace

void note_sent(Flow& flow, uint32_t frame, double now) {
  flow.in_flight.push_back({frame, now});
  while (flow.in_flight.size() > 64) flow.in_flight.pop_front();
}

void note_unsent(Flow& flow, uint32_t frame) {
  std::erase_if(flow.in_flight, [&](const Flow::Sent& sent) { return sent.frame == frame; });
}

void note_ack(Flow& flow, uint32_t frame, float decoded_ms, double now) {
  flow.acknowledges = true;
  flow.acks++;
  flow.last_ack = now;
  const float decoded = std::clamp(decoded_ms, 0.0f, 1000.0f);
  flow.decode_ms += (decoded - flow.decode_ms) * (flow.acks == 1 ? 1 : 0.1f);
  // Frames are sent in order, so an acknowledgement answers for all before it as well.
  while (!flow.in_flight.empty() && int32_t(flow.in_flight.front().frame - frame) <= 0) {
    if (flow.in_flight.front().frame == frame) {
      float trip = float(std::clamp(now - flow.in_flight.front().time, 0.0, 10.0));
      flow.round_trip = flow.acks == 1 ? trip : flow.round_trip + (trip - flow.round_trip) * 0.1f;
    }
    flow.in_flight.pop_front();
  }
}

void note_delivery(Flow& flow, const Delivery& delivery) {
  flow.deliveries++;
  if (delivery.picture && !flow.acknowledges && !flow.in_flight.empty()) flow.in_flight.pop_front();
  const double trip = std::max(delivery.ended - delivery.began, 1e-4);
  // A smaller trip is always the line's; a larger one only where nothing was in its way.
  const bool clear = delivery.alone && delivery.bytes <= small_bytes;
  if (clear || float(trip) < flow.line_trip) note_trip(flow, float(trip), delivery.ended);
  const double before = flow.delivered;
  flow.delivered = std::max(before, delivery.ended);
  if (delivery.bytes > 0) {
    const double from = std::max(delivery.began + double(flow.line_trip), before);
    const double busy = std::max(delivery.ended - from, shortest_busy);
    const float rate = float(double(delivery.bytes) / busy);
    // Few bytes tell only that the line carries as much.
    const bool more = flow.line_rate > 0 && rate > flow.line_rate;
    if (delivery.bytes < telling_bytes && !more) return;
    // What took long is measured well, and a line that became slow is believed at once.
    const bool sure = flow.line_rate == 0 || (rate < flow.line_rate && busy >= sure_busy);
    flow.line_rate += (rate - flow.line_rate) * (sure ? 1 : 0.5f);
  }
}

void note_encoded(Flow& flow, size_t bytes, double pixels, int quality, bool full_chroma) {
  if (pixels <= 0) return;
  const float chroma = full_chroma ? full_chroma_size : 1;
  const float now = float(bytes) / (float(pixels) * size_of_quality(quality) * chroma);
  flow.bytes_per_pixel += (now - flow.bytes_per_pixel) * 0.3f;
}

bool may_send(const Flow& flow, double now) {
  const bool answers = flow.acknowledges || flow.deliveries > 0;
  if (!answers || flow.in_flight.size() < max_in_flight) return true;
  double last = std::max(flow.last_ack, flow.in_flight.back().time);
  return now - last > silence;
}

float size_of_quality(int quality) {
  const float q = float(std::clamp(quality, 1, 100));
  const float step = q < 50 ? 50 / q : std::max(2 - q / 50, 0.02f);  // as libjpeg scales its tables
  return std::pow(step, -0.6f);
}

double expected_bytes(const Flow& flow, double pixels, int quality, bool full_chroma) {
  return pixels * double(flow.bytes_per_pixel * size_of_quality(quality) *
                         (full_chroma ? full_chroma_size : 1));
}

}  // namespace wellspring::show
