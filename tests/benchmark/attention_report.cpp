// SPDX-License-Identifier: Apache-2.0
// attention: what predicting where a visitor looks costs, by the size of the picture: the saliency
// of a photograph-like picture (attention.ms), and its objects' measures with two hints, their
// attention and an order of a thousand shares (attention.objects_ms). Medians. Then what it is
// worth: attention_steer.cpp.
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include "attention/task.h"
#include "base/clock.h"
#include "base/rng.h"
#include "report.h"

namespace wellspring::test {
namespace {

// Tilted, coloured ellipses of all sizes over a slope, with a little noise. They are the objects,
// too: hundreds.
struct Scenery {
  Image8 picture;
  std::vector<uint32_t> object;
};
Scenery make_scenery(int size) {
  Scenery made{{size, size, std::vector<uint8_t>(size_t(3 * size * size))},
               std::vector<uint32_t>(size_t(size * size))};
  for (int i = 0; i < size * size; i++)
    for (int c = 0; c < 3; c++)
      made.picture.rgb[size_t(3 * i + c)] =
          uint8_t(60 + 80 * (i / size) / size + int(mix64(uint64_t(3 * i + c)) % 8));
  for (uint32_t n = 1; n <= 400; n++) {
    Rng rng(n);
    vec2 middle = vec2(rng.uniform(), rng.uniform()) * float(size);
    float radius = float(size) * 0.08f * rng.uniform() * rng.uniform() + 2;
    vec3 color = vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 255.0f;
    for (int y = std::max(0, int(middle.y - radius)); float(y) < middle.y + radius; y++)
      for (int x = std::max(0, int(middle.x - radius)); float(x) < middle.x + radius; x++) {
        vec2 off = vec2(float(x), float(y)) - middle;
        if (x >= size || y >= size || glm::length(off + 0.4f * vec2(off.y, 0)) > radius) continue;
        size_t i = size_t(y) * size_t(size) + size_t(x);
        made.object[i] = n;
        for (int c = 0; c < 3; c++) made.picture.rgb[3 * i + size_t(c)] = uint8_t(color[c]);
      }
  }
  return made;
}

template <class Body>
double median_ms(int rounds, const Body& body) {
  body();  // allocates
  std::vector<double> times;
  for (int i = 0; i < rounds; i++) {
    double began = seconds_now();
    body();
    times.push_back(1000 * (seconds_now() - began));
  }
  return quantile(times, 0.5);
}

struct Attention {
  SaliencyWork work;
  SaliencyMap saliency;
  TaskWork task;
  std::vector<SeenObject> seen;
  std::vector<float> attention;
  AttentionOrder winners;
  std::vector<int> order;
};

}  // namespace

void bench_attention(BenchReport& report, const BenchOptions& options) {
  const int rounds = options.quick ? 21 : 201, all = oneapi::tbb::info::default_concurrency();
  for (int size : {256, 512, 1024}) {
    Scenery scenery = make_scenery(size);
    Attention made;
    const std::vector<AttentionHint> hints{{vec2(0.3f * float(size)), 60, 0.8f},
                                           {vec2(0.8f * float(size)), 90, 0.4f}};
    for (int cores : {all, 1}) {
      using oneapi::tbb::global_control;
      global_control limit(global_control::max_allowed_parallelism, size_t(cores));
      nlohmann::json fields = {{"width", size}, {"height", size}, {"cores", cores}};
      double ms =
          median_ms(rounds, [&] { eval_saliency(scenery.picture, made.work, made.saliency); });
      double objects_ms = median_ms(rounds, [&] {
        eval_objects(scenery.object, size, size, made.saliency, hints, made.task, made.seen);
        eval_attention(made.seen, 0.5f, made.attention);
        plan_order(made.attention, 1000, made.winners, made.order);
      });
      report.add("attention.ms", ms, "ms", fields);
      report.add("attention.ns_a_pixel", ms * 1e6 / (double(size) * size), "ns", fields);
      report.add("attention.objects_ms", objects_ms, "ms", fields);
    }
    report.add("attention.memory", double(memory_bytes(made.work)) / 1e6, "MB",
               {{"width", size}, {"height", size}, {"cores", all}});
  }
  bench_attention_steer(report, options);
}

}  // namespace wellspring::test
