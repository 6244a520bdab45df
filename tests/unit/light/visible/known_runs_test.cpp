// SPDX-License-Identifier: Apache-2.0
// What a map says of a drawn picture's pixels is what it says of the places that rays meet there.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "light/visible/visibility.h"
#include "light/walk/known_light.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 100, height = 75;

// The Cornell box, a smooth ball in it, a mirror, a two-sided sheet, and a ball that moves.
Scene make_hall() {
  Scene scene = make_cornell_box();
  add_mesh(scene, sphere_mesh(1, 0.09f, 12), "ball", at({0.12f, 0.4f, -0.1f}));
  add_sphere(scene, metal(vec3(0.9f), 0.02f), 0.07f, "mirror", at({-0.15f, 0.07f, -0.08f}));
  Material sheet = diffuse(vec3(0.5f));
  sheet.double_sided = true;
  add_quad(scene, sheet, {-0.25f, 0.3f, -0.3f}, {0, 0.2f, 0}, {0.2f, 0, 0},
           "sheet");  // seen from behind
  return scene;
}

// A pixel whose light the map knows, as it is drawn and as a sample of its place is told.
struct KnownPixel {
  Ray ray;
  Hit hit;
  Surface at;
  vec3 drawn{0}, wanted{0};
  bool is_off(float share) const { return !(length(drawn - wanted) < share * length(wanted)); }
};
// Calls visit(pixel) on any thread.
template <class Visit>
void for_each_known(const World& world, const IlluminationMap& map, const View& view,
                    const Visit& visit) {
  const Lights lights = make_lights(world);
  const VisibilityPass visibility(world, lights);
  Transport transport{world, *lights.tables};
  transport.maps = &map;
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    RunSurface surface;
    run.describe(~uint64_t(0) >> (64 - run.count), surface);
    RunKnown told;
    const uint64_t bits = run.known(map, surface, told);
    for (int i = 0; i < run.count; i++) {
      KnownPixel pixel{.ray = view_ray(view, float(run.x + i) + 0.5f, float(run.y) + 0.5f)};
      pixel.hit = world.intersect(pixel.ray);
      if (!(bits >> i & 1) || !pixel.hit.valid()) continue;
      pixel.at = eval_surface(world, pixel.ray, pixel.hit);
      pixel.wanted = find_known_light(transport, pixel.ray, pixel.hit, pixel.at).unit;
      pixel.drawn = vec3(told.red[i], told.green[i], told.blue[i]);
      visit(pixel);
    }
  });
}

TEST(KnownRuns, AreLitAsThePlacesThatRaysMeet) {
  Scene scene = make_hall();
  scene.objects.push_back("moving");
  Mesh moving = sphere_mesh(1, 0.06f, 12);
  for (vec3& p : moving.positions) p += vec3(0, 0.15f, 0);
  World world(scene, {moving}, {uint32_t(scene.objects.size() - 1)});
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  auto map = test::paint_map(world, 0.03f, {[](vec3 p) { return vec3(1) + p; }});
  View view = cornell_view(scene, width, height);
  std::atomic<int> known = 0, unknown = 0, differ = 0, moved = 0;
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    RunSurface surface;
    run.describe(~uint64_t(0) >> (64 - run.count), surface);
    RunKnown told;
    const uint64_t bits = run.known(*map, surface, told);
    for (int i = 0; i < run.count; i++) {
      Ray ray = view_ray(view, float(run.x + i) + 0.5f, float(run.y) + 0.5f);
      Hit hit = world.intersect(ray);
      if (!hit.valid() || world.object_of(hit.instance) != run.object[i]) continue;  // an edge
      const bool says = bits >> i & 1;
      bool front = dot(eval_face(world, hit.instance, hit.triangle), ray.direction) < 0;
      bool moves = world.is_moving(hit.instance);
      uint32_t chart = moves ? no_chart : map->places->find(hit.instance, hit.triangle, front);
      moved += moves;
      EXPECT_EQ(says, chart != no_chart) << scene.objects[run.object[i]];
      (says ? known : unknown)++;
      if (!says || chart == no_chart) continue;
      vec3 light = known_light(
          *map,
          eval_illumination(*map, map->places->charts[chart],
                            eval_position(world, hit.instance, hit.triangle, hit.barycentric)));
      vec3 off = vec3(told.red[i], told.green[i], told.blue[i]) - light;
      differ += !(length(off) < 0.01f);
    }
  });
  EXPECT_GT(known, width * height / 3);
  EXPECT_GT(unknown, 20);
  EXPECT_GT(moved, 20);
  // These may differ: a triangle's edge runs through the middle of the pixel.
  EXPECT_LE(differ, known / 500);
}

