// SPDX-License-Identifier: Apache-2.0
// What pixels get that a warped picture has no colour for.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "picture/fill_unseen.h"

namespace wellspring {
namespace {

enum class Kind { seen, hidden, outside };
struct Pixel {
  int level = 0;        // of red; green is half of it, blue a third
  float disparity = 0;  // of hidden ones: of what hid them
  Kind kind = Kind::seen;
};
using Paint = std::function<Pixel(int x, int y)>;

struct Filled {
  Image8 before, after;
  int width = 0;
  int red(int x, int y) const { return after.rgb[3 * (size_t(y) * size_t(width) + size_t(x))]; }
};
constexpr uint8_t unset = 251;
// Disparities differ from block to block only where `flat`. A unit of disparity is 100 pixels,
// sideways.
Filled fill(int width, int height, const Paint& paint, vec3 parallax = vec3(100, 0, 0),
            bool flat = false) {
  Unseen unseen;
  resize_unseen(width, height, unseen);
  std::fill(unseen.hidden.begin(), unseen.hidden.end(), 0);
  std::fill(unseen.outside.begin(), unseen.outside.end(), 0);
  std::fill(unseen.flat.begin(), unseen.flat.end(), Unseen::many);
  Filled filled{{width, height, {}}, {}, width};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      Pixel p = paint(x, y);
      size_t word = size_t(y) * size_t(unseen.columns) + size_t(x / 8);
      if (p.kind == Kind::hidden) unseen.hidden[word] |= uint8_t(1 << x % 8);
      if (p.kind == Kind::outside) unseen.outside[word] |= uint8_t(1 << x % 8);
      unseen.disparity[size_t(y) * size_t(width) + size_t(x)] = p.disparity;
      if (flat) unseen.flat[size_t(y / 8) * size_t(unseen.columns) + size_t(x / 8)] = p.disparity;
      bool seen = p.kind == Kind::seen;
      for (int share : {1, 2, 3})
        filled.before.rgb.push_back(seen ? uint8_t(p.level / share) : unset);
    }
  filled.after = filled.before;
  FillScratch scratch;
  fill_unseen(unseen, parallax, scratch, filled.after);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      if (paint(x, y).kind != Kind::seen) continue;
      size_t i = 3 * (size_t(y) * size_t(width) + size_t(x));
      EXPECT_TRUE(std::equal(&filled.after.rgb[i], &filled.after.rgb[i] + 3, &filled.before.rgb[i]))
          << x << ", " << y;
    }
  return filled;
}

// A near figure has uncovered forty pixels of what lies behind it, wherever blocks begin: nothing
// of the figure gets there, and all channels are of one colour.
TEST(FillUnseen, WhatWasHiddenIsNothingOfWhatHidIt) {
  for (int shift : {0, 1, 3, 6})
    for (bool mirrored : {false, true}) {
      auto paint = [&](int x, int y) -> Pixel {
        x = (mirrored ? 199 - x : x) - shift;
        if (x >= 60 && x < 100) return {0, 0.5f + 0.001f * float(y), Kind::hidden};
        // Both move on by a tenth of a pixel from row to row, as floors do.
        float slope = 0.001f * float(y);
        return x < 60 ? Pixel{250, 0.5f + slope} : Pixel{90, 0.1f + slope};
      };
      Filled filled = fill(200, 120, paint);
      for (int y = 0; y < 120; y++)
        for (int x = 0; x < 200; x++)
          if (paint(x, y).kind == Kind::hidden) {
            ASSERT_NEAR(filled.red(x, y), 90, 1) << x << ", " << y;
            ASSERT_NEAR(filled.after.rgb[3 * (size_t(y) * 200 + size_t(x)) + 1], 45, 1);
          }
    }
}

// Of two sides the farther one counts, however much there is of the other.
TEST(FillUnseen, TheFartherSideGoesOn) {
  auto paint = [](int x, int y) -> Pixel {
    if (std::hypot(float(x) - 50, float(y) - 50) < 20) return {0, 0.5f, Kind::hidden};
    return x >= 62 && x < 80 ? Pixel{40, 0.05f} : Pixel{200, 0.5f};
  };
  Filled filled = fill(100, 100, paint);
  for (int y = 34; y < 67; y++)  // where that side is the end of the row
    for (int x = 36; x < 62; x++)
      if (paint(x, y).kind == Kind::hidden) {
        ASSERT_NEAR(filled.red(x, y), 40, 6) << x << ", " << y;
      }
}

// Thin lead before the sky, of which a wall as near has hidden half: the sky goes on, not the lead.
TEST(FillUnseen, PanesGoOnAsWhatIsBehindTheirLead) {
  auto paint = [](int x, int y) -> Pixel {
    if ((x + y) % 16 < 2 || (x - y + 400) % 16 < 2) return {10, 0.3f};
    return x < 100 ? Pixel{230, 0} : Pixel{0, 0.3f, Kind::hidden};
  };
  Filled filled = fill(200, 120, paint);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < 120; y++)
    for (int x = 100; x < 200; x++) {
      if (paint(x, y).kind != Kind::hidden || (x + y) % 16 < 3 || (x - y + 400) % 16 < 3) continue;
      if ((x + y) % 16 == 15 || (x - y + 400) % 16 == 15)
        continue;  // not at corners, where holes are narrow
      sum += filled.red(x, y), count++;
    }
  EXPECT_GT(sum / count, 200);
}

