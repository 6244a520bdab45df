// SPDX-License-Identifier: Apache-2.0
#include "store/picture/sample_picture.h"

#include <gtest/gtest.h>

#include <malloc.h>
#include <optional>
#include <random>

#include "image/srgb.h"
#include "store/picture/kept_levels.h"
#include "unit/store/address_picture.h"

namespace wellspring::test {
namespace {

constexpr int64_t whole = int64_t(1) << 20;

// An address picture in a store without threads.
struct Shown {
  double now = 0;
  std::shared_ptr<AddressPicture> picture;
  std::shared_ptr<PieceStore> store;
  LargePicture large;
  explicit Shown(int64_t width = whole, int64_t height = whole, size_t budget = size_t(256) << 20)
      : picture(std::make_shared<AddressPicture>(width, height)),
        store(std::make_shared<PieceStore>(budget, 0, [this] { return now; })),
        large(store, picture) {}
  vec3 look(dvec2 at, double texels_across, double texels_down) {
    PictureSampler sampler(*store);
    const dvec2 size(double(picture->levels()[0].width), double(picture->levels()[0].height));
    return sampler.look(large, {at, dvec2(texels_across, 0) / size, dvec2(0, texels_down) / size});
  }
  void fetch_seen(PieceClient& client, std::vector<PieceMotion>& motions) {
    client.want(make_wishes(
        large.seen.take(), [&](int) { return &large.sizes; }, motions));
    while (store->fetch_next()) {}
  }
};

int code(float linear) {
  int best = 0;
  for (int i = 1; i < 256; i++)
    if (std::abs(srgb_table[size_t(i)] - linear) < std::abs(srgb_table[size_t(best)] - linear))
      best = i;
  return best;
}

TEST(SamplePicture, ThereIsNeverAHole) {
  Shown shown;
  const int last = int(shown.picture->levels().size()) - 1;
  EXPECT_EQ(code(shown.look({0.3, 0.7}, 1, 1).x), last);
}

TEST(SamplePicture, LevelIsTheLogarithmOfTexelsAPixel) {
  Shown shown;
  PieceClient client(shown.store);
  std::vector<PieceMotion> motions;
  for (double texels = 0.4; texels < 4000; texels *= 1.37) {
    const dvec2 at(0.31, 0.62);
    shown.look(at, texels, texels);
    shown.fetch_seen(client, motions);
    const float level = shown.look(at, texels, texels).x;
    const double ideal = std::max(std::log2(texels), 0.0);
    const int low = int(std::floor(ideal));
    const float blend = float(ideal - low);
    const float expected =
        srgb_table[size_t(low)] * (1 - blend) + srgb_table[size_t(low + 1)] * blend;
    EXPECT_NEAR(level, expected, 1e-5f) << texels;
  }
}

TEST(SamplePicture, LooksThatFoundTexelsTooCoarseAreCounted) {
  Shown shown;
  PieceClient client(shown.store);
  std::vector<PieceMotion> motions;
  shown.look({0.31, 0.62}, 3, 3);
  EXPECT_EQ(shown.store->stats().looked_coarse, 1u) << "only the coarsest level is there";
  shown.fetch_seen(client, motions);
  shown.look({0.31, 0.62}, 3, 3);
  shown.look({0.31, 0.62}, 1.6, 1.6);  // one level finer than what was fetched
  EXPECT_EQ(shown.store->stats().looked, 3u);
  EXPECT_EQ(shown.store->stats().looked_coarse, 1u);
}

// Along a path with jumps, all that is shown is of the tile that was asked for or of one above it.
TEST(SamplePicture, EveryTexelIsTheRightOneOrItsAncestor) {
  Shown shown(whole, whole, size_t(24) << 20);
  PieceClient client(shown.store);
  std::vector<PieceMotion> motions;
  std::mt19937 random(5);
  auto uniform = [&] { return double(random()) / 4294967296.0; };
  dvec2 middle(0.5);
  double texels = 64;
  int exact = 0, looks = 0;
  for (int step = 0; step < 300; step++) {
    shown.now += 0.03;
    if (random() % 16 == 0) middle = {uniform(), uniform()}, texels = std::exp2(random() % 12);
    middle += (dvec2(uniform(), uniform()) - 0.5) * (texels * 200 / double(whole));
    for (int i = 0; i < 60; i++) {
      const dvec2 at =
          middle + (dvec2(uniform(), uniform()) - 0.5) * (texels * 600 / double(whole));
      const vec3 color = shown.look(at, texels, texels);
      // A texel between tiles is a mixture.
      const int level = code(color.x);
      if (std::abs(srgb_table[size_t(level)] - color.x) > 1e-6f) continue;
      const PyramidLevel& l = shown.picture->levels()[size_t(level)];
      const dvec2 place = glm::clamp(at, dvec2(0), dvec2(1 - 1e-12)) * dvec2(l.width, l.height);
      const dvec2 within = glm::fract(place / 256.0) * 256.0;
      if (glm::any(glm::lessThan(within, dvec2(1))) ||
          glm::any(glm::greaterThan(within, dvec2(255))))
        continue;
      EXPECT_EQ(code(color.y), int(place.x / 256) & 255) << level;
      EXPECT_EQ(code(color.z), int(place.y / 256) & 255) << level;
      EXPECT_GE(level, int(std::log2(texels) - 1e-3));
      looks++, exact += level <= int(std::log2(texels)) + 1;
    }
    client.want(make_wishes(
        shown.large.seen.take(), [&](int) { return &shown.large.sizes; }, motions));
    for (int fetches = 0; fetches < 12 && shown.store->fetch_next(); fetches++) {}
  }
  EXPECT_GT(looks, 3000);
  EXPECT_GT(exact, looks / 2);
}

TEST(SamplePicture, ASlantedPixelReadsAlongItsLongerAxis) {
  Shown shown;
  PieceClient client(shown.store);
  std::vector<PieceMotion> motions;
  const dvec2 at(0.41, 0.53);
  for (double longer : {2.0, 8.0, 16.0, 64.0}) {
    shown.look(at, longer, 1);
    shown.fetch_seen(client, motions);
    const double ideal = std::max(std::log2(longer / 16), 0.0);
    EXPECT_NEAR(shown.look(at, longer, 1).x, srgb_table[size_t(ideal)], 1e-5f) << longer;
  }
}

// Fine stripes, and what a pixel of them looks like that is seen nearly along the wall.
struct Stripes {
  static constexpr int side = 1024;
  std::vector<float> bright = std::vector<float>(size_t(side) * side);  // linear
  std::shared_ptr<PieceStore> store = std::make_shared<PieceStore>(size_t(64) << 20, 0);
  std::optional<LargePicture> large;

