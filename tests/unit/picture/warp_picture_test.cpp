// SPDX-License-Identifier: Apache-2.0
// Pictures warped from keyframes against what the view shows, of a wall and bars whose colours are
// known everywhere.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>

#include "picture/warp_picture.h"

namespace wellspring::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct SeenPlace {
  vec3 color{0};              // 0 to 255
  float distance = infinity;  // along the ray
};
using Place = std::function<SeenPlace(const Ray&)>;

View look_at(vec3 position, float yaw, int width = 200, int height = 120) {
  return View{.position = position,
              .right = vec3(std::cos(yaw), 0, -std::sin(yaw)),
              .forward = vec3(-std::sin(yaw), 0, -std::cos(yaw)),
              .width = width,
              .height = height};
}

struct Drawn {
  Image8 picture;
  std::vector<float> depth;
};
Drawn draw(const Place& place, const View& view) {
  Drawn drawn{{view.width, view.height, {}}, {}};
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      SeenPlace seen = place(ray);
      for (int c = 0; c < 3; c++) drawn.picture.rgb.push_back(uint8_t(seen.color[c] + 0.5f));
      drawn.depth.push_back(seen.distance * dot(ray.direction, view.forward));
    }
  return drawn;
}
Keyframe keyframe_of(const Place& place, const View& view) {
  Drawn drawn = draw(place, view);
  Keyframe keyframe;
  make_keyframe(view, drawn.picture, drawn.depth, keyframe);
  return keyframe;
}
Image8 warp(const Keyframe& keyframe, const View& view) {
  WarpScratch scratch;
  Image8 out;
  warp_picture(keyframe, view, 1, scratch, out);
  return out;
}

// A pattern without edges: at most 0.3 levels of second difference from pixel to pixel at the sizes
// used here.
vec3 pattern(float u, float v) {
  return vec3(128 + 100 * std::sin(3 * u), 128 + 100 * std::cos(3 * v),
              128 + 100 * std::sin(2 * (u + v)));
}
float distance_to_wall(const Ray& ray, float z) {
  return ray.direction.z < 0 ? (z - ray.origin.z) / ray.direction.z : infinity;
}
// A wall at z = -4, painted.
SeenPlace wall(const Ray& ray) {
  float t = distance_to_wall(ray, -4);
  if (!(t < infinity)) return {};
  vec3 p = ray.origin + t * ray.direction;
  return {pattern(p.x, p.y), t};
}
SeenPlace sky(const Ray& ray) {
  return {pattern(2 * std::atan2(ray.direction.x, -ray.direction.z), 2 * ray.direction.y),
          infinity};
}
// Upright red bars, `width` wide, every half metre at z = -2 before a blue and green wall.
Place bars(float width) {
  return [width](const Ray& ray) {
    float t = distance_to_wall(ray, -2);
    float x = ray.origin.x + t * ray.direction.x;
    if (std::abs(x - 0.5f * std::round(2 * x)) < 0.5f * width) return SeenPlace{vec3(255, 0, 0), t};
    SeenPlace behind = wall(ray);
    behind.color.x = 0;
    return behind;
  };
}

