// SPDX-License-Identifier: Apache-2.0
#include "benchmark/corrective/corrections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "cache/packing.h"
#include "cache/point_cache.h"
#include "picture/cells/surface_image.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 64, height = 48;

using Words = std::array<uint32_t, surface_planes>;

// Traces and keeps everything that is asked for. `truth` holds the samples by pixel.
struct Corrected {
  Stage stage;
  std::vector<float> shining;
  Corrections corrections;
  View view;
  uint64_t seed = 1;
  std::map<uint32_t, Words> truth;
  explicit Corrected(Scene scene) : stage(std::move(scene)), shining(find_shining(stage.scene)) {
    view = cornell_view(stage.scene, width, height);
  }
  std::vector<Request> ask(int most, std::span<const float> weights = {}) {
    std::vector<Request> requests;
    corrections.begin(view, *stage.visibility, shining);
    corrections.request(weights, most, seed++, requests);
    return requests;
  }
  void answer(std::span<const Request> requests) {
    std::vector<Sample> samples(requests.size());
    trace(*find_technique("path"), *stage.world, stage.lights, {}, requests, samples);
    corrections.remember(view, requests, samples);
    for (size_t i = 0; i < samples.size(); i++) {
      const Sample& s = samples[i];
      uint32_t noise = s.flags & sample_sure ? sure_noise : 0;
      truth[requests[i].pixel] = {pack_albedo(s.albedo), pack_rgb9e5(s.rest), pack_rgb9e5(s.smooth),
                                  s.object, pack_normal(s.normal) | 1u << 16 | noise << 24};
    }
  }
  void converge() {
    for (int rounds = 0; rounds < 20; rounds++) {
      auto requests = ask(500);
      if (requests.empty()) return;
      answer(requests);
    }
  }
  Frame show() {
    Frame light;
    fit_frame(view.width, view.height, light);
    std::fill(light.object.begin(), light.object.end(), no_object);
    corrections.show(view, light);
    return light;
  }
  Words shown(const Frame& light, uint32_t pixel) const {
    Words words;
    read_packed(light, int(pixel) % width, int(pixel) / width, words.data());
    return words;
  }
};

Scene room_with(std::initializer_list<Material> materials, int balls = 1) {
  Scene scene = make_cornell_box();
  int i = 0;
  for (const Material& material : materials)
    for (int k = 0; k < balls; k++, i++) {
      Mesh ball = sphere_mesh(0, balls > 1 ? 0.012f : 0.09f, balls > 1 ? 6 : 24);
      ball.material = add_material(scene, material);
      vec3 place(-0.2f + 0.03f * float(i % 14), 0.12f + 0.03f * float(i / 14), 0);
      if (balls == 1) place = vec3(-0.15f + 0.2f * float(i), 0.2f, 0);
      add_mesh(scene, ball, ("ball " + std::to_string(i)).c_str(), at(place));
    }
  return scene;
}
TEST(Corrections, OnlyWhatShinesNeedsThem) {
  Scene scene = empty_scene();
  Material said_metal = metal(vec3(1), 0.9f), rough = diffuse(vec3(0.5f)), coat = rough;
  coat.clearcoat = 1;
  Material unlit = metal(vec3(1), 0.1f);
  unlit.unlit = true;
  for (const Material& m :
       {rough, said_metal, plastic(vec3(0.5f), 0.2f), coat, unlit, glass(1.5f, 0, 1)}) {
    Mesh ball = sphere_mesh(add_material(scene, m), 1, 6);
    add_mesh(scene, ball, "ball");
  }
  std::vector<float> shining = find_shining(scene);
  ASSERT_EQ(shining.size(), scene.objects.size());
  std::vector<float> of(shining.end() - 6, shining.end());
  EXPECT_EQ(of[0], 0);
  EXPECT_FLOAT_EQ(of[1], delta_of(0.9f));
  EXPECT_FLOAT_EQ(of[2], delta_of(0.2f));
  EXPECT_GT(of[3], 0);
  EXPECT_EQ(of[4], 0);
  EXPECT_FLOAT_EQ(of[5], delta_of(0));
}

TEST(Corrections, CostNothingWhereNothingShines) {
  Corrected room(make_cornell_box());
  EXPECT_TRUE(room.ask(1000).empty());
  EXPECT_EQ(room.corrections.pixels(), 0);
  EXPECT_EQ(room.corrections.counts().pictures, 0u);
}

