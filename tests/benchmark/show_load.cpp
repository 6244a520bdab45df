// SPDX-License-Identifier: Apache-2.0
// show.load: a visitor is led along a guided tour of the castle while the server has few cores,
// idle or wanted by as many busy threads. FLIP of each displayed picture against the truth of the
// pose that it shows, both at 320x180: `path`, reconstructed by the network. So that every
// picture's pose is known exactly, the client sends the tour's poses itself, thirty a second, and
// the packet header tells the last that the picture has followed; the field of view stays that of
// the first stop. (Of turns so quick that four fifths of a warp were unknown, the pose is a
// predicted one.) Beside it: the worst of twenty, pictures a second, the longest time without one,
// keyframes a second, and the time from a pose to its picture. The storytellers are sent away.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <pthread.h>
#include <sched.h>
#include <stdexcept>
#include <thread>

#include "base/clock.h"
#include "cache_visit_truth.h"
#include "denoise/denoise.h"
#include "frame/flip.h"
#include "frame/jpeg.h"
#include "frame/picture_file.h"
#include "frame/tonemap.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_load.h"
#include "show/visit/tour.h"
#include "stream/ws_client.h"
#include "stream_server.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring {
namespace {

constexpr double input_interval = 1.0 / 30;
constexpr int width = 1280, height = 720, shrink = 4;
constexpr int truth_spp = 16;  // of each half
constexpr size_t saved_worst = 6;

using Cores = std::vector<int>;

Cores allowed_cores() {
  cpu_set_t set;
  sched_getaffinity(0, sizeof set, &set);
  Cores cores;
  for (int i = 0; i < CPU_SETSIZE; i++)
    if (CPU_ISSET(i, &set)) cores.push_back(i);
  return cores;
}

void stay_on(const Cores& cores) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int core : cores) CPU_SET(core, &set);
  if (pthread_setaffinity_np(pthread_self(), sizeof set, &set) != 0)
    throw std::runtime_error("cores cannot be chosen");
}

// The server's process inherits the affinity of the thread that starts it.
struct ServerOnCores {
  std::optional<ServerProcess> process;
  ServerOnCores(const BenchOptions& options, const Cores& cores) {
    const Cores all = allowed_cores();
    stay_on(cores);
    process.emplace(options, "castle");
    stay_on(all);
  }
};

// A thread on each core that does nothing but want it.
struct OtherWork {
  std::vector<std::jthread> threads;
  explicit OtherWork(const Cores& cores) {
    for (int core : cores)
      threads.emplace_back([core](std::stop_token stop) {
        stay_on({core});
        for (std::atomic<unsigned> work = 0; !stop.stop_requested();) work++;
      });
  }
};

struct Pose {
  dvec3 position{0};
  float yaw = 0, pitch = 0;
};

// The ways of the exhibit's first tour one after the other, without rests.
std::vector<Pose> tour_poses(const Exhibit& exhibit, const World& world, double seconds) {
  std::vector<Problem> problems;
  TourRoads roads = make_tour_roads(exhibit, world, problems);
  if (roads.legs.empty() || !problems.empty()) throw std::runtime_error("there is no tour");
  std::vector<Pose> poses;
  for (const auto& leg : roads.legs[0])
    for (double t = 0; leg && t < leg->seconds; t += input_interval) {
      if (double(poses.size()) * input_interval >= seconds) return poses;
      Viewpoint at = eval_camera_path(*leg, t);
      poses.push_back({at.position, at.yaw, at.pitch});
    }
  return poses;
}

struct Displayed {
  uint32_t seq = 0;
  double arrived = 0, asked = 0;
  std::vector<uint8_t> jpeg;
};

struct Walk {
  std::vector<Displayed> pictures;  // of the tour, not of the rest before it
  double seconds = 0, keyframes = 0;
};

