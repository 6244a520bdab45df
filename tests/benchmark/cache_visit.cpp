// SPDX-License-Identifier: Apache-2.0
#include "cache_visit.h"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/load_error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "cache_visit_judge.h"
#include "cache_visit_stage.h"
#include "cache_visit_truth.h"
#include "frame/picture_file.h"
#include "frame/tonemap.h"
#include "image/image.h"
#include "judge/flip.h"

namespace wellspring::test {
namespace {

// A misspelt name would measure nothing and take minutes to say so.
void refuse_unknown_names(const VisitSettings& settings, const std::vector<VisitTrace>& traces) {
  auto named = [&](const VisitTrace& trace) { return trace.name == settings.only; };
  if (!settings.only.empty() && std::none_of(traces.begin(), traces.end(), named))
    throw LoadError(settings.traces, settings.only + ".json", "there is no such visit");
  for (const std::string& method : settings.methods) {
    auto same = [&](const VisitMethodEntry& entry) { return entry.name == method; };
    std::span<const VisitMethodEntry> all = visit_methods();
    if (std::none_of(all.begin(), all.end(), same))
      throw LoadError("--visit-method", method, "there is no such way to keep the picture up");
  }
}

constexpr double settled_after =
    2;  // seconds at rest until the reference takes over, as show/picture

// One method at one budget, on its way through a trace.
struct Running {
  std::unique_ptr<VisitMethod> method;
  int budget = 0;
  VisitPicture picture;
  Image8 image, image_before;
  VisitRun run;
};

std::vector<Running> start_runs(const VisitSettings& settings, const VisitTrace& trace) {
  std::vector<Running> runs;
  for (const VisitMethodEntry& entry : visit_methods()) {
    const auto& asked = settings.methods;
    bool named = std::find(asked.begin(), asked.end(), entry.name) != asked.end();
    if (asked.empty() ? entry.when_named : !named) continue;
    for (int mismatch : settings.mismatches) {
      Running& running = runs.emplace_back();
      running.method = entry.make();
      running.budget = std::max(settings.width * settings.height / mismatch, 1);
      running.run.trace = trace.name;
      running.run.method = entry.name;
      running.run.mismatch = mismatch;
    }
  }
  return runs;
}

std::vector<int> judged_frames(const VisitSettings& settings, const VisitTrace& trace) {
  std::vector<int> frames;
  for (int i = 0; i < settings.instants; i++)
    frames.push_back(
        int(std::lround(trace_seconds(trace) * (i + 0.5) / settings.instants * visit_rate)));
  return frames;
}

bool sees_motion(const TrueView& seen) {
  return std::any_of(seen.where.begin(), seen.where.end(),
                     [](const Hit& hit) { return hit.valid(); });
}

Image8 through_jpeg(const Image8& image, int quality) {
  std::vector<uint8_t> bytes;
  encode_jpeg(image, quality, false, bytes);
  return decode_jpeg(bytes, "a picture just made");
}

// Holds what a trace's cameras have seen so far: this frame and the one before.
struct PrimaryHit {
  TrueView now, before;
  std::vector<vec2> motion;
};

void judge(const VisitSettings& settings, const VisitTrace& trace, double time, float exposure,
           const Truth& truth, std::vector<Running>& runs) {
  Image8 wanted, half[2];
  tonemap(truth.picture, Tonemap{exposure}, wanted);
  for (int i = 0; i < 2; i++) tonemap(truth.half[i], Tonemap{exposure}, half[i]);
  auto save = [&](const std::string& what, const Image8& image) {
    char at[16];
    std::snprintf(at, sizeof at, "%05.2f", time);
    save_image8(settings.pictures + "/" + trace.name + "_" + at + "_" + what + ".png", image);
  };
  if (!settings.pictures.empty()) save("wanted", wanted);
  parallel_for(int(runs.size()), [&](int i) {
    Running& running = runs[size_t(i)];
    Image8 compressed = through_jpeg(running.image, settings.jpeg_quality);
    VisitInstant instant;
    instant.time = time;
    instant.flip = eval_flip(running.image, wanted).mean;
    instant.flip_jpeg = eval_flip(compressed, wanted).mean;
    instant.rmse = display_rmse(running.image, half[0], half[1]);
    instant.rmse_jpeg = display_rmse(compressed, half[0], half[1]);
    running.run.instants.push_back(instant);
  });
  if (!settings.pictures.empty())
    for (const Running& running : runs)
      save(running.run.method + "_" + std::to_string(running.run.mismatch), running.image);
}

void add_noise(const Truth& truth, float exposure, TruthNoise& noise, int instants) {
  Image8 half[2];
  for (int i = 0; i < 2; i++) tonemap(truth.half[i], Tonemap{exposure}, half[i]);
  noise.flip += eval_flip(half[0], half[1]).mean / instants;
  noise.rmse += display_rmse(half[0], half[1]) / instants;
}

void step(const VisitMoment& moment, const PrimaryHit& seen, float exposure, Running& running) {
  running.method->show(moment, running.budget, running.picture);
  std::swap(running.image, running.image_before);
  tonemap(running.picture.frame, Tonemap{exposure}, running.image);
  VisitFrame frame;
  frame.empty = float(running.picture.empty);
  frame.stats = running.picture.stats;
  frame.wrong_surface = float(wrong_surface_share(seen.now, running.picture.frame.object));
  frame.temporal =
      moment.frame == 0
          ? NAN
          : float(motion_compensated_error(running.image, running.image_before, seen.motion));
  running.run.frames.push_back(frame);
}

void simulate(const VisitSettings& settings, VisitStage& stage, const VisitTrace& trace,
              const TruthSettings& truths, VisitResult& result) {
  std::vector<Running> runs = start_runs(settings, trace);
  std::vector<int> judged = judged_frames(settings, trace);
  TruthNoise noise{trace.name};
  int frames = judged.back() + 1, found = 0;
  float exposure = stage.exhibit().exposure;
  const ShowSettings& show = stage.settings();
  double moved_at = 0;
  PrimaryHit seen;
  stage.begin(trace);
  for (int i = 0; i < frames; i++) {
    double time = i / visit_rate;
    stage.advance(trace, time, i == 0 ? 0 : float(1 / visit_rate));
    std::swap(seen.now, seen.before);
    View view = stage.view(trace, time, settings.width, settings.height);
    stage.see(view, seen.now);
    bool moved = i == 0 || view != seen.before.view;
    if (moved) moved_at = time;
    if (i > 0)
      seen.motion = motion_vectors(seen.now, seen.before,
                                   [&](const Hit& hit) { return stage.moved_back(hit); });
    Lights lights = stage.lights();
    VisitMoment moment;
    moment.world = &stage.world();
    moment.lights = &lights;
    moment.maps = std::exchange(lights.maps, nullptr);
    moment.change = stage.change();
    bool settled = time - moved_at > settled_after;
    moment.technique = settled ? &stage.still_technique() : &stage.moving_technique();
    moment.transport = show.transport;
    if (!settled) moment.transport.clamp = show.moving_clamp;
    moment.view = view;
    moment.changed = moved || stage.change() || sees_motion(seen.now) || sees_motion(seen.before);
    moment.frame = i;
    moment.seed = mix64(uint64_t(i + 1) * 0x9e3779b9u + 1);
    parallel_for(int(runs.size()), [&](int r) {
      // A thread that waits for its samples does not begin another run meanwhile.
      oneapi::tbb::this_task_arena::isolate([&] { step(moment, seen, exposure, runs[size_t(r)]); });
    });
    if (std::find(judged.begin(), judged.end(), i) == judged.end()) continue;
    Truth truth = find_truth(stage.world(), lights, view, truths);
    found += truth.kept;
    judge(settings, trace, time, exposure, truth, runs);
    add_noise(truth, exposure, noise, settings.instants);
  }
  log::info("visit '{}': {} frames, {} of {} converged pictures were kept", trace.name, frames,
            found, settings.instants);
  for (Running& running : runs) result.runs.push_back(std::move(running.run));
  result.noise.push_back(noise);
}

}  // namespace

VisitResult simulate_visits(const VisitSettings& settings) {
  std::vector<VisitTrace> traces = load_visit_traces(settings.traces);
  refuse_unknown_names(settings, traces);
  VisitStage stage(settings.exhibit, settings.technique);
  TruthSettings truths;
  truths.spp = settings.truth_spp;
  truths.max_depth = stage.settings().transport.max_depth;
  truths.content = hash_files(settings.exhibit);
  truths.folder = settings.truths;
  if (!settings.pictures.empty()) std::filesystem::create_directories(settings.pictures);
  VisitResult result;
  for (const VisitTrace& trace : traces)
    if (settings.only.empty() || settings.only == trace.name)
      simulate(settings, stage, trace, truths, result);
  return result;
}

VisitInstant mean_instant(const VisitRun& run) {
  VisitInstant mean;
  double share = 1 / double(std::max<size_t>(run.instants.size(), 1));
  for (const VisitInstant& instant : run.instants) {
    mean.flip += share * instant.flip;
    mean.flip_jpeg += share * instant.flip_jpeg;
    mean.rmse += share * instant.rmse;
    mean.rmse_jpeg += share * instant.rmse_jpeg;
  }
  return mean;
}

VisitFrame mean_frame(const VisitRun& run, double from) {
  double temporal = 0, wrong = 0, empty = 0, fresh = 0, reprojected = 0, filled = 0, age = 0;
  int frames = 0, compared = 0;
  for (size_t i = 0; i < run.frames.size(); i++) {
    if (double(i) / visit_rate < from) continue;
    const VisitFrame& frame = run.frames[i];
    frames++;
    if (!std::isnan(frame.temporal)) temporal += frame.temporal, compared++;
    wrong += frame.wrong_surface;
    empty += frame.empty;
    fresh += frame.stats.fresh;
    reprojected += frame.stats.reprojected;
    filled += frame.stats.filled;
    age += frame.stats.mean_age;
  }
  auto mean = [](double sum, int count) { return count > 0 ? float(sum / count) : NAN; };
  VisitFrame result;
  result.temporal = mean(temporal, compared);
  result.wrong_surface = mean(wrong, frames);
  result.empty = mean(empty, frames);
  result.stats.fresh = mean(fresh, frames);
  result.stats.reprojected = mean(reprojected, frames);
  result.stats.filled = mean(filled, frames);
  result.stats.mean_age = mean(age, frames);
  return result;
}

double mean_flip(const VisitResult& result, const std::string& method, int mismatch) {
  double sum = 0;
  int count = 0;
  for (const VisitRun& run : result.runs)
    if (run.method == method && run.mismatch == mismatch) sum += mean_instant(run).flip, count++;
  return count > 0 ? sum / count : NAN;
}

}  // namespace wellspring::test
