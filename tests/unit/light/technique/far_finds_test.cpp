// SPDX-License-Identifier: Apache-2.0
// A find of 2 cm at the edge of a survey of 2 km looks as it does alone at the origin: to rays, to
// the z-buffer and in light.
#include <gtest/gtest.h>

#include <cmath>

#include "light/technique/technique.h"
#include "scenes/scenes.h"
#include "unit/world/load/asset.h"
#include "world/mesh_finish.h"
#include "world/raster/raster.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A ball with ridges a fifth of a millimetre apart and faces as small, each with its own normal.
Mesh find_mesh(int material) {
  Mesh mesh = sphere_mesh(material, 0.01f, 150);
  for (vec3& p : mesh.positions)
    p *= 1 + 0.01f * std::sin(1500 * p.x) * std::sin(1300 * p.y) * std::sin(1400 * p.z);
  make_flat_normals(mesh);
  return mesh;
}
struct Survey {
  Scene scene = empty_scene();
  dvec3 place;
  // `wide`: of the ground, metres each way from `middle`.
  Survey(dvec3 place, vec3 middle, float wide) : place(place) {
    int stone = add_material(scene, diffuse({0.7f, 0.6f, 0.5f}));
    int soil = add_material(scene, diffuse(vec3(0.4f)));
    add_quad(scene, soil, middle + vec3(-wide, 0, wide), {2 * wide, 0, 0}, {0, 0, -2 * wide},
             "ground");
    add_mesh(scene, find_mesh(stone), "find", at(vec3(place) + vec3(0, 0.01f, 0)));
    scene.lights.push_back({.type = PunctualType::directional,
                            .direction = normalize(vec3(-1, -1.2f, -0.4f)),
                            .intensity = vec3(3)});
  }
  View view(int side) const {  // from about ten centimetres; exact in floats where it is
    return make_view_towards(scene, place + dvec3(0.015625, 0.0625, 0.078125),
                             place + dvec3(0, 0.009765625, 0), {0, 1, 0}, 0.3f, side, side);
  }
};
Survey far_find() { return {{1000, 0, 700}, vec3(0), 1024}; }
Survey near_find() { return {{0, 0, 0}, vec3(0), 2}; }

struct Difference {
  double mean = 0, most = 0;  // luminance, as shares of the mean and of the brightest
};
Difference difference(const Frame& a, const Frame& b) {
  Difference d;
  double sum = 0, brightest = 0;
  for (size_t i = 0; i < a.color.size(); i++) {
    double x = double(luminance(a.color[i])), y = double(luminance(b.color[i]));
    sum += y, d.mean += std::abs(x - y);
    d.most = std::max(d.most, std::abs(x - y)), brightest = std::max(brightest, y);
  }
  return {d.mean / sum, d.most / brightest};
}

Frame render(const Survey& survey, const char* technique, int spp) {
  World world(survey.scene);
  return render_still(*find_technique(technique), world, make_lights(world), survey.view(96),
                      {.spp = spp});
}

TEST(FarFinds, RaysMeetTheSameTrianglesWithTheSameNormals) {
  Survey far = far_find(), near = near_find();
  World there(far.scene), here(near.scene);
  EXPECT_TRUE(there.placed(1).apart);
  EXPECT_FALSE(there.placed(0).apart);
  EXPECT_FALSE(here.any_apart());
  View v = far.view(200), w = near.view(200);
  int same = 0, all = 0;
  double bent = 0;
  for (int y = 0; y < 200; y++)
    for (int x = 0; x < 200; x++) {
      Ray a = view_ray(v, float(x) + 0.5f, float(y) + 0.5f),
          b = view_ray(w, float(x) + 0.5f, float(y) + 0.5f);
      Hit f = there.intersect(a), n = here.intersect(b);
      if (!n.valid() || n.instance != 1) continue;
      all++;
      if (f.instance != n.instance || f.triangle != n.triangle) continue;
      same++;
      EXPECT_NEAR(f.t, n.t, 1e-6f);
      vec3 normal = eval_surface(there, a, f).normal;
      bent = std::max(bent, double(glm::length(normal - eval_surface(here, b, n).normal)));
    }
  EXPECT_GT(all, 4000);
  EXPECT_GT(double(same) / all, 0.999);  // but for rounding at edges
  EXPECT_LT(bent, 1e-3);
}