int largest_difference(const Image8& a, const Image8& b) {
  int largest = 0;
  for (size_t i = 0; i < a.rgb.size(); i++)
    largest = std::max(largest, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
  return a.rgb.size() == b.rgb.size() ? largest : 256;
}

TEST(WarpPicture, OfTheSameViewIsThePictureItself) {
  View view = look_at({0.3f, 1, 0.2f}, 0.4f, 203, 117);
  Drawn drawn = draw(bars(0.1f), view);
  Keyframe keyframe;
  make_keyframe(view, drawn.picture, drawn.depth, keyframe);
  EXPECT_EQ(warp(keyframe, view).rgb, drawn.picture.rgb);
}

// The keyframe is wider than the picture; the error of linear interpolation of the pattern stays
// below a level, quantising twice adds one.
TEST(WarpPicture, TurningShowsTheSameSky) {
  View before = look_at({0, 0, 0}, 0), now = look_at({0, 0, 0}, 0.05f);
  before.width = 260, before.height = 144;
  before.tan_half_fov *= 144 / 120.0f;
  EXPECT_LE(largest_difference(warp(keyframe_of(sky, before), now), draw(sky, now).picture), 2);
}

TEST(WarpPicture, ApproachedWallGrowsAsItShould) {
  View before = look_at({0, 0, 0}, 0.2f), now = look_at({-0.05f, 0.02f, -0.3f}, 0.2f);
  before.width = 260, before.height = 160;
  before.tan_half_fov *= 160 / 120.0f;
  EXPECT_LE(largest_difference(warp(keyframe_of(wall, before), now), draw(wall, now).picture), 2);
}

// The eye goes aside before a window whose frame stays.
TEST(WarpPicture, BesideTheAxis) {
  View before = look_at({0, 0, 0}, 0.1f), now = before;
  before.width = 260, before.height = 160;
  before.tan_half_fov *= 160 / 120.0f;
  before.middle = {0.1f, 0.05f};
  now.position += 0.12f * now.right - 0.05f * now.up;
  now.middle = {-0.02f, 0.1f};
  EXPECT_LE(largest_difference(warp(keyframe_of(wall, before), now), draw(wall, now).picture), 2);
  EXPECT_LE(largest_difference(warp(keyframe_of(sky, before), now), draw(sky, now).picture), 2);
}

// Another field of view is one more mapping of the same kind.
TEST(WarpPicture, AnotherFieldOfView) {
  View before = look_at({0, 0, 0}, 0), now = before;
  now.tan_half_fov *= 0.8f;
  EXPECT_LE(largest_difference(warp(keyframe_of(wall, before), now), draw(wall, now).picture), 2);
}

// A keyframe in larger pixels is seen softly: edges that it draws within one of its pixels have no
// steps.
TEST(WarpPicture, OfLargerPixelsIsSoft) {
  View view = look_at({0.3f, 1, 0.2f}, 0);
  for (float scale : {0.75f, 0.5f, 0.375f}) {
    Image8 soft = warp(keyframe_of(bars(0.2f), scaled_view(view, scale)), view);
    int step = 0;
    for (size_t i = 3; i < soft.rgb.size(); i++)
      if (i / 3 % size_t(view.width) != 0)
        step = std::max(step, std::abs(int(soft.rgb[i]) - int(soft.rgb[i - 3])));
    EXPECT_LT(step, 255 * scale + 16) << scale;
    EXPECT_GT(step, 64);
  }
}

// A step aside uncovers four pixels beside every bar. They show the wall, and every bar is where it
// is.
TEST(WarpPicture, WhatWasHiddenShowsWhatIsBehind) {
  Place place = bars(0.12f);
  View before = look_at({0, 0, 0}, 0), now = look_at({0.07f, 0, 0}, 0);
  Image8 warped = warp(keyframe_of(place, before), now), right = draw(place, now).picture;
  int red = 0;
  for (int y = 0; y < now.height; y++)
    for (int x = 8; x < now.width - 8; x++) {
      auto is_red = [&](const Image8& image, int at) {
        return image.rgb[3 * (size_t(y) * size_t(now.width) + size_t(at))] > 100;
      };
      red += is_red(right, x);
      // A pixel at an edge may be on either side of it, as the keyframe has it to a pixel.
      if (is_red(right, x - 1) == is_red(right, x) && is_red(right, x) == is_red(right, x + 1)) {
        ASSERT_EQ(is_red(warped, x), is_red(right, x)) << x << ", " << y;
      }
      // The wall is continued by its nearest visible place, four pixels away at most.
      if (!is_red(right, x) && !is_red(warped, x))
        for (size_t c = 1; c < 3; c++) {
          size_t i = 3 * (size_t(y) * size_t(now.width) + size_t(x)) + c;
          ASSERT_NEAR(warped.rgb[i], right.rgb[i], 40) << x << ", " << y;
        }
    }
  EXPECT_GT(red, 1000);
}

// Bars one pixel wide: iteration from the wall's depth alone would lose them.
TEST(WarpPicture, ThinBarsStay) {
  Place place = bars(0.022f);
  View before = look_at({0, 0, 0}, 0), now = look_at({0.1f, 0, 0}, 0.03f);
  auto count_red = [](const Image8& image) {
    int red = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
      red += image.rgb[i] > 100 && image.rgb[i + 1] < 100;
    return red;
  };
  // They stay as wide as they were; one of them, two pixels wide, may have come into view.
  int drawn = count_red(draw(place, before).picture),
      warped = count_red(warp(keyframe_of(place, before), now));
  EXPECT_GT(drawn, 500);
  EXPECT_NEAR(warped, drawn, 2 * now.height);
}

TEST(WarpPicture, SaysHowMuchTheKeyframeDoesNotShow) {
  View before = look_at({0, 0, 0}, 0);
  Keyframe keyframe = keyframe_of(sky, before);
  WarpScratch scratch;
  Image8 out;
  float half_width = before.tan_half_fov * float(before.width) / float(before.height);
  // Turned so that about the left third of the picture looks past the keyframe's edge.
  View now = look_at({0, 0, 0}, std::atan(half_width) - std::atan(half_width / 3));
  int outside = 0;
  for (int y = 0; y < now.height; y++)
    for (int x = 0; x < now.width; x++) {
      Projected there =
          project_point(before, view_ray(now, float(x) + 0.5f, float(y) + 0.5f).direction);
      outside += !(there.x > 0 && there.y > 0 && there.x < float(before.width) &&
                   there.y < float(before.height));
    }
  float pixels = float(now.width * now.height);
  EXPECT_NEAR(warp_picture(keyframe, now, 1, scratch, out), float(outside) / pixels, 0.01f);
  EXPECT_GT(float(outside) / pixels, 0.3f);
  EXPECT_EQ(out.width, before.width);
  EXPECT_GT(warp_picture(keyframe, look_at({0, 0, 0}, pi), 0.5f, scratch, out), 0.95f);
  EXPECT_EQ(warp_picture(Keyframe{}, before, 1, scratch, out), 1);
}

// A cut to a place that the keyframe does not show is refused; the picture asked for is left alone.
TEST(WarpPicture, ACameraCutIsRefused) {
  Keyframe keyframe = keyframe_of(wall, look_at({0, 0, 0}, 0));
  WarpScratch scratch;
  Image8 out;
  for (vec3 place : {vec3(0, 0, -8), vec3(1e6f, 0, 0), vec3(0, -40, 0)})
    EXPECT_GT(warp_picture(keyframe, look_at(place, 0), 0.3f, scratch, out), 0.3f) << place.x;
  EXPECT_TRUE(out.rgb.empty());
}

// Whatever depths and views there are, every pixel gets a colour of the keyframe.
TEST(WarpPicture, NothingIsReadElsewhere) {
  View before = look_at({0, 0, 0}, 0);
  Drawn drawn = draw(bars(0.1f), before);
  for (size_t i = 0; i < drawn.picture.rgb.size(); i++) drawn.picture.rgb[i] = uint8_t(100 + i % 3);
  float nan = std::nanf("");
  const float odd[] = {nan, infinity, -infinity, 0, -1, 1e-30f, 1e30f, 1e-4f};
  for (size_t i = 0; i < drawn.depth.size(); i += 3) drawn.depth[i] = odd[i / 3 % std::size(odd)];
  Keyframe keyframe;
  make_keyframe(before, drawn.picture, drawn.depth, keyframe);
  std::vector<View> views = {
      look_at({0, 0, -2}, 0),  look_at({0, 0, -2.0001f}, 0),      look_at({0.4f, 0, 0}, 0.2f),
      look_at({nan, 0, 0}, 0), look_at({0, 0, 0}, nan),           look_at({1e30f, 0, 0}, 0),
      look_at({0, 0, 0}, 3),   look_at({0, 0, 0.5f}, 0, 7, 1000), look_at({0, 0, 0}, 0, 1, 1)};
  views.push_back(before);
  views.back().tan_half_fov = 1e-3f;
  views.push_back(before);
  views.back().tan_half_fov = 100;
  views.push_back(before);
  views.back().forward = views.back().right = views.back().up = vec3(0);
  for (const View& view : views) {
    WarpScratch scratch;
    Image8 out;
    float unknown = warp_picture(keyframe, view, 1, scratch, out);
    EXPECT_GE(unknown, 0);
    EXPECT_LE(unknown, 1);
    for (size_t i = 0; i < out.rgb.size(); i++) ASSERT_EQ(out.rgb[i], 100 + i % 3);
  }
}

TEST(WarpPicture, SameBitsWhateverTheThreads) {
  View before = look_at({0, 0, 0}, 0), now = look_at({0.1f, 0, -0.1f}, 0.05f);
  Keyframe keyframe = keyframe_of(bars(0.1f), before);
  Image8 many = warp(keyframe, now);
  oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(warp(keyframe, now).rgb, many.rgb);
}

// A turned view's border comes from the smaller picture of all around, the rest is as without that.
TEST(WarpPicture, WhatIsOutsideComesFromAround) {
  for (const Place& place : {Place(sky), Place(wall)}) {
    View before = look_at({0, 0, 0}, 0), now = look_at({0.05f, 0, -0.05f}, 0.3f);
    const View views[] = {before, now};
    View wide = surrounding_view(views, 1 / 4.0f);
    Keyframe keyframe = keyframe_of(place, before), around = keyframe_of(place, wide);
    Image8 truth = draw(place, now).picture, without, with;
    WarpScratch scratch;
    float unknown = warp_picture(keyframe, now, 1, scratch, without);
    EXPECT_GT(unknown, 0.2f);
    EXPECT_EQ(warp_picture(keyframe, around, now, 0, scratch, with),
              0.0f);  // nothing is unknown, so none is too much
    size_t same = 0;
    int worst = 0;
    for (size_t i = 0; i < with.rgb.size(); i += 3) {
      same += std::equal(&with.rgb[i], &with.rgb[i] + 3, &without.rgb[i]);
      for (size_t c = 0; c < 3; c++)
        worst = std::max(worst, std::abs(int(with.rgb[i + c]) - int(truth.rgb[i + c])));
    }
    size_t pixels = truth.rgb.size() / 3;
    // But for those at the seam: a column of three pixels, as the view turned to one side, and such
    // a row.
    size_t seams = size_t(3 * now.height + 3 * now.width);
    EXPECT_GE(same + seams, pixels - size_t(std::lround(unknown * float(pixels))));
    // Bilinear within pixels that are three times as wide: (3 h)^2 / 8 of the pattern's second
    // derivative, 900 levels, of one that is h = 1/120 of the picture's distance wide; and places
    // are right to half a small pixel.
    EXPECT_LE(worst, 8);
  }
}

// At a keyframe's border its light passes into that of its surroundings: no step of more than a
// pixel's part of the way, which is a 64th of its width, and one more for pixels seen at an angle.
TEST(WarpPicture, PassesSmoothlyIntoWhatIsAround) {
  auto plain = [](float level) {
    return Place([=](const Ray&) { return SeenPlace{vec3(level), infinity}; });
  };
  View before = look_at({0, 0, 0}, 0), now = look_at({0, 0, 0}, 0.3f);
  const View views[] = {before, now};
  WarpScratch scratch;
  Image8 out;
  EXPECT_EQ(
      warp_picture(keyframe_of(plain(50), before),
                   keyframe_of(plain(200), surrounding_view(views, 0.25f)), now, 0, scratch, out),
      0.0f);
  auto at = [&](int x) { return int(out.rgb[3 * (size_t(60) * 200 + size_t(x))]); };
  EXPECT_EQ(at(0), 200);
  EXPECT_EQ(at(199), 50);
  for (int x = 1; x < now.width; x++) {
    EXPECT_LE(at(x), at(x - 1)) << x;
    EXPECT_GE(at(x), at(x - 1) - 2 * 150 / 3) << x;
  }
}

// A step aside uncovers what the newest keyframe does not show, and the one before does.
TEST(WarpPicture, WhatIsHiddenComesFromTheKeyframeBefore) {
  const Place place = bars(0.12f);
  const View now = look_at({0.07f, 0, 0}, 0);
  const Keyframe newest = keyframe_of(place, look_at({0, 0, 0}, 0)),
                 before = keyframe_of(place, look_at({0.14f, 0, 0}, 0));
  const Image8 right = draw(place, now).picture;
  auto count_wrong = [&](const Image8& image) {
    int wrong = 0;
    for (int y = 0; y < now.height; y++)
      for (int x = 12; x < now.width - 12; x++) {
        const size_t i = 3 * (size_t(y) * size_t(now.width) + size_t(x));
        wrong += std::abs(image.rgb[i + 2] - right.rgb[i + 2]) > 8;
      }
    return wrong;
  };
  WarpScratch scratch;
  Image8 both;
  const Keyframe* const keyframes[] = {&newest, &before};
  EXPECT_EQ(warp_picture(keyframes, now, 0.1f, scratch, both), 0.0f);
  EXPECT_LT(2 * count_wrong(both), count_wrong(warp(newest, now)));
}

// A figure stood beside where it stands now. Nothing of it is left, neither there nor in what it
// uncovers, as the newest keyframe sees past where it was.
TEST(WarpPicture, WhatHasGoneIsNotSeenBesideWhereItIs) {
  auto figure = [](float left) {
    return Place([=](const Ray& ray) {
      const float t = distance_to_wall(ray, -2), x = ray.origin.x + t * ray.direction.x;
      if (x > left && x < left + 0.4f) return SeenPlace{vec3(255, 0, 0), t};
      return SeenPlace{vec3(0, 100, 0), distance_to_wall(ray, -4)};
    });
  };
  const View drawn = look_at({0, 0, 0}, 0), now = look_at({0.15f, 0, 0}, 0);
  const Keyframe newest = keyframe_of(figure(0), drawn), before = keyframe_of(figure(-0.1f), drawn);
  WarpScratch scratch;
  Image8 both;
  const Keyframe* const keyframes[] = {&newest, &before};
  warp_picture(keyframes, now, 1, scratch, both);
  const Image8 right = draw(figure(0), now).picture;
  int different = 0;
  for (size_t i = 0; i < both.rgb.size(); i += 3) different += both.rgb[i] != right.rgb[i];
  EXPECT_LE(different, 2 * now.height);  // a pixel at either edge
}

TEST(WarpPicture, WhatIsNowhereStaysUnknown) {
  View before = look_at({0, 0, 0}, 0), now = look_at({0, 0, 0}, 1.5f),
       beside = look_at({0, 0, 0}, 0.5f, 60, 36);
  Keyframe keyframe = keyframe_of(sky, before), around = keyframe_of(sky, beside);
  WarpScratch scratch;
  Image8 out;
  float unknown = warp_picture(keyframe, around, now, 1, scratch, out);
  EXPECT_GT(unknown, 0.5f);
  EXPECT_LT(unknown, 1.0f);
  // An empty keyframe counts as none.
  EXPECT_EQ(warp_picture(Keyframe{}, around, now, 1, scratch, out),
            warp_picture(around, now, 1, scratch, out));
  EXPECT_EQ(warp_picture(Keyframe{}, Keyframe{}, now, 1, scratch, out), 1.0f);
}

TEST(SurroundingView, HoldsAllViewsInFewPixels) {
  View a = look_at({0, 0, 0}, 0.2f), b = look_at({0, 0, 0}, -0.5f), up = a;
  up.forward = normalize(a.forward + 0.5f * a.up);
  up.up = cross(up.right, up.forward);
  WarpScratch scratch;
  Image8 out;
  for (float share : {1 / 4.0f, 1 / 16.0f}) {
    View aside = b;
    aside.middle = {0.3f, -0.2f};
    const View views[] = {a, b, up, aside};
    View around = surrounding_view(views, share);
    const Keyframe keyframe = keyframe_of(sky, around);
    for (const View& view : views) EXPECT_EQ(warp_picture(keyframe, view, 1, scratch, out), 0.0f);
    EXPECT_NEAR(float(around.width * around.height), share * 200 * 120, 0.1f * share * 200 * 120);
    EXPECT_EQ(around.middle, vec2(0));
    EXPECT_NEAR(dot(around.forward, around.up), 0, 1e-6f);
    EXPECT_NEAR(length(around.right), 1, 1e-6f);
  }
  // Views that no flat picture can hold are held in part.
  const View apart[] = {a, look_at({0, 0, 0}, 0.2f + 3.14159f)};
  View around = surrounding_view(apart, 1 / 4.0f);
  EXPECT_EQ(around.forward, a.forward);
  EXPECT_LE(around.tan_half_fov, 3.2f);
  // A flat strip is no longer than the picture.
  View strip = a;
  strip.tan_half_fov = 0.01f, strip.height = 4;
  const View strips[] = {strip, b};
  View flat = surrounding_view(strips, 1);
  EXPECT_LE(flat.width, 200);
  EXPECT_LE(flat.height, 4);
  EXPECT_EQ(surrounding_view({}, 1).width, 0);
}

TEST(MakeKeyframe, RefusesWhatDoesNotFit) {
  View view = look_at({0, 0, 0}, 0, 16, 8);
  Drawn drawn = draw(wall, view);
  Keyframe keyframe;
  drawn.depth.pop_back();
  EXPECT_THROW(make_keyframe(view, drawn.picture, drawn.depth, keyframe), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
