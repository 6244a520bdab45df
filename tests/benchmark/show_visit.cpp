// SPDX-License-Identifier: Apache-2.0
#include "show_visit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "base/clock.h"
#include "local_display.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring::test {
namespace {

constexpr double pose_interval = 1.0 / 60, rest = 2, first_within = 60;  // seconds
constexpr int windows = 8;           // windows in a row and in a column
constexpr double while_worst = 0.5;  // seconds

// Neighbouring poses look at places far from each other.
Window window_of(uint32_t seq) {
  constexpr uint32_t stride = 29;
  const int number = int(seq * stride % (windows * windows));
  constexpr int width = shown_width / windows, height = shown_height / windows;
  return {number % windows * width, number / windows * height, width, height};
}

struct Mean {
  double sum = 0;
  size_t count = 0;
  void add(double value) { sum += value, count++; }
  double mean() const { return count > 0 ? sum / double(count) : std::nan(""); }
};

void add_rates(BenchReport& report, const std::string& name, const ShownWalk& walk,
               const nlohmann::json& where) {
  std::vector<double> gaps, lags, bytes;
  double before = 0;
  for (const ShownPicture& one : walk.pictures) {
    gaps.push_back(1000 * (one.arrived - before));
    lags.push_back(1000 * (one.arrived - one.asked));
    bytes.push_back(double(one.message.size()));
    before = one.arrived;
  }
  report.add(name + ".fps", double(walk.pictures.size()) / walk.seconds, "1/s", where);
  report.add(name + ".drawn_fps", walk.keyframes / walk.seconds, "1/s", where);
  report.add(name + ".still_gap_ms", quantile(gaps, 1), "ms", where);
  report.add(name + ".latency_ms", quantile(lags, 0.5), "ms", where);
  report.add(name + ".picture_bytes", quantile(bytes, 0.5), "B", where);
  const double sum = std::accumulate(bytes.begin(), bytes.end(), 0.0);
  report.add(name + ".bytes_rate", sum / walk.seconds, "B/s", where);
}

std::vector<Viewpoint> walk_poses(const VisitTrace& trace, const Exhibit& exhibit) {
  const float fov = exhibit.viewpoints[size_t(exhibit.start)].view.fov;
  std::vector<Viewpoint> poses;
  for (double time = 0; time < trace_seconds(trace); time += pose_interval) {
    poses.push_back(eval_trace(trace, time));
    poses.back().fov = fov;
  }
  return poses;
}

}  // namespace

VisitTrace load_walk(const BenchOptions& options, std::string name) {
  if (name.empty()) name = options.visit_trace.empty() ? "stroll" : options.visit_trace;
  const auto traces = std::filesystem::path(options.scenes).parent_path() / "traces";
  return load_visit_trace((traces / (name + ".json")).string());
}

void look_until(WsClient& client, double moment,
                const std::function<void(const WsMessage&)>& take) {
  WsMessage message;
  for (double left; (left = moment - seconds_now()) > 0;) {
    const auto got = client.receive(message, std::min(left, 0.03));
    if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
    if (got != WsClient::Got::message || !message.binary) continue;
    const auto packet = read_packet(message.bytes);
    if (!packet) continue;
    client.send_text(write_message(Ack{packet->header.frame, 1, true}));
    take(message);
  }
}

void join_alone(WsClient& client, const ServerProcess& server, const WalkWay& way) {
  join_visit(client, way.port ? way.port : server.port, shown_width, shown_height,
             way.local ? "local" : "server");
  StorytellerOrder away;
  away.visible = false;
  client.send_text(write_message(away));
}

ShownWalk walk_along(const ServerProcess& server, const std::vector<Viewpoint>& poses,
                     const WalkWay& way) {
  WsClient client;
  join_alone(client, server, way);
  auto go_to = [&](size_t seq) {
    const Viewpoint& pose = poses[seq - 1];
    client.send_text(write_message(CameraTo{uint32_t(seq), pose.position, pose.yaw, pose.pitch}));
  };
  go_to(1);
  ShownWalk walk;
  walk.local = way.local;
  const auto note = [&](const WsMessage& message) { walk.before.push_back(message.bytes); };
  for (const double last = seconds_now() + first_within;
       walk.before.empty() && seconds_now() < last;)
    look_until(client, seconds_now() + pose_interval, note);
  look_until(client, seconds_now() + rest, note);
  const double keyframes = read_metric(server.port, "pictures_drawn_total");
  const double began = seconds_now();
  std::vector<double> asked{0};  // when each pose was sent
  auto take = [&](const WsMessage& message) {
    const auto sent = uint32_t(asked.size());
    const uint32_t seq = std::clamp(read_packet(message.bytes)->header.seq, 1u, sent);
    walk.pictures.push_back({seq, sent, seconds_now() - began, asked[seq - 1], message.bytes});
  };
  while (true) {
    look_until(client, began + pose_interval * double(asked.size()), take);
    if (asked.size() == poses.size()) break;
    go_to(asked.size() + 1);
    asked.push_back(seconds_now() - began);
  }
  walk.seconds = seconds_now() - began;
  walk.keyframes = read_metric(server.port, "pictures_drawn_total") - keyframes;
  client.close();
  if (walk.pictures.size() < 2) throw std::runtime_error("hardly any picture arrived");
  return walk;
}

