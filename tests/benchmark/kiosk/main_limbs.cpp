// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk_limbs: how well the kiosk's eye sees bodies and hands and what they cost, for
// `wellspring bench --only kiosk.hands`, which starts it. Prints one JSON object a result:
// {"name","value","unit",...}.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "about/version.h"
#include "base/log.h"
#include "kiosk/camera.h"
#include "kiosk/gesture/train.h"
#include "kiosk/gesture/writer.h"
#include "kiosk/observe.h"
#include "unit/kiosk/hand/made_hand.h"
#include "tell.h"

namespace {

using namespace wellspring;
using namespace wellspring::test;
namespace fs = std::filesystem;
using nlohmann::json;

constexpr float degree = pi / 180;
constexpr double usual_rate = 15;  // observations a second of a kiosk

struct Options {
  std::string weights, data;
  bool quick = false;
};

double process_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Holds what an observer says of a recording.
struct Watched {
  Mean bodies, hands, milliseconds;
  double seconds = 0;
  int gestures = 0;
};

// Frames beyond the usual rate are left out, as the kiosk's program does with a camera.
void watch(const fs::path& file, const ObserverSettings& settings, double most, Watched& all) {
  CameraSettings source;
  source.source = file.string();
  auto camera = make_camera(source);
  Observer observer(settings);
  GrayFrame frame;
  double next = 0, last = 0;
  std::string before;
  while (camera->next(frame) == Got::frame && frame.time < most) {
    if (frame.time < next) continue;
    next = std::max(next + 1 / usual_rate, frame.time);
    const double began = process_seconds();
    const Observation seen = observer.step(frame);
    all.milliseconds.add(1000 * (process_seconds() - began));
    last = frame.time;
    bool hand = false;
    std::string now;
    for (const Person& person : seen.people) {
      hand |= !person.hands.empty();
      now += person.gesture;
    }
    all.gestures += !now.empty() && now != before;
    before = now;
    if (frame.time < 2) continue;  // until somebody is found and believed
    all.bodies.add(!seen.bodies.empty());
    all.hands.add(hand);
  }
  all.seconds += last;
}

struct Clips {
  const char* name;
  std::vector<const char*> files;
  bool people, near;
};
const Clips clips[] = {
    {"people far away",
     {"preview/people-detection.gif", "preview/face-demographics-walking.gif",
      "preview/face-demographics-walking-and-pause.gif", "preview/classroom.gif"},
     true,
     false},
    {"nobody", {"car-detection.mp4", "bottle-detection.mp4"}, false, false},
    {"signing",
     {"asl_gestures/again.mkv", "asl_gestures/bird.mkv", "asl_gestures/book.mkv",
      "asl_gestures/brother.mkv", "asl_gestures/eat.mkv", "asl_gestures/help.mkv",
      "asl_gestures/hungry.mkv", "asl_gestures/learn.mkv"},
     true,
     true}};

void measure_clips(const Options& options, const GestureModels& models) {
  const fs::path folder = fs::path(options.data) / "5_faces" / "intel_sample_videos";
  if (options.data.empty() || !fs::is_directory(folder)) return;
  for (const Clips& set : clips)
    for (const char* by : {"landmarks", "colour of skin"}) {
      const bool networks = by == std::string("landmarks");
      ObserverSettings settings;
      settings.face.weights = options.weights;
      settings.gestures = &models;
      settings.bodies = networks;
      // Faces are found by the same networks; those of bodies and hands lie elsewhere.
      if (!networks) settings.face.graphs = "/nowhere";
      Watched all;
      for (const char* file : set.files) {
        if (!fs::exists(folder / file)) continue;
        Watched one;
        watch(folder / file, settings, options.quick ? 8 : 60, one);
        if (networks)
          tell("kiosk.body.clip", one.bodies.value(), "1",
               {{"clip", fs::path(file).filename().string()}});
        for (auto [to, from] : {std::pair(&all.bodies, &one.bodies),
                                {&all.hands, &one.hands},
                                {&all.milliseconds, &one.milliseconds}})
          to->sum += from->sum, to->count += from->count;
        all.seconds += one.seconds, all.gestures += one.gestures;
      }
      const json fields{{"recordings", set.name}, {"by", by}};
      if (networks) tell("kiosk.body.found", all.bodies.value(), "1", fields);
      if (networks) tell("kiosk.hand.found", all.hands.value(), "1", fields);
      tell("kiosk.limbs_ms", all.milliseconds.value(), "ms", fields);
      tell("kiosk.limbs_cores", all.milliseconds.value() * usual_rate / 1000, "1", fields);
      if (set.near && all.seconds > 0)
        tell("kiosk.hand.false_a_minute", 60 * all.gestures / all.seconds, "1/min", fields);
    }
}

// Judges poses and pointing of hands that are made up, whose landmarks tremble as those of the
// network do; away from the camera thrice as much.
void measure_made(const Options& options) {
  const int each = options.quick ? 40 : 400;
  const Mount mount;
  const vec3 eye{0, 0.15f, 0.95f};
  for (float millimetres : {0.f, 2.f, 4.f, 8.f}) {
    Mean counted, posed, by_eye, by_finger;
    uint64_t seed = 1;
    for (int k = 0; k < each; k++) {
      const float turn = float(k) / float(each);
      MadeHand hand;
      hand.roll = 1.2f * std::sin(17 * turn), hand.pitch = 0.7f * std::sin(31 * turn);
      const int fingers = k % 6;
      for (int f = 0; f < 5; f++)
        hand.stretched[size_t(f)] = fingers == 5 || (f > 0 && f <= fingers);
      const HandShape shape = shape_of(marks_of(hand, mount, millimetres / 1000, ++seed));
      counted.add(shape.fingers == fingers);
      const HandPose wanted = fingers == 0   ? HandPose::fist
                              : fingers == 1 ? HandPose::point
                              : fingers == 5 ? HandPose::open
                                             : HandPose::other;
      posed.add(shape.pose == wanted);

      // A finger on the line from the eye to a place on the screen, and along it.
      const vec3 target{0.3f * std::sin(13 * turn), 0.2f * std::cos(7 * turn), 0};
      const vec3 ray = glm::normalize(target - eye);
      MadeHand pointing;
      pointing.stretched = {false, true, false, false, false};
      pointing.pitch = std::asin(std::clamp(-ray.z, -1.f, 1.f));
      pointing.roll = std::atan2(-ray.x, ray.y);
      const vec3 tip = eye + 0.42f * ray;
      const auto metres = metres_of(pointing);
      const vec3 off = metres[index_tip_point];
      pointing.palm = camera_to_screen(mount, screen_to_camera(mount, tip) - off);
      const HandMarks marks = marks_of(pointing, mount, millimetres / 1000, ++seed);
      const auto place =
          place_hand(marks, focal_length(mount, hand_picture_width, hand_picture_width),
                     hand_picture_width, hand_picture_height);
      if (!place) continue;
      auto error = [&](vec3 from) -> double {
        const auto found = point_on_screen(from, camera_to_screen(mount, place->index_tip));
        if (!found) return 90;
        const float cosine = glm::dot(glm::normalize(vec3(*found, 0) - eye), ray);
        return std::acos(std::clamp(cosine, -1.f, 1.f)) / degree;
      };
      by_eye.add(error(eye));
      by_finger.add(error(camera_to_screen(mount, place->index_root)));
    }
    const json fields{{"trembling, mm", millimetres}};
    tell("kiosk.hand.counted", counted.value(), "1", fields);
    tell("kiosk.hand.posed", posed.value(), "1", fields);
    tell("kiosk.hand.point_eye_deg", by_eye.value(), "degrees", fields);
    tell("kiosk.hand.point_finger_deg", by_finger.value(), "degrees", fields);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  CLI::App app{"Measures how the kiosk's eye sees bodies and hands, for wellspring bench."};
  Options options;
  app.add_option("--weights", options.weights, "folder of the face networks' weights");
  app.add_option("--data", options.data, "folder of real recordings");
  app.add_flag("--quick", options.quick, "shorter clips, fewer hands");
  CLI11_PARSE(app, argc, argv);
  log::start("limbs");
  cv::setNumThreads(1);
  try {
    measure_made(options);
    measure_clips(options, train_gestures(write_set(WriterGroup::training, 21, 2, 1)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
