// SPDX-License-Identifier: Apache-2.0
// What moves in a picture at rest, drawn by itself.
#include "picture/keyframe.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "frame/tonemap.h"
#include "light/kept/skin/skin_light.h"
#include "unit/frame/tonemap_color.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

constexpr int width = 192, height = 128, pixels = width * height;
constexpr vec3 ball_place(-0.03f, 0.3f, -0.25f);  // behind the bars

Stage make_stage() {
  Scene scene = make_barred_box(vec3(0.1f, 0.2f, 0.7f), 0.02f);
  Mesh ball = add_ball(scene, ball_place);
  return Stage(std::move(scene), std::move(ball));
}
View view_of(const Stage& stage, double z = 1.2) {
  return make_view(stage.scene, {0, 0.35, z}, 0, 0, 0.45f, width, height);
}
uint32_t ball_of(const Stage& stage) { return uint32_t(stage.scene.objects.size() - 1); }
bool is_inside(const PictureWindow& w, int x, int y) {
  return x >= w.left && x < w.left + w.width && y >= w.top && y < w.top + w.height;
}

Image8 shown(const Frame& frame) {
  Image8 image;
  tonemap(frame, {}, image);
  return image;
}
Keyframe keyframe_of(const View& view, const Frame& frame) {
  Keyframe keyframe;
  make_keyframe(view, shown(frame), frame.depth, keyframe);
  return keyframe;
}
Image8 laid_over(const Keyframe& backdrop, const MovingPicture& moving) {
  Image8 image;
  copy_colors(backdrop, {0, 0, backdrop.view.width, backdrop.view.height}, image);
  lay_over(moving, image);
  return image;
}
int difference(const Image8& a, const Image8& b, int x, int y) {
  int most = 0;
  for (size_t c = 0; c < 3; c++) {
    size_t i = 3 * size_t(y * a.width + x) + c;
    most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
  }
  return most;
}

double value(const Image8& image, int x, int y) {
  const uint8_t* c = &image.rgb[3 * size_t(y * image.width + x)];
  return (double(c[0]) + c[1] + c[2]) / 3;
}

// A visitor who has stood before the box for a while.
struct Rested {
  DrawnVisit visit;
  Frame backdrop;
  MovingLight light;
  MovingPicture moving;
  SkinLight skin;
  Rested(const Stage& stage, const View& view, int pictures = 24) {
    for (int i = 0; i < pictures; i++) visit.step(stage, view, pixels / 4, PictureOf::still);
    skin = make_skin_light(*stage.world);
    compute_skin_light(stage);
    visit.compositor.set_skin(&skin, &stage.lights);
  }
  void compute_skin_light(const Stage& stage) {
    SkinUpdate update{.samples = 32 * int(skin.places.size())};
    update_skin(*stage.world, stage.lights, update, skin);
    for (int i = 0; i < 8; i++) smooth_skin(*stage.world, skin);
  }
  Keyframe draw_backdrop(const Stage& stage, const View& view) {
    visit.cache.move_points(*stage.world);
    visit.cache.project(view);
    visit.compositor.draw_still(visit.cache, view, *stage.visibility, backdrop,
                                StillShows::backdrop);
    return keyframe_of(view, backdrop);
  }
  Image8 draw_over(const Stage& stage, const Keyframe& keyframe) {
    visit.compositor.draw_moving(*stage.world, keyframe, nullptr, *stage.visibility, {}, false,
                                 light, moving);
    return laid_over(keyframe, moving);
  }
};

TEST(MovingPicture, WindowHoldsWhatMoves) {
  Stage stage = make_stage();
  for (double z : {1.2, 0.4, 0.0}) {
    View view = view_of(stage, z);
    PictureWindow window = moving_window(*stage.world, view);
    int seen = 0;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        if (stage.object_at(view, float(x) + 0.5f, float(y) + 0.5f) != ball_of(stage)) continue;
        seen++;
        EXPECT_TRUE(is_inside(window, x, y)) << z << ": " << x << ", " << y;
      }
    EXPECT_GT(seen, 100);
    for (const PictureWindow& w : {window, whole_runs(window, view)}) {
      EXPECT_GE(w.left, 0);
      EXPECT_GE(w.top, 0);
      EXPECT_LE(w.left + w.width, width);
      EXPECT_LE(w.top + w.height, height);
      EXPECT_TRUE(is_inside(w, window.left, window.top));
      EXPECT_TRUE(is_inside(w, window.left + window.width - 1, window.top + window.height - 1));
    }
    EXPECT_EQ(whole_runs(window, view).left % RasterRun::most, 0);
    EXPECT_EQ(whole_runs(window, view).top % cell_size, 0);
    if (z == 1.2) {
      EXPECT_LT(window.width * window.height, pixels / 2);
    }
  }
  // Within the ball it may be anywhere; behind the eye it is nowhere, and so it is when hidden.
  PictureWindow whole = moving_window(*stage.world, view_of(stage, ball_place.z + 0.02f));
  EXPECT_EQ(whole.width * whole.height, pixels);
  EXPECT_TRUE(moving_window(*stage.world, view_of(stage, -0.6)).empty());
  stage.world->show(0, false);
  stage.world->commit();
  EXPECT_TRUE(moving_window(*stage.world, view_of(stage)).empty());
}

