// SPDX-License-Identifier: Apache-2.0
// Two layers at one place, and maps that do not lie alike.
#include <gtest/gtest.h>

#include "store/picture/sample_picture.h"
#include "unit/store/address_picture.h"

namespace wellspring::test {
namespace {

// One colour in its left half, another in the right one, in a single tile.
class TwoColors : public AddressPicture {
 public:
  TwoColors(uint8_t left, uint8_t right) : AddressPicture(64, 64, 64), left_(left), right_(right) {}
  Fetched fetch(PieceKey) const override {
    auto piece = std::make_shared<store::Piece>();
    piece->width = piece->height = 64;
    for (int i = 0; i < 64 * 64; i++) {
      const uint8_t code = i % 64 < 32 ? left_ : right_;
      piece->bytes.insert(piece->bytes.end(), {code, code, code, 255});
    }
    return {piece};
  }

 private:
  const uint8_t left_, right_;
};

struct ShownPictureTest : testing::Test {
  std::shared_ptr<PieceStore> store = std::make_shared<PieceStore>(size_t(1) << 24, 1);
  PictureLayer layer(uint8_t left, uint8_t right) {
    return {std::make_shared<LargePicture>(store, std::make_shared<TwoColors>(left, right))};
  }
  float look(const ShownPicture& shown, double x, double y = 0.5) {
    PictureSampler sampler(*store);
    return sampler.look(shown, PictureFootprint{{x, y}, {1 / 64.0, 0}, {0, 1 / 64.0}}).x;
  }
};

TEST_F(ShownPictureTest, TwoLayersAreShownByCurtainFadeAndDifference) {
  const PictureLayer white = layer(255, 255), black = layer(0, 0);
  ShownPicture shown{white, black, Blend::curtain, 0.25f};
  EXPECT_FLOAT_EQ(look(shown, 0.2), 1);
  EXPECT_FLOAT_EQ(look(shown, 0.3), 0);
  shown.blend = Blend::fade;
  EXPECT_FLOAT_EQ(look(shown, 0.3), 0.75f);
  shown.blend = Blend::difference;
  EXPECT_FLOAT_EQ(look(shown, 0.3), 1);
  EXPECT_FLOAT_EQ(look({white, white, Blend::difference}, 0.3), 0);
  shown.blend = Blend::none;
  EXPECT_FLOAT_EQ(look(shown, 0.3), 1);
  EXPECT_FLOAT_EQ(look({white, {}, Blend::fade, 1}, 0.3), 1) << "there is no second layer";
}

TEST_F(ShownPictureTest, CornersPlaceALayerOverTheFirst) {
  // The first layer's corners lie in this one's left half, which is white.
  PictureLayer map = layer(255, 0);
  EXPECT_FLOAT_EQ(look({map}, 0.9), 0);
  map.placing = *square_to_corners({dvec2(0, 0), dvec2(0.4, 0), dvec2(0.4, 1), dvec2(0, 1)});
  EXPECT_FLOAT_EQ(look({map}, 0.9), 1);
}

TEST_F(ShownPictureTest, CornersLeadToCornersAndFootprintsToTheirDerivatives) {
  const std::array<dvec2, 4> corners = {dvec2(0.1, 0.05), dvec2(0.9, 0.2), dvec2(1.1, 0.95),
                                        dvec2(-0.1, 0.7)};
  const glm::dmat3 placing = square_to_corners(corners).value();
  const dvec2 square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; i++) {
    const dvec2 at = placed_footprint({square[i], {}, {}}, placing).at;
    EXPECT_NEAR(length(at - corners[size_t(i)]), 0, 1e-12);
  }
  const dvec2 at(0.3, 0.8), across(1e-6, 2e-6);
  const PictureFootprint placed = placed_footprint({at, across, {}}, placing);
  const dvec2 moved = placed_footprint({at + across, {}, {}}, placing).at - placed.at;
  EXPECT_NEAR(length(placed.across - moved), 0, 1e-5 * length(moved));
}

TEST_F(ShownPictureTest, CornersOnALineAreNone) {
  EXPECT_FALSE(square_to_corners({dvec2(0, 0), dvec2(1, 0), dvec2(2, 0), dvec2(0, 1)}));
  EXPECT_FALSE(square_to_corners({dvec2(0, 0), dvec2(0, 0), dvec2(1, 1), dvec2(0, 1)}));
  EXPECT_FALSE(square_to_corners({dvec2(0, 0), dvec2(NAN, 0), dvec2(1, 1), dvec2(0, 1)}));
}

}  // namespace
}  // namespace wellspring::test
