// SPDX-License-Identifier: Apache-2.0
// How much of pixels edges cover, told from one sampling place a pixel.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "scenes/scenes.h"
#include "world/raster/raster.h"
#include "world/raster/raster_edges.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Coverage of every pixel by an instance, as edges tell it from one sampling place, and as they do
// not.
struct Coverage {
  std::vector<float> plain, softened;
  size_t named = 0;
};
Coverage coverage_by(Raster& raster, const View& view, uint32_t instance) {
  Coverage c;
  c.plain.resize(size_t(view.width) * size_t(view.height));
  RasterSettings settings{.edges = true};
  raster.draw(view, settings, [&](const RasterRun& run) {
    for (int i = 0; i < run.count; i++)
      c.plain[size_t(run.y * view.width + run.x + i)] = run.instance[i] == instance;
  });
  c.softened = c.plain;
  std::vector<int> list_of(c.plain.size(), -1);
  int number = 0;
  for (const std::vector<EdgeShare>& list : raster.edges()) {
    for (const EdgeShare& e : list) {
      EXPECT_GT(e.share, 0);
      EXPECT_LE(e.share, 0.5f);
      int x = int(e.pixel) % view.width, y = int(e.pixel) / view.width;
      int ox = int(e.other) % view.width, oy = int(e.other) / view.width;
      EXPECT_LE(std::max(std::abs(x - ox), std::abs(y - oy)), 5);
      EXPECT_TRUE(list_of[e.pixel] == -1 || list_of[e.pixel] == number);
      list_of[e.pixel] = number;
      c.softened[e.pixel] += e.share * (c.plain[e.other] - c.plain[e.pixel]);
      c.named++;
    }
    number++;
  }
  return c;
}

// Root mean square of what plain and softened coverage differ from the exact one by.
struct CoverageError {
  double plain = 0, softened = 0;
  int cut = 0;  // pixels that are covered in part
};
CoverageError compare_coverage(const World& world, const View& view, const Coverage& c,
                               uint32_t instance) {
  CoverageError error;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      size_t i = size_t(y * view.width + x);
      constexpr int side = 8;
      float covered = 0;
      for (int k = 0; k < side * side; k++) {
        Ray ray = view_ray(view, float(x) + (float(k % side) + 0.5f) / side,
                           float(y) + (float(k / side) + 0.5f) / side);
        Hit hit = world.intersect(ray);
        covered += (hit.valid() && hit.instance == instance) / float(side * side);
      }
      error.plain += std::pow(c.plain[i] - covered, 2);
      error.softened += std::pow(c.softened[i] - covered, 2);
      error.cut += covered > 0 && covered < 1;
    }
  error.plain = std::sqrt(error.plain), error.softened = std::sqrt(error.softened);
  return error;
}

// Looks at a mesh from two metres, 120 pixels to a metre, before a wall.
CoverageError look_at(const Mesh& mesh) {
  Scene scene = empty_scene();
  int grey = add_material(scene, diffuse(vec3(0.5f)));
  Mesh grating = mesh;
  grating.material = grey;
  grating.normals.assign(grating.positions.size(), {0, 0, 1});
  add_mesh(scene, grating, "grating");
  add_wall(scene, grey, -7);
  World world(scene);
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 2 * std::atan(0.5f), 240, 240);
  return compare_coverage(world, view, coverage_by(raster, view, 0), 0);
}
void add_face(Mesh& mesh, vec3 a, vec3 u, vec3 v) {  // with vertices of its own
  uint32_t n = uint32_t(mesh.positions.size());
  for (vec3 p : {a, a + u, a + u + v, a + v}) mesh.positions.push_back(p);
  mesh.triangles.push_back({n, n + 1, n + 2});
  mesh.triangles.push_back({n, n + 2, n + 3});
}
constexpr float pixel = 1 / 120.0f;  // metres, for look_at()

// Edges of a turned square before nothing, before a wall and upon it, over many tiles.
TEST(Raster, EdgesTellHowMuchOfAPixelIsCovered) {
  for (int background : {0, 1, 2}) {
    Scene scene = empty_scene();
    int grey = add_material(scene, diffuse(vec3(0.5f)));
    vec3 across(1.3f, 0.4f, 0.3f), up(-0.3f, 1.1f, -0.2f), corner(-0.7f, -0.6f, -3);
    add_quad(scene, grey, corner, across, up, "square");
    if (background == 1) add_wall(scene, grey, -7);
    if (background == 2)  // in its plane, a hair behind
      add_quad(scene, grey, corner - 4.0f * across - 4.0f * up + vec3(0, 0, -0.002f), 9.0f * across,
               9.0f * up, "board");
    World world(scene);
    Raster raster(world);
    View view = make_view(scene, {0, 0, 0}, 0, 0, 0.9f, 301, 203);
    Coverage c = coverage_by(raster, view, 0);
    CoverageError error = compare_coverage(world, view, c, 0);
    EXPECT_GT(error.cut, 300);
    // Errors are left at corners, and where edges run rather along the other axis.
    EXPECT_LT(error.softened, 0.2 * error.plain) << "background " << background;
  }
}

