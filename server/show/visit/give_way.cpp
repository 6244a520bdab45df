// SPDX-License-Identifier: Apache-2.0
#include "show/visit/give_way.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {

constexpr int worst_quality = 30;
constexpr double least_rate = 8;    // pictures a second, before resolution falls
constexpr double trickle_rate = 1;  // likewise, whatever happens
constexpr int least_eighths = 2;
constexpr float most_pressure = 3, step = 0.05f;
constexpr double line_share = 0.85;   // of the line's rate: the rest lets its queue run empty
constexpr double unknown_rate = 1e6;  // bytes a second of a line before it is known
// A picture's time on the line: with its trip, far from the two trips and 100 ms it may take.
constexpr double line_seconds = 0.065, line_trips = 0.6;
constexpr double work_share = 0.85;    // of a period, for encoding and for decoding
constexpr double work_seconds = 0.08;  // for one picture
constexpr double first_wait = 0.2, longest_wait = 1.6;    // seconds between probes
constexpr double update_interval = 0.02;                  // seconds
constexpr float probe = 0.5f;                             // that a pressure falls by
constexpr double failed_within = 1, forgotten_after = 4;  // seconds after a probe
constexpr float clear_evidence = 0.5f;  // that there is room: probes need not wait

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

// Time for a picture's encoding or decoding, over that of one at full size and quality 50.
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

// What takes that long as pictures are now.
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
  // Less than a step is not worth a change that is seen, but at the end.
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
  // Of a line of which nothing is known only the guess is kept to: it is no reason to give way.
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
