// SPDX-License-Identifier: Apache-2.0
// show.walk: how right every picture is that somebody who strolls through the castle is shown by a
// server as museums run it (show_visit.h). show.first: what somebody who has just come is shown at
// the exhibit's start, so many seconds after hello or after the server's start, where nothing is
// kept from before: with the light that the package carries and without it. A screen that shows
// nothing yet is black.
#include <algorithm>
#include <filesystem>

#include "base/clock.h"
#include "frame/flip.h"
#include "frame/picture_file.h"
#include "light/bake/map_file.h"
#include "show_visit.h"

namespace wellspring {
namespace {

struct Moment {
  std::string since;  // hello, start
  double seconds = 0;
  Image8 shown = {};
};

std::vector<Moment> first_moments() {
  return {{"hello", 0.5}, {"hello", 2}, {"hello", 10}, {"start", 10}};
}

std::vector<Moment> visit_first(const BenchOptions& options, const std::string& exhibit) {
  const ServerProcess server(options, exhibit);
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

}  // namespace

void bench_show_walk(BenchReport& report, const BenchOptions& options) {
  const VisitTrace trace = load_walk(options);
  WalkJudge judge(options, trace);
  ShownWalk walk;
  {
    const ServerProcess server(options, trace.exhibit);
    walk = walk_along(server, judge.poses());
  }
  const FirstVisits visits = visit_first_times(options, trace.exhibit);
  judge.add(report, "show.walk", walk,
            {{"scene", trace.exhibit},
             {"display", "server"},
             {"round_trip_ms", 0},
             {"trace", trace.name}});
  add_first_visits(report, options, visits, judge.truth());
}

}  // namespace wellspring
