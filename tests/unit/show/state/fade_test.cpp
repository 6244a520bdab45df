// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_picture.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

Keyframe gray_keyframe(int width, int height, uint8_t value) {
  View view{.width = width, .height = height};
  Image8 image{width, height, std::vector<uint8_t>(3 * size_t(width * height), value)};
  Keyframe keyframe;
  make_keyframe(view, image, std::vector<float>(size_t(width * height), 1.0f), keyframe);
  return keyframe;
}
Image8 gray(int width, int height, uint8_t value) {
  return {width, height, std::vector<uint8_t>(3 * size_t(width * height), value)};
}

TEST(Fade, LeadsFromOnePictureToTheNext) {
  Keyframe before = gray_keyframe(17, 9, 40);
  Fade fade;
  begin_fade(before, 10, fade);
  EXPECT_EQ(fade_share(fade, before.view, 10), 0);
  float last = 0;
  for (double time = 10; time < 11; time += 0.05) {
    float share = fade_share(fade, before.view, time);
    EXPECT_GE(share, last);
    EXPECT_LT(share - last, 0.2f);  // no jump
    last = share;
    Image8 image = gray(17, 9, 240);
    mix_fade(fade, share, image);
    for (uint8_t code : image.rgb) ASSERT_NEAR(double(code), 40 + 200 * double(share), 1.5);
  }
  EXPECT_EQ(last, 1);
}

TEST(Fade, ItsEndsAreThePicturesThemselves) {
  Keyframe before = gray_keyframe(4, 3, 255);
  Fade fade;
  begin_fade(before, 0, fade);
  Image8 image = gray(4, 3, 0);
  mix_fade(fade, 1, image);
  EXPECT_EQ(image.rgb, gray(4, 3, 0).rgb);
  mix_fade(fade, 0, image);
  EXPECT_EQ(image.rgb, gray(4, 3, 255).rgb);
}

TEST(Fade, OtherViewsAndSizesAreLeftAlone) {
  Keyframe before = gray_keyframe(4, 3, 255);
  Fade fade;
  EXPECT_EQ(fade_share(fade, before.view, 0), 1);  // nothing fades
  begin_fade(before, 0, fade);
  View other = before.view;
  other.position.x += 1;
  EXPECT_EQ(fade_share(fade, other, 0), 1);
  Image8 larger = gray(8, 3, 7);
  mix_fade(fade, 0, larger);
  EXPECT_EQ(larger.rgb, gray(8, 3, 7).rgb);
}

}  // namespace
}  // namespace wellspring::test
