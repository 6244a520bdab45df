// SPDX-License-Identifier: Apache-2.0
// show.rest: a visitor alone jumps to a viewpoint of the castle and stands still, over loopback.
// Samples a second meanwhile, and FLIP of what is shown after two (and ten) seconds against the
// converged picture of that view: so the show's schedule is in it, and the machine's speed. The
// storytellers are sent away.
#include <filesystem>

#include "base/clock.h"
#include "frame/picture_file.h"
#include "show_visit.h"
#include "wire/json.h"

namespace wellspring::test {

void bench_show_rest(BenchReport& report, const BenchOptions& options) {
  const int spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 16 : 64;
  const ShowTruth truth(options, "castle", spp);
  const ServerProcess server(options, "castle");
  WsClient client;
  join_alone(client, server);
  Screen screen(shown_width, shown_height);
  int pictures = 0;
  auto look = [&](double seconds) {
    look_until(client, seconds_now() + seconds, [&](const WsMessage& message) {
      screen.receive(message.bytes);
      pictures++;
    });
  };
  struct Shown {
    std::string viewpoint;
    double seconds;
    Image8 picture;
  };
  std::vector<Shown> shown;
  uint32_t seq = 0;
  look(2);
  for (const std::string viewpoint : {"crown", "hall"}) {
    if (options.quick && viewpoint != "crown") continue;
    client.send_text(write_message(ViewpointTo{++seq, viewpoint}));
    double before = 0;
    for (double until : {2.0, 10.0}) {
      if (options.quick && until > 2) break;
      const double samples = read_metric(server.port, "samples_total"), began = seconds_now();
      pictures = 0;
      look(until - before);
      const double counted = seconds_now() - began;
      const nlohmann::json where = {{"viewpoint", viewpoint}, {"seconds", until}};
      report.add("show.rest.samples",
                 (read_metric(server.port, "samples_total") - samples) / counted, "1/s", where);
      report.add("show.rest.fps", pictures / counted, "1/s", where);
      shown.push_back({viewpoint, until, screen.picture()});
      before = until;
    }
  }
  client.close();
  for (const Shown& one : shown) {
    const Exhibit& exhibit = truth.exhibit();
    const Viewpoint& at = exhibit.viewpoints[size_t(find_viewpoint(exhibit, one.viewpoint))].view;
    const Converged wanted = truth.converge(truth.view(at, shown_width, shown_height));
    const nlohmann::json where = {
        {"viewpoint", one.viewpoint}, {"seconds", one.seconds}, {"spp", truth.spp()}};
    report.add("show.rest.flip", judge(one.picture, wanted), "FLIP", where);
    report.add("show.rest.truth_halves_flip", judge_halves(wanted), "FLIP", where);
    if (options.visit_pictures.empty()) continue;
    std::filesystem::create_directories(options.visit_pictures);
    const std::string stem = options.visit_pictures + "/show_rest_" + one.viewpoint + "_" +
                             std::to_string(int(one.seconds)) + "s";
    save_image8(stem + ".png", one.picture);
    save_image8(stem + "_true.png", wanted.picture);
  }
}

}  // namespace wellspring::test