// A window of a picture is that part of it.
TEST(MovingPicture, RaysThroughAWindowAreThoseOfThePicture) {
  Stage stage = make_stage();
  View view = view_of(stage);
  PictureWindow window{64, 12, 64, 37};
  PixelRays whole(view), part(WindowView(view, window));
  for (int i : {0, 5, 36}) {
    EXPECT_NEAR(part.x(float(i)), whole.x(float(i + window.left)), 1e-6f);
    EXPECT_NEAR(part.y(float(i)), whole.y(float(i + window.top)), 1e-6f);
  }
}

// The two parts together are the picture that is drawn as a whole, but for what points do not know
// yet.
TEST(MovingPicture, IsThatOfWholePictures) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested whole(stage, view), parts(stage, view);
  whole.visit.cache.move_points(*stage.world);
  whole.visit.cache.project(view);
  whole.visit.compositor.draw_still(whole.visit.cache, view, *stage.visibility, whole.visit.frame);
  Image8 wanted = shown(whole.visit.frame);
  Keyframe keyframe = parts.draw_backdrop(stage, view);
  for (uint32_t object : parts.backdrop.object) ASSERT_NE(object, ball_of(stage));
  Image8 got = parts.draw_over(stage, keyframe);
  int of_ball = 0, bars = 0, sum = 0;
  double brightness = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      uint32_t object = whole.visit.frame.object[size_t(y * width + x)];
      bool ball = object == ball_of(stage);
      of_ball += ball;
      if (ball) sum += difference(got, wanted, x, y);
      if (ball) brightness += value(got, x, y) - value(wanted, x, y);
      if (is_inside(parts.moving.window, x, y) && stage.scene.objects[object] == "bar") bars++;
      // The rest is corrected by its own samples, scale by scale: a little also by what it hides.
      if (!is_inside(parts.moving.window, x, y)) {
        EXPECT_LE(difference(got, wanted, x, y), 1);
      }
    }
  EXPECT_GT(of_ball, 300);
  EXPECT_GT(bars, 100);  // before it, and not covered
  // Points are 12 codes from what is converged; light that is smoothed over the skin loses the
  // ball's shadow to the lamp's side.
  EXPECT_LT(double(sum) / of_ball, 24);
  EXPECT_NEAR(brightness / of_ball, 0, 14);
  // The bars, which are nearer, stay.
  Image8 ground;
  copy_colors(keyframe, {0, 0, width, height}, ground);
  int changed = 0;
  for (int y = 1; y + 1 < height; y++)
    for (int x = 1; x + 1 < width; x++) {
      bool inner = true;
      for (int k = -1; k <= 1; k++) {
        auto bar = [&](int i) { return stage.scene.objects[i ? uint32_t(i) : 0u] == "bar"; };
        inner = inner && bar(int(whole.visit.frame.object[size_t(y * width + x + k)]));
      }
      if (inner) changed += difference(got, ground, x, y) > 0;
    }
  EXPECT_LE(changed, 4);  // the ball's silhouette is hidden beside a bar's own
}

// Between pictures of the rest it goes where its mesh goes, with its light, and what it has left
// shows the backdrop.
TEST(MovingPicture, FollowsItsMesh) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested rested(stage, view);
  Keyframe keyframe = rested.draw_backdrop(stage, view);
  Image8 before = rested.draw_over(stage, keyframe), ground;
  copy_colors(keyframe, {0, 0, width, height}, ground);
  std::vector<char> was(pixels);
  for (int i = 0; i < pixels; i++)
    was[size_t(i)] =
        stage.object_at(view, float(i % width) + 0.5f, float(i / width) + 0.5f) == ball_of(stage);
  stage.push_ball(0.17f);
  Image8 after = rested.draw_over(stage, keyframe), truth = shown(stage.truth(view, 256));
  int here = 0, left = 0, left_wrong = 0;
  double light = 0, true_light = 0;
  for (int y = 2; y + 2 < height; y++)
    for (int x = 2; x + 2 < width; x++) {
      bool inner = true, outer = true;  // not at its silhouette
      for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
          bool is =
              stage.object_at(view, float(x + dx) + 0.5f, float(y + dy) + 0.5f) == ball_of(stage);
          inner = inner && is;
          outer = outer && !is;
        }
      if (inner) here++, light += value(after, x, y), true_light += value(truth, x, y);
      if (outer && was[size_t(y * width + x)])
        left++, left_wrong += difference(after, ground, x, y) > 0;
    }
  EXPECT_GT(here, 200);
  // The light is still that of its former place.
  EXPECT_NEAR(light / here, true_light / here, 0.2 * true_light / here);
  EXPECT_GT(left, 200);
  EXPECT_EQ(left_wrong, 0);
}

