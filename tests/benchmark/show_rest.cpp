// SPDX-License-Identifier: Apache-2.0
// show.rest: a visitor alone jumps to a viewpoint of the castle and stands still, over loopback.
// Samples a second meanwhile, and FLIP of the last picture of the first two (and ten) seconds
// against the converged picture of that view: so the show's schedule is in it, and the machine's
// speed. The storytellers are sent away.
#include <filesystem>
#include <stdexcept>

#include "base/clock.h"
#include "cache_visit_truth.h"
#include "frame/flip.h"
#include "frame/jpeg.h"
#include "frame/picture_file.h"
#include "frame/tonemap.h"
#include "show/exhibit/exhibit_load.h"
#include "stream/ws_client.h"
#include "stream_server.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring {

namespace {

struct Rest {
  WsClient client;
  std::vector<uint8_t> picture;  // the last that came
  int pictures = 0;

  // Takes what comes and says so, for that long.
  void look(double seconds) {
    double until = seconds_now() + seconds;
    WsMessage message;
    while (seconds_now() < until) {
      auto got = client.receive(message, std::clamp(until - seconds_now(), 0.0, 0.03));
      if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
      if (got != WsClient::Got::message || !message.binary) continue;
      auto packet = read_packet(message.bytes);
      if (!packet) continue;
      client.send_text(write_message(Ack{packet->header.frame, 1, true}));
      picture.assign(packet->payload.begin(), packet->payload.end());
      pictures++;
    }
  }
};

// As a visitor would see it once no sample were missing.
struct Museum {
  Exhibit exhibit;
  World world;
  Lights lights;
  explicit Museum(const std::string& folder) : exhibit(load_exhibit(folder)), world(exhibit.scene) {
    world.commit();
    lights = make_lights(world);
  }
  Image8 converged(const std::string& viewpoint, const TruthSettings& settings) const {
    const Viewpoint& at = exhibit.viewpoints[size_t(find_viewpoint(exhibit, viewpoint))].view;
    View view = make_view(exhibit.scene, at.position, at.yaw, at.pitch, at.fov, 1280, 720);
    Image8 picture;
    tonemap(find_truth(world, lights, view, settings).picture, Tonemap{exhibit.exposure}, picture);
    return picture;
  }
};

}  // namespace

void bench_show_rest(BenchReport& report, const BenchOptions& options) {
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 24 : 128;
  truths.folder = truths_folder(options);
  Museum museum(options.content + "/castle");
  ServerProcess server(options, "castle");
  Rest rest;
  join_visit(rest.client, server.port);
  StorytellerOrder away;
  away.visible = false;
  rest.client.send_text(write_message(away));
  struct Shown {
    std::string viewpoint;
    double seconds;
    std::vector<uint8_t> picture;
  };
  std::vector<Shown> shown;
  uint32_t seq = 0;
  rest.look(2);
  for (const std::string viewpoint : {"crown", "hall"}) {
    if (options.quick && viewpoint != "crown") continue;
    rest.client.send_text(write_message(ViewpointTo{++seq, viewpoint}));
    double before = 0;
    for (double until : {2.0, 10.0}) {
      if (options.quick && until > 2) break;
      double samples = read_metric(server.port, "samples_total"), began = seconds_now();
      int pictures = rest.pictures;
      rest.look(until - before);
      double counted = seconds_now() - began;
      nlohmann::json where = {{"viewpoint", viewpoint}, {"seconds", until}};
      report.add("show.rest.samples",
                 (read_metric(server.port, "samples_total") - samples) / counted, "1/s", where);
      report.add("show.rest.fps", (rest.pictures - pictures) / counted, "1/s", where);
      shown.push_back({viewpoint, until, rest.picture});
      before = until;
    }
  }
  rest.client.close();
  for (const Shown& one : shown) {
    Image8 reference = museum.converged(one.viewpoint, truths);
    Image8 picture = decode_jpeg(one.picture, "picture");
    report.add("show.rest.flip", eval_flip(picture, reference).mean, "FLIP",
               {{"viewpoint", one.viewpoint}, {"seconds", one.seconds}, {"spp", truths.spp}});
    if (options.visit_pictures.empty()) continue;
    std::filesystem::create_directories(options.visit_pictures);
    std::string stem = options.visit_pictures + "/show_rest_" + one.viewpoint + "_" +
                       std::to_string(int(one.seconds)) + "s";
    save_image8(stem + ".png", picture);
    save_image8(stem + "_true.png", reference);
  }
}

}  // namespace wellspring
