// SPDX-License-Identifier: Apache-2.0
// Runs wellspring_kiosk: watches who stands in front of the kiosk and sends the server numbers.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/core.h>
#include <functional>
#include <iostream>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <sys/prctl.h>
#include <thread>
#include <utility>

#include "about/version.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/calibrate.h"
#include "kiosk/camera.h"
#include "kiosk/config.h"
#include "kiosk/gesture/gesture_file.h"
#include "kiosk/gesture/train.h"
#include "kiosk/gesture/writer.h"
#include "kiosk/observe.h"
#include "kiosk/process/eye_process.h"
#include "kiosk/process/link.h"
#include "kiosk/process/recording.h"
#include "kiosk/tree/tree_file.h"
#include "wire/json.h"

namespace {

using namespace wellspring;
using namespace wellspring::program;

std::atomic<bool> stop_asked{false};
void ask_to_stop(int) { stop_asked = true; }

// Prints a line; false when stdout is gone: its reader has left.
bool print(const std::string& line) {
  return std::fputs(line.c_str(), stdout) >= 0 && std::fputc('\n', stdout) != EOF &&
         std::fflush(stdout) == 0;
}

// Gives observations to all but the server: stdout, a file. Any camera's thread may call.
class Readers {
 public:
  explicit Readers(const KioskOptions& given) : options_(given) {
    if (!given.record.empty()) recorder_ = std::make_unique<Recorder>(given.record);
  }
  // Writes an observation. False: the reader of stdout has left.
  bool tell(const std::string& text) {
    std::lock_guard lock(mutex_);
    if (options_.print && !print(text)) return false;
    if (recorder_ && !recorder_->write(text)) {
      log::warn("{} is full or gone: nothing more is recorded", options_.record);
      recorder_ = nullptr;
    }
    return true;
  }

