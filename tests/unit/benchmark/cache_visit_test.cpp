// SPDX-License-Identifier: Apache-2.0
// The pure parts of the simulated visits: what a wrong line there would make of every figure.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/load_error.h"
#include "base/rng.h"
#include "benchmark/cache_visit.h"
#include "benchmark/cache_visit_judge.h"
#include "benchmark/cache_visit_method.h"
#include "benchmark/cache_visit_trace.h"
#include "light/sample/lights.h"
#include "scenes/scenes.h"

namespace wellspring::test {
namespace {

VisitTrace make_trace() {
  VisitTrace trace{.name = "there", .exhibit = "castle"};
  trace.samples = {
      {0, {1, 2, 3}, 3.0f, 0, 1}, {0.5, {2, 2, 3}, 3.5f, 0.1f, 1}, {1, {2, 4, 3}, 4, 0, 2}};
  trace.lamps = {{0.25, false}, {0.75, true}};
  return trace;
}

TEST(VisitTrace, IsLinearBetweenSamplesAndRestsOutside) {
  VisitTrace trace = make_trace();
  EXPECT_EQ(eval_trace(trace, -1).position, dvec3(1, 2, 3));
  EXPECT_EQ(eval_trace(trace, 0.5).position, dvec3(2, 2, 3));
  EXPECT_EQ(eval_trace(trace, 9).position, dvec3(2, 4, 3));
  Viewpoint quarter = eval_trace(trace, 0.125);
  EXPECT_NEAR(quarter.position.x, 1.25, 1e-12);
  EXPECT_NEAR(quarter.yaw, 3.125f, 1e-6f);  // beyond pi: turns are not cut
  EXPECT_NEAR(eval_trace(trace, 0.75).fov, 1.5f, 1e-6f);
}

TEST(VisitTrace, LampsFollowTheirSwitches) {
  VisitTrace trace = make_trace();
  EXPECT_TRUE(lamps_on(trace, 0.2));
  EXPECT_FALSE(lamps_on(trace, 0.25));
  EXPECT_FALSE(lamps_on(trace, 0.7));
  EXPECT_TRUE(lamps_on(trace, 0.8));
}

TEST(VisitTrace, SurvivesTheDiskAndRefusesNonsense) {
  std::string folder = testing::TempDir() + "wellspring_traces";
  std::filesystem::create_directories(folder);
  VisitTrace trace = make_trace();
  trace.telling = true;
  save_visit_trace(trace, folder);
  VisitTrace loaded = load_visit_traces(folder).front();
  EXPECT_EQ(loaded.name, "there");
  EXPECT_TRUE(loaded.telling);
  ASSERT_EQ(loaded.samples.size(), 3u);
  EXPECT_EQ(loaded.samples[2].position, trace.samples[2].position);
  EXPECT_NEAR(loaded.samples[1].pitch, 0.1f, 1e-6f);
  ASSERT_EQ(loaded.lamps.size(), 2u);
  EXPECT_FALSE(loaded.lamps[0].on);
  auto refuses = [&](const std::string& text) {
    std::string file = folder + "/bad.json";
    std::ofstream(file) << text;
    EXPECT_THROW(load_visit_trace(file), LoadError) << text;
  };
  std::string head = R"({"about":"","exhibit":"castle","storyteller":"idle","lamps":[],"samples":)";
  refuses("{");
  refuses(head + "[]}");
  refuses(head + "[[0,1,2,3,4,5]]}");
  refuses(head + "[[0,1,2,3,4,5,1],[0,1,2,3,4,5,1]]}");
  refuses(head + "[[0,1,2,3,4,5,1e999]]}");
  EXPECT_THROW(load_visit_traces(folder + "/nowhere"), LoadError);
  std::filesystem::remove_all(folder);
}

TEST(VisitTrace, MisspeltNamesAreRefusedBeforeAnythingIsMeasured) {
  VisitSettings settings{.exhibit = "no exhibit is loaded",
                         .traces = WELLSPRING_SOURCE "/tests/benchmark/traces",
                         .only = "strol"};
  EXPECT_THROW(simulate_visits(settings), LoadError);
  settings.only = "stroll";
  settings.methods = {"cach"};
  try {
    simulate_visits(settings);
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.where, "cach");
  }
}

TEST(VisitTrace, CommittedTracesLoadAndMoveAsPeopleDo) {
  std::vector<VisitTrace> traces = load_visit_traces(WELLSPRING_SOURCE "/tests/benchmark/traces");
  EXPECT_EQ(traces.size(), 10u);
  int camera_cuts = 0;
  for (const VisitTrace& trace : traces) {
    EXPECT_GT(trace_seconds(trace), 3) << trace.name;
    for (size_t i = 1; i < trace.samples.size(); i++) {
      const TraceSample &a = trace.samples[i - 1], &b = trace.samples[i];
      if (b.time - a.time < 0.5 / visit_rate) {  // asked for another viewpoint
        camera_cuts += trace.name == "jump";
        continue;
      }
      EXPECT_LT(glm::length(b.position - a.position), 3 * (b.time - a.time))
          << trace.name << " " << i;
      EXPECT_LT(std::abs(b.yaw - a.yaw), 4 * (b.time - a.time)) << trace.name << " " << i;
    }
  }
  EXPECT_EQ(camera_cuts, 5);
}

Image8 make_image(int width, int height, auto shade) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) image.rgb.push_back(uint8_t(shade(x, y)));
  return image;
}

