// SPDX-License-Identifier: Apache-2.0
#include "show/visit/flow.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {
constexpr double silence = 2;  // seconds without an acknowledgement before a trickle is sent
// seconds; the smallest trip is taken from this window and the last
constexpr double trip_window = 10;
constexpr double shortest_busy = 2e-3;    // seconds; shorter times are not measured well
constexpr double sure_busy = 0.1;         // seconds; longer times are measured well
constexpr size_t small_bytes = 1500;      // one packet of the network: its trip is the line's
constexpr size_t telling_bytes = 2000;    // fewer bytes do not say a rate
constexpr float full_chroma_size = 1.3f;  // size over 4:2:0, for pictures of the castle

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
  // A smaller trip is always the line's; a larger one only if nothing was in its way.
  const bool clear = delivery.alone && delivery.bytes <= small_bytes;
  if (clear || float(trip) < flow.line_trip) note_trip(flow, float(trip), delivery.ended);
  const double before = flow.delivered;
  flow.delivered = std::max(before, delivery.ended);
  if (delivery.bytes > 0) {
    const double from = std::max(delivery.began + double(flow.line_trip), before);
    const double busy = std::max(delivery.ended - from, shortest_busy);
    const float rate = float(double(delivery.bytes) / busy);
    // Few bytes say only that the line carries as much.
    const bool more = flow.line_rate > 0 && rate > flow.line_rate;
    if (delivery.bytes < telling_bytes && !more) return;
    // A long delivery is measured well, and a line that became slow is believed at once.
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

namespace {

constexpr int worst_quality = 30;
constexpr double least_rate = 8;    // pictures a second, before resolution falls
constexpr double trickle_rate = 1;  // likewise, whatever happens
constexpr int least_eighths = 2;
constexpr float most_pressure = 3, step = 0.05f;
constexpr double line_share = 0.85;   // share of the line's rate: the rest lets its queue run empty
constexpr double unknown_rate = 1e6;  // bytes a second of a line before it is measured
// A picture may occupy the line for these seconds, and for this share of a round trip: together
// with its trip that stays far below the two trips and 100 ms that it may take.
constexpr double line_seconds = 0.065, line_trips = 0.6;
constexpr double work_share = 0.85;    // share of a period, for encoding and for decoding
constexpr double work_seconds = 0.08;  // for one picture
constexpr double first_wait = 0.2, longest_wait = 1.6;    // seconds between probes
constexpr double update_interval = 0.02;                  // seconds
constexpr float probe = 0.5f;                             // amount that a pressure falls by
constexpr double failed_within = 1, forgotten_after = 4;  // seconds after a probe
// difference that shows that there is room: probes need not wait
constexpr float clear_evidence = 0.5f;

PicturePlan plan_at(float at, const FlowWishes& wishes) {
  const int worst = std::min(worst_quality, wishes.quality);
  const double least = std::min(least_rate, wishes.rate);
  const float quality = std::min(at, 1.0f), rate = std::clamp(at - 1, 0.0f, 1.0f),
              size = std::clamp(at - 2, 0.0f, 1.0f);
  PicturePlan plan;
  plan.quality = int(std::lround(float(wishes.quality) + quality * float(worst - wishes.quality)));
  plan.rate = wishes.rate * std::pow(least / wishes.rate, double(rate));
  plan.eighths = int(std::lround(8 + size * float(least_eighths - 8)));
  return plan;
}

double bytes_of_plan(const Flow& flow, const FlowWishes& wishes, const PicturePlan& plan) {
  return expected_bytes(flow, counted_pixels(wishes.pixels, plan.eighths), plan.quality, false);
}

// Returns the time for a picture's encoding or decoding, over that of one at full size and quality
// 50.
double work_of_plan(const PicturePlan& plan) {
  const double scale = plan.eighths / 8.0;
  return scale * scale * (0.6 + 0.4 * double(size_of_quality(plan.quality)));
}

double line_rate(const Flow& flow) {
  return flow.line_rate > 0 ? line_share * double(flow.line_rate) : unknown_rate;
}

template <class Fits>
float first_that(const FlowWishes& wishes, const Fits& fits) {
  for (float at = 0; at < most_pressure; at += step)
    if (fits(plan_at(at, wishes))) return at;
  return most_pressure;
}

float of_line(const Flow& flow, const FlowWishes& wishes) {
  const double rate = usable_rate(flow, wishes), most = usable_bytes(flow);
  return first_that(wishes, [&](const PicturePlan& plan) {
    const double bytes = bytes_of_plan(flow, wishes, plan);
    return bytes <= most && bytes * plan.rate <= rate;
  });
}

// Returns the pressure at which work that takes `seconds` as pictures are now is quick enough.
float of_work(double seconds, const PicturePlan& now, const FlowWishes& wishes) {
  const double whole = seconds / work_of_plan(now);
  return first_that(wishes, [&](const PicturePlan& plan) {
    const double work = whole * work_of_plan(plan);
    return work <= work_seconds && work * plan.rate <= work_share;
  });
}

void move(Pressure& one, float target, double now) {
  one.wait = std::max(one.wait, first_wait);
  if (target > one.value) {
    if (now - one.fell < failed_within && target - one.value > 2 * step)
      one.wait = std::min(2 * one.wait, longest_wait), one.fell = -1e9;
    one.value = target;
    one.next_probe = now + one.wait;
    return;
  }
  if (now - one.fell > forgotten_after && now > one.next_probe + forgotten_after)
    one.wait = first_wait;
  if (one.value - target > clear_evidence)
    one.wait = first_wait, one.next_probe = std::min(one.next_probe, now + first_wait);
  // A change of less than a step is not worth being seen, but at the end.
  if (now < one.next_probe || (target > 0 && one.value - target < 2 * step)) return;
  if (one.value > target) one.fell = now;
  one.value = std::max(target, one.value - probe);
  one.next_probe = now + one.wait;
}

}  // namespace

double counted_pixels(double pixels, int eighths) { return pixels * std::pow(eighths / 8.0, 1.5); }

double usable_rate(const Flow& flow, const FlowWishes& wishes) {
  const double rate = line_rate(flow);
  return wishes.bandwidth > 0 ? std::min(rate, wishes.bandwidth) : rate;
}

double usable_bytes(const Flow& flow) {
  return line_rate(flow) * (line_seconds + line_trips * double(flow.line_trip));
}

int quality_within(const Flow& flow, double bytes, double pixels, int best, bool full_chroma) {
  const int worst = std::min(worst_quality, best);
  int quality = best;
  while (quality > worst && expected_bytes(flow, pixels, quality, full_chroma) > bytes) quality--;
  return quality;
}

void update(GiveWay& way, const Flow& flow, const FlowWishes& wishes, float encode_ms, double now) {
  if (now - way.updated_at < update_interval) return;
  way.updated_at = now;
  const PicturePlan plan = plan_at(pressure(way), wishes);
  // A line that is not measured yet is no reason to give way: only the guess of its rate is kept
  // to.
  if (flow.line_rate > 0 || wishes.bandwidth > 0)
    move(way.pressures[0], of_line(flow, wishes), now);
  move(way.pressures[1], of_work(0.001 * double(encode_ms), plan, wishes), now);
  move(way.pressures[2], of_work(0.001 * double(flow.decode_ms), plan, wishes), now);
}

float pressure(const GiveWay& way) {
  float most = 0;
  for (const Pressure& one : way.pressures) most = std::max(most, one.value);
  return most;
}

Limit limit(const GiveWay& way) {
  if (pressure(way) <= step) return Limit::none;
  const auto most = std::ranges::max_element(way.pressures, {}, &Pressure::value);
  return Limit(most - way.pressures.begin() + 1);
}

PicturePlan plan_picture(const GiveWay& way, const Flow& flow, const FlowWishes& wishes) {
  PicturePlan plan = plan_at(pressure(way), wishes);
  const double bytes = bytes_of_plan(flow, wishes, plan);
  plan.rate = std::min(plan.rate, usable_rate(flow, wishes) / bytes);
  plan.rate = std::max(plan.rate, std::min(trickle_rate, wishes.rate));
  return plan;
}

}  // namespace wellspring::show
