// SPDX-License-Identifier: Apache-2.0
#include "show/http/still.h"

#include <gtest/gtest.h>

#include "show/state/make_show.h"
#include "unit/show/ball_piece.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

TEST(StillQuestion, AsksForAViewpointOrForAnyView) {
  const Exhibit exhibit = make_tiny_exhibit();
  StillQuestion plain = read_still_question(exhibit, {});
  EXPECT_EQ(plain.status, 200);
  EXPECT_EQ(plain.job.viewpoint, exhibit.start);
  EXPECT_FALSE(plain.job.position || plain.job.yaw || plain.job.pitch || plain.job.fov);
  StillQuestion view = read_still_question(exhibit, {{"position", "50.5,1.6,-2e-1"},
                                                     {"yaw", "-1.5"},
                                                     {"pitch", "0.25"},
                                                     {"fov", "0.8"},
                                                     {"width", "320"}});
  ASSERT_EQ(view.status, 200) << view.problem;
  EXPECT_EQ(view.job.position, dvec3(50.5, 1.6, -0.2));
  EXPECT_EQ(view.job.yaw, -1.5f);
  EXPECT_EQ(view.job.pitch, 0.25f);
  EXPECT_EQ(view.job.fov, 0.8f);
  EXPECT_EQ(view.job.width, 320);
  EXPECT_NE(view.job, plain.job) << "no kept picture of another view";
}

TEST(StillQuestion, NamesTheFieldThatIsWrong) {
  const Exhibit exhibit = make_tiny_exhibit();
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"position", "1,2"},
                                                        {"position", "1,2,3,4"},
                                                        {"position", "1,2,3,"},
                                                        {"position", "1,2,nan"},
                                                        {"position", "inf,2,3"},
                                                        {"position", "1,2,1e7"},
                                                        {"position", "1;2;3"},
                                                        {"yaw", "north"},
                                                        {"yaw", "101"},
                                                        {"pitch", "-inf"},
                                                        {"pitch", "1 "},
                                                        {"fov", "0"},
                                                        {"fov", "3.2"},
                                                        {"fov", "nan"},
                                                        {"spp", "0"},
                                                        {"seconds", "0"},
                                                        {"seconds", "soon"},
                                                        {"pieces", "map:1850:1650:curtian"},
                                                        {"pieces", "map:1850:1650:fade:2"},
                                                        {"pieces", "map:1850:1650:fade:half"},
                                                        {"pieces", "ball:core::::north"},
                                                        {"pieces", "ball:core::::90:0;0"},
                                                        {"pieces", "ball:core::::90:0;0;2"},
                                                        {"pieces", "ball:core::::90:0;0;0:1;1;1:"},
                                                        {"width", "1e3"}}) {
    StillQuestion asked = read_still_question(exhibit, {{name, text}});
    EXPECT_EQ(asked.status, 400) << name << "=" << text;
    EXPECT_TRUE(asked.problem.starts_with(name + ": ")) << asked.problem;
  }
  EXPECT_EQ(read_still_question(exhibit, {{"viewpoint", "moon"}, {"spp", "0"}}).status, 404);
}

TEST(StillQuestion, AsksForAVolumeTurnedAndCut) {
  Exhibit exhibit = make_tiny_exhibit();
  add_ball(exhibit, dvec3(0));
  const auto read = [&](const std::string& pieces) {
    const StillQuestion asked = read_still_question(exhibit, {{"pieces", pieces}});
    EXPECT_EQ(asked.status, 200) << asked.problem;
    return choice_of(asked.job.pieces, 0);
  };
  const PieceChoice all = read("ball:core:skin:fade:0.25:-90:0.1;0;0:1;0.9;0.5");
  EXPECT_EQ(all.layer, 1);
  EXPECT_EQ(all.over, 0);
  EXPECT_FLOAT_EQ(all.share, 0.25f);
  EXPECT_NEAR(all.turn, -pi / 2, 1e-6f);
  EXPECT_EQ(all.low, vec3(0.1f, 0, 0));
  EXPECT_EQ(all.high, vec3(1, 0.9f, 0.5f));
  const PieceChoice turned = read("ball:core::::30");
  EXPECT_EQ(turned.by, Blend::none);
  EXPECT_NEAR(turned.turn, pi / 6, 1e-6f);
  EXPECT_EQ(turned.high, vec3(1));
  const StillQuestion glass =
      read_still_question(exhibit, {{"lens", "0.5,0.5,0.2,1"}, {"lens_depth", "0.1"}});
  EXPECT_EQ(glass.job.lens.depth, 0.1f);
  EXPECT_EQ(read_still_question(exhibit, {{"lens", "0.5,0.5,0.2,1"}, {"lens_depth", "-1"}}).status,
            400);
}

