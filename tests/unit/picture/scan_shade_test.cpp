// SPDX-License-Identifier: Apache-2.0
// Scans are shaded by what moves, and lit by lights that move.
#include <gtest/gtest.h>

#include <cmath>

#include "light/virtual/dynamic_image.h"
#include "picture/compositor.h"
#include "picture/laid_view.h"
#include "scan/tree/coarse_cut.h"
#include "scenes/build.h"
#include "unit/light/kept/bake_cases.h"
#include "unit/scan/tree_made.h"
#include "world/load/stand_in.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int side = 128;

std::shared_ptr<const PointTree> grey_floor() {
  PointBlock block;
  for (int x = 0; x < 200; x++)
    for (int z = 0; z < 200; z++) {
      block.place.push_back({0.04 * x - 4, 0, 0.04 * z - 4});
      block.color.push_back({188, 188, 188});  // half the light, linear
    }
  ScanInfo info;
  info.fields.color = true;
  return std::make_shared<PointTree>(
      make_tree(made_source(std::move(block), info), plain_settings()));
}

// A scanned floor of 8 x 8 m, evenly lit, on which a pillar stands that moves.
struct Room {
  Scene scene = empty_scene();
  std::unique_ptr<World> world;
  Lights lights;
  std::unique_ptr<VisibilityPass> visibility;
  std::shared_ptr<const IlluminationMap> maps;
  LaidWork work;
  View view = make_view_towards(scene, {0, 6, 4}, {0, 0, 0}, up, 0.9f, side, side);
  static constexpr vec3 up{0, 1, 0};

  explicit Room(ScanColors colors) {
    static const auto floor = grey_floor();
    const std::vector<NodePoints> cut = coarse_cut(*floor, 5'000);
    Mesh mesh = make_stand_in(cut);
    Material material = diffuse(vec3(0.5f));
    material.double_sided = true;
    mesh.material = add_material(scene, material);
    const vec3 origin(floor->origin);
    const int stand_in = add_mesh(scene, std::move(mesh), "scan", at(origin));
    Mesh pillar = box_mesh(add_material(scene, diffuse(vec3(0.5f))), {0.4f, 1.6f, 0.4f});
    for (vec3& p : pillar.positions) p.y += 0.8f;
    scene.objects.push_back("pillar");
    world = std::make_unique<World>(scene, std::vector<Mesh>{pillar}, std::vector<uint32_t>{2});
    world->place_scans({{.sets = {{floor}},
                         .splats = nullptr,
                         .position = origin,
                         .object = 1,
                         .stand_in = stand_in,
                         .look = {.colors = colors, .cuts = {}}}});
    lights = make_lights(*world);
    visibility = std::make_unique<VisibilityPass>(*world, lights);
    maps = paint_map(*world, 0.2f, {[](vec3) { return vec3(1); }});
  }
  void show_pillar(bool on) {
    world->show(0, on);
    world->commit();
  }
  // Returns the light that is seen of a place of the floor.
  float at_place(vec3 place, const DynamicImage* dynamic = nullptr) {
    const LaidView laid(laid_things(*world, &lights, maps, 1), view, vec2(0.5f), false, 0, work, {},
                        dynamic);
    const Projected to = project_point(view, place);
    return laid.look(int(to.x), int(to.y), all_lanes(INFINITY)).light.x[0];
  }
};

class ScanShade : public testing::TestWithParam<ScanColors> {};

TEST_P(ScanShade, AFigureDarkensTheFloorAtItsFeetAndNothingFarOff) {
  Room room(GetParam());
  const vec3 beside(0.35f, 0, 0), far(3, 0, -2);
  const float shaded = room.at_place(beside), lit = room.at_place(far);
  room.show_pillar(false);
  EXPECT_LT(shaded, 0.85f * room.at_place(beside));
  EXPECT_NEAR(lit, room.at_place(far), 1e-4f);
  EXPECT_NEAR(lit, 0.5f, 0.03f);
}

INSTANTIATE_TEST_SUITE_P(Colors, ScanShade, testing::Values(ScanColors::captured, ScanColors::lit));

TEST(ScanShade, ColoursThatSayAHeightAreNotShaded) {
  Room room(ScanColors::height);
  const float shaded = room.at_place({0.35f, 0, 0});
  room.show_pillar(false);
  EXPECT_EQ(shaded, room.at_place({0.35f, 0, 0}));
}

struct Torch {
  DynamicLights lights;
  DynamicImage image;
  explicit Torch(const Room& room) {
    lights.push_back({point_light({1.5f, 1, 0}, vec3(4)), 1, 0});
    compute_dynamic_light(*room.world, room.lights, *room.visibility, room.view, lights,
                          dynamic_splat_settings(), image);
  }
};

TEST(ScanShade, AMovingLampLightsAndThePillarCastsItsShadow) {
  Room room(ScanColors::lit);
  const Torch torch(room);
  const vec3 under(1.5f, 0, 0), behind(-1.2f, 0, 0), far(-1.2f, 0, 2.2f);
  // Its irradiance is 4 over a square metre, of which the floor reflects half.
  EXPECT_NEAR(room.at_place(under, &torch.image) - room.at_place(under), 4 / pi / 2, 0.1f);
  EXPECT_LT(room.at_place(behind, &torch.image) - room.at_place(behind), 0.01f);
  EXPECT_GT(room.at_place(far, &torch.image) - room.at_place(far), 0.01f);
}

TEST(ScanShade, AMovingLampLightsItAtRestToo) {
  Room room(ScanColors::lit);
  Keyframe keyframe;
  Image8 black;
  black.width = black.height = side;
  black.rgb.assign(3 * side * side, 0);
  Frame frame;
  fit_frame(side, side, frame);
  std::fill(frame.depth.begin(), frame.depth.end(), INFINITY);
  const LaidThings things = laid_things(*room.world, &room.lights, room.maps, 1);
  LaidLayer().lay_over(things, room.view, 1, room.work, frame);
  make_keyframe(room.view, black, frame.depth, keyframe);
  BackdropSurfaces surfaces;
  find_backdrop_surfaces(*room.visibility, room.view, surfaces);
  lay_scans_over(things.scans, keyframe, room.work.scans, surfaces);
  DynamicBounce bounce;
  LightPlanes light;
  const Torch torch(room);
  light_surfaces(*room.world, room.lights, torch.lights, surfaces.surfaces, {}, bounce, light);
  RunKnown reflected;
  const Projected to = project_point(room.view, {1.5f, 0, 0});
  reflect_light(surfaces, light, int(to.x), int(to.y), 1, reflected);
  EXPECT_NEAR(reflected.red[0], 4 / pi / 2, 0.1f);
}

TEST(ScanShade, AtRestTheMeanBeginsAnewWhenTheFigureHasGone) {
  Room room(ScanColors::lit);
  LaidLayer layer;
  const Projected to = project_point(room.view, {0.35f, 0, 0});
  auto draw = [&] {
    Frame frame;
    fit_frame(side, side, frame);
    std::fill(frame.depth.begin(), frame.depth.end(), INFINITY);
    layer.lay_over(laid_things(*room.world, &room.lights, room.maps, 1), room.view, 4, room.work,
                   frame);
    return frame.color[size_t(to.y) * side + size_t(to.x)].x;
  };
  const float shaded = draw();
  room.show_pillar(false);
  EXPECT_GT(draw(), 1.15f * shaded);
}

}  // namespace
}  // namespace wellspring::test
