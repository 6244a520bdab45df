// SPDX-License-Identifier: Apache-2.0
// The networks against the package that they come from. reference.json is what the package itself
// computes; make_reference.mjs beside it made it.
#include "base/layers.h"
#include "kiosk/network/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

const fs::path weights = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "face";

int level(int which, int x, int y, int c) {
  if (which == 0) return (x * 7 + y * 13 + c * 29 + x * y % 31 * 5) % 256;
  const int u = x - 56, v = y - 56;
  return std::max(0, 230 - (u * u + 2 * v * v) / 40 - c * 10);
}

NetworkInput picture(int which, int side) {
  NetworkInput input{side, side, {}};
  for (int c = 0; c < 3; c++)
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++) input.planes.push_back(float(level(which, x, y, c)));
  return input;
}

class Networks : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(weights)) GTEST_SKIP() << weights << " is not here; ./wellspring installs it";
    std::ifstream in(fs::path(WELLSPRING_SOURCE) / "tests/unit/kiosk/network/reference.json");
    reference = nlohmann::json::parse(in).at("pictures");
    ASSERT_EQ(reference.size(), 2u);
  }
  nlohmann::json reference;
};

void expect_near(const std::vector<float>& found, const std::vector<float>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t i = 0; i < found.size(); i++) ASSERT_NEAR(found[i], wanted[i], 1e-3) << "at " << i;
}

TEST_F(Networks, landmarks_are_those_of_the_package) {
  Network network = load_face_landmarks(weights.string());
  for (int which : {0, 1})
    expect_near(network.run(picture(which, marks_side)), reference[size_t(which)]["landmarks"]);
}

TEST_F(Networks, expressions_are_those_of_the_package) {
  Network network = load_face_expression(weights.string());
  for (int which : {0, 1})
    expect_near(network.run(picture(which, marks_side)), reference[size_t(which)]["expression"]);
}

TEST_F(Networks, boxes_are_those_of_the_package) {
  Network network = load_face_detector(weights.string());
  for (int which : {0, 1}) {
    // The package has the 25 values of a cell side by side, OpenCV has planes.
    const std::vector<float> cells = reference[size_t(which)]["detector"];
    std::vector<float> planes(cells.size());
    for (size_t cell = 0; cell < 16; cell++)
      for (size_t k = 0; k < 25; k++) planes[k * 16 + cell] = cells[cell * 25 + k];
    expect_near(network.run(picture(which, 128)), planes);
  }
}

TEST_F(Networks, a_picture_of_another_size_is_refused) {
  Network marks = load_face_landmarks(weights.string());
  EXPECT_THROW(marks.run(picture(0, 96)), std::invalid_argument);
  Network detector = load_face_detector(weights.string());
  EXPECT_THROW(detector.run(picture(0, 100)), std::invalid_argument);
  NetworkInput torn = picture(0, 128);
  torn.planes.pop_back();
  EXPECT_THROW(detector.run(torn), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