TEST(StillQuestion, NoNumberOfSamplesIsTooManyAndTimeIsASettingOfItsOwn) {
  const Exhibit exhibit = make_tiny_exhibit();
  const auto read = [&](const std::map<std::string, std::string>& query) {
    StillQuestion asked = read_still_question(exhibit, query);
    EXPECT_EQ(asked.status, 200) << asked.problem;
    return asked.job;
  };
  read({{"width", "3840"}, {"height", "3840"}, {"spp", "1024"}});
  EXPECT_EQ(read({}).seconds, 8);
  EXPECT_EQ(read({}).spp, 0) << "as many as fit";
  EXPECT_EQ(read({{"seconds", "2.5"}}).seconds, 2.5);
}

// On a clock that a sample a pixel takes a second of.
TEST(StillRoom, HasAsManySamplesAsFitIntoItsTimeAndSaysSo) {
  std::unique_ptr<Show> show = make_show(make_tiny_exhibit(), settings_for("direct"));
  double now = 0;
  StillRoom room(*show, [&] { return now++; });
  const auto samples = [&](double seconds, int spp, double denoise_seconds = 0) {
    StillJob job{.width = 16, .height = 16, .seconds = seconds, .spp = spp, .denoise = false};
    job.yaw = float(now);  // nothing that is remembered
    StillCosts costs;
    const StillPicture made = room.make(job, {}, 1, denoise_seconds, &costs);
    EXPECT_EQ(costs.spp, made.spp);
    const std::string comment =
        std::to_string(made.spp) + " samples a pixel by direct, not denoised";
    EXPECT_NE(made.jpeg.find(comment), std::string::npos);
    return made.spp;
  };
  EXPECT_EQ(samples(5, 0), 5);
  EXPECT_EQ(samples(5, 0, 2), 3) << "the network's time is kept";
  EXPECT_EQ(samples(5, 2), 2) << "no more than are wished for";
  EXPECT_EQ(samples(0.1, 16), 1) << "one comes, whatever it takes";
}

TEST(StillRoom, SaysWhereItIsNotDenoisedForWantOfWeights) {
  ShowSettings settings = settings_for("direct");
  settings.weights = "";
  std::unique_ptr<Show> show = make_show(make_tiny_exhibit(), settings);
  StillRoom room(*show);
  const StillPicture made = room.make({.width = 16, .height = 16, .seconds = 60, .spp = 1});
  EXPECT_EQ(made.denoised, StillPicture::Denoised::no_weights);
  EXPECT_NE(made.jpeg.find("weights are missing"), std::string::npos);
}

// A viewpoint's view, given in numbers, is the picture from there.
TEST(StillQuestion, AViewInNumbersIsThePictureFromThere) {
  Exhibit exhibit = make_tiny_exhibit();
  const Viewpoint first = exhibit.viewpoints[0].view;
  std::unique_ptr<Show> show = make_show(std::move(exhibit), settings_for("direct"));
  StillRoom room(*show);
  StillJob job{.width = 64, .height = 48, .seconds = 60, .spp = 1, .denoise = false};
  const std::string there = room.make(job).jpeg;
  job.position = first.position, job.yaw = first.yaw, job.pitch = first.pitch, job.fov = first.fov;
  EXPECT_TRUE(room.make(job).jpeg == there);
  for (int field = 0; field < 4; field++) {
    StillJob other = job;
    if (field == 0) *other.position += dvec3(0.3, 0, 0);
    if (field == 1) *other.yaw += 0.4f;
    if (field == 2) *other.pitch -= 0.4f;
    if (field == 3) *other.fov *= 0.5f;
    EXPECT_FALSE(room.make(other).jpeg == there) << field;
  }
}

}  // namespace
}  // namespace wellspring::test
