// SPDX-License-Identifier: Apache-2.0
// attention.steer: a visitor jumps to a place of the castle and points at a thing. How many samples
// does it take until that thing is as good as it becomes without attention, and what does the rest
// of the picture pay? FLIP against the converged `path` of that view, over the thing's pixels and
// over all; means over seeds. Samples are those that a renderer of 2 million a second has for each
// pixel of 1280x720; pictures are smaller, with as many samples a pixel.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "attention/task.h"
#include "base/rng.h"
#include "cache_visit_truth.h"
#include "judge/flip.h"
#include "light_scenes.h"
#include "picture/compositor.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr double rate = 60, samples_a_second = 2e6, full_pixels = 1280.0 * 720.0;
constexpr int analysed_every = 3;   // pictures
constexpr int still_from = 15;      // pictures, as show/draw
constexpr float seen_well = 0.05f;  // FLIP

struct Target {
  const char *viewpoint, *thing;
};
constexpr Target targets[] = {{"crown", "crown"}, {"figure", "horse"}};

struct SteeredScenery {
  const World& world;
  const Lights& lights;
  const VisibilityPass& visibility;
  View view;
  const Truth& truth;
  int max_depth;
  uint32_t object;
  std::vector<size_t> pixels;  // pixels that show the object
};

// Holds one run's error after so many samples a pixel.
struct Curve {
  std::vector<double> samples, thing, whole;
};

double mean_over(const FlipMap& map, const std::vector<size_t>& pixels) {
  double sum = 0;
  for (size_t i : pixels) sum += double(map.error[i]);
  return sum / double(pixels.size());
}

// Holds the show's analysis of a picture whose visitor points at the object.
struct Analysis {
  SaliencyWork work;
  SaliencyMap saliency;
  TaskWork task;
  std::vector<SeenObject> seen;
  std::vector<float> attention, weights;
  Image8 picture;

  void run(const Frame& shown, const SteeredScenery& at, float task_weight) {
    tonemap(shown, {}, picture);
    const size_t middle = at.pixels[at.pixels.size() / 2], width = size_t(at.view.width);
    const AttentionHint pointer{vec2(float(middle % width) + 0.5f, float(middle / width) + 0.5f),
                                0.02f * float(width), 1};
    eval_saliency(picture, work, saliency);
    eval_objects(shown.object, at.view.width, at.view.height, saliency, std::span(&pointer, 1),
                 task, seen);
    eval_attention(seen, task_weight, attention);
    eval_weights(seen, attention, weights);
  }
};

std::vector<size_t> find_pixels(const VisibilityPass& visibility, const View& view,
                                uint32_t object) {
  std::vector<uint8_t> shows(size_t(view.width) * size_t(view.height), 0);
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    for (int i = 0; i < run.count; i++)
      shows[size_t(run.y) * size_t(view.width) + size_t(run.x + i)] = run.object[i] == object;
  });
  std::vector<size_t> pixels;
  for (size_t i = 0; i < shows.size(); i++)
    if (shows[i]) pixels.push_back(i);
  return pixels;
}

// Says how samples are traced for a visitor who has just come, and for one who stands.
struct Answers {
  const char* technique;
  float clamp;  // as ShowSettings
  double most;  // samples a pixel
};
constexpr Answers answers[] = {{"gather", 4, 2}, {"path", 12, 4}};

// `task_weight` below 0: without attention.
Curve run(const SteeredScenery& at, const Answers& by, float task_weight, uint64_t seed,
          double most) {
  RenderCache cache;
  Compositor compositor;
  Analysis analysis;
  Frame shown;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Curve curve;
  const double pixels = double(at.view.width) * double(at.view.height);
  double owed = 0, spent = 0;
  const Technique& technique = *find_technique(by.technique);
  TransportSettings transport;
  transport.max_depth = at.max_depth;
  transport.clamp = by.clamp;
  cache.set_reference(technique.name == std::string("path"));
  cache.resize(at.view.width, at.view.height);
  for (int frame = 0; spent < most * pixels; frame++) {
    owed += samples_a_second / rate * pixels / full_pixels;
    const int budget = int(owed);
    owed -= budget, spent += budget;
    cache.move_points(at.world);
    cache.project(at.view);
    cache.attend();
    cache.plan(at.view, budget, mix64(seed + uint64_t(frame) * 0x9e3779b9u), requests);
    samples.resize(requests.size());
    trace(technique, at.world, at.lights, transport, requests, samples);
    cache.remember(at.view, requests, samples);
    compositor.follow_changes(cache);
    if (frame < still_from) {
      compositor.draw(cache, at.view, at.visibility, shown);
    } else {
      compositor.add_samples(at.view, requests, samples);
      compositor.draw_still(cache, at.view, at.visibility, shown);
    }
    if (task_weight >= 0 && frame % analysed_every == 0) {
      analysis.run(shown, at, task_weight);
      cache.set_weights(analysis.weights);
    }
    FlipMap map = eval_flip(shown, at.truth.picture);
    curve.samples.push_back(spent / pixels);
    curve.thing.push_back(mean_over(map, at.pixels));
    curve.whole.push_back(map.mean);
  }
  return curve;
}

