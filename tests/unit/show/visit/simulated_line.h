// SPDX-License-Identifier: Apache-2.0
// A visitor at the end of a line, in simulated time: the queue before the line, its rate and delay,
// an encoder and a decoder that take their time, acknowledgements and answers to pings.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "show/visit/flow.h"

namespace wellspring::test {

struct SimulatedLine {
  // The functions take the time in seconds.
  std::function<double(double)> rate = [](double) { return 2.5e6; };  // bytes a second
  // seconds for a whole picture
  std::function<double(double)> encode = [](double) { return 0.006; };
  std::function<double(double)> decode = [](double) { return 0.004; };  // likewise
  std::function<double(double)> others = [](double) { return 0.0; };    // seconds of others' queue
  double trip = 0.02;                                                   // there and back, seconds
  double bytes_per_pixel = 0.09;                                        // at quality 50
  bool answers_pings = true;
};

struct SimulatedPicture {
  double sent = 0, shown = 0, acknowledged = 0, bytes = 0;
  PicturePlan plan;
  Limit limit = Limit::none;
  double lag() const { return acknowledged - sent; }
};

// All pictures that were sent in `seconds`.
inline std::vector<SimulatedPicture> simulate(const SimulatedLine& line, const FlowWishes& wishes,
                                              double seconds) {
  struct Event {
    double time;
    bool ack;
    uint32_t frame;
    float decode_ms;
    Delivery delivery;
  };
  std::vector<SimulatedPicture> pictures;
  std::vector<Event> events;
  Flow flow;
  GiveWay way;
  float encode_ms = 0;
  double line_free = 0, decoder_free = 0, encoder_free = 0, due = 0, next_text = 0.3,
         outstanding = 0;
  constexpr double tick = 0.005;
  // Through the queue and over the line: when its last byte is there.
  auto carry = [&](double bytes, double now) {
    double at = std::max(now + line.others(now), line_free);
    while (bytes > 0) {
      const double part = std::min(bytes, line.rate(at) * 0.001);
      at += part / line.rate(at);
      bytes -= part;
    }
    line_free = at;
    return at + line.trip / 2;
  };
  auto write = [&](double bytes, double now, bool picture = false) {
    const bool alone = outstanding <= now;
    const double there = carry(bytes, now);
    outstanding = there + line.trip / 2;
    if (line.answers_pings)
      events.push_back(
          {outstanding, false, 0, 0, {size_t(bytes), now, outstanding, alone, picture}});
    return there;
  };
  write(0, 0);
  write(8000, 0.02);  // the welcome
  for (double now = 0; now < seconds; now += tick) {
    std::ranges::stable_sort(events, {}, &Event::time);
    while (!events.empty() && events.front().time <= now) {
      const Event event = events.front();
      events.erase(events.begin());
      if (event.ack) note_ack(flow, event.frame, event.decode_ms, event.time);
      else note_delivery(flow, event.delivery);
    }
    update(way, flow, wishes, encode_ms, now);
    if (now >= next_text) {
      write(300, now);
      next_text = now + 0.5;
    }
    const PicturePlan plan = plan_picture(way, flow, wishes);
    if (now < 0.15 || now < encoder_free || !may_send(flow, now) || now - due < 1 / plan.rate)
      continue;
    due = std::clamp(due + 1 / plan.rate, now - 0.5 / plan.rate, now);
    const double scale = plan.eighths / 8.0;
    const double wobble = 1 + 0.1 * double(pictures.size() % 3);
    SimulatedPicture picture{.sent = now,
                             .bytes = wobble * wishes.pixels * std::pow(scale, 1.6) *
                                      line.bytes_per_pixel * double(size_of_quality(plan.quality)),
                             .plan = plan,
                             .limit = limit(way)};
    const double work = scale * scale * (0.5 + 0.5 * plan.quality / 82.0);
    const uint32_t frame = uint32_t(pictures.size() + 1);
    note_sent(flow, frame, now);
    encoder_free = now + line.encode(now) * work;
    encode_ms = float(1000 * line.encode(now) * work);
    note_encoded(flow, size_t(picture.bytes), counted_pixels(wishes.pixels, plan.eighths),
                 plan.quality, false);
    const double there = write(picture.bytes, encoder_free, true);
    picture.shown = decoder_free = std::max(there, decoder_free) + line.decode(now) * work;
    picture.acknowledged = picture.shown + line.trip / 2;
    events.push_back(
        {picture.acknowledged, true, frame, float(1000 * line.decode(now) * work), {}});
    pictures.push_back(picture);
  }
  return pictures;
}

}  // namespace wellspring::test
