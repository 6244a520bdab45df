// SPDX-License-Identifier: Apache-2.0
// denoise.ms: the networks' time for a picture (without encoding its input, which
// denoise.encode_ms is), beside denoise.peak_share, the share of the processor's floating-point
// peak that this is, by the operations that the networks are made of; denoise.bytes: their memory.
// denoise.flip: FLIP of the castle's hall, traced by `path` with few samples a pixel, before
// (net "none") and after, against its converged picture.
#include <algorithm>
#include <oneapi/tbb/info.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "cache_visit_truth.h"
#include "denoise/denoise.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "light/visible/guides.h"
#include "light_scenes.h"
#include "report.h"

namespace wellspring::test {
namespace {

using Vector = float __attribute__((vector_size(32)));

// Multiplications and additions a second of all cores, in chains long enough to hide their delay.
double measure_peak() {
  constexpr int chains = 12, steps = 1 << 22;
  const int cores = int(oneapi::tbb::info::default_concurrency());
  std::vector<float> keep(size_t(cores), 0.0f);
  double best = 0;
  for (int round = 0; round < 3; round++) {
    double began = seconds_now();
    parallel_each(cores, [&](int core) {
      Vector sum[chains], factor = Vector{} + 0.999f, term = Vector{} + float(core + 1);
      for (Vector& one : sum) one = term;
      for (int i = 0; i < steps; i++)
#pragma GCC unroll 12
        for (int k = 0; k < chains; k++) sum[k] = sum[k] * factor + term;
      for (Vector& one : sum) keep[size_t(core)] += one[0];
    });
    double operations = 2.0 * 8 * chains * steps * cores;
    best = std::max(best, operations / (seconds_now() - began));
  }
  return best;
}

struct Input {
  std::vector<vec3> color, albedo, normal;
  int width, height;
  DenoiseInput get() const { return {width, height, color, albedo, normal, 0}; }
};

void time_nets(BenchReport& report, const BenchOptions& options) {
  double peak = measure_peak();
  report.add("denoise.peak", peak * 1e-9, "GFLOP/s");
  for (NetSize size : {NetSize::small, NetSize::base, NetSize::large}) {
    std::string problem;
    auto denoiser = load_denoiser(size, problem);
    if (!denoiser) throw std::runtime_error(problem);
    for (auto [width, height] : {std::pair(640, 360), std::pair(1280, 720)}) {
      if (options.quick && size == NetSize::large && width > 640) continue;
      Input input{{}, {}, {}, width, height};
      size_t pixels = size_t(width) * size_t(height);
      for (size_t i = 0; i < pixels; i++)
        input.color.push_back(vec3(float(i % 97) / 97, float(i % 31) / 31, 0.4f));
      input.albedo.assign(pixels, vec3(0.5f));
      input.normal.assign(pixels, vec3(0, 0, 1));
      std::vector<double> encoding, running;
      for (int round = 0; round < (options.quick ? 3 : 5); round++) {
        double began = seconds_now();
        denoiser->start(input.get());
        double encoded = seconds_now();
        while (denoiser->advance(10)) {}
        encoding.push_back(1000 * (encoded - began));
        running.push_back(1000 * (seconds_now() - encoded));
      }
      nlohmann::json fields = {{"net", net_name(size)}, {"width", width}, {"height", height}};
      double ms = quantile(running, 0.5);
      report.add("denoise.ms", ms, "ms", fields);
      report.add("denoise.encode_ms", quantile(encoding, 0.5), "ms", fields);
      report.add("denoise.peak_share", denoiser->net().operations() / (0.001 * ms) / peak, "",
                 fields);
      report.add("denoise.bytes", double(denoiser->memory_bytes()), "B", fields);
    }
    std::printf("%s runs %s\n", net_name(size), denoiser->net().implementation().c_str());
  }
}

void judge_nets(BenchReport& report, const BenchOptions& options) {
  BenchScene scene = load_bench_scene(options, "castle");
  World world(scene.scene);
  world.commit();
  Lights lights = make_lights(world);
  int width = options.visit_width > 0 ? options.visit_width : 320, height = (width * 9 + 8) / 16;
  View view = bench_view(scene, width, height);
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 64 : 1024;
  truths.folder = truths_folder(options);
  truths.max_depth = scene.max_depth;
  Truth truth = find_truth(world, lights, view, truths);
  report.add("denoise.truth_halves_flip", flip(truth.half[0], truth.half[1]), "FLIP",
             {{"spp", truths.spp}});
  GuidePlanes guides = make_guides(world, lights, view);
  for (int spp : {1, 4, 16}) {
    StillSettings settings;
    settings.spp = spp;
    settings.seed = 99;
    settings.transport.max_depth = scene.max_depth;
    Frame noisy = render_still(*find_technique("path"), world, lights, view, settings);
    auto add = [&](const char* net, const Frame& frame) {
      report.add("denoise.flip", flip(frame, truth.picture), "FLIP",
                 {{"net", net}, {"spp", spp}, {"scene", "castle"}, {"width", width}});
      if (!options.visit_pictures.empty())
        save_picture(
            options.visit_pictures + "/denoise_" + net + "_" + std::to_string(spp) + ".png", frame,
            {});
    };
    add("none", noisy);
    for (NetSize size : {NetSize::small, NetSize::base, NetSize::large}) {
      std::string problem;
      auto denoiser = load_denoiser(size, problem);
      if (!denoiser) throw std::runtime_error(problem);
      Frame clean = noisy;
      denoiser->run({width, height, noisy.color, guides.albedo, guides.normal}, clean.color);
      add(net_name(size), clean);
    }
  }
}

}  // namespace

void bench_denoise_time(BenchReport& report, const BenchOptions& options) {
  time_nets(report, options);
}
void bench_denoise_flip(BenchReport& report, const BenchOptions& options) {
  judge_nets(report, options);
}

}  // namespace wellspring::test