// A case is a scene; its picture ends as the traced samples are, bit for bit.
struct Case {
  const char* name;
  Scene (*make)();
};
struct CorrectedCase : testing::TestWithParam<Case> {};
TEST_P(CorrectedCase, ConvergesToWhatIsTraced) {
  Corrected room(GetParam().make());
  room.converge();
  ASSERT_GT(room.corrections.pixels(), 100);
  Frame light = room.show();
  int shown = 0, differ = 0;
  for (const auto& [pixel, truth] : room.truth) {
    Words words = room.shown(light, pixel);
    if (words[plane_object] == no_object) continue;
    shown++;
    differ += !std::equal(truth.begin(), truth.begin() + plane_depth, words.begin());
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GE(shown, room.corrections.pixels() * 95 / 100) << "at edges rays may see another object";
  EXPECT_LE(shown, room.corrections.pixels());
}
INSTANTIATE_TEST_SUITE_P(
    Corrections, CorrectedCase,
    testing::Values(Case{"polished", [] { return room_with({metal(vec3(0.9f), 0.1f)}); }},
                    Case{"glass", [] { return room_with({glass(1.5f, 0, 1)}); }},
                    Case{"hundreds", [] { return room_with({metal(vec3(0.9f), 0)}, 200); }},
                    Case{"mirrors",
                         [] {
                           Scene scene = make_cornell_box();
                           for (Material& m : scene.materials)
                             if (m.emission == vec3(0)) m = metal(vec3(0.9f), 0);
                           return scene;
                         }}),
    [](const auto& info) { return info.param.name; });

// The budget is too small for two balls; the one looked at is sampled first.
TEST(Corrections, ComeFirstToWhatIsLookedAt) {
  Corrected room(room_with({metal(vec3(0.9f), 0), metal(vec3(0.9f), 0)}));
  std::vector<float> weights(room.stage.scene.objects.size(), 1);
  weights.back() = 4;
  const uint32_t looked_at = uint32_t(weights.size() - 1);
  auto requests = room.ask(60, weights);
  ASSERT_EQ(requests.size(), 60u);
  int on = 0;
  for (const Request& r : requests)
    on += room.stage.object_at(room.view, float(r.pixel % width) + 0.5f,
                               float(r.pixel / width) + 0.5f) == looked_at;
  EXPECT_GE(on, 45);
  std::set<uint32_t> pixels;
  for (const Request& r : requests) pixels.insert(r.pixel);
  EXPECT_EQ(pixels.size(), requests.size()) << "each once";
}

// A step to the side keeps them, the other side of a ball drops them.
TEST(Corrections, HoldWhileTheAngleDoes) {
  Corrected room(room_with({metal(vec3(0.9f), 0.3f)}));
  room.converge();
  const View began = room.view;
  room.view = make_view_towards(room.stage.scene, {0.004, 0.275, 0.8}, {0.004, 0.275, 0}, {0, 1, 0},
                                0.686f, width, height);
  int asked = int(room.ask(100000).size());
  EXPECT_LT(asked, room.corrections.pixels() / 3);
  EXPECT_EQ(room.corrections.counts().dropped, 0u);
  room.view = make_view_towards(room.stage.scene, {0.26, 0.4, 0.3}, {-0.15, 0.2, 0}, {0, 1, 0},
                                0.686f, width, height);
  room.ask(0);
  EXPECT_GT(room.corrections.counts().dropped, 100u);
  Frame light;
  fit_frame(width, height, light);
  std::fill(light.object.begin(), light.object.end(), no_object);
  room.corrections.show(began, light);
  EXPECT_EQ(std::count(light.object.begin(), light.object.end(), no_object), width * height)
      << "another view's";
}

// Objects of one material that stand close together are a group, once there are groups.
TEST(Corrections, GroupsAreOfOneMaterialAndClose) {
  Scene scene = empty_scene();
  const int gold = add_material(scene, metal(vec3(0.9f), 0.1f)),
            steel = add_material(scene, metal(vec3(0.5f), 0.1f)),
            paint = add_material(scene, diffuse(vec3(0.5f)));
  const uint32_t first = uint32_t(scene.objects.size());
  for (auto [material, x] : {std::pair(gold, 0.0f),
                             {gold, 0.4f},
                             {steel, 0.2f},
                             {gold, 5.0f},
                             {paint, 0.1f},
                             {gold, 0.8f}}) {
    Mesh ball = sphere_mesh(material, 0.1f, 6);
    add_mesh(scene, ball, "ball", at({x, 0, 0}));
  }
  std::vector<uint32_t> group = group_shining(scene, find_shining(scene));
  group.erase(group.begin(), group.begin() + first);
  EXPECT_EQ(group, (std::vector<uint32_t>{first, first, first + 2, first + 3, first + 4, first}));
}

// Samples near a moving object do not have the map's light: they are left to the cache's points.
TEST(Corrections, LeaveOutShadowsOfWhatMoves) {
  Corrected room(room_with({plastic(vec3(0.5f), 0.1f)}));
  std::vector<Request> requests = room.ask(10);
  std::vector<Sample> samples(requests.size());
  trace(*find_technique("path"), *room.stage.world, room.stage.lights, {}, requests, samples);
  for (size_t i = 0; i < samples.size(); i++) {
    samples[i].flags |= sample_mapped;
    samples[i].smooth = vec3(i < 4 ? 1.0f : 0.3f);
  }
  const uint64_t before = room.corrections.counts().kept;
  room.corrections.remember(room.view, requests, samples);
  EXPECT_EQ(room.corrections.counts().kept - before, 4u);
}

// An eye in a solid of glass: rays find what it sees.
TEST(Corrections, AreThereWithinGlass) {
  Corrected room(room_with({glass(1.5f, 0, 1)}));
  room.view = make_view_towards(room.stage.scene, {-0.15, 0.2, 0.03}, {0, 0.25, -0.5}, {0, 1, 0},
                                0.686f, width, height);
  room.converge();
  EXPECT_GT(room.corrections.pixels(), width * height / 2);
  EXPECT_GT(int(room.truth.size()), room.corrections.pixels() * 9 / 10);
}

}  // namespace
}  // namespace wellspring::test