TEST(VisitJudge, NoiseOfTwoReferencesDoesNotCountInTheirProduct) {
  Rng rng(7);
  auto noisy = [&](int mean) {
    return make_image(200, 200, [&, mean](int, int) { return mean + int(rng.next() % 41) - 20; });
  };
  Image8 test = make_image(200, 200, [](int, int) { return 110; });
  Image8 one = noisy(100), other = noisy(100);
  // The differences' product has mean 100 and, of 120,000 equal triples of 40,000 pixels, a
  // standard error of sqrt(2 * 100 * 140 + 140^2) / 200 = 1.1; four of them are allowed for.
  double squared = 255.0 * 255 * std::pow(display_rmse(test, one, other), 2);
  EXPECT_NEAR(squared, 100, 4 * 1.1);
  // One alone counts its own variance, (41^2 - 1) / 12 = 140.
  EXPECT_NEAR(255.0 * 255 * std::pow(display_rmse(test, one), 2), 240, 4 * 2);
  EXPECT_THROW(display_rmse(test, make_image(2, 2, [](int, int) { return 0; })),
               std::invalid_argument);
}

TEST(VisitJudge, WrongSurfaceLooksAtThePixelAndItsCorners) {
  TrueView truth;
  truth.view.width = 2;
  truth.view.height = 1;
  truth.object = {1, 2};
  truth.corner = {1, 3, 2, 1, 1, 2};  // three above, three below
  EXPECT_EQ(wrong_surface_share(truth, std::vector<uint32_t>{1, 2}), 0);
  EXPECT_EQ(wrong_surface_share(truth, std::vector<uint32_t>{3, 3}), 0);  // a corner they share
  EXPECT_EQ(wrong_surface_share(truth, std::vector<uint32_t>{2, 2}),
            0.5);  // 2 is not seen in the first
  EXPECT_EQ(wrong_surface_share(truth, std::vector<uint32_t>{4, 0}), 1);
}

// A wall across the view at z = -2, seen from z = 0.
TrueView see_wall(const View& view) {
  TrueView seen{.view = view};
  size_t pixels = size_t(view.width) * size_t(view.height);
  seen.object.assign(pixels, 5);
  seen.hit.assign(pixels, 1);
  seen.where.assign(pixels, Hit{});
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      seen.position.push_back(ray.origin + ray.direction * ((-2 - ray.origin.z) / ray.direction.z));
    }
  return seen;
}

