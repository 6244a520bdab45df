// SPDX-License-Identifier: Apache-2.0
// How large a visitor's pictures may be, where others have their seats.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct PictureSize : testing::Test, ShowStage {
  std::shared_ptr<Capacity> capacity =
      std::make_shared<Capacity>(CapacitySettings{.cores = 64, .memory = 4 * visitor_bytes(0)});

  void SetUp() override {
    begin(make_tiny_exhibit(), settings_for("direct"));
    for (int i = 0; i < 2; i++) {
      browsers.push_back({std::make_shared<Link>(i + 1, LinkKind::visit, "test")});
      arrivals.put(browsers.back().link, capacity->find_seat(32 * 32));
      say(R"({"type":"hello","width":32,"height":32})", size_t(i));
      run(0.5);
    }
  }
};

TEST_F(PictureSize, GrowsOnlyWhereThereIsRoomAndElseStaysAsItIs) {
  order(R"({"type":"settings","width":1920,"height":1200,"fps":7})");
  EXPECT_EQ(last("error")["code"], "no_room");
  EXPECT_NE(last("error")["message"].get<std::string>().find("32x32"), std::string::npos);
  EXPECT_EQ(visitor().wants.width, 32);
  EXPECT_EQ(visitor().wants.fps, 7) << "the rest counts";
  EXPECT_EQ(last_header().width, 32);
  order(R"({"type":"hello","width":1920,"height":1200})");
  EXPECT_EQ(last("welcome")["width"], 32) << "another hello finds no more room";
  browsers[1].link->mark_closed();
  run(0.5);
  order(R"({"type":"settings","width":128,"height":64})");
  EXPECT_EQ(visitor().wants.width, 128) << "when others have gone there is";
}

}  // namespace
}  // namespace wellspring::test
