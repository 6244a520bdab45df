// SPDX-License-Identifier: Apache-2.0
// The tick as a whole, driven by links without sockets and a clock of its own.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "image/image.h"
#include "show/http/answer.h"
#include "show/state/renderer.h"
#include "show/state/make_show.h"
#include "unit/show/show_stage.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

struct ShowTest : testing::Test, ShowStage {
  void begin(dvec3 origin = dvec3(0), ShowSettings settings = {}) {
    settings.fps = 50;
    ShowStage::begin(make_tiny_exhibit(origin), settings);
    join(96, 64);
  }
};

TEST_F(ShowTest, WelcomesAndSendsPicturesThatDecode) {
  begin();
  run(0.5);
  EXPECT_EQ(last("welcome")["exhibit"], "tiny");
  ASSERT_GT(pictures().size(), 4u);
  auto packet = read_packet(pictures().back());
  ASSERT_TRUE(packet);
  Image8 image = decode_jpeg(packet->payload, "picture");
  EXPECT_EQ(image.width, 96);
  EXPECT_EQ(image.height, 64);
  double mean = 0;
  for (uint8_t value : image.rgb) mean += value;
  mean /= double(image.rgb.size());
  EXPECT_GT(mean, 20);  // the lamp lights the room
  EXPECT_LT(mean, 250);
}

TEST_F(ShowTest, PicturesCarryTheLastSeqAndGrowingNumbers) {
  begin();
  run(0.2);
  say(R"({"type":"input","seq":7,"move":[0,0,0],"look":[0.2,0]})");
  run(0.1);
  EXPECT_EQ(last_header().seq, 7u);
  for (size_t i = 1; i < pictures().size(); i++)
    EXPECT_EQ(header(i).frame, header(i - 1).frame + 1);
}

TEST_F(ShowTest, WalksOnUntilTheNextInput) {
  begin();
  run(0.1);
  dvec3 from = show->visits.visitors.front().place.view.position;
  say(R"({"type":"input","seq":1,"move":[0,0,1],"look":[0,0]})");
  run(1);
  say(R"({"type":"input","seq":2,"move":[0,0,0],"look":[0,0]})");
  run(0.5);
  dvec3 to = show->visits.visitors.front().place.view.position;
  EXPECT_NEAR(from.z - to.z, 1, 0.1);
  run(1);
  EXPECT_EQ(show->visits.visitors.front().place.view.position, to);
}

TEST_F(ShowTest, StandingStillConvergesToTheReference) {
  begin();
  // On a busy machine pictures have fewer samples: it goes on until there are 120 a pixel.
  run(4);
  for (int i = 0; i < 600 && show->totals.samples < 120u * 96 * 64; i++) run(0.1);
  const Visitor& visitor = show->visits.visitors.front();
  StillSettings settings{.spp = 768};
  settings.transport = show->settings.transport;
  Frame reference = render_still(*show->stage.still_technique, *show->stage.world,
                                 show->stage.lights, visitor.place.last_view, settings);
  double error = 0, size = 0;
  for (size_t i = 0; i < reference.color.size(); i++) {
    // Pictures are compared as they are shown: lamps are no brighter than white.
    auto seen = [&](vec3 light) {
      return luminance(min(light * show->stage.exhibit.exposure, vec3(1)));
    };
    error += std::abs(seen(show->drawing->renderer.work.frame.color[i]) - seen(reference.color[i]));
    size += seen(reference.color[i]);
  }
  EXPECT_LT(error / size, 0.08);
  EXPECT_TRUE(last_header().flags & packet_still);
}

TEST_F(ShowTest, FarFromTheOriginThePictureIsTheSame) {
  begin();
  run(2);
  std::vector<vec3> near = show->drawing->renderer.work.frame.color;
  begin(dvec3(1e6, 0, -1e6));
  run(2);
  double error = 0, size = 0;
  const std::vector<vec3>& far = show->drawing->renderer.work.frame.color;
  for (size_t i = 0; i < near.size(); i++) {
    error += std::abs(luminance(near[i]) - luminance(far[i]));
    size += luminance(near[i]);
  }
  EXPECT_LT(error / size, 0.12);
}