TEST(VisitJudge, MotionFollowsTheCameraAndComparesNothingElse) {
  View before{.width = 16, .height = 8};
  before.tan_half_fov = 1;  // a pixel is half a metre on the wall
  View now = before;
  now.position.x = 1;  // two pixels to the right: what is seen was two pixels further right
  TrueView wall = see_wall(before), moved = see_wall(now);
  auto nowhere = [](const Hit&) { return vec3(NAN); };
  std::vector<vec2> motion = motion_vectors(moved, wall, nowhere);
  EXPECT_NEAR(motion[3 * 16 + 4].x, 6.5f, 1e-4f);
  EXPECT_NEAR(motion[3 * 16 + 4].y, 3.5f, 1e-4f);
  EXPECT_TRUE(std::isnan(motion[3 * 16 + 15].x));  // came into view

  auto stripes = [](int offset) {
    return make_image(16, 8, [offset](int x, int) { return (x + offset) % 4 < 2 ? 200 : 50; });
  };
  EXPECT_NEAR(motion_compensated_error(stripes(2), stripes(0), motion), 0, 1e-4);
  EXPECT_NEAR(motion_compensated_error(stripes(0), stripes(0), motion), 150 / 255.0, 1e-4);

  wall.object[3 * 16 + 6] = 9;      // something else was there
  wall.position[3 * 16 + 7].z = 5;  // five pixels' size and more off
  motion = motion_vectors(moved, wall, nowhere);
  EXPECT_TRUE(std::isnan(motion[3 * 16 + 4].x));
  EXPECT_TRUE(std::isnan(motion[3 * 16 + 5].x));

  moved.where[0].instance = 1;  // moves by itself: it was right in the middle
  motion = motion_vectors(moved, wall, [](const Hit&) { return vec3(0.01f, 0.01f, -2); });
  EXPECT_NEAR(motion[0].x, 8.02f, 1e-3f);
}

TEST(VisitJudge, NothingToCompareIsNotZeroError) {
  Image8 image = make_image(2, 1, [](int, int) { return 9; });
  EXPECT_TRUE(std::isnan(motion_compensated_error(image, image, std::vector<vec2>(2, vec2(NAN)))));
}

TEST(VisitMethod, AffordableSizeSpendsNearlyTheBudgetAndNeverMore) {
  for (int budget : {1, 2, 7, 100, 288, 1234, 9216, 36864, 100000}) {
    ivec2 size = affordable_size(256, 144, budget);
    EXPECT_LE(size.x * size.y, budget);
    EXPECT_GE(size.x, 1);
    EXPECT_GE(size.y, 1);
    EXPECT_LE(size.x, 256);
    EXPECT_LE(size.y, 144);
    if (budget >= 100 && budget <= 36864) {
      EXPECT_GE(size.x * size.y, 0.85 * budget) << budget;
    }
  }
  EXPECT_EQ(affordable_size(256, 144, 36864), ivec2(256, 144));
}

TEST(VisitMethod, UpsamplingKeepsConstantsAndRampsAndInventsNoObject) {
  Frame small, large;
  small.width = 4, small.height = 2;
  large.width = 16, large.height = 8;
  for (int i = 0; i < 8; i++) {
    small.color.push_back(vec3(float(i % 4), 1, 0));
    small.object.push_back(uint32_t(10 + i));
  }
  large.color.resize(128);
  large.object.resize(128);
  upsample(small, large);
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 16; x++) {
      size_t i = size_t(y * 16 + x);
      float ramp = std::clamp((float(x) + 0.5f) / 4 - 0.5f, 0.0f, 3.0f);
      EXPECT_NEAR(large.color[i].x, ramp, 1e-6f);
      EXPECT_NEAR(large.color[i].y, 1, 1e-6f);
      EXPECT_EQ(large.object[i], uint32_t(10 + y / 4 * 4 + x / 4));
    }
}

// The methods on the Cornell box, whose light needs no preparation.
struct Box {
  Scene scene = scenes::make_cornell_box();
  World world{scene};
  Lights lights = make_lights(world);
  VisitMoment moment(int frame, bool changed, float aside = 0) const {
    VisitMoment m{.world = &world,
                  .lights = &lights,
                  .technique = find_technique("direct"),
                  .view = scenes::cornell_view(scene, 32, 24)};
    m.view.position.x += aside;
    m.changed = changed;
    m.frame = frame;
    m.seed = uint64_t(frame) + 1;
    return m;
  }
};

