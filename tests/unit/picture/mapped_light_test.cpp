// SPDX-License-Identifier: Apache-2.0
// Pictures in the light of an illumination map, with few points or none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/light/kept/bake_cases.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 120, height = 90, pixels = width * height;
constexpr PictureOf kinds[] = {PictureOf::moving, PictureOf::still};

vec3 painted(vec3 place) { return {0.5f + place.x, 0.2f + 0.5f * place.y, 0.2f - 0.3f * place.z}; }

// The Cornell box; `moves`: with a small pole that reaches through it.
struct MappedStage {
  Stage stage;
  View view = cornell_view(stage.scene, width, height);
  std::shared_ptr<const IlluminationMap> map;
  explicit MappedStage(const test::PaintedLight& light = painted, bool moves = false)
      : stage(moves ? Stage(make_cornell_box(), make_pole()) : Stage(make_cornell_box())) {
    paint(light);
  }
  MappedStage(Scene scene, const test::PaintedLight& light) : stage(std::move(scene)) {
    paint(light);
  }
  void paint(const test::PaintedLight& light) {
    stage.lights.maps = map = test::paint_map(*stage.world, 0.03f, {light});
  }
  static Mesh make_pole() {
    Mesh pole = box_mesh(1, {0.01f, 0.5f, 0.01f});
    for (vec3& p : pole.positions) p += vec3(0.2f, 0.27f, -0.2f);
    return pole;
  }

  // Returns the map's light at a pixel's middle; negative: the map has none there, or the surface
  // emits light.
  vec3 expected(int x, int y) const {
    Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
    Hit hit = stage.world->intersect(ray);
    if (!hit.valid()) return vec3(-1);
    const Material& material = stage.world->material_of(hit.instance);
    bool front = dot(eval_face(*stage.world, hit.instance, hit.triangle), ray.direction) < 0;
    uint32_t chart = map->places->find(hit.instance, hit.triangle, front);
    if (chart == no_chart || material.emission != vec3(0)) return vec3(-1);
    vec3 place = eval_position(*stage.world, hit.instance, hit.triangle, hit.barycentric);
    return vec3(material.base_color) * eval_illumination(*map, map->places->charts[chart], place);
  }
  // Pixels that are not within `share` of `scale` times what the map says; about edges many are
  // mixed.
  double wrong(const Frame& frame, float scale, float share) const {
    int wrong = 0, known = 0;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        vec3 wanted = scale * expected(x, y), shown = frame.color[size_t(y * width + x)];
        if (wanted.x < 0) continue;
        known++;
        EXPECT_GT(max_component(shown), 0) << x << ", " << y;
        wrong += !(length(shown - wanted) < share * length(wanted));
      }
    EXPECT_GT(known, pixels / 3);
    return double(wrong) / known;
  }
  DrawnVisit visit(const char* technique) const {
    DrawnVisit visit;
    visit.compositor.set_maps(map);
    visit.technique = technique;
    return visit;
  }
};

TEST(MappedLight, IsThereBeforeTheFirstSample) {
  MappedStage mapped;
  for (PictureOf kind : kinds) {
    DrawnVisit visit = mapped.visit("path");
    visit.step(mapped.stage, mapped.view, 0, kind);
    EXPECT_EQ(visit.requests.size(), 0u);
    EXPECT_LT(mapped.wrong(visit.frame, 1, 0.03f), 0.05) << int(kind);
    // Without them it is dark, but for the lamp.
    visit.compositor.set_maps(nullptr);
    DrawnVisit dark;
    dark.step(mapped.stage, mapped.view, 0, kind);
    int lit = 0;
    for (vec3 color : dark.frame.color) lit += color != vec3(0);
    EXPECT_LT(lit, pixels / 20);
  }
}

// No map has the light of metal: it is shown in what is usual until samples tell it.
TEST(MappedLight, MetalIsNotBlackBeforeItsFirstSample) {
  Scene scene = make_cornell_box();
  Material gold = diffuse({0.8f, 0.6f, 0.2f});
  gold.metallic = 1, gold.roughness = 0.3f;
  add_quad(scene, gold, {-0.2f, 0.2f, -0.1f}, {0.4f, 0, 0}, {0, 0.2f, 0}, "board");
  MappedStage mapped(std::move(scene), [](vec3) { return vec3(0.7f); });
  for (PictureOf kind : kinds) {
    DrawnVisit visit = mapped.visit("path");
    visit.step(mapped.stage, mapped.view, 0, kind);
    int board = 0;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        const Ray ray = view_ray(mapped.view, float(x) + 0.5f, float(y) + 0.5f);
        const Hit hit = mapped.stage.world->intersect(ray);
        if (!hit.valid() || mapped.stage.world->material_of(hit.instance).metallic == 0) continue;
        const vec3 color = visit.frame.color[size_t(y * width + x)];
        board += length(color - 0.7f * vec3(gold.base_color)) < 0.1f;
      }
    EXPECT_GT(board, 300) << int(kind);
  }
}

