// SPDX-License-Identifier: Apache-2.0
// Pixels that lie side by side are lit as each would be alone.
#include "picture/cells/pixel_light.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace wellspring::test {
namespace {

TEST(PixelLight, SomeFlatPixelsAreLitAsAllWouldBe) {
  Rng rng(3);
  auto number = [&] { return float(rng.next() >> 8) * 0x1p-24f; };
  auto numbers = [&] {
    return Lanes{number(), number(), number(), number(), number(), number(), number(), number()};
  };
  for (int round = 0; round < 200; round++) {
    Pixels p;
    p.x = numbers() - 0.5f, p.y = numbers() - 0.5f, p.depth = 0.9f + 0.2f * numbers();
    p.nx = numbers() - 0.5f, p.ny = numbers() - 0.5f, p.nz = all_lanes(1);
    p.normal2 = p.nx * p.nx + p.ny * p.ny + p.nz * p.nz;
    p.object = LaneBits{1, 1, 1, 2, 1, 1, 1, 2};
    CellLightOf<Lanes, LaneBits> cell[4];
    const CellLightOf<Lanes, LaneBits>* corners[4];
    Lanes weights[4];
    for (int k = 0; k < 4; k++) {
      CellLightOf<Lanes, LaneBits>& c = cell[k];
      corners[k] = &c, weights[k] = all_lanes(0.25f);
      for (int n = 0; n < 3; n++) c.smooth[n] = numbers(), c.rest[n] = numbers();
      c.prior_weight = numbers(), c.detail = numbers(), c.noise = numbers();
      c.normal[0] = c.normal[1] = Lanes{}, c.normal[2] = all_lanes(1);
      c.plane[0] = 0.1f * numbers(), c.plane[1] = 0.1f * numbers(), c.plane[2] = all_lanes(1);
      c.object = LaneBits{1, 1, 1, 1, 1, 1, 1, 2} + uint32_t(k == round % 4);
    }
    LaneMask flat = lanes_of_bits(rng.next() & 255);
    Surroundings some = look_around(corners, flat, weights, p),
                 all = look_around(corners, true, weights, p),
                 none = look_around(corners, false, weights, p);
    for (int i = 0; i < lane_count; i++) {
      const Surroundings& wanted = flat[i] ? all : none;
      ASSERT_EQ(some.lonely[i], wanted.lonely[i]) << round << " " << i;
      ASSERT_NEAR(some.smooth.g[i], wanted.smooth.g[i], 1e-5f) << round << " " << i;
      ASSERT_NEAR(some.rest.b[i], wanted.rest.b[i], 1e-5f) << round << " " << i;
      ASSERT_NEAR(some.prior_weight[i], wanted.prior_weight[i], 1e-5f) << round << " " << i;
      ASSERT_NEAR(some.noise[i], wanted.noise[i], 1e-5f) << round << " " << i;
    }
  }
}

}  // namespace
}  // namespace wellspring::test