// The mean of runs of the same pictures.
Curve run_all(const SteeredScenery& at, const Answers& by, float task_weight, bool quick) {
  const int seeds = quick ? 1 : 3;
  const double most = quick ? 0.5 * by.most : by.most;
  Curve mean;
  for (int seed = 1; seed <= seeds; seed++) {
    Curve one = run(at, by, task_weight, mix64(uint64_t(seed)), most);
    if (seed == 1) mean = {one.samples, {}, {}};
    mean.thing.resize(one.thing.size()), mean.whole.resize(one.whole.size());
    for (size_t i = 0; i < one.thing.size(); i++) {
      mean.thing[i] += one.thing[i] / seeds;
      mean.whole[i] += one.whole[i] / seeds;
    }
  }
  return mean;
}

// Samples a pixel of the picture after which an error is not above `wanted`; NaN: never.
double samples_to(const Curve& curve, const std::vector<double>& error, double wanted) {
  for (size_t i = 0; i < error.size(); i++)
    if (error[i] <= wanted) return curve.samples[i];
  return std::nan("");
}

void compare(BenchReport& report, const Target& target, const SteeredScenery& at, const Answers& by,
             bool quick) {
  const Curve even = run_all(at, by, -1, quick);
  double wanted = std::max(double(seen_well), even.thing.back());
  const double even_samples = samples_to(even, even.thing, wanted);
  nlohmann::json fields = {
      {"thing", target.thing},
      {"thing_share", double(at.pixels.size()) / double(at.view.width) / double(at.view.height)},
      {"technique", by.technique},
      {"wanted", wanted},
      {"order", "without attention"}};
  auto tell = [&](const Curve& curve, double samples) {
    report.add("attention.steer.samples", samples, "a pixel", fields);
    report.add("attention.steer.ratio", samples / even_samples, "1", fields);
    report.add("attention.steer.flip", curve.thing.back(), "FLIP", fields);
    report.add("attention.steer.whole_flip", curve.whole.back(), "FLIP", fields);
    report.add("attention.steer.whole_ratio", curve.whole.back() / even.whole.back(), "1", fields);
  };
  tell(even, even_samples);
  for (float task_weight : {0.0f, 0.5f, 1.0f}) {
    const Curve curve = run_all(at, by, task_weight, quick);
    fields["order"] = task_weight == 0   ? "what catches the eye"
                      : task_weight == 1 ? "what is looked at"
                                         : "half of each";
    tell(curve, samples_to(curve, curve.thing, wanted));
  }
}

}  // namespace

void bench_attention_steer(BenchReport& report, const BenchOptions& options) {
  BenchScene scene = load_bench_scene(options, "castle");
  const Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
  World world(scene.scene);
  world.commit();
  Lights lights = make_lights(world);
  for (const Target& target : targets) {
    int viewpoint = find_viewpoint(castle, target.viewpoint);
    const PointOfInterest* thing = find_point(castle, target.thing);
    if (viewpoint < 0 || !thing || thing->objects.empty()) continue;
    scene.camera = castle.viewpoints[size_t(viewpoint)].view;
    const int width = options.visit_width > 0 ? options.visit_width : 192;
    const View view = bench_view(scene, width, (width * 9 + 8) / 16);
    find_technique("gather")->prepare(world, std::span(&view.position, 1), lights);
    VisibilityPass visibility(world, lights);
    TruthSettings truths;
    truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 64 : 256;
    truths.folder = truths_folder(options);
    truths.max_depth = scene.max_depth;
    const Truth truth = find_truth(world, lights, view, truths);
    SteeredScenery at{
        world, lights, visibility, view, truth, scene.max_depth, thing->objects.front(), {}};
    at.pixels = find_pixels(visibility, view, thing->objects.front());
    if (at.pixels.empty()) continue;
    for (const Answers& by : answers) compare(report, target, at, by, options.quick);
  }
}

}  // namespace wellspring::test
