// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::test {
namespace {

TEST(Png, WhatIsWrittenIsReadBackWithItsComment) {
  Image8 image{37, 21, std::vector<uint8_t>(37 * 21 * 3)};
  for (size_t i = 0; i < image.rgb.size(); i++) image.rgb[i] = uint8_t(i * i / 7);
  const std::string comment = "seed 1, exposé";
  const std::vector<uint8_t> bytes = encode_png(image, comment, "a.png");
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find("tEXtComment" + ('\0' + comment)),
            std::string::npos);
  const ImageCodes back = decode_codes(bytes, 37 * 21, "a.png");
  ASSERT_EQ(back.codes8.size(), 4u * 37 * 21);
  for (size_t i = 0; i < image.rgb.size(); i++)
    ASSERT_EQ(back.codes8[i / 3 * 4 + i % 3], image.rgb[i]) << i;
  EXPECT_THROW(decode_codes(bytes, 37 * 21 - 1, "a.png"), LoadError);
  EXPECT_THROW(encode_png({0, 0, {}}, "", "a.png"), LoadError);
}

}  // namespace
}  // namespace wellspring::test
