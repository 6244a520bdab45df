// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk: watches who stands in front of the kiosk and tells the server in numbers.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <opencv2/core/utility.hpp>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/camera.h"
#include "kiosk/feed.h"
#include "kiosk/link.h"
#include "kiosk/observe.h"
#include "wire/json.h"

namespace {

using namespace wellspring;

std::atomic<bool> stop_asked{false};
void ask_to_stop(int) { stop_asked = true; }

struct Options {
  CameraSettings camera;
  ObserverSettings observer;
  std::string server = "ws://127.0.0.1:8080";
  bool server_given = false, print = false, pace = true;
  double fov = 60, pitch = 0;
  std::vector<float> offset{0, 0, 0};
};

// Fills options; a wrong command line throws CLI::ParseError.
void parse(Options& options, int argc, char** argv, CLI::App& app) {
  app.add_option("--camera", options.camera.source,
                 "number of a webcam, a device's path, a video file, or 'synthetic'")
      ->required();
  auto* server = app.add_option("--server", options.server,
                                "where observations go; without it and with --print nowhere")
                     ->capture_default_str();
  app.add_flag("--print", options.print, "one JSON observation a line on stdout");
  app.add_flag("!--no-pace", options.pace, "read a file as fast as possible, every frame of it");
  app.add_flag("--loop", options.camera.loop, "start a file again at its end");
  app.add_option("--fov", options.fov, "horizontal field of view, degrees")
      ->check(CLI::Range(10.0, 170.0))
      ->capture_default_str();
  app.add_option("--mount-offset", options.offset,
                 "the lens from the screen's centre, metres: right as the visitor sees it, up, "
                 "towards the visitor")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(-10.0, 10.0))
      ->capture_default_str();
  app.add_option("--mount-pitch", options.pitch, "tilt of the camera, degrees, upwards positive")
      ->check(CLI::Range(-80.0, 80.0))
      ->capture_default_str();
  app.add_flag("--mirrored", options.camera.mount.mirrored, "the camera delivers a mirror image");
  app.add_option("--width", options.camera.width,
                 "pixels across: asked of a webcam; wider frames are reduced")
      ->check(CLI::Range(160, 1920))
      ->capture_default_str();
  app.add_option("--rate", options.camera.rate,
                 "frames a second at most; all of a file with --no-pace")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  app.add_option("--cascades", options.observer.face.cascades, "folder of OpenCV's cascades")
      ->capture_default_str();
  app.parse(argc, argv);
  options.server_given = server->count() > 0;
  Mount& mount = options.camera.mount;
  mount.fov = float(options.fov) * pi / 180;
  mount.pitch = float(options.pitch) * pi / 180;
  mount.offset = {options.offset[0], options.offset[1], options.offset[2]};
  options.camera.synthetic_ends = !options.pace && !options.camera.loop;
  options.observer.mount = mount;
}

// False when stdout is gone: whoever read us has left.
bool print(const std::string& line) {
  return std::fputs(line.c_str(), stdout) >= 0 && std::fputc('\n', stdout) != EOF &&
         std::fflush(stdout) == 0;
}

void watch(const Options& options, Observer& observer, Feed& feed, ServerLink* link) {
  constexpr double patience = 2;       // seconds without a picture before nobody is seen
  constexpr double blind_every = 0.5;  // seconds between observations of a blind camera
  const double step = 1 / options.camera.rate;
  double frame_at = seconds_now(), frame_time = frame_at, blind_at = 0, due = -1e9;
  Presence told = Presence::absent;
  GrayFrame frame;
  while (!stop_asked) {
    const Fed fed = feed.take(frame, 0.1);
    if (fed == Fed::end) return;
    Observation seen;
    if (fed == Fed::frame) {
      frame_at = seconds_now();
      frame_time = frame.time;
      // A camera faster than the rate is thinned out; half a frame of tolerance keeps one that is
      // just as fast.
      if (options.pace && frame.time < due - 0.5 * step) continue;
      due = std::max(due, frame.time - step) + step;
      seen = observer.step(frame);
    } else {
      const double now = seconds_now();
      if (now - frame_at < patience || now - blind_at < blind_every) continue;
      blind_at = now;
      seen = observer.step_blind(frame_time + now - frame_at);
    }
    if (seen.state != told) log::info("{} -> {}", to_string(told), to_string(seen.state));
    told = seen.state;
    std::string text = write_observation(seen);
    if (options.print && !print(text)) return;
    if (link) link->send(std::move(text));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Watches a camera and tells the museum's server who stands there: presence, heads in metres, "
      "how they are turned. Pictures never leave this program."};
  app.name("wellspring kiosk");
  Options options;
  try {
    parse(options, argc, argv, app);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return 2;
  }
  auto address = parse_address(options.server);
  if (!address) {
    std::cerr << "--server: '" << options.server << "' is not ws://HOST[:PORT][/PATH]\n";
    return 2;
  }
  log::start("kiosk");
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::signal(SIGPIPE, SIG_IGN);
  cv::setNumThreads(1);  // one core for the eyes; the others belong to the museum
  try {
    Observer observer(options.observer);
    auto camera = make_camera(options.camera);
    std::unique_ptr<ServerLink> link;
    if (options.server_given || !options.print) link = std::make_unique<ServerLink>(*address);
    Feed feed(std::move(camera), options.pace);
    watch(options, observer, feed, link.get());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
