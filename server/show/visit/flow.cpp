// SPDX-License-Identifier: Apache-2.0
#include "show/visit/flow.h"

#include <algorithm>

namespace wellspring {

namespace {
constexpr size_t max_in_flight = 4;
constexpr double silence = 2;  // seconds without an acknowledgement before a trickle is sent
constexpr int worst_quality = 30;
}  // namespace

void note_sent(Flow& flow, uint32_t frame, double now) {
  flow.in_flight.push_back({frame, now});
  while (flow.in_flight.size() > 64) flow.in_flight.pop_front();
}

void note_ack(Flow& flow, uint32_t frame, float decoded_ms, double now) {
  flow.acknowledges = true;
  flow.acks++;
  flow.last_ack = now;
  flow.decode_ms += (std::clamp(decoded_ms, 0.0f, 1000.0f) - flow.decode_ms) * 0.1f;
  // Frames are sent in order, so an acknowledgement answers for all before it as well.
  while (!flow.in_flight.empty() && int32_t(flow.in_flight.front().frame - frame) <= 0) {
    if (flow.in_flight.front().frame == frame) {
      float trip = float(std::clamp(now - flow.in_flight.front().time, 0.0, 1.0));
      flow.round_trip = flow.acks == 1 ? trip : flow.round_trip + (trip - flow.round_trip) * 0.1f;
      flow.best_round_trip = std::min(flow.best_round_trip * 1.002f + 1e-5f, trip);
    }
    flow.in_flight.pop_front();
  }
}

bool may_send(const Flow& flow, double now) {
  if (!flow.acknowledges || flow.in_flight.size() < max_in_flight) return true;
  double last = std::max(flow.last_ack, flow.in_flight.back().time);
  return now - last > silence;
}

int suggest_quality(const Flow& flow, int best) {
  if (!flow.acknowledges) return best;
  float lag_ms = 1000 * std::max(0.0f, flow.round_trip - flow.best_round_trip);
  return std::clamp(best - int(std::max(0.0f, lag_ms - 20)), std::min(worst_quality, best), best);
}

}  // namespace wellspring
