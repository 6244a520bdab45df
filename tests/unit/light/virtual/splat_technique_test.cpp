// SPDX-License-Identifier: Apache-2.0
// Technique `multires_splatting`: direct light and one bounce.
#include <gtest/gtest.h>

#include "light/technique/technique.h"
#include "scenes/scenes.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;

namespace {

Frame render(const char* technique, int max_depth, int spp, const SplatSettings& splat = {}) {
  Scene scene = make_cornell_box();
  View view = cornell_view(scene, 24, 24);
  World world(scene);
  StillSettings settings;
  settings.spp = spp;
  settings.transport.max_depth = max_depth;
  settings.transport.splat = splat;
  return render_still(*find_technique(technique), world, make_lights(world), view, settings);
}

// Means of 6 x 6 pixels each, so that noise is small.
std::vector<dvec3> means_of(const Frame& frame) {
  std::vector<dvec3> means(16, dvec3(0));
  for (int y = 0; y < 24; y++)
    for (int x = 0; x < 24; x++)
      means[size_t(y / 6 * 4 + x / 6)] += dvec3(frame.color[size_t(y * 24 + x)]) / 36.0;
  return means;
}

}  // namespace

TEST(SplatTechnique, ManyPassesAreDirectLightAndOneBounce) {
  std::vector<dvec3> truth = means_of(render("path", 3, 512)),
                     direct = means_of(render("direct", 3, 64)),
                     found = means_of(render("multires_splatting", 3, 64));
  for (size_t i = 0; i < truth.size(); i++)
    for (int c = 0; c < 3; c++) {
      double bounce = truth[i][c] - direct[i][c];
      EXPECT_NEAR(found[i][c], truth[i][c], 0.06 * truth[i][c] + 0.002)
          << i << " channel " << c << ", bounce " << bounce;
    }
}

TEST(SplatTechnique, WithoutRoomForABounceItIsDirectLight) {
  Frame direct = render("direct", 2, 2), found = render("multires_splatting", 2, 2);
  for (size_t i = 0; i < direct.color.size(); i++) EXPECT_EQ(found.color[i], direct.color[i]);
}

// Each pass draws other virtual lights; the same pass always the same.
TEST(SplatTechnique, PassesAreRepeatable) {
  Frame a = render("multires_splatting", 3, 2), b = render("multires_splatting", 3, 2);
  EXPECT_EQ(a.color, b.color);
}
