// SPDX-License-Identifier: Apache-2.0
// The scenes that techniques are compared on: the castle and the benchmark's own
// (tests/benchmark/scenes, made by the script beside them).
#pragma once
#include "report.h"
#include "world/view.h"

namespace wellspring::test {

struct BenchScene {
  std::string name, about;
  Scene scene;
  Viewpoint camera;
  int max_depth = 8;
};

// Every scene there is, in the report's order. Throws LoadError.
std::vector<BenchScene> load_bench_scenes(const BenchOptions& options);
BenchScene load_bench_scene(const BenchOptions& options, const std::string& name);
View bench_view(const BenchScene& scene, int width, int height);

}  // namespace wellspring::test
