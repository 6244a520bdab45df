// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk_measure: how good the kiosk's eye is and what it costs, for `wellspring bench
// --only kiosk`, which starts it: so OpenCV stays in kiosk/ and out of the benchmark's program.
// Prints one JSON object a result: {"name","value","unit",...}.
#include "main_measure.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <opencv2/core/utility.hpp>

#include "about/version.h"
#include "base/clock.h"
#include "base/log.h"
#include "kiosk/camera.h"
#include "kiosk/face/face_finder.h"
#include "kiosk/face/face_mesh.h"
#include "kiosk/figure.h"
#include "kiosk/network/graph/graph_network.h"

namespace wellspring::test {

ObserverSettings settings_of(const MeasureOptions& options, const std::string& finder) {
  ObserverSettings settings;
  settings.face.weights = finder == "networks" ? options.weights : "/nowhere";
  return settings;
}

}  // namespace wellspring::test

namespace {

using namespace wellspring;
using namespace wellspring::test;
namespace fs = std::filesystem;
using nlohmann::json;

constexpr float degree = pi / 180;
constexpr double rate = 30;
constexpr double comes = 0.5;  // seconds of an empty room
constexpr double settle = 4;   // seconds in which a visitor is found and believed

double process_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// A visitor who stands and turns the head at 15 degrees a second.
struct Scene {
  vec3 from{0}, to{0};  // yaw, pitch, roll in degrees
  float distance = 0.8f, light = 1;
};

struct Errors {
  std::map<std::string, Mean> mean;  // by range and axis
  std::map<int, Mean> by_yaw;        // degrees, by tens of the true yaw
  Mean position, found;
};

void watch_scene(const ObserverSettings& settings, const Scene& scene, Errors& errors) {
  Observer observer(settings);
  const float way = glm::length(scene.to - scene.from);
  const double turning = std::max(2.0, double(way) / 15);
  for (int k = 0; k < int((settle + turning) * rate); k++) {
    const double time = k / rate, at = std::clamp((time - settle) / turning, 0.0, 1.0);
    FigurePose pose;
    pose.visible = time >= comes;
    pose.position = {0.01f * std::sin(3 * float(time)), 0, scene.distance};
    // The head goes from the front to the turn's beginning while settling.
    const vec3 begin = scene.from * float(std::clamp(time / (0.8 * settle), 0.0, 1.0));
    pose.rotation = (time < settle ? begin : glm::mix(scene.from, scene.to, float(at))) * degree;
    const auto seen = observer.step(
        draw_figure({640, 480, scene.light, 2.5f, uint64_t(k)}, settings.mount, pose, time));
    if (time < settle) continue;
    errors.found.add(!seen.people.empty());
    if (seen.people.empty()) continue;
    const Person& person = seen.people[0];
    const vec3 off = glm::abs(person.rotation - pose.rotation) / degree;
    const float yaw = std::abs(pose.rotation.x) / degree;
    const char* axes[] = {"yaw", "pitch", "roll"};
    for (int axis = 0; axis < 3; axis++) {
      if (yaw <= 35.01f) errors.mean[std::string("35 ") + axes[axis]].add(off[axis]);
      if (yaw <= 60.01f) errors.mean[std::string("60 ") + axes[axis]].add(off[axis]);
    }
    errors.by_yaw[int(std::floor(yaw / 10)) * 10].add((off.x + off.y + off.z) / 3);
    errors.position.add(glm::length(person.position - pose.position) / scene.distance);
  }
}

void measure_heads(const MeasureOptions& options, const std::string& finder) {
  const ObserverSettings settings = settings_of(options, finder);
  std::vector<Scene> scenes = {
      {{-60, 0, 0}, {60, 0, 0}}, {{0, -20, 0}, {0, 20, 0}}, {{0, 0, -30}, {0, 0, 30}}};
  if (!options.quick) {
    for (float pitch : {-15.f, 15.f}) scenes.push_back({{-60, pitch, 0}, {60, pitch, 0}});
    for (float yaw : {-30.f, 30.f}) scenes.push_back({{yaw, -20, 0}, {yaw, 20, 0}});
    scenes.push_back({{-40, -10, -15}, {40, 10, 15}});
  }
  Errors all;
  for (const Scene& scene : scenes) watch_scene(settings, scene, all);
  for (const auto& [key, mean] : all.mean)
    tell("kiosk.head.mae_deg", mean.value(), "degrees",
         {{"finder", finder},
          {"range", std::stoi(key)},
          {"axis", key.substr(key.find(' ') + 1)},
          {"frames", mean.count}});
  for (const auto& [yaw, mean] : all.by_yaw)
    tell("kiosk.head.by_yaw_deg", mean.value(), "degrees", {{"finder", finder}, {"yaw", yaw}});
  tell("kiosk.head.position", all.position.value(), "1", {{"finder", finder}});
  tell("kiosk.head.found", all.found.value(), "1", {{"finder", finder}});
  auto curve = [&](const char* name, const char* field, float value, Scene scene) {
    Errors errors;
    watch_scene(settings, scene, errors);
    Mean mean;
    for (const char* axis : {"35 yaw", "35 pitch", "35 roll"})
      mean.sum += errors.mean[axis].sum, mean.count += errors.mean[axis].count;
    tell(name, mean.value(), "degrees",
         {{"finder", finder},
          {field, value},
          {"position", errors.position.value()},
          {"found", errors.found.value()}});
  };
  const Scene turn{{-35, 0, 0}, {35, 0, 0}};
  for (float distance : {0.5f, 1.f, 1.5f, 2.f, 2.5f, 3.f, 3.5f}) {
    Scene scene = turn;
    scene.distance = distance;
    curve("kiosk.head.by_distance_deg", "metres", std::round(distance * 10) / 10, scene);
  }
  for (float light : {0.25f, 0.5f, 1.f, 1.5f}) {
    Scene scene = turn;
    scene.light = light;
    curve("kiosk.head.by_light_deg", "light", light, scene);
  }
}

// A visitor comes in front of the camera at a distance and stays, hardly moving.
void measure_reach(const MeasureOptions& options, const std::string& finder) {
  for (float distance : {1.f, 2.f, 2.5f, 3.f, 3.5f}) {
    Observer observer(settings_of(options, finder));
    double seen_at = NAN;
    Mean found;
    for (int k = 0; k < int(7 * rate); k++) {
      const double time = k / rate;
      FigurePose pose;
      pose.visible = time >= comes;
      pose.position = {0.05f * std::sin(2 * float(time)), 0, distance};
      const auto seen =
          observer.step(draw_figure({640, 480, 1, 2.5f, uint64_t(k)}, {}, pose, time));
      if (std::isnan(seen_at) && !seen.people.empty()) seen_at = time - comes;
      if (time >= comes + 3) found.add(!seen.people.empty());
    }
    const json fields{{"finder", finder}, {"metres", distance}};
    tell("kiosk.reach.found", found.value(), "1", fields);
    tell("kiosk.reach.seconds", seen_at, "s", fields);
  }
}

struct Clip {
  const char* file;
  bool face;  // one shows in every frame; else in none
};
constexpr Clip clips[] = {{"headtrackr/capture4.mp4", true},
                          {"tracking_js/franck.mp4", true},
                          {"intel_sample_videos/preview/head-pose-face-detection-male.gif", true},
                          {"intel_sample_videos/asl_gestures/again.mkv", true},
                          {"intel_sample_videos/asl_gestures/bird.mkv", true},
                          {"intel_sample_videos/asl_gestures/book.mkv", true},
                          {"intel_sample_videos/asl_gestures/eat.mkv", true},
                          {"intel_sample_videos/asl_gestures/help.mkv", true},
                          {"intel_sample_videos/asl_gestures/hungry.mkv", true},
                          {"intel_sample_videos/asl_gestures/learn.mkv", true},
                          {"intel_sample_videos/car-detection.mp4", false},
                          {"intel_sample_videos/bottle-detection.mp4", false}};
constexpr const char* talking = "tracking_js/franck.mp4";

// Root mean square of what a signal differs from its mean over a quarter of a second about it.
double jitter(const std::vector<float>& values) {
  constexpr int half = 4;
  double sum = 0;
  int count = 0;
  for (int i = half; i + half < int(values.size()); i++) {
    double mean = 0;
    for (int k = -half; k <= half; k++) mean += values[size_t(i + k)] / (2 * half + 1);
    sum += (values[size_t(i)] - mean) * (values[size_t(i)] - mean), count++;
  }
  return count ? std::sqrt(sum / count) : NAN;
}

void measure_clips(const MeasureOptions& options, const std::string& finder) {
  Mean with_face, without;
  for (const Clip& clip : clips) {
    const fs::path file = fs::path(options.data) / "5_faces" / clip.file;
    if (!fs::exists(file)) continue;
    CameraSettings source;
    source.source = file.string();
    auto camera = make_camera(source);
    Observer observer(settings_of(options, finder));
    GrayFrame frame;
    Mean found;
    std::vector<float> angles[3];
    const double most = options.quick ? 15 : 60;
    while (camera->next(frame) == Got::frame && frame.time < most) {
      const auto seen = observer.step(frame);
      if (clip.face && frame.time < 1.5) continue;  // presence wants to be sure
      found.add(!seen.people.empty());
      (clip.face ? with_face : without).add(!seen.people.empty());
      if (!seen.people.empty())
        for (int axis = 0; axis < 3; axis++)
          angles[axis].push_back(seen.people[0].rotation[axis] / degree);
    }
    tell("kiosk.face.clip", found.value(), "1",
         {{"finder", finder},
          {"clip", fs::path(clip.file).filename().string()},
          {"face", clip.face},
          {"frames", found.count}});
    if (std::string(clip.file) == talking)
      for (int axis = 0; axis < 3; axis++)
        tell("kiosk.head.jitter_deg", jitter(angles[axis]), "degrees",
             {{"finder", finder},
              {"axis", axis == 0   ? "yaw"
                       : axis == 1 ? "pitch"
                                   : "roll"}});
  }
  if (with_face.count) tell("kiosk.face.found", with_face.value(), "1", {{"finder", finder}});
  if (without.count) tell("kiosk.face.false", without.value(), "1", {{"finder", finder}});
}

void measure_cost(const MeasureOptions& options, const std::string& finder, bool expression) {
  ObserverSettings settings = settings_of(options, finder);
  settings.expression = expression;
  Observer observer(settings);
  std::vector<GrayFrame> frames;
  for (int k = 0; k < int(8 * rate); k++) {
    const double time = 4 + k / rate;  // the visitor stands
    frames.push_back(draw_figure({640, 480, 1, 2.5f, uint64_t(k)}, {}, figure_at(time), time));
  }
  std::vector<double> walls;
  double spent = 0;
  for (const GrayFrame& frame : frames) {
    const double began = seconds_now(), before = process_seconds();
    observer.step(frame);
    if (frame.time < 4 + settle) continue;
    spent += process_seconds() - before;
    walls.push_back(seconds_now() - began);
  }
  std::sort(walls.begin(), walls.end());
  const json fields{{"finder", finder}, {"expression", expression}};
  const double each = spent / double(walls.size());
  tell("kiosk.frame_ms", 1000 * each, "ms", fields);
  tell("kiosk.cores", each * rate, "1", fields);
  tell("kiosk.frame_p95_ms", 1000 * walls[walls.size() * 95 / 100], "ms", fields);
}

// Tells the time of every graph that lies in the folder, for a picture of its size.
void measure_graphs(const fs::path& folder) {
  std::error_code none;
  std::map<std::string, fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".json") files[entry.path().stem().string()] = entry.path();
  for (const auto& [name, file] : files) {
    GraphNetwork network = open_graph(file.string());
    const GraphNetwork::Input& size = network.input();
    const std::vector<float> picture(size_t(size.rows * size.columns * size.channels), 0.5f);
    std::vector<double> times;
    for (int k = 0; k < 25; k++) {
      const double before = process_seconds();
      network.run(picture);
      times.push_back(process_seconds() - before);
    }
    std::sort(times.begin(), times.end());
    tell("kiosk.graph_ms", 1000 * times[times.size() / 2], "ms", {{"graph", name}});
  }
}