// A wall whose map of normals leans one way on its left and another on its right, seen from both
// sides, mirrored or not, in light from its upper left.
struct ReliefWall {
  static constexpr int size = 64;
  Scene scene = empty_scene();
  explicit ReliefWall(bool mirrored, float scale) {
    Material m = diffuse(vec3(0.5f));
    m.double_sided = true;
    m.normal_scale = scale;
    Image image{.width = size, .height = 1};
    for (int i = 0; i < size; i++)
      for (int code :
           {i < size / 2 ? 191 : 89, i < size / 2 ? 110 : 179, i < size / 2 ? 237 : 238, 255})
        image.texels8.push_back(uint8_t(code));
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0});
    m.normal_texture.texture = 0;
    add_wall(scene, m, 0, 1);
    Mesh& mesh = scene.meshes.back();
    mesh.uv[0].clear();
    for (vec3 p : mesh.positions) mesh.uv[0].push_back({0.5f + 0.5f * p.x, 0.5f - 0.5f * p.y});
    mesh.tangents.assign(mesh.positions.size(), vec4(1, 0, 0, 1));
    if (mirrored) scene.instances.back().to_world = glm::scale(mat4(1), vec3(-1, 1, 1));
  }
};

TEST(KnownRuns, OnMapsOfNormalsAreLitAsSamplesAre) {
  for (bool mirrored : {false, true})
    for (float side : {1.0f, -1.0f})
      for (float scale : {1.0f, 0.5f}) {
        ReliefWall wall(mirrored, scale);
        const World world(wall.scene);
        IlluminationMap map =
            *test::paint_map(world, 0.1f, {[](vec3 p) { return vec3(1) + 0.2f * p; }});
        IlluminationNodes nodes = map.layers->front();
        nodes.slope.assign(nodes.light.size(), pack_slope({-0.6f, 0.5f, 0.4f}));
        map.layers = std::make_shared<std::vector<IlluminationNodes>>(1, nodes);
        map = sum_of_layers(std::move(map));
        const View view = make_view(wall.scene, {0, 0, 2.5 * double(side)}, side > 0 ? 0 : pi, 0,
                                    0.7f, width, height);
        std::atomic<int> judged = 0, differ = 0, turned = 0;
        for_each_known(world, map, view, [&](const KnownPixel& pixel) {
          const vec3 place = pixel.at.position;
          if (std::abs(place.x) < 0.05f) return;  // between the two
          judged++, differ += pixel.is_off(0.02f);
          const float flat = luminance(vec3(1) + 0.2f * place);
          turned += std::abs(luminance(pixel.wanted) / flat - 1) > 0.05f;
        });
        EXPECT_GT(judged, 2000);
        EXPECT_GT(turned, judged / 3) << "the map of normals makes a difference";
        EXPECT_LE(differ, judged / 200) << mirrored << " " << side << " " << scale;
      }
}