double mean_difference(const Frame& a, const Frame& b) {
  double sum = 0;
  for (size_t i = 0; i < a.color.size(); i++)
    sum += double(luminance(abs(a.color[i] - b.color[i])));
  return sum / double(a.color.size());
}

TEST(VisitMethod, EveryMethodComesToRestAtTheRightPicture) {
  Box box;
  StillSettings still{.spp = 256};
  Frame wanted = render_still(*find_technique("direct"), box.world, box.lights,
                              box.moment(0, true).view, still);
  // Returns how far pictures of as many samples a pixel are from the truth.
  auto distance_of = [&](int spp) {
    still.spp = spp;
    still.seed = 99;
    return mean_difference(render_still(*find_technique("direct"), box.world, box.lights,
                                        box.moment(0, true).view, still),
                           wanted);
  };
  double plain = distance_of(4), filtered = distance_of(2);
  for (const VisitMethodEntry& entry : visit_methods()) {
    if (entry.when_named) continue;
    auto method = entry.make();
    VisitPicture picture;
    for (int frame = 0; frame < 240; frame++) {
      method->show(box.moment(frame, frame == 0), 32 * 24 / 4, picture);
      ASSERT_EQ(picture.frame.color.size(), wanted.color.size()) << entry.name;
      ASSERT_EQ(picture.frame.object.size(), wanted.color.size()) << entry.name;
    }
    EXPECT_EQ(picture.empty, 0) << entry.name;
    // Sixty samples a pixel were there to spend. The cache smooths, which at this size costs
    // detail. Points alone show one place of each pixel, filtered over its neighbours.
    const double points = 4 * filtered;
    const bool published = std::string_view(entry.name) == "cache";
    EXPECT_LT(mean_difference(picture.frame, wanted), published        ? points
                                                      : entry.baseline ? plain
                                                                       : filtered)
        << entry.name;
  }
}

TEST(VisitMethod, HoldShowsNothingThenTheViewOfThenWhole) {
  Box box;
  auto method = make_hold();
  VisitPicture picture;
  for (int frame = 0; frame < 4; frame++) {
    method->show(box.moment(frame, true), 32 * 24 / 4, picture);
    EXPECT_EQ(picture.empty, 1) << frame;
  }
  method->show(box.moment(4, true, 50), 32 * 24 / 4, picture);
  EXPECT_EQ(picture.empty, 0);
  std::vector<uint32_t> first = picture.frame.object;
  // The picture shows the view of frame 0, not the one wanted now.
  auto again = make_hold();
  VisitPicture other;
  for (int frame = 0; frame < 5; frame++) again->show(box.moment(frame, true), 32 * 24 / 4, other);
  EXPECT_EQ(other.frame.object, first);
  for (int frame = 5; frame < 8; frame++) {
    method->show(box.moment(frame, true, 50), 32 * 24 / 4, picture);
    EXPECT_EQ(picture.frame.object, first) << frame;
  }
  method->show(box.moment(8, true, 50), 32 * 24 / 4, picture);
  EXPECT_NE(picture.frame.object, first);
}

TEST(VisitMethod, FramelessDrawsEveryPixelOnceASweep) {
  Box box;
  auto method = make_frameless();
  VisitPicture picture;
  for (int frame = 0; frame < 4; frame++) {
    method->show(box.moment(frame, true), 32 * 24 / 4, picture);
    EXPECT_NEAR(picture.empty, 1 - (frame + 1) / 4.0, 1e-9);
  }
}

TEST(VisitMethod, TheSameVisitIsTheSamePicture) {
  Box box;
  for (const VisitMethodEntry& entry : visit_methods()) {
    if (!entry.baseline) continue;
    VisitPicture picture[2];
    for (VisitPicture& made : picture) {
      auto method = entry.make();
      for (int frame = 0; frame < 9; frame++) method->show(box.moment(frame, frame < 5), 100, made);
    }
    for (size_t i = 0; i < picture[0].frame.color.size(); i++)
      ASSERT_EQ(picture[0].frame.color[i], picture[1].frame.color[i]) << entry.name;
  }
}

}  // namespace
}  // namespace wellspring::test