// The covered place begins anew, and samples of the ball are none of the backdrop's. A layer has
// the colours and the depth of moving things; elsewhere nothing is in it, nor in the picture that
// it is laid over.
TEST(MovingPicture, IsALayerOfItsOwn) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested rested(stage, view);
  Keyframe keyframe = rested.draw_backdrop(stage, view);
  const Image8 whole = rested.draw_over(stage, keyframe);
  rested.visit.compositor.draw_moving(*stage.world, keyframe, nullptr, *stage.visibility, {}, true,
                                      rested.light, rested.moving);
  EXPECT_TRUE(rested.moving.empty());
  const MovingLayer& layer = rested.moving.layer;
  const PictureWindow& w = layer.window;
  const View part = window_view(view, w);
  ASSERT_EQ(part.width, w.width);
  int there = 0, beside = 0;
  for (int y = 0; y < w.height; y++)
    for (int x = 0; x < w.width; x++) {
      const size_t at = size_t(y * w.width + x);
      const Ray ray = view_ray(view, float(x + w.left) + 0.5f, float(y + w.top) + 0.5f);
      const Hit hit = stage.world->intersect(ray);
      const bool ball = stage.world->object_of(hit.instance) == ball_of(stage);
      bool inner = true;  // thin bars before it, and its silhouette, are seen at other places
      for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
          const uint32_t object =
              stage.object_at(view, float(x + w.left + dx) + 0.5f, float(y + w.top + dy) + 0.5f);
          inner &= (object == ball_of(stage)) == ball && stage.scene.objects[object] != "bar";
        }
      if (!inner) continue;
      EXPECT_EQ(layer.disparity[at] > 0, ball) << x << ',' << y;
      (ball ? there : beside)++;
      if (!ball) continue;
      const size_t in_whole = size_t((y + w.top) * width + x + w.left);
      for (size_t c = 0; c < 3; c++) EXPECT_EQ(layer.rgb[3 * at + c], whole.rgb[3 * in_whole + c]);
      const Projected place = project_point(part, ray.origin + hit.t * ray.direction);
      EXPECT_NEAR(place.x, float(x) + 0.5f, 0.01f);
      EXPECT_NEAR(place.y, float(y) + 0.5f, 0.01f);
      EXPECT_NEAR(layer.disparity[at] * place.depth, 1, 0.02f);
    }
  EXPECT_GT(there, 50);
  EXPECT_GT(beside, 50);
}

TEST(MovingPicture, WhatWasCoveredBecomesRight) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested rested(stage, view);
  auto pictures = [&](int count) {
    for (int i = 0; i < count; i++) {
      rested.visit.step(stage, view, pixels / 4, PictureOf::still);
      Keyframe keyframe = rested.draw_backdrop(stage, view);
      rested.draw_over(stage, keyframe);
    }
  };
  pictures(12);
  std::vector<char> was(pixels);
  for (int i = 0; i < pixels; i++)
    was[size_t(i)] =
        stage.object_at(view, float(i % width) + 0.5f, float(i / width) + 0.5f) == ball_of(stage);
  stage.push_ball(0.17f);
  Keyframe keyframe = rested.draw_backdrop(stage, view);
  rested.draw_over(stage, keyframe);
  pictures(24);
  Frame truth = stage.truth(view, 256);
  int left = 0, wrong = 0;
  for (int i = 0; i < pixels; i++) {
    if (!was[size_t(i)] || rested.backdrop.object[size_t(i)] == 0) continue;
    vec3 a = rested.backdrop.color[size_t(i)], b = truth.color[size_t(i)];
    left++, wrong += glm::length(a - b) > 0.25f * glm::length(b) + 0.02f;
  }
  EXPECT_GT(left, 200);
  EXPECT_LT(wrong, left / 10);
}