WalkJudge::WalkJudge(const BenchOptions& options, const VisitTrace& trace)
    : truth_(options, trace.exhibit,
             options.visit_spp > 0 ? options.visit_spp
             : options.quick       ? 16
                                   : 32),
      poses_(walk_poses(trace, truth_.exhibit())) {
  const size_t wanted = options.visit_instants > 0 ? size_t(options.visit_instants)
                        : options.quick            ? 40
                                                   : poses_.size();
  every_ = uint32_t(std::max<size_t>(poses_.size() / wanted, 1));
}

const Converged& WalkJudge::converge(uint32_t seq) {
  auto [found, is_new] = converged_.try_emplace(seq);
  if (is_new)
    found->second =
        truth_.converge(truth_.view(poses_[seq - 1], shown_width, shown_height), window_of(seq));
  return found->second;
}

void WalkJudge::add(BenchReport& report, const std::string& name, const ShownWalk& walk,
                    nlohmann::json where) {
  add_rates(report, name, walk, where);
  Mean flip, late, halves;
  std::map<int, Mean> times;  // by half seconds
  Screen screen(shown_width, shown_height);
  for (const ShownPicture& one : walk.pictures) {
    screen.receive(one.message);
    if (!is_judged(one.seq) && !is_judged(one.late)) continue;
    const Image8 shown = screen.picture();
    if (is_judged(one.seq)) {
      const Converged& truth = converge(one.seq);
      const double error = judge(shown, truth);
      flip.add(error);
      times[int(one.arrived / while_worst)].add(error);
      halves.add(judge_halves(truth));
    }
    if (is_judged(one.late)) late.add(judge(shown, converge(one.late)));
  }
  double worst = 0;
  for (const auto& [time, errors] : times) worst = std::max(worst, errors.mean());
  where["judged"] = flip.count, where["shown"] = walk.pictures.size(), where["spp"] = truth_.spp();
  report.add(name + ".flip", flip.mean(), "FLIP", where);
  report.add(name + ".flip_late", late.mean(), "FLIP", where);
  report.add(name + ".flip_worst", worst, "FLIP", where);
  report.add(name + ".truth_halves_flip", halves.mean(), "FLIP", where);
}

double WalkJudge::add_had(BenchReport& report, const std::string& name, const ShownWalk& walk,
                          nlohmann::json where) {
  add_rates(report, name, walk, where);
  Screen screen(shown_width, shown_height);
  LocalDisplay local(truth_.exhibit().scene.origin);
  auto take = [&](const std::vector<uint8_t>& message) {
    if (walk.local) local.receive(message);
    else screen.receive(message);
  };
  for (const auto& message : walk.before) take(message);
  Mean flip, halves, own;
  // Judges the newest keyframe's own error, seen from where it was drawn.
  auto judge_own = [&](const ShownPicture& one) {
    View view = local.newest_view();
    view.width = shown_width, view.height = shown_height;
    own.add(judge(local.picture(view), truth_.converge(view, window_of(one.seq))));
  };
  const size_t own_every = std::max<size_t>(walk.pictures.size() * every_ / poses_.size(), 1);
  std::map<int, Mean> times;  // by half seconds
  auto next = walk.pictures.begin();
  for (uint32_t seq = 1; seq <= poses_.size(); seq++) {
    const double now = pose_interval * (seq - 1);
    for (; next != walk.pictures.end() && next->arrived <= now; ++next) {
      take(next->message);
      if (walk.local && (next - walk.pictures.begin()) % own_every == 0) judge_own(*next);
    }
    if (!is_judged(seq)) continue;
    const View view = truth_.view(poses_[seq - 1], shown_width, shown_height);
    const Converged& truth = converge(seq);
    const double error = judge(walk.local ? local.picture(view) : screen.picture(), truth);
    flip.add(error);
    times[int(now / while_worst)].add(error);
    halves.add(judge_halves(truth));
  }
  double worst = 0;
  for (const auto& [time, errors] : times) worst = std::max(worst, errors.mean());
  where["judged"] = flip.count, where["shown"] = walk.pictures.size(), where["spp"] = truth_.spp();
  report.add(name + ".flip", flip.mean(), "FLIP", where);
  if (walk.local) report.add(name + ".flip_drawn", own.mean(), "FLIP", where);
  report.add(name + ".flip_worst", worst, "FLIP", where);
  report.add(name + ".truth_halves_flip", halves.mean(), "FLIP", where);
  return flip.mean();
}

}  // namespace wellspring::test
