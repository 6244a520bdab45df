// SPDX-License-Identifier: Apache-2.0
#include "stroll.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "judge/ws_client.h"
#include "stream_server.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring::test {

Input stroll(double t, uint32_t seq, double interval) {
  constexpr double ahead = 2.5, turn_speed = 1.5, turning = std::numbers::pi / turn_speed;
  Input input;
  input.seq = seq;
  input.move = {float(0.2 * std::sin(t)), 0, 1.2f};
  bool turns = std::fmod(t, ahead + turning) > ahead;
  double yaw = turns ? turn_speed : 0.25 * std::sin(2 * std::numbers::pi * t / ahead);
  input.look = {float(yaw * interval), float(0.06 * std::cos(t) * interval)};
  return input;
}

// Everybody walks and stands for a while, in turns.
static bool walks(const StrollPlan& plan, double t) {
  constexpr double turn = 9;  // seconds
  return std::fmod(t + 1.7 * plan.phase, turn) < plan.walking * turn;
}

double Stroll::fps() const {
  if (arrivals.size() < 2) return 0;
  return double(arrivals.size() - 1) / (arrivals.back() - arrivals.front());
}

std::vector<double> Stroll::gaps() const {
  std::vector<double> gaps;
  for (size_t i = 1; i < arrivals.size(); i++)
    gaps.push_back(1000 * (arrivals[i] - arrivals[i - 1]));
  return gaps;
}

Stroll stroll_through(const StrollPlan& plan, const std::function<void()>& counting) {
  const double input_interval = 1.0 / 30;
  WsClient client;
  join_visit(client, plan.port, plan.width, plan.height, plan.local ? "local" : "server");
  Stroll seen;
  std::deque<std::pair<uint32_t, double>> asked;  // seq, when sent
  std::vector<uint8_t> before;                    // the picture before
  uint32_t seq = 0;
  const double began = seconds_now();
  double next_input = began;
  bool counts = false;
  WsMessage message;
  while (seconds_now() - began < plan.warm_up + plan.seconds) {
    const double now = seconds_now(), t = now - began;
    if (!counts && t > plan.warm_up) {
      counts = true;
      if (counting) counting();
    }
    if (now >= next_input) {
      Input input = stroll(t + plan.phase, ++seq, input_interval);
      if (walks(plan, t)) seen.walked += counts ? input_interval : 0;
      else input.move = vec3(0), input.look = vec2(0);
      client.send_text(write_message(input));
      asked.emplace_back(seq, seconds_now());
      next_input += input_interval;
    }
    auto got = client.receive(message, std::clamp(next_input - seconds_now(), 0.0, 0.03));
    if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
    if (got != WsClient::Got::message || !message.binary) continue;
    auto packet = read_packet(message.bytes);
    if (!packet) continue;
    const double arrived = seconds_now();
    client.send_text(write_message(Ack{packet->header.frame, 1, true}));
    constexpr int of_walk = packet_depth | packet_still | packet_around | packet_layer;
    if (plan.local && (packet->header.flags & of_walk) != packet_depth) continue;
    while (!asked.empty() && int32_t(packet->header.seq - asked.front().first) >= 0) {
      if (counts) seen.latencies.push_back(1000 * (arrived - asked.front().second));
      asked.pop_front();
    }
    std::vector<uint8_t> picture(packet->payload.begin(), packet->payload.end());
    if (counts) {
      seen.repeated += picture == before;
      seen.arrivals.push_back(arrived - began - plan.warm_up);
      seen.bytes.push_back(double(message.bytes.size()));
      if (packet->keyframe) seen.scales.push_back(double(packet->keyframe->width) / plan.width);
    }
    before = std::move(picture);
  }
  client.close();
  return seen;
}

std::vector<Stroll> stroll_together(const StrollPlan& plan, int visitors) {
  std::vector<Stroll> seen{size_t(visitors)};
  std::string problem;
  std::mutex mutex;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < visitors; i++)
      threads.emplace_back([&, i] {
        try {
          StrollPlan one = plan;
          one.phase = 0.7 * i;
          seen[size_t(i)] = stroll_through(one);
        } catch (const std::exception& error) {
          std::lock_guard lock(mutex);
          problem = error.what();
        }
      });
  }
  if (!problem.empty()) throw std::runtime_error(problem);
  return seen;
}

}  // namespace wellspring::test