// A ball whose light turns with its normals, from outside and from within.
TEST(KnownRuns, OnBentMeshesAreLitAsSamplesAre) {
  for (double away : {2.5, 0.0}) {
    Scene scene = empty_scene();
    Material sheet = diffuse(vec3(0.5f));
    sheet.double_sided = true;
    add_sphere(scene, sheet, 1, "ball", mat4(1), 24);
    scene.lights.push_back(
        test::point_light(away > 0 ? vec3(2, 2, 3) : vec3(0.4f, 0.3f, 0), vec3(9)));
    test::Baked baked(scene, {.gather_nodes = 300, .direct_nodes = 300});
    const auto map = baked.map(4);
    ASSERT_TRUE(map && map->normals);
    const View view = make_view(baked.scene, {0, 0, away}, 0, 0, 0.7f, width, height);
    std::atomic<int> judged = 0, differ = 0, turned = 0;
    for_each_known(baked.world, *map, view, [&](const KnownPixel& pixel) {
      const uint32_t chart = find_chart(*map->places, baked.world, pixel.ray, pixel.hit);
      const vec3 flat =
          known_light(*map, eval_illumination(*map, map->places->charts[chart], pixel.at.position));
      judged++, differ += pixel.is_off(0.02f);
      turned += length(flat - pixel.wanted) > 0.05f * length(pixel.wanted);
    });
    EXPECT_GT(judged, 2000);
    EXPECT_GT(turned, judged / 20) << "the normals make a difference";
    EXPECT_LE(differ, judged / 100) << away;
  }
}

// Slats of a few pixels: flat, with a map of normals, bent, and both.
TEST(KnownRuns, OfManyKindsSideBySideAreLitAsSamplesAre) {
  constexpr int slats = 37;
  Scene scene = empty_scene();
  Material m = diffuse(vec3(0.5f));
  const int smooth = add_material(scene, m);
  scene.images.push_back({.width = 1, .height = 1, .texels8 = {191, 110, 237, 255}});
  scene.textures.push_back({.image = 0});
  m.normal_texture.texture = 0;
  const int rough = add_material(scene, m);
  for (int i = 0; i < slats; i++) {
    const float wide = 2.0f / float(slats);
    const bool bent = i % 4 >= 2;
    add_quad(scene, i % 2 ? rough : smooth, {-1 + wide * float(i), -1, 0}, {wide, 0, 0}, {0, 2, 0},
             "slat");
    Mesh& mesh = scene.meshes.back();
    for (vec3& n : mesh.normals)
      if (bent) n = normalize(n + vec3(&n == &mesh.normals[0] ? 0.2f : -0.1f, 0.1f, 0));
    mesh.uv[0].assign(mesh.positions.size(), vec2(0));
    mesh.tangents.assign(mesh.positions.size(), vec4(1, 0, 0, 1));
  }
  scene.lights.push_back(test::point_light({0.5f, 1, 1.5f}, vec3(9)));
  test::Baked baked(scene, {.gather_nodes = 600, .direct_nodes = 1200});
  const auto map = baked.map(2);
  ASSERT_TRUE(map && map->normals);
  const View view = make_view(baked.scene, {0, 0, 2.5}, 0, 0, 0.7f, width, height);
  std::atomic<int> judged[4] = {}, differ[4] = {}, turned[4] = {};
  for_each_known(baked.world, *map, view, [&](const KnownPixel& pixel) {
    const uint32_t chart = find_chart(*map->places, baked.world, pixel.ray, pixel.hit);
    const vec3 flat =
        known_light(*map, eval_illumination(*map, map->places->charts[chart], pixel.at.position));
    const uint32_t kind = pixel.hit.instance % 4;
    // A map's tangents are alike all over a triangle, which bent ones show.
    judged[kind]++, differ[kind] += pixel.is_off(kind == 3 ? 0.1f : 0.01f);
    turned[kind] += length(flat - pixel.wanted) > 0.01f * length(pixel.wanted);
  });
  for (int kind = 0; kind < 4; kind++) {
    EXPECT_GT(judged[kind], 300) << kind;
    EXPECT_LE(differ[kind], judged[kind] / 100) << kind;
    EXPECT_TRUE(kind == 0 ? turned[kind] == 0 : turned[kind] > judged[kind] / 4) << kind;
  }
}

}  // namespace
}  // namespace wellspring::test