// Within a smooth surface nothing is softened, however many triangles it has; creases are.
TEST(Raster, EdgesAreNotThoseOfTriangles) {
  Scene scene = empty_scene();
  int grey = add_material(scene, diffuse(vec3(0.5f)));
  add_mesh(scene, sphere_mesh(grey, 1, 64), "ball", at({0, 0, -4}));
  World world(scene);
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 0.9f, 320, 240);
  Coverage c = coverage_by(raster, view, 0);
  EXPECT_GT(c.named, 200u);
  for (const std::vector<EdgeShare>& list : raster.edges())
    for (const EdgeShare& e : list) {
      vec2 from_centre = vec2(float(e.pixel % 320), float(e.pixel / 320)) - vec2(159.5f, 119.5f);
      float radius = 120 / std::tan(0.45f) / std::sqrt(15.0f);
      EXPECT_NEAR(glm::length(from_centre), radius, 3) << e.pixel;
    }
  raster.draw(view, {}, [](const RasterRun&) {});
  EXPECT_TRUE(raster.edges().empty());
}

// Bars with two faces to be seen, each of two triangles, all of them narrower than a pixel: where
// one of these ends, the bar goes on.
TEST(Raster, EdgesAreThoseOfSurfacesNotOfFaces) {
  for (float lean : {0.15f, 0.7f}) {
    Mesh bars;
    for (int i = 0; i < 20; i++) {
      vec3 a(-0.8f - 0.5f * lean + 0.08f * float(i), -0.9f, -2), up(lean, 1.8f, 0);
      vec3 right(0.7f * pixel, 0, 0.7f * pixel), left(-0.7f * pixel, 0, 0.7f * pixel);
      add_face(bars, a - left, left, up), add_face(bars, a, right, up);
      add_face(bars, a - left, right, up), add_face(bars, a + right - left, left, up);
    }
    CoverageError error = look_at(bars);
    EXPECT_GT(error.cut, 2000);
    EXPECT_LT(error.softened, 0.1 * error.plain) << lean;
  }
}

// A grating of one instance, in one plane, with gaps narrower than a pixel: between two sampling
// places on bars the wall is seen.
TEST(Raster, EdgesTellOfGapsWithinAnInstance) {
  for (float lean : {0.1f, 0.5f}) {
    Mesh bars;
    for (int i = 0; i < 100; i++)
      add_face(bars, {-0.9f - 0.5f * lean + 2.15f * pixel * float(i), -0.9f, -2},
               {1.3f * pixel, 0, 0}, {lean, 1.8f, 0});
    CoverageError error = look_at(bars);
    EXPECT_GT(error.cut, 2000);
    EXPECT_LT(error.softened, 0.2 * error.plain) << lean;
  }
}

// Neighbours are found over a box's edges, with vertices shared or not, and not where three
// triangles meet.
TEST(Raster, TrianglesKnowTheirNeighbours) {
  Mesh box;
  add_face(box, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_face(box, {1, 0, 0}, {0, 0, 0.25f}, {0, 1, 0});
  MeshNeighbours found = find_neighbours(box);
  ASSERT_EQ(found.over.size(), 4u);
  EXPECT_EQ(found.over[0], (std::array<uint32_t, 3>{MeshNeighbours::none, 3 * 4 + 2, 1 * 4 + 0}));
  EXPECT_EQ(found.over[1][0], 0u * 4 + 2);
  EXPECT_NEAR(found.width[1], std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(found.width[0], 0.25f / std::sqrt(1 + 0.0625f), 1e-5f);  // its neighbour's
  EXPECT_EQ(found.bar, (std::vector<uint8_t>{1, 0, 1, 1}));  // one is wide, as its neighbour is
  box.triangles.push_back({1, 2, 3});                        // a third at the same edge
  found = find_neighbours(box);
  EXPECT_EQ(found.over[0][1], MeshNeighbours::none);
  Mesh ball = sphere_mesh(0, 1, 64);
  found = find_neighbours(ball);
  int bar = 0;
  for (uint8_t s : found.bar) bar += s;
  EXPECT_LT(bar, int(ball.triangles.size()) / 10);
}

}  // namespace
}  // namespace wellspring::test
