// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "avatar/figure/figure_check.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

TEST(Describe, JsonSaysWhatTheFigureIs) {
  Character c = test::load_text(test::whole_figure());
  nlohmann::json j = nlohmann::json::parse(describe_json(c));
  EXPECT_EQ(j["name"], "Whole");
  EXPECT_EQ(j["loa"], 0);
  ASSERT_EQ(j["joints"].size(), c.joints.size());
  EXPECT_EQ(j["joints"][0]["parent"], nullptr);
  EXPECT_EQ(j["joints"][1]["parent"], "humanoid_root");
  EXPECT_EQ(j["joints"][1]["center"][1], 0.865) << "0.93, and the figure was put on the floor";
  EXPECT_EQ(j["displacers"].size(), 9u);
  EXPECT_EQ(j["segments"].size(), c.joints.size());
  EXPECT_TRUE(j["unknown_joints"].empty());
  EXPECT_FALSE(j["warnings"].empty()) << "the file claims LOA 1 and lacks the feet";
  EXPECT_EQ(j["skin"]["vertices"], c.positions.size());
}

TEST(Describe, NamesThatAreNoUtf8DoNotBreakTheJson) {
  Character c = test::load_text(test::small_skin());
  c.name = "\xff\xfe bad";
  c.joints[1].name = "strange \xc3";
  nlohmann::json j = nlohmann::json::parse(describe_json(c));
  EXPECT_EQ(j["unknown_joints"].size(), 1u);
  EXPECT_NE(describe_text(c).find("not H-Anim"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