  // `normal`: across the stripes, whose width is `period` texels for a dark and a bright one.
  Stripes(dvec2 normal, double period) {
    store::Piece whole{side, side, {}};
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++) {
        const double wave = std::sin(2 * pi / period * dot(normal, dvec2(x, y)));
        const auto code = uint8_t(127.5 + 127.5 * wave);
        bright[size_t(y * side + x)] = srgb_table[code];
        whole.bytes.insert(whole.bytes.end(), {code, code, code, 255});
      }
    large.emplace(store, make_pyramid(std::move(whole)));
  }
  // `across` and `down` are in texels.
  float look(dvec2 at, dvec2 across, dvec2 down) {
    const double texels = side;
    return PictureSampler(*store).look(*large, {at / texels, across / texels, down / texels}).x;
  }
  float supersample(dvec2 at, dvec2 across, dvec2 down) const {
    constexpr int samples = 32;
    double sum = 0;
    for (int i = 0; i < samples * samples; i++) {
      const double u = (i % samples + 0.5) / samples - 0.5, v = (i / samples + 0.5) / samples - 0.5;
      const dvec2 place = at + across * u + down * v;
      sum += double(bright[size_t(int(place.y) * side + int(place.x))]);
    }
    return float(sum / (samples * samples));
  }
};

struct Variance {
  double sum = 0, squares = 0, count = 0;
  void add(double value) { sum += value, squares += value * value, count++; }
  double get() const { return squares / count - sum * sum / (count * count); }
};

// At two degrees a pixel is 29 times as high as wide on the wall, which is more than the taps.
TEST(SamplePicture, StripesSeenAtAGrazingAngleAreAsSupersampledAndDoNotShimmer) {
  const double stretch = 1 / std::sin(2 * pi / 180);
  std::mt19937 random(11);
  auto uniform = [&] { return double(random()) / 4294967296.0; };
  double error = 0, looks = 0;
  for (double turn : {0.0, 0.2, 0.8, 1.5708})
    for (double period : {3.0, 6.0, 17.0, 40.0}) {
      Stripes stripes({std::cos(turn), std::sin(turn)}, period);
      PieceClient client(stripes.store);
      std::vector<PieceMotion> motions;
      for (double pixel : {0.5, 1.0, 2.0}) {
        const dvec2 across(pixel, 0), down(0, pixel * stretch);
        Variance seen, wanted;
        for (bool there : {false, true}) {
          for (int i = 0; i < 64; i++) {
            // The eye moves by parts of a pixel.
            const dvec2 at = dvec2(500) + across * (4 * uniform()) + down * uniform();
            const float color = stripes.look(at, across, down);
            if (!there) continue;
            const float right = stripes.supersample(at, across, down);
            seen.add(color), wanted.add(right);
            error += std::abs(color - right), looks++;
          }
          client.want(make_wishes(
              stripes.large->seen.take(), [&](int) { return &stripes.large->sizes; }, motions));
          while (stripes.store->fetch_next()) {}
        }
        EXPECT_LT(seen.get(), 1.5 * wanted.get()) << turn << " " << period << " " << pixel;
      }
    }
  EXPECT_LT(error / looks, 0.035);
}

// As they are in memory while nobody looks at them, with the most that is kept of each.
TEST(SamplePicture, FiveHundredPicturesTakeLittleMemory) {
  auto picture = std::make_shared<AddressPicture>(whole, whole);
  auto store = std::make_shared<PieceStore>(size_t(256) << 20, 0);
  const auto used = [] {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const size_t before = used();
  if (before == 0) GTEST_SKIP() << "a sanitizer's allocator does not tell";
  std::vector<std::unique_ptr<LargePicture>> hall;
  for (int i = 0; i < 500; i++) hall.push_back(std::make_unique<LargePicture>(store, picture));
  EXPECT_EQ(hall[0]->coarsest.width, coarsest_side);
  EXPECT_LT(used() - before, size_t(150'000'000));
  EXPECT_GT(used() - before, size_t(100'000'000)) << "and it is measured";
}

TEST(SamplePicture, HardNumbersAreAnswered) {
  Shown shown(1, 1), wide(30000, 3);
  const double nan = std::nan(""), huge = 1e300;
  for (Shown* one : {&shown, &wide})
    for (dvec2 at : {dvec2(nan, 0), dvec2(huge, -huge), dvec2(-0.0, 1), dvec2(0.5, 1e-310)})
      for (double across : {0.0, nan, huge, 1e-310, -3.0}) {
        const vec3 color = one->look(at, across, 1);
        EXPECT_TRUE(is_finite(color)) << at.x << " " << across;
      }
}

// The paper's test (section 6): all of a picture is new each second, with a second of grace.
TEST(SamplePicture, BetweenSoftAndHardExpiryNothingFallsALevel) {
  Shown shown(131072, 65536);
  shown.picture->soft = 1, shown.picture->hard = 2;
  PieceClient client(shown.store);
  std::vector<PieceMotion> motions;
  double x = 0.2;
  auto draw = [&](bool checks) {
    for (int i = 0; i < 8; i++)
      for (int j = 0; j < 5; j++) {
        const dvec2 at(x + i * 0.00025, 0.4 + j * 0.0005);
        const float level = shown.look(at, 1, 1).x;
        if (checks) {
          EXPECT_EQ(level, 0) << shown.now;
        }
      }
    client.want(make_wishes(
        shown.large.seen.take(), [&](int) { return &shown.large.sizes; }, motions));
  };
  draw(false);
  while (shown.store->fetch_next()) {}
  for (int frame = 0; frame < 600; frame++) {
    shown.now += 1 / 60.0;
    x += 1e-6;
    draw(true);
    for (int fetches = 0; fetches < 3 && shown.store->fetch_next(); fetches++) {}
  }
  EXPECT_GT(shown.picture->fetches, 60);
}

TEST(MakeWishes, GoOutwardsFromTheMiddleAndForwards) {
  const LevelSizes sizes = {{64, 64}, {32, 32}, {16, 16}, {8, 8}};
  auto sizes_of = [&](int) { return &sizes; };
  std::vector<PieceMotion> motions;
  std::vector<SeenPiece> seen;
  for (uint32_t x = 10; x < 13; x++)
    for (uint32_t y = 10; y < 13; y++) seen.push_back({{1, 1, x, y}, 100});
  make_wishes(seen, sizes_of, motions);
  for (SeenPiece& piece : seen) piece.key = {1, 1, piece.key.column() + 1, piece.key.row()};
  // A quarter of a piece to the right is slow, so detail comes first.
  motions[0].middle = dvec2(12.5 - 0.25, 11.5);
  const std::vector<Wish> wishes = make_wishes(seen, sizes_of, motions);
  EXPECT_NEAR(motions[0].way.x, 0.25f, 1e-5f);
  std::vector<Wish> shown;
  for (const Wish& wish : wishes)
    if (wish.urgency == Urgency::shown) shown.push_back(wish);
  ASSERT_EQ(shown.size(), 4 + 9u);  // four pieces of level 2 lie below nine of level 1
  for (size_t i = 0; i < 4; i++) EXPECT_EQ(shown[i].key.level(), 2);
  EXPECT_EQ(shown[4].key, PieceKey(1, 1, 12, 11));  // the middle, then what lies to the right
  EXPECT_EQ(shown[5].key.column(), 13u);
  EXPECT_EQ(shown.back().key.column(), 11u);
  std::vector<PieceKey> ahead;
  for (const Wish& wish : wishes)
    if (wish.urgency == Urgency::ahead && wish.key.level() == 1) ahead.push_back(wish.key);
  ASSERT_EQ(ahead.size(), 5u);
  for (PieceKey key : ahead) EXPECT_EQ(key.column(), 14u);
  EXPECT_EQ(ahead.front().row(), 11u);
  for (size_t i = 1; i < wishes.size(); i++)
    EXPECT_LE(int(wishes[i - 1].urgency), int(wishes[i].urgency));
  const Wish last = wishes.back();
  EXPECT_EQ(last.urgency, Urgency::wished);
  EXPECT_EQ(last.key.level(), 0);
}

TEST(MakeWishes, InFlightALevelComesWithWhatIsAhead) {
  const LevelSizes sizes = {{64, 64}, {32, 32}, {16, 16}, {8, 8}};
  std::vector<PieceMotion> motions = {{1, dvec2(10.5, 11.5), vec2(0), 1}};
  std::vector<SeenPiece> seen = {{{1, 1, 12, 11}, 10}};
  const auto wishes = make_wishes(
      seen, [&](int) { return &sizes; }, motions);
  int level = 2;
  for (const Wish& wish : wishes) {
    if (wish.urgency != Urgency::shown) break;
    EXPECT_LE(wish.key.level(), level);
    level = wish.key.level();
  }
  EXPECT_EQ(level, 1);
  EXPECT_TRUE(std::any_of(wishes.begin(), wishes.end(), [](const Wish& wish) {
    return wish.urgency == Urgency::shown && wish.key == PieceKey(1, 1, 13, 11);
  }));
}

}  // namespace
}  // namespace wellspring::test