 private:
  const KioskOptions& options_;
  std::mutex mutex_;
  std::unique_ptr<Recorder> recorder_;
};

// Returns where the server has the recognition tree of a kiosk.
std::string station_path(const std::string& kiosk) {
  std::string path = "/api/v1/station";
  if (kiosk.empty()) return path;
  path += "?kiosk=";
  for (const char c : kiosk) path += fmt::format("%{:02X}", uint8_t(c));
  return path;
}

// Keeps the tree that the exhibit names for this kiosk, as the server told it last.
class ToldStation {
 public:
  // Waits for it until the first eye begins, up to two seconds. `link`: may be null.
  void wait(ServerLink* link) {
    if (!link) return;
    for (const double until = seconds_now() + 2; !stop_asked && seconds_now() < until;) {
      if (take(*link) || known_) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    log::warn(
        "the server does not say whether objects are to be recognised: none are until it "
        "does");
  }
  // Takes what has come. True: an eye that runs has another tree.
  bool take(ServerLink& link) {
    auto text = link.take_document();
    if (!text) return false;
    const bool first = !std::exchange(known_, true);
    if (*text == text_) return false;
    text_ = std::move(*text);
    file_.reset();
    try {
      if (!text_.empty()) parse_tree("the station of this kiosk's exhibit", text_);
      if (!text_.empty()) file_.emplace(text_);
      log::info("{}", file_ ? "objects are recognised by the exhibit's tree"
                            : "objects are no longer recognised: the exhibit has no tree");
    } catch (const std::exception& error) {
      log::error("no objects are recognised: {}", error.what());
    }
    return !first || file_;
  }
  const HandedText* file() const { return file_ ? &*file_ : nullptr; }

 private:
  std::string text_;
  std::optional<HandedText> file_;
  bool known_ = false;
};

// Makes the link to the server; null: observations go to stdout alone.
std::unique_ptr<ServerLink> make_link(const KioskOptions& options) {
  if (!options.server_given && options.print) return nullptr;
  ServerLinkSettings settings;
  settings.token = options.token;
  settings.ca_file = options.ca_file;
  if (options.station.empty()) settings.document = station_path(options.name);
  return std::make_unique<ServerLink>(*parse_address(options.server), settings);
}

// Watches a camera until it ends: its pictures become numbers.
void watch(const KioskOptions& options, const CameraSettings& settings, Observer& observer,
           Feed& feed) {
  constexpr double patience = 2;       // seconds without a picture before nobody is seen
  constexpr double blind_every = 0.5;  // seconds between observations of a blind camera
  constexpr double idle_step = 0.5;    // seconds between looks while the house is closed
  const double step = 1 / settings.rate;
  double looked_at = -1e9;
  bool idle = false;
  double frame_at = seconds_now(), frame_time = frame_at, blind_at = 0, due = -1e9;
  Presence told = Presence::absent;
  CameraWatch camera;
  CameraState known = CameraState::good;
  GrayFrame frame;
  Orders orders;
  while (!stop_asked) {
    if (options.observe_to >= 0)
      if (const auto order = orders.take()) observer.need(order->needs), idle = order->idle;
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
      const CameraState state = camera.step(frame);
      if (idle && std::abs(frame.time - looked_at) < idle_step) continue;
      looked_at = frame.time;
      seen = observer.step(frame);
      seen.camera = state;
    } else {
      const double now = seconds_now();
      if (now - frame_at < patience || now - blind_at < blind_every) continue;
      blind_at = now;
      seen = observer.step_blind(frame_time + now - frame_at);
      seen.camera = camera.step_blind();
    }
    if (seen.camera != known)
      log::warn("{}: camera {} -> {}", settings.name, camera_states[size_t(known)],
                camera_states[size_t(seen.camera)]);
    known = seen.camera;
    if (seen.state != told)
      log::info("{}: {} -> {}", settings.name, to_string(told), to_string(seen.state));
    told = seen.state;
    seen.name = settings.name;
    seen.kiosk = options.name;
    if (!write_line(options.observe_to, write_observation(seen))) return;
  }
}

// Makes 42 of each gesture, as many as the paper trains with; learnt from within a second.
std::vector<HandPath> generated_set() { return write_set(WriterGroup::training, 21, 2, 1); }

int learn(const KioskOptions& options) {
  const auto paths =
      options.recordings == "generated" ? generated_set() : load_recordings(options.recordings);
  const GestureModels models = train_gestures(paths);
  for (const HandPath& path : paths) {
    auto is_learnt = [&](const GestureModel& model) { return model.label == path.label; };
    if (!path.label.empty() &&
        std::none_of(models.gestures.begin(), models.gestures.end(), is_learnt))
      throw LoadError(options.recordings, "",
                      "fewer than three recordings of '" + path.label + "' move far enough");
  }
  if (models.gestures.empty()) throw LoadError(options.recordings, "", "no recording has a label");
  save_gesture_models(models, options.gestures);
  std::printf("%zu recordings, %zu models -> %s\n", paths.size(), models.gestures.size(),
              options.gestures.c_str());
  return 0;
}

// Runs the eye, which sees pictures; what it has opened by then is all that it may use.
void look(KioskOptions options) {
  const CameraSettings& settings = options.cameras[options.eye];
  GestureModels gestures;
  if (options.hands) {
    gestures = options.gestures.empty() ? train_gestures(generated_set())
                                        : load_gesture_models(options.gestures);
    options.observer.gestures = &gestures;
  }
  if (!options.station.empty()) options.observer.station = load_tree(options.station);
  options.observer.mount = settings.mount;
  Observer observer(options.observer);
  auto camera = make_camera(settings);
  if (options.sandbox) enter_sandbox({camera->live()});
  Feed feed(std::move(camera), options.pace);
  watch(options, settings, observer, feed);
}

int replay(const KioskOptions& options) {
  Replay file(options.replay);
  Readers readers(options);
  const auto link = make_link(options);
  Observation seen;
  std::string text;
  double began = 0;
  for (bool first = true; !stop_asked && file.next(seen, text); first = false) {
    if (first) began = seconds_now() - seen.time;
    while (options.pace && !stop_asked && seconds_now() < began + seen.time)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (!readers.tell(text)) break;
    if (link) link->send(text);
  }
  return 0;
}

// Takes an observation as it came, and its text. False: nothing more is wanted.
using Tell = std::function<bool(const Observation& seen, const std::string& text)>;

// Runs a camera's eye in a process of its own, and starts it again when it dies: a codec crashes, a
// driver takes it along, the exhibit has another recognition tree. `link` says what is needed of
// the eye; may be null. `asks`: also for that tree. Returns its exit status.
int supervise(const std::vector<std::string>& arguments, size_t which, const std::string& name,
              ServerLink* link, bool asks, const Tell& tell) {
  constexpr double longest_pause = 30;  // seconds
  std::string order;                    // the server's last order
  ToldStation station;
  if (asks) station.wait(link);
  for (int deaths = 0; !stop_asked;) {
    std::vector<std::string> words = arguments;
    if (station.file()) words.insert(words.end(), {"--station", handed_file});
    EyeProcess eye(std::move(words), which, station.file());
    if (!order.empty()) eye.tell(order);
    const double began = seconds_now();
    std::string text;
    bool again = false;
    for (;;) {
      const EyeProcess::Heard heard = eye.take(text, 0.1);
      if (again = asks && link && station.take(*link); again) break;
      if (const auto said = link ? link->take_order() : std::nullopt)
        eye.tell(order = write_eye_order(*said));
      if (stop_asked) return 0;
      if (heard == EyeProcess::Heard::ended) break;
      if (heard != EyeProcess::Heard::line) continue;
      // Only numbers that are valid are passed on.
      const auto read = read_observation(text);
      const Observation* seen = std::get_if<Observation>(&read);
      if (seen && !tell(*seen, text)) return 0;
    }
    if (again) continue;
    const int status = eye.status();
    if (status >= 0) return status;
    if (seconds_now() - began > longest_pause) deaths = 0;
    const double pause = std::min(0.5 * std::pow(2.0, std::min(deaths++, 10)), longest_pause);
    log::error("{}: the process that sees pictures died of signal {}; begun again in {:.1f} s",
               name, -status, pause);
    for (double until = seconds_now() + pause; !stop_asked && seconds_now() < until;)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return 0;
}

// Runs all cameras, each in a thread of its own with its own way to the server, so that a fault of
// one does not touch the others. Returns when the last of them ends.
int watch_all(const KioskOptions& options, const std::vector<std::string>& arguments) {
  Readers readers(options);
  std::atomic<int> worst{0};
  auto watch_one = [&](size_t which) {
    const std::string& name = options.cameras[which].name;
    try {
      const auto link = make_link(options);
      const int status = supervise(arguments, which, name, link.get(), options.station.empty(),
                                   [&](const Observation&, const std::string& text) {
                                     if (link) link->send(text);
                                     if (readers.tell(text)) return true;
                                     stop_asked = true;
                                     return false;
                                   });
      if (status > worst) worst = status;
    } catch (const std::exception& error) {
      log::error("{}: {}", name, error.what());
      worst = 1;
    }
  };
  std::vector<std::thread> threads;
  for (size_t i = 0; i < options.cameras.size(); i++) threads.emplace_back(watch_one, i);
  for (std::thread& thread : threads) thread.join();
  return worst;
}

int calibrate(const KioskOptions& options, const std::vector<std::string>& arguments) {
  const CameraSettings& camera = options.cameras[0];
  const auto link = make_link(options);
  Calibration calibration;
  std::string advice;
  Observation last;
  auto tell_screen = [&](const CalibrationStep& step) {
    last.calibration = step;
    if (link) link->send(write_observation(last));
  };
  bool done = false;
  int status =
      supervise(arguments, 0, camera.name, nullptr, false, [&](const Observation& seen, auto&) {
        done = calibration.step(seen);
        if (std::string now = calibration.advice(); now != advice) print(advice = now);
        last = seen;
        if (!done) tell_screen(calibration.now());
        return !done;
      });
  if (!done) return std::max(status, 1);
  try {
    const Mount mount =
        solve_mount(camera.mount, calibration.at_near(), calibration.at_far(),
                    options.eyes_given ? std::optional(options.eyes) : std::nullopt);
    save_mount(options.config, camera.source, mount);
    std::printf(
        "field of view %.1f degrees, pitch %.1f degrees, lens at %.2f, %.2f, %.2f m -> %s\n",
        double(mount.fov * 180 / pi), double(mount.pitch * 180 / pi), double(mount.offset.x),
        double(mount.offset.y), double(mount.offset.z), options.config.c_str());
  } catch (const std::exception&) {
    tell_screen({CalibrationStep::What::failed});
    throw;
  }
  tell_screen(calibration.now());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv, {"Boost", "CLI11", "GLM", "nlohmann-json", "stb"})) return 0;
  CLI::App app{
      "Watches a camera and tells the museum's server who stands there: presence, heads in metres, "
      "how they are turned. Pictures never leave this program."};
  app.name("wellspring kiosk");
  KioskOptions options;
  try {
    options = parse_options(argc, argv, app);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  if (!parse_address(options.server)) {
    std::cerr << "--server: '" << options.server << "' is not ws://HOST[:PORT][/PATH] or wss://\n";
    return 2;
  }
  log::start("kiosk");
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::signal(SIGPIPE, SIG_IGN);
  cv::setNumThreads(1);  // one core for the eyes; the others are left to the museum's programs
  try {
    if (!options.recordings.empty()) return learn(options);
    if (!options.replay.empty()) return replay(options);
    const std::vector<std::string> arguments{argv, argv + argc};
    if (options.observe_to < 0)
      return options.calibrate ? calibrate(options, arguments) : watch_all(options, arguments);
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // must not outlive its parent
    look(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
