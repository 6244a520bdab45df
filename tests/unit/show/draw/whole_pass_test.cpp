// SPDX-License-Identifier: Apache-2.0
// Techniques that filter whole passes over a picture, in a running show.
#include <gtest/gtest.h>

#include <algorithm>

#include "show/draw/late_samples.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct WholePass : testing::Test, ShowStage {
  void open() {
    ShowSettings settings = settings_for("instant_radiosity");
    begin(make_tiny_exhibit(), settings);
    join(96, 64);
    steps(3);
  }
};

// A pass asks for each of its pixels once, and its samples are those that the filter left.
TEST_F(WholePass, IsFilteredAsAWhole) {
  open();
  turn(0.05, 0.1), step();
  DrawingWork& work = show->drawing->renderer.work;
  const size_t pixels = size_t(work.pass.width) * size_t(work.pass.height);
  ASSERT_GT(pixels, 200u);
  ASSERT_EQ(work.samples.size(), pixels);
  ASSERT_EQ(work.requests.size(), pixels);
  // The same again without the filter: names of pixels have been changed since.
  std::vector<Request> requests = work.requests;
  for (size_t i = 0; i < pixels; i++) requests[i].pixel = uint32_t(i);
  std::vector<Sample> plain(pixels);
  TransportSettings transport = show->settings.transport;
  transport.clamp = show->settings.moving_clamp;
  trace(*show->stage.technique, *show->stage.world, show->stage.lights, transport, requests, plain);
  auto roughness = [&](const std::vector<Sample>& samples) {
    double sum = 0;
    for (size_t i = 1; i < pixels; i++)
      if (samples[i].object == samples[i - 1].object)
        sum += length(samples[i].radiance() - samples[i - 1].radiance());
    return sum;
  };
  EXPECT_LT(roughness(work.samples), 0.8 * roughness(plain));
}

TEST_F(WholePass, ItsSamplesAreOfPixelsOfThePicturesLight) {
  open();
  turn(0.05, 0.1), step();
  const DrawingWork& work = show->drawing->renderer.work;
  std::vector<uint32_t> named;
  for (const Request& request : work.requests)
    if (request.pixel != no_pixel) named.push_back(request.pixel);
  std::sort(named.begin(), named.end());
  EXPECT_GT(named.size(), work.requests.size() * 9 / 10);
  auto distinct = std::unique(named.begin(), named.end()) - named.begin();
  EXPECT_GT(size_t(distinct), named.size() * 8 / 10) << "spread over the picture";
  EXPECT_GT(visitor().picture->cache.stats().points, int(named.size() / 2));
}

// At rest its pictures go to what the same technique renders.
TEST_F(WholePass, PicturesAtRestGetNearToTheTruth) {
  ShowSettings settings = settings_for("instant_radiosity");
  settings.still_technique = "instant_radiosity";
  begin(make_tiny_exhibit(), settings);
  join(96, 64);
  run(3);
  Image8 truth_image = truth(visitor().place.last_view, 64);
  EXPECT_LT(mean_difference(last_image(), truth_image), 8);
}

}  // namespace
}  // namespace wellspring::test
