// SPDX-License-Identifier: Apache-2.0
// How many pictures may be on their way to a browser, and how good: learned from its
// acknowledgements. A client that never acknowledges is paced by its socket alone (newest-wins
// slot). Quality law: full until 20 ms of lag above the best round trip, then down one step a
// millisecond, as Guacamole's display worker does; a window of two to four unacknowledged pictures.
#pragma once
#include <cstdint>
#include <deque>

namespace wellspring {

struct Flow {
  struct Sent {
    uint32_t frame = 0;
    double time = 0;
  };
  std::deque<Sent> in_flight;
  bool acknowledges = false;
  double last_ack = 0;
  float round_trip = 0;       // seconds, smoothed
  float best_round_trip = 1;  // smallest of late, forgets slowly
  float decode_ms = 0;        // as the browser measures it, smoothed
  uint64_t acks = 0;
};

void note_sent(Flow& flow, uint32_t frame, double now);
void note_ack(Flow& flow, uint32_t frame, float decoded_ms, double now);
// False while too many pictures are unacknowledged; true again after 2 s of silence (a trickle, so
// that a browser that lost an acknowledgement is not stuck for ever).
bool may_send(const Flow& flow, double now);
// JPEG quality for the next moving picture, at most `best`.
int suggest_quality(const Flow& flow, int best);

}  // namespace wellspring
