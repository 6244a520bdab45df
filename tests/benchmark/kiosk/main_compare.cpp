// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk_compare: what the kiosk's eye could have been made of otherwise, and what the
// whole program costs, for `wellspring bench --only kiosk.eye`, which starts it.
#include "about/version.h"
#include "main_compare.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <opencv2/core/utility.hpp>

#include "base/log.h"

namespace wellspring::test {

double mean(const std::vector<double>& values) {
  return values.empty()
             ? NAN
             : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

}  // namespace wellspring::test

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::test;
  if (answer_version(argc, argv, {"Boost", "CLI11", "GLM", "nlohmann-json", "stb"})) return 0;
  CLI::App app{"Compares parts of the kiosk's eye for wellspring bench."};
  CompareOptions options;
  app.add_option("--weights", options.weights, "folder of the networks' weights");
  app.add_option("--data", options.data, "folder of real recordings");
  app.add_option("--kiosk", options.kiosk, "the kiosk's program")->required();
  app.add_flag("--quick", options.quick, "fewer scenes and shorter runs");
  CLI11_PARSE(app, argc, argv);
  log::start("compare");
  cv::setNumThreads(1);
  try {
    compare_filters(options);
    compare_landmarks(options);
    measure_way(options);
    measure_memory(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
