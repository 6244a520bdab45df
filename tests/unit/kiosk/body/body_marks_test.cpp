// SPDX-License-Identifier: Apache-2.0
// Decodes bodies as the package @vladmandic/human does (reference.json), and refuses damaged files.
#include "kiosk/body/body_marks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "unit/folder.h"
#include "unit/kiosk/body/made_body.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

const fs::path weights = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "human";

TEST(BodyMarks, AreThoseOfThePackage) {
  if (!fs::exists(weights / "movenet-lightning.json"))
    GTEST_SKIP() << weights << " is not here; ./wellspring installs it";
  std::ifstream in(fs::path(WELLSPRING_SOURCE) / "tests/unit/kiosk/network/graph/reference.json");
  const nlohmann::json wanted =
      nlohmann::json::parse(in).at("movenet-lightning").at("Identity").at("values");
  constexpr int side = 192;
  std::vector<uint8_t> pixels;
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++)
      pixels.push_back(uint8_t((x * 7 + y * 13 + x * y % 31 * 5) % 256));
  BodyReader reader(weights.string());
  const auto found =
      reader.read({pixels.data(), side, side}, {}, {{side / 2, side / 2}, side, side, 0}, 3);
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(wanted.size(), 3 * body_points);
  for (size_t k = 0; k < body_points; k++) {
    const BodyMark& mark = found[0].points[k];
    EXPECT_NEAR(mark.pixel.y / side, wanted[3 * k], 1e-3) << k;
    EXPECT_NEAR(mark.pixel.x / side, wanted[3 * k + 1], 1e-3) << k;
    EXPECT_NEAR(mark.score, wanted[3 * k + 2], 1e-3) << k;
  }
}

TEST(BodyMarks, FilesThatAreCutOffAreRefused) {
  if (!fs::exists(weights / "movenet-lightning.json"))
    GTEST_SKIP() << weights << " is not here; ./wellspring installs it";
  const Folder folder;
  const std::string name = "movenet-lightning";
  EXPECT_THROW(BodyReader(folder.file("")), LoadError);
  for (const char* kind : {".json", ".bin"})
    fs::copy_file(weights / (name + kind), folder.file(name + kind));
  fs::resize_file(folder.file(name + ".bin"), fs::file_size(weights / (name + ".bin")) / 2);
  try {
    BodyReader reader(folder.file(""));
    ADD_FAILURE() << "no error";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find(name + ".bin"), std::string::npos) << error.what();
  }
  fs::resize_file(folder.file(name + ".json"), 1000);
  EXPECT_THROW(BodyReader(folder.file("")), LoadError);
}

TEST(BodyMarks, TheSquareHoldsTheBody) {
  for (float z : {1.f, 3.f, 6.f}) {
    MadeBody body;
    body.feet.z = z;
    const BodyMarks marks = marks_of(body);
    const Cut cut = body_cut(marks);
    EXPECT_GT(cut.width, 0);
    for (const BodyMark& mark : marks.points) {
      if (mark.score < least_point_score) continue;
      EXPECT_LT(std::abs(mark.pixel.x - cut.middle.x), cut.width / 2);
      EXPECT_LT(std::abs(mark.pixel.y - cut.middle.y), cut.height / 2);
    }
  }
  EXPECT_EQ(body_cut(BodyMarks{}).width, 0);
}

}  // namespace
}  // namespace wellspring::test