Walk walk(const ServerProcess& server, const std::vector<Pose>& poses) {
  const double rest = 2;  // before the tour
  WsClient client;
  join_visit(client, server.port, width, height);
  StorytellerOrder away;
  away.visible = false;
  client.send_text(write_message(away));
  auto go_to = [&](uint32_t seq) {
    const Pose& pose = poses[seq - 1];
    client.send_text(write_message(CameraTo{seq, pose.position, pose.yaw, pose.pitch}));
  };
  go_to(1);
  Walk walk;
  std::vector<double> asked{seconds_now()};  // of each seq after the first
  double began = asked[0] + rest, before = 0;
  WsMessage message;
  while (true) {
    double due = began + input_interval * double(asked.size() - 1);
    if (seconds_now() >= due) {
      if (asked.size() >= poses.size()) break;
      if (asked.size() == 1) before = read_metric(server.port, "pictures_drawn_total");
      go_to(uint32_t(asked.size() + 1));
      asked.push_back(seconds_now());
    }
    auto got = client.receive(message, std::clamp(due - seconds_now(), 0.0, 0.03));
    if (got == WsClient::Got::closed) throw std::runtime_error("the server closed the visit");
    auto packet =
        got == WsClient::Got::message && message.binary ? read_packet(message.bytes) : std::nullopt;
    if (!packet) continue;
    client.send_text(write_message(Ack{packet->header.frame, 1, true}));
    uint32_t seq = packet->header.seq;
    if (asked.size() < 2 || seq < 1 || seq > asked.size()) continue;
    walk.pictures.push_back({seq,
                             seconds_now() - began,
                             asked[seq - 1] - began,
                             {packet->payload.begin(), packet->payload.end()}});
  }
  walk.seconds = seconds_now() - began;
  walk.keyframes = read_metric(server.port, "pictures_drawn_total") - before;
  client.close();
  return walk;
}

struct Judge {
  const Exhibit& exhibit;
  const World& world;
  Lights lights;
  std::unique_ptr<Denoiser> denoiser;
  TruthSettings settings;
  std::map<uint32_t, Image8> truths = {};  // by seq

  const Image8& truth(uint32_t seq, const Pose& pose) {
    auto [found, is_new] = truths.try_emplace(seq);
    if (!is_new) return found->second;
    float fov = exhibit.viewpoints[size_t(exhibit.start)].view.fov;
    View view = make_view(exhibit.scene, pose.position, pose.yaw, pose.pitch, fov, width / shrink,
                          height / shrink);
    Frame frame = find_truth(world, lights, view, settings).picture;
    GuidePlanes guides = make_guides(world, lights, view);
    std::vector<vec3> noisy = frame.color;
    denoiser->run({frame.width, frame.height, noisy, guides.albedo, guides.normal}, frame.color);
    tonemap(frame, Tonemap{exhibit.exposure}, found->second);
    return found->second;
  }
};

float decoded(uint8_t code) {
  float x = float(code) / 255;
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}
uint8_t encoded(float x) {
  float code = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return uint8_t(std::lround(255 * std::clamp(code, 0.0f, 1.0f)));
}

// Means of squares of pixels, in linear light.
Image8 shrunk(const Image8& picture) {
  float linear[256];
  for (int i = 0; i < 256; i++) linear[i] = decoded(uint8_t(i));
  Image8 small{picture.width / shrink, picture.height / shrink, {}};
  for (int y = 0; y < small.height; y++)
    for (int x = 0; x < small.width; x++)
      for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int i = 0; i < shrink * shrink; i++) {
          int at = (y * shrink + i / shrink) * picture.width + x * shrink + i % shrink;
          sum += linear[picture.rgb[size_t(3 * at + c)]];
        }
        small.rgb.push_back(encoded(sum / float(shrink * shrink)));
      }
  return small;
}

// So many of them, evenly by their poses, so that those of other runs ask for the same truths.
std::vector<const Displayed*> choose(const Walk& walk, size_t poses, int count) {
  std::vector<const Displayed*> chosen;
  for (int i = 0; i < count; i++) {
    double wanted = (i + 0.5) * double(poses) / count;
    auto far = [&](const Displayed& one) { return std::abs(double(one.seq) - wanted); };
    auto nearest = std::min_element(walk.pictures.begin(), walk.pictures.end(),
                                    [&](auto& a, auto& b) { return far(a) < far(b); });
    if (nearest != walk.pictures.end() && (chosen.empty() || chosen.back() != &*nearest))
      chosen.push_back(&*nearest);
  }
  return chosen;
}

struct Judged {
  const Displayed* picture;
  double flip;
};

void save_worst(const std::string& stem, std::vector<Judged> judged, Judge& judge,
                const std::vector<Pose>& poses) {
  std::sort(judged.begin(), judged.end(), [](auto& a, auto& b) { return a.flip > b.flip; });
  for (size_t i = 0; i < std::min(judged.size(), saved_worst); i++) {
    const Displayed& one = *judged[i].picture;
    std::string name = stem + "_worst" + std::to_string(i) + "_" + std::to_string(one.seq);
    save_image8(name + ".png", decode_jpeg(one.jpeg, "picture"));
    save_image8(name + "_true.png", judge.truth(one.seq, poses[one.seq - 1]));
  }
}