// Pixels where it is nearer than what the picture shows, and no others.
TEST(MovingPicture, CoversWhatLiesBehindIt) {
  Stage stage = make_stage();
  View view = view_of(stage);
  MovingLight light;
  PictureWindow window = whole_runs(moving_window(*stage.world, view), view);
  SkinLight skin = make_skin_light(*stage.world);
  for (float depth : {0.5f, 3.0f}) {
    std::vector<float> disparity(pixels, 1 / depth);
    std::vector<uint8_t> covered(pixels, 7);
    light.picture.width = width, light.picture.height = height;
    light.picture.rgb.assign(3 * pixels, 99);
    guess_peaks(light.picture, window, light.peaks);
    compose_moving(view, *stage.visibility, window, {}, disparity, covered, {&skin}, light);
    int count = int(std::count(covered.begin(), covered.end(), uint8_t(0)));
    EXPECT_EQ(count + std::count(covered.begin(), covered.end(), uint8_t(7)), pixels);
    if (depth < 1) EXPECT_EQ(count, 0);
    else EXPECT_GT(count, 400);
    int black = 0;  // without light
    for (int i = 0; i < pixels; i++) black += light.picture.rgb[size_t(3 * i)] == 0;
    EXPECT_LE(black, count);
    EXPECT_GE(black, count / 2);
  }
}

// This holds for every kind of picture, whatever points say.
TEST(MovingPicture, IsLitByItsSkinAlone) {
  Stage stage = make_stage();
  View view = view_of(stage);
  SkinLight skin = make_skin_light(*stage.world);
  std::fill(skin.light.begin(), skin.light.end(), vec4(0, 2, 0, 1));
  for (PictureOf kind : {PictureOf::moving, PictureOf::still}) {
    DrawnVisit visit;
    visit.compositor.set_skin(&skin, &stage.lights);
    for (int i = 0; i < 3; i++) visit.step(stage, view, pixels / 4, kind);
    int of_ball = 0, green = 0, others_green = 0;
    for (size_t i = 0; i < visit.frame.color.size(); i++) {
      vec3 c = visit.frame.color[i];
      bool is_green = c.y > 0.8f && c.x < 0.3f && c.z < 0.3f;  // its gloss reflects some, too
      bool ball = visit.frame.object[i] == ball_of(stage);
      of_ball += ball, green += ball && is_green, others_green += !ball && is_green;
    }
    EXPECT_GT(of_ball, 100);
    EXPECT_GT(green, 9 * of_ball / 10);
    EXPECT_EQ(others_green, 0);
  }
}

TEST(MovingPicture, NeedsNoPoint) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested rested(stage, view, 0);
  rested.visit.step(stage, view, 0, PictureOf::still);
  Keyframe keyframe = rested.draw_backdrop(stage, view);
  rested.draw_over(stage, keyframe);
  EXPECT_FALSE(rested.moving.empty());
  stage.world->show(0, false);
  stage.world->commit();
  rested.draw_over(stage, keyframe);
  EXPECT_TRUE(rested.moving.empty());
}

// A peak above white cannot be read from its code: the least that is shown so is taken. Below,
// codes give their light.
TEST(MovingPicture, GuessesPeaksFromColours) {
  Image8 image{.width = 256, .height = 1};
  for (int i = 0; i < 256; i++)
    for (int c : {i / 2, i, 0}) image.rgb.push_back(uint8_t(c));
  std::vector<uint8_t> peaks;
  guess_peaks(image, {0, 0, 256, 1}, peaks);
  for (int i = 232; i < 256; i++) {
    float above = peak_of(peaks[size_t(i)]), beyond = peak_of(peaks[size_t(i)] + 1);
    auto shown = [](float peak) { return test::tonemap_color(vec3(peak), {}).x * 255; };
    EXPECT_LE(shown(above), float(i) + 0.6f) << i;
    EXPECT_GE(shown(beyond), std::min(float(i), 254.5f) - 0.6f) << i;
  }
}

// A keyframe that is warped on shows what was laid over it.
TEST(MovingPicture, MergesIntoAKeyframe) {
  Stage stage = make_stage();
  View view = view_of(stage);
  Rested rested(stage, view);
  Keyframe keyframe = rested.draw_backdrop(stage, view);
  std::vector<float> disparity = keyframe.disparity;
  Image8 over = rested.draw_over(stage, keyframe), merged;
  lay_over(rested.moving, keyframe);
  copy_colors(keyframe, {0, 0, width, height}, merged);
  EXPECT_EQ(over.rgb, merged.rgb);
  EXPECT_EQ(keyframe.disparity, disparity);
}

}  // namespace
}  // namespace wellspring::test
