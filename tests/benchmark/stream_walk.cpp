// SPDX-License-Identifier: Apache-2.0
// The whole way as a visitor has it: a server process, a scripted client that strolls through the
// castle at 1280x720 over loopback, and the time from sending an input to receiving the picture
// that shows it.
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <stdexcept>

#include "base/clock.h"
#include "report.h"
#include "stream/ws_client.h"
#include "stream_server.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring {

namespace {

// A stroll up and down: ahead, swaying, and round again every few seconds with the turn of a key
// (web/controls.js), so that walls come and go and none is walked into, where there would be
// nothing new to show between inputs.
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

// Results are called `name`.fps and so on.
void walk(BenchReport& report, const BenchOptions& options, const std::string& name) {
  const double warm_up = 2, seconds = options.quick ? 6 : 20, input_interval = 1.0 / 30;
  ServerProcess server(options, "castle");
  WsClient client;
  join_visit(client, server.port);

  std::deque<std::pair<uint32_t, double>> asked;  // seq, when sent
  std::vector<double> latencies, arrivals, bytes;
  std::vector<uint8_t> before;  // the picture before
  size_t repeated = 0;
  uint32_t seq = 0;
  double began = seconds_now(), next_input = began, counted_from = 0;
  const char* counters[] = {"pictures_drawn_total", "pictures_warped_total"};
  double counts_before[2] = {};
  WsMessage message;
  while (seconds_now() - began < warm_up + seconds) {
    double now = seconds_now(), t = now - began;
    if (counted_from == 0 && t > warm_up) {
      for (size_t i = 0; i < 2; i++) counts_before[i] = read_metric(server.port, counters[i]);
      counted_from = seconds_now();
    }
    if (now >= next_input) {
      client.send_text(write_message(stroll(t, ++seq, input_interval)));
      asked.emplace_back(seq, seconds_now());
      next_input += input_interval;
    }
    auto got = client.receive(message, std::clamp(next_input - seconds_now(), 0.0, 0.03));
    if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
    if (got != WsClient::Got::message || !message.binary) continue;
    auto packet = read_packet(message.bytes);
    if (!packet) continue;
    double arrived = seconds_now();
    client.send_text(write_message(Ack{packet->header.frame, 1, true}));
    bool counts = arrived - began > warm_up;
    while (!asked.empty() && int32_t(packet->header.seq - asked.front().first) >= 0) {
      if (counts) latencies.push_back(1000 * (arrived - asked.front().second));
      asked.pop_front();
    }
    std::vector<uint8_t> picture(packet->payload.begin(), packet->payload.end());
    if (counts) {
      repeated += picture == before;
      arrivals.push_back(arrived);
      bytes.push_back(double(message.bytes.size()));
    }
    before = std::move(picture);
  }
  if (arrivals.size() < 2) throw std::runtime_error("hardly any picture arrived");
  double counted = seconds_now() - counted_from;
  std::vector<double> gaps;
  for (size_t i = 1; i < arrivals.size(); i++)
    gaps.push_back(1000 * (arrivals[i] - arrivals[i - 1]));
  nlohmann::json where = {{"scene", "castle"}, {"size", "1280x720"}};
  report.add(name + ".fps", double(arrivals.size() - 1) / (arrivals.back() - arrivals.front()),
             "1/s", where);
  report.add(name + ".drawn_fps",
             (read_metric(server.port, counters[0]) - counts_before[0]) / counted, "1/s", where);
  report.add(name + ".warped_fps",
             (read_metric(server.port, counters[1]) - counts_before[1]) / counted, "1/s", where);
  report.add(name + ".repeated", 100 * double(repeated) / double(arrivals.size()), "%", where);
  report.add(name + ".latency_p50_ms", quantile(latencies, 0.5), "ms", where);
  report.add(name + ".latency_p95_ms", quantile(latencies, 0.95), "ms", where);
  report.add(name + ".gap_p95_ms", quantile(gaps, 0.95), "ms", where);
  report.add(name + ".picture_bytes_p50", quantile(bytes, 0.5), "B", where);
  report.add(name + ".server_memory", server.resident() / (1 << 20), "MiB", where);
  client.close();
}

}  // namespace

void bench_stream(BenchReport& report, const BenchOptions& options) {
  walk(report, options, "stream.walk");
}

}  // namespace wellspring