TEST_F(ShowTest, OrdersAreObeyedOrAnswered) {
  begin();
  run(0.1);
  say(R"({"type":"viewpoint","seq":3,"name":"corner"})");
  run(0.6);
  EXPECT_EQ(last("state")["viewpoint"], "corner");
  say(R"({"type":"viewpoint","seq":4,"name":"moon"})");
  run(0.1);
  EXPECT_EQ(last("error")["code"], "unknown_viewpoint");
  EXPECT_EQ(show->visits.visitors.front().place.seq, 3u);
  say(R"({"type":"viewpoint","seq":5,"name":"door"})");
  say(R"({"type":"tour","action":"play","name":"round"})");
  run(0.6);
  EXPECT_EQ(last("subtitle")["text"], "Here");
  EXPECT_EQ(last("state")["tour"]["state"], "playing");
  say(R"({"type":"storyteller","story":"tale"})");
  run(0.1);
  EXPECT_EQ(last("error")["code"], "no_storyteller");
  say(R"({"type":"settings","width":64,"height":64})");
  run(0.2);
  EXPECT_EQ(last_header().width, 64);
}

TEST_F(ShowTest, TheTourWaitsForAVisitorWhoWalksOff) {
  begin();
  run(0.1);
  say(R"({"type":"tour","action":"play"})");
  run(0.5);
  say(R"({"type":"input","seq":1,"move":[0,0,0.5],"look":[0,0]})");
  run(0.1);
  EXPECT_EQ(show->visits.visitors.front().place.tour.state, TourRide::State::paused);
}

TEST_F(ShowTest, ByeAndClosedLinksLeave) {
  begin();
  run(0.1);
  EXPECT_EQ(show->visits.visitors.size(), 1u);
  say(R"({"type":"bye"})");
  run(0.1);
  EXPECT_TRUE(show->visits.visitors.empty());
  size_t other = connect();
  run(0.05);
  EXPECT_EQ(show->visits.visitors.size(), 1u);
  browsers[other].link->mark_closed();
  run(0.05);
  EXPECT_TRUE(show->visits.visitors.empty());
}

TEST_F(ShowTest, ClockJumpsAreSurvived) {
  begin();
  run(0.2);
  say(R"({"type":"input","seq":1,"move":[1,0,1],"look":[0,0]})");
  for (double jump : {1e-9, 3600.0, 86400.0, 0.0}) {
    now += jump;
    run(0.06);
  }
  dvec3 position = show->visits.visitors.front().place.view.position;
  EXPECT_LT(std::abs(position.x), 4);
  EXPECT_LT(std::abs(position.z), 4);
}

TEST_F(ShowTest, ReportAndMetricsTellTheVisitor) {
  begin();
  run(0.5);
  ShowReport report = make_report(*show);
  ASSERT_EQ(report.visitors.size(), 1u);
  EXPECT_EQ(report.visitors[0].width, 96);
  EXPECT_GT(report.totals.pictures, 4u);
  EXPECT_EQ(report.bad_samples, 0u);
  std::string text = write_metrics(report);
  EXPECT_NE(text.find("wellspring_visitors 1\n"), std::string::npos);
  EXPECT_NE(text.find("wellspring_visitor_pictures_per_second{visitor=\"1\""), std::string::npos);
}

TEST(DescribeApi, NamesOnlyMessagesThatAreUnderstood) {
  auto api = nlohmann::json::parse(describe_api());
  ASSERT_GE(api["browser_to_server"].size(), 9u);
  for (const auto& [type, fields] : api["browser_to_server"].items()) {
    auto read = read_browser_message("{\"type\":\"" + type + "\"}");
    if (const WireError* error = std::get_if<WireError>(&read)) {
      EXPECT_NE(error->code, "unknown_type") << type;
    }
  }
}

TEST(MakeShow, UnknownTechniqueIsRefused) {
  ShowSettings settings{.technique = "magic"};
  EXPECT_THROW(make_show(make_tiny_exhibit(), settings), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
