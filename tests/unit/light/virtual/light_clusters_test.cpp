// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/instant_radiosity.h"
#include "light/virtual/light_clusters.h"

#include <algorithm>

#include "scenes/scenes.h"
#include "unit/light/statistics.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

struct Box {
  Scene scene;
  World world;
  Lights lights;
  InstantPass pass;
  explicit Box(Scene made, int walks)
      : scene(std::move(made)), world(scene), lights(make_lights(world)) {
    TransportSettings settings;
    settings.instant.walks = walks;
    pass = draw_instant_pass({world, *lights.tables}, settings, 64, 3, 0);
  }
};

Scene box_and_lamp() {
  Scene scene = make_cornell_box();
  PunctualLight lamp;
  lamp.position = {0.1f, 0.3f, 0.2f};
  lamp.intensity = vec3(0.1f);
  scene.lights.push_back(lamp);  // few: exact, so that nobody chooses it
  return scene;
}

// Returns each light's share of the effect of all lights, as the mean over the places.
std::vector<double> exact_shares(const LightClusters& clusters, float clip,
                                 std::span<const LitPoint> points) {
  std::vector<double> shares(clusters.size() * lane_count, 0.0);
  for (const LitPoint& point : points) {
    std::vector<double> here;
    double sum = 0;
    for (size_t g = 0; g < clusters.size(); g++) {
      Lanes effect = eval_unshadowed(clusters.lights, g, point, most_of_clip(clip));
      for (int i = 0; i < lane_count; i++) here.push_back(double(effect[i])), sum += here.back();
    }
    for (size_t i = 0; i < here.size(); i++) shares[i] += here[i] / sum;
  }
  for (double& s : shares) s /= double(points.size());
  return shares;
}

}  // namespace

TEST(LightOrder, NeighboursAreNearAndFaceOneWay) {
  Box box(box_and_lamp(), 200);
  std::vector<uint32_t> order = order_lights(box.pass);
  std::vector<uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
  size_t exact = size_t(std::count_if(box.pass.lights.begin(), box.pass.lights.end(),
                                      [](const PointLight& light) { return light.exact; }));
  ASSERT_GT(exact, 0u);
  EXPECT_EQ(order.size() + exact, box.pass.lights.size());
  double walked = 0, as_drawn = 0;
  int turns = 0;
  for (size_t k = 1; k < order.size(); k++) {
    const PointLight &a = box.pass.lights[order[k - 1]], &b = box.pass.lights[order[k]];
    const PointLight &c = box.pass.lights[sorted[k - 1]], &d = box.pass.lights[sorted[k]];
    EXPECT_FALSE(b.exact);
    walked += double(length(b.position - a.position));
    as_drawn += double(length(d.position - c.position));
    turns += dot(a.normal, b.normal) < 0.5f;
  }
  // A curve through n places of a surface is about as long as their square root, not as their
  // number.
  EXPECT_LT(walked, 0.2 * as_drawn);
  EXPECT_LT(turns, 200);  // out of some thousands
}

// The second moment of choosing by shares s what would best be chosen by shares e is the sum of
// e^2/s: 1 at its best. Far and near places, one of them beside a wall.
TEST(LightClusters, ChoosingByThemIsNearlyAsGoodAsByEachLight) {
  Box box(make_cornell_box(), 200);
  LightClusters clusters = make_light_clusters(*box.lights.tables, box.pass);
  const vec3 up(0, 1, 0), left(1, 0, 0);
  const std::vector<std::vector<LitPoint>> regions = {
      {{{0, 0.001f, 0.1f}, up}},
      {{{-0.27f, 0.01f, 0.1f}, left}, {{-0.27f, 0.3f, 0}, left}},
      {{{0.1f, 0.54f, 0}, -up}, {{0, 0.001f, 0.1f}, up}, {{0.2f, 0.001f, 0.2f}, up}}};
  for (const std::vector<LitPoint>& points : regions) {
    ClusterShares shares;
    ASSERT_TRUE(share_lights(clusters, 0.05f, points, shares));
    std::vector<double> best = exact_shares(clusters, 0.05f, points);
    double sum = 0, moment = 0, even = 0;
    for (size_t c = 0; c < clusters.size(); c++) {
      Lanes of_lights = shares_in(clusters, shares, c);
      float whole = shares.of_cluster[c];
      EXPECT_NEAR(lanes_sum(of_lights), whole, 1e-5f * whole + 1e-12f);
      for (int i = 0; i < lane_count; i++) {
        double s = double(of_lights[i]), e = best[c * lane_count + size_t(i)];
        sum += s;
        if (e == 0) continue;
        ASSERT_GT(s, 0) << "what does something can be chosen";
        moment += e * e / s, even += e * e * double(clusters.number);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_LT(moment, 1.1);
    EXPECT_GT(even, 1.4) << "the places are no test: any choice would do";
  }
}

TEST(LightClusters, NothingLitHasNoShares) {
  Box box(make_cornell_box(), 20);
  LightClusters clusters = make_light_clusters(*box.lights.tables, box.pass);
  ClusterShares shares;
  EXPECT_FALSE(share_lights(clusters, 0.05f, {}, shares));
  LitPoint nowhere{vec3(std::numeric_limits<float>::quiet_NaN()), {0, 1, 0}};
  EXPECT_FALSE(share_lights(clusters, 0.05f, std::span(&nowhere, 1), shares));
}