TEST(FarFinds, TheRasteriserSeesWhatRaysSee) {
  Survey far = far_find();
  World world(far.scene);
  Raster raster(world);
  View view = far.view(200);
  std::vector<Hit> hits(200 * 200);
  raster.draw(view, {}, [&](const RasterRun& run) {
    for (int i = 0; i < run.count; i++)
      hits[size_t(run.y) * 200 + size_t(run.x + i)] = hit_of(run, i, view, vec2(0.5f));
  });
  int same = 0, all = 0;
  for (int i = 0; i < 200 * 200; i++) {
    Hit hit = world.intersect(view_ray(view, float(i % 200) + 0.5f, float(i / 200) + 0.5f));
    if (hit.instance != 1) continue;
    all++;
    const Hit& drawn = hits[size_t(i)];
    same += drawn.instance == 1 && drawn.triangle == hit.triangle;
    if (drawn.instance != 1) continue;
    EXPECT_NEAR(drawn.t, hit.t, 2e-4f);  // a neighbour across an edge
  }
  EXPECT_GT(double(same) / all, 0.97);  // corners are rounded to 1/256 of a pixel
}

// A small difference is left: light is gathered a fifth of a millimetre off the find, where
// rounding allows.
TEST(FarFinds, LightOnThemIsAsAtTheOrigin) {
  Difference d = difference(render(far_find(), "direct", 4), render(near_find(), "direct", 4));
  EXPECT_LT(d.mean, 0.01);
  d = difference(render(far_find(), "path", 64), render(near_find(), "path", 64));
  EXPECT_LT(d.mean, 0.02);
}

// Rays that leave a place of a find never meet that place again, nor start beyond what is near it.
TEST(FarFinds, NoPlaceShadowsItself) {
  Scene scene = far_find().scene;
  scene.meshes[1] = sphere_mesh(scene.meshes[1].material, 0.01f, 100);  // convex
  World world(scene);
  ASSERT_TRUE(world.any_apart());
  const vec3 middle = vec3(world.to_world(1)[3]);
  int shadowed = 0;
  for (int i = 0; i < 20000; i++) {
    float u = 2 * (float(i) + 0.5f) / 20000 - 1, turn = float(i) * 2.39996f;
    vec3 n(std::sqrt(1 - u * u) * std::cos(turn), u, std::sqrt(1 - u * u) * std::sin(turn));
    if (n.y < 0) continue;  // the ground is below
    Ray ray{.origin = middle + n * 0.05f, .direction = -n};
    Hit hit = world.intersect(ray);
    ASSERT_EQ(hit.instance, 1u);
    Surface s = eval_surface(world, ray, hit);
    vec3 side = normalize(cross(n, std::abs(n.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    for (float slant : {0.05f, 0.3f, 1.0f}) {
      Ray leaving{.direction = normalize(slant * s.geometric_normal + (1 - slant) * side)};
      leaving.origin = offset_origin(s, leaving.direction);
      leaving.t_max = 0.005f;
      shadowed += world.occluded(leaving);
    }
    // Eight steps of a coordinate there; it was 15 mm.
    EXPECT_LT(glm::length(offset_origin(s, n) - s.position), 0.0005f);
  }
  EXPECT_EQ(shadowed, 0);
}

// The scene is read from a file: a node's place is kept apart from the places of its corners.
TEST(FarFinds, AreReadFromFilesAsFineAsTheyAre) {
  Asset asset;
  Mesh find = find_mesh(0);
  std::vector<float> places;
  for (const vec3& p : find.positions) places.insert(places.end(), {p.x, p.y, p.z});
  std::vector<uint32_t> corners;
  for (const uvec3& t : find.triangles) corners.insert(corners.end(), {t.x, t.y, t.z});
  int position = asset.add_floats("VEC3", 3, places);
  int index = asset.add_accessor(asset.add_view(corners), 5125, "SCALAR", corners.size());
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", index}});
  int ground = asset.add_floats("VEC3", 3, {-1024, 0, -1024, -1024, 0, 1024, 1024, 0, 1024});
  asset.add_mesh({{"attributes", {{"POSITION", ground}}}});
  asset.add_node({{"mesh", 1}});
  asset.add_node({{"mesh", 0}, {"translation", {1000, 0.01, 700}}});
  Scene scene = load(asset);
  World world(scene);
  ASSERT_TRUE(world.placed(1).apart);
  uvec3 t = find.triangles[1234];
  vec3 wanted = normalize(
      cross(find.positions[t.y] - find.positions[t.x], find.positions[t.z] - find.positions[t.x]));
  EXPECT_LT(glm::length(eval_face(world, 1, 1234) - wanted), 1e-3f);
}

}  // namespace
}  // namespace wellspring::test
