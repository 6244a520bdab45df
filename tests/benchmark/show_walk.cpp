// SPDX-License-Identifier: Apache-2.0
// show.walk: how right is, sixty times a second, what somebody who walks through the castle has
// before them, by a server as museums run it (show_visit.h), who is so many milliseconds away there
// and back: finished pictures, and keyframes that the visitor's device shows. show.first: what
// somebody who has just come is shown at the exhibit's start, so many seconds after hello or after
// the server's start, where nothing is kept from before: with the light that the package carries
// and without it. A screen that shows nothing yet is black.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "base/clock.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "light/kept/map_file.h"
#include "shaped_line.h"
#include "show_visit.h"

namespace wellspring::test {
namespace {

struct Moment {
  std::string since;  // hello, start
  double seconds = 0;
  Image8 shown = {};
};

std::vector<Moment> first_moments() {
  return {{"hello", 0.5}, {"hello", 2}, {"hello", 10}, {"start", 10}};
}

constexpr double most_start = 60;  // seconds until the server has loaded its exhibit

std::vector<Moment> visit_first(const BenchOptions& options, const std::string& exhibit) {
  const ServerProcess server(options, exhibit);
  while (fetch(server.port, "/healthz").find("ok") == std::string::npos &&
         seconds_now() < server.started + most_start)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  WsClient client;
  const double hello = seconds_now();
  join_alone(client, server);
  Screen screen(shown_width, shown_height);
  std::vector<Moment> moments = first_moments();
  auto time_of = [&](const Moment& moment) {
    return (moment.since == "hello" ? hello : server.started) + moment.seconds;
  };
  std::ranges::stable_sort(moments, {}, time_of);
  for (Moment& moment : moments) {
    look_until(client, time_of(moment),
               [&](const WsMessage& message) { screen.receive(message.bytes); });
    moment.shown = screen.picture();
  }
  client.close();
  return moments;
}

// All packages, of which this one has lost its light.
void copy_without_light(const std::string& content, const std::string& exhibit,
                        const std::string& to) {
  std::filesystem::copy(content + "/" + exhibit, to + "/" + exhibit,
                        std::filesystem::copy_options::recursive);
  std::filesystem::remove(shipped_light(to + "/" + exhibit));
}

void save(const BenchOptions& options, const std::string& name, const Image8& shown,
          const Image8& truth) {
  if (options.visit_pictures.empty()) return;
  std::filesystem::create_directories(options.visit_pictures);
  const std::string stem = options.visit_pictures + "/show_first_";
  save_image8(stem + name + ".png", shown);
  save_image8(stem + "true.png", truth);
  const FlipMap map = eval_flip(shown, truth);
  Image8 error{map.width, map.height, {}};
  for (float one : map.error) error.rgb.insert(error.rgb.end(), 3, uint8_t(255 * one));
  save_image8(stem + name + "_flip.png", error);
}

// Pictures by the light that there was, "shipped" or "none".
using FirstVisits = std::vector<std::pair<std::string, std::vector<Moment>>>;

FirstVisits visit_first_times(const BenchOptions& options, const std::string& exhibit) {
  const OwnFolder content;
  copy_without_light(options.content, exhibit, content.path());
  BenchOptions without = options;
  without.content = content.path();
  return {{"shipped", visit_first(options, exhibit)}, {"none", visit_first(without, exhibit)}};
}

void add_first_visits(BenchReport& report, const BenchOptions& options, const FirstVisits& visits,
                      const ShowTruth& truth) {
  const Exhibit& exhibit = truth.exhibit();
  const Viewpoint& start = exhibit.viewpoints[size_t(exhibit.start)].view;
  const Converged wanted = truth.converge(truth.view(start, shown_width, shown_height));
  for (const auto& [light, moments] : visits)
    for (const Moment& moment : moments) {
      report.add("show.first.flip", judge(moment.shown, wanted), "FLIP",
                 {{"scene", exhibit.id},
                  {"light", light},
                  {"since", moment.since},
                  {"seconds", moment.seconds},
                  {"spp", truth.spp()}});
      save(options, light + "_" + moment.since + "_" + std::to_string(int(10 * moment.seconds)),
           moment.shown, wanted.picture);
    }
  report.add("show.first.truth_halves_flip", judge_halves(wanted), "FLIP",
             {{"scene", exhibit.id}, {"spp", truth.spp()}});
}

constexpr double line_mbit = 1000;
constexpr size_t line_queue = size_t(256) << 20;  // bytes; only the way is long

ShownWalk walk_over(const BenchOptions& options, const WalkJudge& judge, bool local,
                    double round_trip_ms) {
  const ServerProcess server(options, judge.truth().exhibit().id);
  std::optional<ShapedLine> line;
  if (round_trip_ms > 0) line.emplace(options, server.port, line_mbit, round_trip_ms, line_queue);
  const uint16_t port = line ? line->port : uint16_t(0);
  return walk_along(server, judge.poses(), {.local = local, .port = port});
}

void add_walks(BenchReport& report, const BenchOptions& options, const VisitTrace& trace,
               WalkJudge& judge) {
  for (int round_trip_ms : {0, 50, 150, 300}) {
    nlohmann::json where = {
        {"scene", trace.exhibit}, {"trace", trace.name}, {"round_trip_ms", round_trip_ms}};
    double flips[2];
    for (bool local : {false, true}) {
      const ShownWalk walk = walk_over(options, judge, local, round_trip_ms);
      where["display"] = local ? "local" : "server";
      flips[local] = judge.add_had(report, "show.walk", walk, where);
    }
    where.erase("display");
    report.add("show.walk.ratio", flips[1] / flips[0], "", where);
  }
}

}  // namespace

void bench_show_walk(BenchReport& report, const BenchOptions& options) {
  std::vector<std::string> names = {"stroll"};
  if (!options.visit_trace.empty()) names = {options.visit_trace};
  else if (!options.quick) names = {"stroll", "turn", "approach", "storyteller", "door"};
  for (const std::string& name : names) {
    const VisitTrace trace = load_walk(options, name);
    WalkJudge judge(options, trace);
    add_walks(report, options, trace, judge);
    if (name == names.front())
      add_first_visits(report, options, visit_first_times(options, trace.exhibit), judge.truth());
  }
}

}  // namespace wellspring::test