// A fiftieth of the mean light is no more than that.
TEST(MappedLight, LeavesTheDarkDark) {
  MappedStage mapped([](vec3 p) { return vec3(p.x > 0 ? 2.0f : 0.02f); });
  for (const char* technique : {"path", "gather"})
    for (PictureOf kind : kinds) {
      DrawnVisit visit = mapped.visit(technique);
      const int budget = technique[0] == 'g' ? pixels / 8 : 0;
      for (int i = 0; i < 4; i++) visit.step(mapped.stage, mapped.view, budget, kind);
      EXPECT_LT(mapped.wrong(visit.frame, 1, 0.05f), 0.1) << technique << int(kind);
    }
}

// Bars that no cell of points stands for are lit as they are, not as what is behind them.
TEST(MappedLight, OfNarrowThingsIsTheirOwn) {
  MappedStage mapped(make_barred_box(vec3(0.7f), 0.012f),
                     [](vec3 p) { return vec3(p.z > -0.2f ? 2.0f : 0.3f); });
  for (PictureOf kind : kinds) {
    DrawnVisit visit = mapped.visit("gather");
    for (int i = 0; i < 16; i++) visit.step(mapped.stage, mapped.view, pixels / 8, kind);
    float mean = 0, expected = 0;
    int bars = 0;
    for (int i = 0; i < pixels; i++) {
      const int x = i % width, y = i / width;
      const uint32_t object = mapped.stage.object_at(mapped.view, float(x) + 0.5f, float(y) + 0.5f);
      if (mapped.stage.scene.objects[object] != "bar") continue;
      bars++, mean += luminance(visit.frame.color[size_t(i)]);
      expected += luminance(mapped.expected(x, y));
    }
    ASSERT_GT(bars, 200);
    EXPECT_NEAR(mean, expected, 0.15 * expected) << int(kind);
  }
}

// The eye sees at once what the frame holds.
TEST(MappedLight, IsThereForTheEyeToo) {
  MappedStage mapped;
  DrawnVisit visit = mapped.visit("path");
  visit.step(mapped.stage, mapped.view, 0, PictureOf::moving);
  Image8 shown, expected;
  visit.compositor.draw(visit.cache, mapped.view, *mapped.stage.visibility, Tonemap{1}, shown);
  tonemap(visit.frame, {1}, expected);
  int differ = 0;
  for (size_t i = 0; i < shown.rgb.size(); i++)
    differ += std::abs(shown.rgb[i] - expected.rgb[i]) > 6;
  EXPECT_EQ(differ, 0);
}

// Samples that say what the map says change nothing, however few or many.
TEST(MappedLight, StaysWherePointsAgree) {
  MappedStage mapped;
  for (PictureOf kind : kinds)
    for (int budget : {pixels / 100, pixels / 4}) {
      DrawnVisit visit = mapped.visit("gather");
      for (int i = 0; i < 8; i++) visit.step(mapped.stage, mapped.view, budget, kind);
      EXPECT_GT(visit.requests.size(), 0u);
      EXPECT_LT(mapped.wrong(visit.frame, 1, 0.03f), 0.05) << int(kind) << ", " << budget;
    }
}

// Points say that there is half of the light.
void halve_light(float raised, std::vector<Sample>& samples) {
  for (Sample& sample : samples)
    if (sample.flags & sample_mapped) {
      vec3 half = 0.5f * (sample.smooth * sample.known - vec3(raised));
      sample.smooth = (half + vec3(raised)) / sample.known;
    }
}

// A picture that passes is lit by the map where that says all, but for what is near something that
// moves and may shade it: there points are believed, as they are at rest.
TEST(MappedLight, PointsAreBelievedNearWhatMoves) {
  for (bool moves : {false, true}) {
    MappedStage mapped(painted, moves);
    DrawnVisit visit = mapped.visit("gather");
    for (int i = 0; i < 16; i++) {
      visit.sample(mapped.stage, mapped.view, pixels / 4);
      halve_light(mapped.map->least_known(), visit.samples);
      visit.cache.remember(mapped.view, visit.requests, visit.samples);
      visit.compositor.draw(visit.cache, mapped.view, *mapped.stage.visibility, visit.frame);
    }
    const double wrong = mapped.wrong(visit.frame, 1, 0.1f);
    if (moves) EXPECT_GT(wrong, 0.5);
    else EXPECT_LT(wrong, 0.08);
  }
}

// Whatever the map says, and were it ten times too much, many samples are right.
TEST(MappedLight, ConvergesToTheLightThereIs) {
  MappedStage mapped([](vec3 p) { return 10.0f * painted(p); });
  DrawnVisit visit = mapped.visit("path");
  for (int i = 0; i < 40; i++) visit.step(mapped.stage, mapped.view, pixels, PictureOf::still);
  mapped.stage.lights.maps = nullptr;
  Frame truth = mapped.stage.truth(mapped.view, 64);
  double shown = 0, wanted = 0;
  for (size_t i = 0; i < truth.color.size(); i++) {
    if (max_component(truth.color[i]) > 4) continue;  // the lamp
    shown += double(luminance(visit.frame.color[i]));
    wanted += double(luminance(truth.color[i]));
  }
  EXPECT_NEAR(shown / wanted, 1, 0.02);
}

}  // namespace
}  // namespace wellspring::test