// Compares the mesh of a man who talks with his landmarks: the mean distance at corners of eyes
// and mouth, nose and chin, over that of the eyes.
void measure_mesh(const MeasureOptions& options, const fs::path& graphs) {
  const fs::path file = fs::path(options.data) / "5_faces" / talking;
  if (options.data.empty() || !fs::exists(file) || !fs::exists(graphs)) return;
  constexpr size_t same[][2] = {{33, 36}, {263, 45}, {61, 48}, {291, 54}, {1, 30}, {152, 8}};
  CameraSettings source;
  source.source = file.string();
  auto camera = make_camera(source);
  const auto finder = make_network_finder(options.weights);
  MeshReader reader(graphs.string());
  Mean apart, time;
  GrayFrame frame;
  for (int k = 0; k < (options.quick ? 150 : 900) && camera->next(frame) == Got::frame; k++) {
    if (k % 15 != 0) continue;
    const GrayView view{frame.pixels.data(), frame.width, frame.height};
    for (const Face& face : finder->search(frame)) {
      const FaceMarks& marks = *face.marks;
      const Cut cut = mesh_cut_of_mesh(reader.read(view, mesh_cut_of_marks(marks)));
      const double before = process_seconds();
      const FaceMesh mesh = reader.read(view, cut);
      time.add(1000 * (process_seconds() - before));
      for (const auto& [point, mark] : same)
        apart.add(glm::length(vec2(mesh.points[point]) - marks[mark]) /
                  glm::length(marks[36] - marks[45]));
    }
  }
  const json fields{{"finder", "networks"}};
  tell("kiosk.mesh.apart", apart.value(), "1", fields);
  tell("kiosk.mesh_ms", time.value(), "ms", fields);
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  CLI::App app{"Measures the kiosk's eye for wellspring bench."};
  MeasureOptions options;
  app.add_option("--weights", options.weights, "folder of the networks' weights");
  app.add_option("--data", options.data, "folder of real recordings");
  app.add_flag("--quick", options.quick, "fewer scenes and shorter clips");
  CLI11_PARSE(app, argc, argv);
  log::start("measure");
  cv::setNumThreads(1);
  try {
    for (const std::string finder : {"networks", "cascades"}) {
      if (finder == "networks" && !fs::exists(options.weights)) continue;
      measure_heads(options, finder);
      measure_reach(options, finder);
      if (!options.data.empty()) measure_clips(options, finder);
      measure_cost(options, finder, false);
      if (finder == "networks") measure_cost(options, finder, true);
    }
    const fs::path graphs = fs::path(options.weights).parent_path() / "human";
    measure_graphs(graphs);
    measure_mesh(options, graphs);
    if (fs::exists(options.weights)) measure_prints(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