void report_rates(BenchReport& report, const Walk& walk, const nlohmann::json& where) {
  if (walk.pictures.size() < 2) throw std::runtime_error("hardly any picture arrived");
  std::vector<double> gaps, lags, bytes;
  double before = 0;
  for (const Displayed& one : walk.pictures) {
    gaps.push_back(1000 * (one.arrived - before));
    lags.push_back(1000 * (one.arrived - one.asked));
    bytes.push_back(double(one.jpeg.size()));
    before = one.arrived;
  }
  report.add("show.load.fps", double(walk.pictures.size()) / walk.seconds, "1/s", where);
  report.add("show.load.drawn_fps", walk.keyframes / walk.seconds, "1/s", where);
  report.add("show.load.still_gap_ms", quantile(gaps, 1), "ms", where);
  report.add("show.load.latency_ms", quantile(lags, 0.5), "ms", where);
  report.add("show.load.picture_bytes", quantile(bytes, 0.5), "B", where);
}

void report_errors(BenchReport& report, const BenchOptions& options, const Walk& walk,
                   const std::vector<Pose>& poses, Judge& judge, const nlohmann::json& where) {
  std::vector<double> flips;
  int count = options.visit_instants > 0 ? options.visit_instants
              : options.quick            ? 24
                                         : int(poses.size());
  std::vector<Judged> judged;
  for (const Displayed* one : choose(walk, poses.size(), count)) {
    Image8 shown = shrunk(decode_jpeg(one->jpeg, "picture"));
    double error = eval_flip(shown, judge.truth(one->seq, poses[one->seq - 1])).mean;
    judged.push_back({one, error});
    flips.push_back(error);
  }
  double sum = 0;
  for (double error : flips) sum += error;
  nlohmann::json fields = where;
  fields["judged"] = flips.size(), fields["spp"] = 2 * judge.settings.spp;
  report.add("show.load.flip", sum / double(flips.size()), "FLIP", fields);
  report.add("show.load.flip_worst", quantile(flips, 0.95), "FLIP", fields);
  if (options.visit_pictures.empty()) return;
  std::filesystem::create_directories(options.visit_pictures);
  std::string stem = options.visit_pictures + "/show_load_" + where["cores"].dump() +
                     (where["busy"].get<bool>() ? "_busy" : "_idle");
  save_worst(stem, judged, judge, poses);
}

Judge make_judge(const Exhibit& exhibit, const World& world, const BenchOptions& options) {
  std::string problem;
  auto denoiser = load_denoiser(NetSize::base, problem);
  if (!denoiser) throw std::runtime_error(problem);
  TruthSettings settings;
  settings.spp = options.visit_spp > 0 ? options.visit_spp : truth_spp;
  settings.folder = truths_folder(options);
  return {exhibit, world, make_lights(world), std::move(denoiser), settings};
}

}  // namespace

void bench_show_load(BenchReport& report, const BenchOptions& options) {
  const double seconds = 10;
  Exhibit exhibit = load_exhibit(options.content + "/castle");
  World world(exhibit.scene);
  world.commit();
  Judge judge = make_judge(exhibit, world, options);
  const std::vector<Pose> poses = tour_poses(exhibit, world, seconds);
  const Cores all = allowed_cores();
  struct Run {
    size_t cores;
    bool busy;
    Walk walk;
    nlohmann::json where() const { return {{"cores", cores}, {"busy", busy}}; }
  };
  std::vector<Run> runs;
  for (size_t cores : {1, 2, 4})
    for (bool busy : {false, true}) {
      if (options.quick && (cores == 4 || (cores == 1) != busy)) continue;
      if (cores > all.size()) {
        if (!busy)
          std::printf("show.load: left out with %zu cores: there are %zu\n", cores, all.size());
        continue;
      }
      const Cores some(all.begin(), all.begin() + long(cores));
      ServerOnCores server(options, some);
      OtherWork other(busy ? some : Cores{});
      runs.push_back({cores, busy, walk(*server.process, poses)});
      report_rates(report, runs.back().walk, runs.back().where());
    }
  for (const Run& run : runs) report_errors(report, options, run.walk, poses, judge, run.where());
}

}  // namespace wellspring