// What is uncovered where a thin bar was is what is on both sides of it, far from the bar.
TEST(FillUnseen, WhereABarWasIsWhatLiesAround) {
  auto paint = [](int x, int) -> Pixel {
    if (x >= 60 && x < 70) return {0, 0.5f, Kind::hidden};
    return x >= 90 && x < 100 ? Pixel{10, 0.5f} : Pixel{180, 0.1f};
  };
  Filled filled = fill(160, 80, paint);
  for (int y = 0; y < 80; y++)
    for (int x = 60; x < 70; x++) ASSERT_NEAR(filled.red(x, y), 180, 1) << x << ", " << y;
}

// A crack in a near surface shows that surface, although a far one is beside it.
TEST(FillUnseen, ACrackIsOfItsSurface) {
  auto paint = [](int x, int) -> Pixel {
    if (x == 45) return {0, 0.5f, Kind::hidden};
    return x < 50 ? Pixel{200, 0.5f} : Pixel{20, 0};
  };
  Filled filled = fill(100, 60, paint);
  for (int y = 0; y < 60; y++) ASSERT_NEAR(filled.red(45, y), 200, 2) << y;
}

// Rows black and white by turns go on as their mean, not as streaks: in the middle of what is
// unseen, rows that follow each other differ by less than a twentieth of what they do around.
TEST(FillUnseen, NoRowStandsForItself) {
  for (Kind kind : {Kind::hidden, Kind::outside}) {
    auto paint = [=](int x, int y) -> Pixel {
      if (kind == Kind::hidden ? x >= 60 && x < 100 : x >= 140) return {0, 0.5f, kind};
      return {(y & 1) * 240, kind == Kind::hidden && x < 60 ? 0.5f : 0.1f};
    };
    Filled filled = fill(200, 120, paint);
    int middle = kind == Kind::hidden ? 80 : 170;
    for (int y = 1; y < 120; y++) {
      ASSERT_LE(std::abs(filled.red(middle, y) - filled.red(middle, y - 1)), 12) << y;
      ASSERT_NEAR(filled.red(middle, y), 120, 30) << y;
    }
  }
}

// Light that changes slowly goes on where it ends: the seam is no step. Nor are there steps within.
TEST(FillUnseen, GoesOnWithoutSteps) {
  auto paint = [](int x, int y) -> Pixel {
    if (x >= 140) return {0, 0, Kind::outside};
    return {int(std::lround(120 + 100 * std::sin(0.02 * x + 0.03 * y))),
            0};  // 3.6 levels a pixel, at most
  };
  Filled filled = fill(200, 120, paint, vec3(0), true);
  for (int y = 0; y < 120; y++)
    for (int x = 140; x < 200; x++) {
      ASSERT_LE(std::abs(filled.red(x, y) - filled.red(x - 1, y)), 12) << x << ", " << y;
      if (y > 0) {
        ASSERT_LE(std::abs(filled.red(x, y) - filled.red(x, y - 1)), 12) << x << ", " << y;
      }
    }
}

// Nothing becomes brighter or darker than what is seen, whatever disparities and sizes there are.
TEST(FillUnseen, StaysWithinWhatIsSeen) {
  const float odd[] = {0, 1e30f, 1e-30f, 0.3f, 1e4f};
  for (auto [width, height] : {std::pair(1, 1), std::pair(7, 300), std::pair(129, 65)})
    for (vec3 parallax :
         {vec3(0), vec3(30, 5, 1), vec3(1e30f), vec3(std::nanf("")), vec3(INFINITY, 0, 0)}) {
      auto paint = [&](int x, int y) -> Pixel {
        uint32_t hash = (uint32_t(x) * 2654435761u) ^ (uint32_t(y) * 40503u * 65537u);
        return {100 + int(hash >> 8 & 31), odd[hash % 5], Kind(hash >> 16 & 1 ? hash % 3 : 0)};
      };
      Filled filled = fill(width, height, paint, parallax);
      for (size_t i = 0; i < filled.after.rgb.size(); i += 3)
        if (filled.after.rgb[i] != unset) {
          ASSERT_NEAR(filled.after.rgb[i], 116, 16);
        }
    }
}

TEST(FillUnseen, WhereNothingIsSeenNothingChanges) {
  Filled filled = fill(50, 40, [](int x, int) {
    return Pixel{0, 0, x % 2 ? Kind::hidden : Kind::outside};
  });
  EXPECT_EQ(filled.after.rgb, filled.before.rgb);
}

TEST(FillUnseen, SameBitsWhateverTheThreads) {
  auto paint = [](int x, int y) -> Pixel {
    if (x * 7 % 31 < 9 && y % 40 < 30) return {0, 0, x % 3 ? Kind::hidden : Kind::outside};
    return {x * y % 256, 0.01f * float(x % 50)};
  };
  Image8 many = fill(300, 200, paint).after;
  oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(fill(300, 200, paint).after.rgb, many.rgb);
}

}  // namespace
}  // namespace wellspring
