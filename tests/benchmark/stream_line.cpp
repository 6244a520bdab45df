// SPDX-License-Identifier: Apache-2.0
// A visitor who turns round at the end of a slow line (tests/shaped_line.mjs): how late pictures
// are, how many and how fine, and how long full quality takes when the line is fast again.
#include "stream_line.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "base/clock.h"
#include "shaped_line.h"
#include "stream_server.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring::test {
namespace {

struct Arrived {
  double time, lag;  // seconds; lag: since it was made
  size_t bytes;
  PacketHeader header;
};

// Turns until `seconds` have passed, or `enough` says so.
template <class Enough>
std::vector<Arrived> turn(WsClient& client, uint32_t& seq, double seconds, const Enough& enough) {
  constexpr double interval = 1.0 / 30;
  std::vector<Arrived> pictures;
  WsMessage message;
  double next = seconds_now();
  for (const double end = next + seconds; seconds_now() < end;) {
    if (seconds_now() >= next) {
      Input input;
      input.seq = ++seq;
      input.look = {0.03f, 0};
      client.send_text(write_message(input));
      next += interval;
    }
    const auto got = client.receive(message, std::clamp(next - seconds_now(), 0.0, 0.03));
    if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
    if (got != WsClient::Got::message || !message.binary) continue;
    const auto packet = read_packet(message.bytes);
    if (!packet) continue;
    client.send_text(write_message(Ack{packet->header.frame, 1, true}));
    pictures.push_back({seconds_now(), 1e-6 * double(microseconds_now() - packet->header.time_us),
                        message.bytes.size(), packet->header});
    if (enough(pictures.back())) break;
  }
  return pictures;
}

}  // namespace

void bench_line(BenchReport& report, const BenchOptions& options) {
  struct Line {
    double mbit, trip_ms;
  };
  ServerProcess server(options, "castle");
  for (const auto& [mbit, trip_ms] : {Line{20, 20}, Line{5, 80}, Line{1, 200}}) {
    ShapedLine line(options, server.port, mbit, trip_ms);
    WsClient client;
    join_visit(client, line.port);
    uint32_t seq = 0;
    const auto never = [](const Arrived&) { return false; };
    turn(client, seq, 3, never);
    const std::vector<Arrived> pictures = turn(client, seq, options.quick ? 5 : 15, never);
    if (pictures.size() < 2) throw std::runtime_error("hardly any picture arrived");
    std::vector<double> lags, qualities, widths, gaps;
    double bytes = 0;
    for (size_t i = 0; i < pictures.size(); i++) {
      // The way back is added, as an acknowledgement would have it.
      lags.push_back(1000 * pictures[i].lag + trip_ms / 2);
      qualities.push_back(pictures[i].header.quality);
      widths.push_back(pictures[i].header.width);
      bytes += double(pictures[i].bytes);
      if (i > 0) gaps.push_back(1000 * (pictures[i].time - pictures[i - 1].time));
    }
    const double seconds = pictures.back().time - pictures.front().time;
    line.set_rate(500);
    const double began = seconds_now();
    const std::vector<Arrived> back = turn(client, seq, 15, [](const Arrived& one) {
      return one.header.width == 1280 && one.header.quality == 82;
    });
    const bool recovered = !back.empty() && back.back().header.quality == 82;
    const nlohmann::json where = {
        {"scene", "castle"}, {"size", "1280x720"}, {"mbit", mbit}, {"round_trip_ms", trip_ms}};
    report.add("stream.shaped.lag_p50_ms", quantile(lags, 0.5), "ms", where);
    report.add("stream.shaped.lag_p95_ms", quantile(lags, 0.95), "ms", where);
    report.add("stream.shaped.lag_most_ms", quantile(lags, 1), "ms", where);
    report.add("stream.shaped.gap_most_ms", quantile(gaps, 1), "ms", where);
    report.add("stream.shaped.fps", double(pictures.size() - 1) / seconds, "1/s", where);
    report.add("stream.shaped.quality_p50", quantile(qualities, 0.5), "JPEG", where);
    report.add("stream.shaped.width_p50", quantile(widths, 0.5), "px", where);
    report.add("stream.shaped.used", 100 * 8e-6 * bytes / seconds / mbit, "%", where);
    if (recovered) report.add("stream.shaped.recovery_s", back.back().time - began, "s", where);
    client.close();
  }
}

}  // namespace wellspring::test
