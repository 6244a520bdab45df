// SPDX-License-Identifier: Apache-2.0
// Networks of the package @vladmandic/human against the package itself. reference.json is what it
// computes; make_reference.mjs beside it made it.
#include "kiosk/network/graph/graph_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

std::vector<float> formula_picture(const GraphNetwork::Input& size) {
  std::vector<float> planes;
  for (int c = 0; c < size.channels; c++)
    for (int y = 0; y < size.rows; y++)
      for (int x = 0; x < size.columns; x++)
        planes.push_back(float((x * 7 + y * 13 + c * 29 + x * y % 31 * 5) % 256) / 255);
  return planes;
}

void expect_close(double found, double wanted) { EXPECT_NEAR(found, wanted, 1e-3); }

class GraphReference : public testing::TestWithParam<const char*> {};

TEST_P(GraphReference, OutputsAreThoseOfThePackage) {
  const fs::path folder = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "human";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here; ./wellspring installs it";
  std::ifstream in(fs::path(WELLSPRING_SOURCE) / "tests/unit/kiosk/network/graph/reference.json");
  const nlohmann::json wanted = nlohmann::json::parse(in).at(GetParam());
  GraphNetwork network = open_graph((folder / (std::string(GetParam()) + ".json")).string());
  const Tensors outputs = network.run(formula_picture(network.input()));
  ASSERT_EQ(outputs.size(), wanted.size());
  for (const auto& [name, about] : wanted.items()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(outputs.contains(name));
    const std::vector<float>& values = outputs.at(name).values;
    EXPECT_EQ(outputs.at(name).shape, about["shape"].get<std::vector<int>>());
    expect_close(std::accumulate(values.begin(), values.end(), 0.0) / double(values.size()),
                 about["mean"]);
    const size_t step = about["step"];
    for (size_t i = 0; i < about["values"].size(); i++) {
      ASSERT_LT(i * step, values.size());
      expect_close(values[i * step], about["values"][i]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Human, GraphReference,
                         testing::Values("facemesh", "handlandmark-lite", "iris"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace wellspring::test
