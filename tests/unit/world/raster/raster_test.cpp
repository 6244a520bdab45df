// SPDX-License-Identifier: Apache-2.0
// The z-buffer sees what rays see: in soups of triangles of all sizes, with the eye among them,
// with alpha, instances and things that move.
#include "world/raster/raster.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <atomic>
#include <cmath>

#include "base/rng.h"
#include "scenes/scenes.h"
#include "world/raster/raster_setup.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

struct Picture {
  std::vector<Hit> hits;
  std::vector<vec3> tint;
  int taken = 0;
};

Picture draw(Raster& raster, const View& view, const RasterSettings& settings = {}) {
  Picture picture;
  size_t pixels = size_t(view.width) * size_t(view.height);
  picture.hits.resize(pixels);
  picture.tint.resize(pixels, vec3(1));
  std::atomic<int> taken = 0;
  raster.draw(view, settings, [&](const RasterRun& run) {
    size_t first = size_t(run.y) * size_t(view.width) + size_t(run.x);
    for (int i = 0; i < run.count; i++)
      picture.hits[first + size_t(i)] = hit_of(run, i, view, settings.offset);
    for (int i = 0; run.veil && i < run.count; i++)
      picture.tint[first + size_t(i)] = run.veil[i].tint + 8.0f * run.veil[i].glow;
    taken += run.count;
  });
  picture.taken = taken;
  return picture;
}

bool same_place(const World& world, const Ray& ray, const Hit& a, const Hit& b) {
  if (a.valid() != b.valid()) return false;
  if (!a.valid()) return true;
  if (a.instance == b.instance && a.triangle == b.triangle) {
    // The barycentrics name the place itself: it may lie beside the ray by the rounding of edges.
    vec3 p = eval_position(world, a.instance, a.triangle, a.barycentric);
    vec3 q = eval_position(world, b.instance, b.triangle, b.barycentric);
    vec3 n = eval_face(world, b.instance, b.triangle);
    float grazing = std::max(std::abs(dot(n, ray.direction)), 1e-5f);
    float tolerance = (2e-4f * b.t + 2e-5f) / grazing;  // triangles are up to 7 m long
    return glm::length(p - q) <= tolerance && std::abs(a.t - b.t) <= tolerance;
  }
  return std::abs(a.t - b.t) <= 1e-5f * b.t;  // a common edge, or one surface in another
}

// Pixels where the picture says what no ray within a two hundredth of a pixel says.
int wrong_pixels(const World& world, const View& view, const Picture& picture,
                 vec2 offset = vec2(0.5f)) {
  int wrong = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const Hit& seen = picture.hits[size_t(y) * size_t(view.width) + size_t(x)];
      bool right = false;
      for (int k = 0; k <= 16 && !right; k++) {
        float angle = float(k) * 2 * pi / 16, radius = k == 0 ? 0 : 0.005f;
        Ray ray = view_ray(view, float(x) + offset.x + radius * std::cos(angle),
                           float(y) + offset.y + radius * std::sin(angle));
        right = same_place(world, ray, seen, world.intersect(ray));
      }
      wrong += !right;
    }
  return wrong;
}

vec3 random_place(Rng& rng, float size) {
  return size * (2.0f * vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 1.0f);
}

// Triangles of all sizes and shapes around and through the origin.
Mesh soup(uint64_t seed, int count) {
  Rng rng(seed);
  Mesh mesh;
  for (int i = 0; i < count; i++) {
    vec3 a = random_place(rng, 4);
    float size = std::exp(6 * rng.uniform() - 4);
    uint32_t first = uint32_t(mesh.positions.size());
    for (vec3 p : {a, a + random_place(rng, size), a + random_place(rng, size)}) {
      mesh.positions.push_back(p);
      mesh.normals.push_back({0, 1, 0});
    }
    if (i % 10 == 0)
      mesh.positions.back() = mix(mesh.positions[first], mesh.positions[first + 1], 0.3f);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

View view_of(const Scene& scene, int i, int width = 160, int height = 90) {
  return make_view(scene, {0.1 * i, 0.2, 0.05 * i}, 0.7f * float(i), 0.3f * std::sin(float(i)),
                   0.3f + 0.4f * float(i % 6), width, height);
}

TEST(Raster, SeesWhatRaysSee) {
  Scene scene = empty_scene();
  add_mesh(scene, soup(1, 3000), "soup");
  add_mesh(scene, soup(2, 300), "turned",
           mat4(0.3f, 0.1f, 0, 0, 0, 0.5f, 0, 0, 0.1f, 0, 0.9f, 0, 1, 0, 0, 1));
  World world(scene);
  Raster raster(world);
  for (int i = 0; i < 12; i++) {
    View view = view_of(scene, i);
    Picture picture = draw(raster, view);
    EXPECT_EQ(picture.taken, 160 * 90);
    EXPECT_EQ(wrong_pixels(world, view, picture), 0) << "view " << i;
  }
}

// Through windows that the eye is not opposite of: nothing in sight is left out at any border.
TEST(Raster, SeesWhatRaysSeeBesideTheAxis) {
  Scene scene = empty_scene();
  add_mesh(scene, soup(1, 3000), "soup");
  World world(scene);
  Raster raster(world);
  for (int i = 0; i < 6; i++) {
    View view = view_of(scene, i);
    view.middle = vec2(1.3f * std::cos(float(i)), 0.9f * std::sin(float(i)));
    RasterSettings settings{.offset = {0.3f, 0.8f}};
    Picture picture = draw(raster, view, settings);
    EXPECT_EQ(picture.taken, 160 * 90);
    EXPECT_EQ(wrong_pixels(world, view, picture, settings.offset), 0) << "view " << i;
  }
}

// Surfaces nearer than the view's beginning are cut away, for rays and for the raster alike.
TEST(Raster, SeesWhatRaysSeeBehindTheViewsBeginning) {
  Scene scene = empty_scene();
  add_mesh(scene, soup(1, 3000), "soup");
  World world(scene);
  Raster raster(world);
  for (int i = 0; i < 6; i++) {
    View view = view_of(scene, i);
    const Picture whole = draw(raster, view);
    view.near = 1.5f;
    const Picture picture = draw(raster, view);
    EXPECT_LE(wrong_pixels(world, view, picture), 2) << "view " << i;  // at the cut's own edge
    int cut = 0;
    for (size_t p = 0; p < picture.hits.size(); p++) {
      const Ray ray = view_ray(view, float(p % 160) + 0.5f, float(p / 160) + 0.5f);
      const float depth = picture.hits[p].t * dot(ray.direction, view.forward);
      EXPECT_GE(depth, 1.499f);
      cut += picture.hits[p].t != whole.hits[p].t;
    }
    EXPECT_GT(cut, 100) << "view " << i;
  }
}

// Rooms behind a wall with a slit: what the wall hides costs nothing, what the slit shows is there.
TEST(Raster, LeavesOutWhatIsHidden) {
  Scene scene = empty_scene();
  int grey = add_material(scene, diffuse(vec3(0.5f)));
  add_quad(scene, grey, {-30, -30, -5}, {29.9f, 0, 0}, {0, 60, 0}, "left of the slit");
  add_quad(scene, grey, {0.1f, -30, -5}, {29.9f, 0, 0}, {0, 60, 0}, "right of the slit");
  for (int i = 0; i < 40; i++)
    add_mesh(scene, soup(uint64_t(20 + i), 300), "clutter",
             glm::scale(at({-16.0f + 0.8f * float(i), 0, -14.0f - 0.2f * float(i)}), vec3(0.15f)));
  Mesh mover = soup(90, 200);
  for (vec3& p : mover.positions) p = 0.15f * p + vec3(4, 0, -12);
  scene.objects.push_back("mover");
  World world(scene, {mover}, {uint32_t(scene.objects.size() - 1)});
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 1.2f, 320, 180);
  Picture picture = draw(raster, view);
  EXPECT_EQ(picture.taken, 320 * 180);
  EXPECT_EQ(wrong_pixels(world, view, picture), 0);
  int through = 0;
  for (const Hit& hit : picture.hits) through += hit.valid() && hit.instance >= 2;
  EXPECT_GT(through, 50);

  for (vec3& p : mover.positions) p += vec3(-3, 0, 9.5f);  // before the wall
  world.move(0, mover.positions, mover.normals);
  world.commit();
  picture = draw(raster, view);
  EXPECT_EQ(wrong_pixels(world, view, picture), 0);
  int moved = 0;
  for (const Hit& hit : picture.hits) moved += hit.valid() && world.is_moving(hit.instance);
  EXPECT_GT(moved, 500);
}

// Still and moving things, drawn apart and the nearer taken, are the whole picture.
TEST(Raster, StillAndMovingMakeAll) {
  Scene scene = empty_scene();
  add_mesh(scene, soup(3, 2000), "soup");
  scene.objects.push_back("mover");
  View view = view_of(scene, 1, 91, 67);
  Mesh mover = sphere_mesh(0, 0.02f, 16);
  for (vec3& p : mover.positions) p += view.position + 0.1f * view.forward;
  World world(scene, {mover}, {uint32_t(scene.objects.size() - 1)});
  Raster raster(world);
  auto shows = [&](RasterShows which) { return draw(raster, view, {.shows = which}); };
  Picture all = shows(RasterShows::all), still = shows(RasterShows::still),
          moving = shows(RasterShows::moving);
  int from[2] = {};
  for (size_t i = 0; i < all.hits.size(); i++) {
    const Hit &a = all.hits[i], &s = still.hits[i], &m = moving.hits[i];
    EXPECT_FALSE(s.valid() && world.is_moving(s.instance));
    EXPECT_TRUE(!m.valid() || world.is_moving(m.instance));
    const Hit& nearer = m.valid() && (!s.valid() || m.t < s.t) ? m : s;
    ASSERT_EQ(a.valid(), nearer.valid()) << i;
    if (!a.valid()) continue;
    EXPECT_EQ(a.instance, nearer.instance) << i;
    EXPECT_EQ(a.triangle, nearer.triangle) << i;
    from[world.is_moving(a.instance)]++;
  }
  EXPECT_GT(from[0], 100);
  EXPECT_GT(from[1], 100);
}

TEST(Raster, SamplesWhereItIsTold) {
  Scene scene = empty_scene();
  add_mesh(scene, soup(3, 2000), "soup");
  World world(scene);
  Raster raster(world);
  View view = view_of(scene, 1, 91, 67);  // odd: tiles and rows end anywhere
  for (vec2 offset : {vec2(0, 0), vec2(0.25f, 0.875f)}) {
    Picture picture = draw(raster, view, {.offset = offset});
    EXPECT_EQ(wrong_pixels(world, view, picture, offset), 0);
  }
}

// A place on a common edge belongs to one of the two triangles, never to none or both.
TEST(Raster, NeighboursShareNoPixelAndLeaveNone) {
  RasterView view{1e-6f, 64, 64, 32, 32, 32 * raster_steps, 32 * raster_steps};
  std::vector<int> covered(64 * 64);
  for (int fan = 0; fan < 40; fan++) {
    RasterCorners corners{};
    int rim = 3 + fan % 12;
    // All corners at whole and half pixels, where sampling places lie on many an edge.
    Rng rng(uint64_t(fan) + 5);
    corners.w[0] = 1;
    corners.x[0] = float(rng.next() % 16) - 8, corners.y[0] = float(rng.next() % 16) - 8;
    for (int i = 1; i <= rim; i++) {
      float angle = 2 * pi * float(i) / float(rim);
      corners.x[i] = std::round(60 * std::cos(angle)),
      corners.y[i] = std::round(60 * std::sin(angle));
      corners.w[i] = 1;
    }
    project_corners(view, 16, corners);
    std::vector<RasterTriangle> triangles;
    for (int i = 1; i <= rim; i++) {
      int next = i % rim + 1;
      i % 2 ? add_triangle(view, corners, 0, i, next, {}, triangles)
            : add_triangle(view, corners, next, i, 0, {}, triangles);
    }
    std::fill(covered.begin(), covered.end(), 0);
    for (const RasterTriangle& t : triangles)
      for (int y = t.top; y <= t.bottom; y++)
        for (int x = t.left; x <= t.right; x++) {
          bool inside = true;
          for (int k = 0; k < 3; k++) {
            int64_t sx = x * raster_steps - view.centre_steps_x,
                    sy = y * raster_steps - view.centre_steps_y;
            inside &= t.a[k] * (sx - t.from_x[k]) + t.b[k] * (sy - t.from_y[k]) + t.bias[k] >= 0;
          }
          covered[size_t(y * 64 + x)] += inside;
        }
    int once = 0;
    for (int n : covered) {
      ASSERT_LE(n, 1) << "fan " << fan;
      once += n;
    }
    EXPECT_GT(once, rim == 3 ? 2000 : 3000) << "fan " << fan;
  }
}

TEST(Raster, AFineSurfaceHasNoHoles) {
  Scene scene = empty_scene();
  Mesh grid;
  constexpr int n = 300;  // three triangles a pixel, over and beyond the picture
  for (int y = 0; y <= n; y++)
    for (int x = 0; x <= n; x++) {
      grid.positions.push_back({0.01f * float(x) - 1.5f, 0.01f * float(y) - 1.5f,
                                -1 - 0.01f * std::sin(0.3f * float(x * y))});
      grid.normals.push_back({0, 0, 1});
    }
  for (uint32_t y = 0; y < n; y++)
    for (uint32_t x = 0; x < n; x++) {
      uint32_t a = y * (n + 1) + x;
      grid.triangles.push_back({a, a + 1, a + n + 2});
      grid.triangles.push_back({a + n + 1, a, a + n + 2});
    }
  add_mesh(scene, grid, "grid");
  World world(scene);
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 1.2f, 120, 100);
  Picture picture = draw(raster, view);
  for (const Hit& hit : picture.hits) ASSERT_TRUE(hit.valid());
  EXPECT_EQ(wrong_pixels(world, view, picture), 0);
}

TEST(Raster, AlphaLetsPassAsRaysDo) {
  Scene scene = empty_scene();
  Material leaf = diffuse(vec3(0.5f));
  leaf.alpha_mode = AlphaMode::blend;
  leaf.base_color.w = 0.4f;
  Mesh blade;  // one triangle: on an edge between two, a ray throws the dice for both
  blade.material = add_material(scene, leaf);
  blade.positions = {{-2, -1, -2}, {2, -1, -2.3f}, {0, 3, -2.1f}};
  blade.normals.assign(3, {0, 0, 1});
  blade.triangles = {{0, 1, 2}};
  add_mesh(scene, blade, "blade");
  add_wall(scene, diffuse(vec3(0.5f)), -3, 1, "quad");
  World world(scene);
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 1, 128, 96);
  Picture picture = draw(raster, view);
  int passed = 0, stopped = 0;
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 128; x++) {
      const Hit& hit = picture.hits[size_t(y * 128 + x)];
      Hit ray = world.intersect(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
      if (!hit.valid()) continue;
      passed += hit.instance == 1, stopped += hit.instance == 0;
      EXPECT_EQ(hit.instance, ray.instance) << x << ", " << y;
    }
  EXPECT_GT(passed, 1000);
  EXPECT_GT(stopped, 1000);
}

TEST(Raster, SeeThroughSurfacesVeilWhatIsBehind) {
  Scene scene = empty_scene();
  int pane = add_material(scene, glass(1.5f, 0, 0));
  add_quad(scene, pane, {-0.5f, -1, -2}, {0.5f, 0, 0}, {0, 2, 0});  // before the wall
  add_quad(scene, pane, {0.2f, -1, -4}, {0.5f, 0, 0}, {0, 2, 0});   // behind it
  add_wall(scene, diffuse(vec3(0.5f)), -3, 9, "quad");
  World world(scene);
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 0.8f, 100, 80);
  std::vector<uint8_t> see_through(scene.materials.size(), 0);
  see_through[size_t(pane)] = 1;
  RasterSettings settings{.see_through = see_through};
  settings.veil = [&](const Hit& hit, vec3 direction) {
    EXPECT_EQ(hit.instance, 0u);
    EXPECT_NEAR(
        glm::length(hit.t * direction - eval_position(world, 0, hit.triangle, hit.barycentric)), 0,
        1e-4f);
    return Veil{vec3(0.5f, 0.25f, 1), vec3(0, 0, 1)};
  };
  Picture picture = draw(raster, view, settings);
  int veiled = 0;
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 100; x++) {
      size_t i = size_t(y * 100 + x);
      EXPECT_EQ(picture.hits[i].instance, 2u);
      bool expected =
          world.intersect(view_ray(view, float(x) + 0.5f, float(y) + 0.5f)).instance == 0;
      EXPECT_EQ(picture.tint[i], expected ? vec3(0.5f, 0.25f, 9) : vec3(1));
      veiled += expected;
    }
  EXPECT_GT(veiled, 500);
}

TEST(Raster, FollowsWhatMovesAndHides) {
  Scene scene = empty_scene();
  scene.objects.push_back("ball");
  Mesh ball = sphere_mesh(0, 0.3f, 24);
  for (vec3& p : ball.positions) p.z -= 2;
  World world(scene, {ball}, {1});
  Raster raster(world);
  View view = make_view(scene, {0, 0, 0}, 0, 0, 0.8f, 96, 96);
  EXPECT_EQ(wrong_pixels(world, view, draw(raster, view)), 0);
  for (vec3& p : ball.positions) p = vec3(p.x + 0.4f, 1.5f * p.y, p.z + 0.7f);
  world.move(0, ball.positions, ball.normals);
  world.commit();
  Picture moved = draw(raster, view);
  EXPECT_EQ(wrong_pixels(world, view, moved), 0);
  EXPECT_TRUE(moved.hits[48 * 96 + 80].valid());
  world.show(0, false);
  world.commit();
  for (const Hit& hit : draw(raster, view).hits) ASSERT_FALSE(hit.valid());
}

TEST(Raster, HardCases) {
  Scene scene = empty_scene();
  Mesh mesh = soup(9, 200);
  float bad[] = {NAN, INFINITY, 1e38f, -1e30f, 1e-42f};
  for (size_t i = 0; i < 60; i++) mesh.positions[i * 3][int(i % 3)] = bad[i % 5];
  mesh.positions.push_back({0, 0, 0});  // the eye itself
  mesh.normals.push_back({0, 1, 0});
  uint32_t eye = uint32_t(mesh.positions.size()) - 1;
  for (uint32_t i = 200; i < 260; i++) mesh.triangles.push_back({eye, i, i + 7});
  add_mesh(scene, mesh, "soup");
  World world(scene);
  Raster raster(world);
  for (float fov : {0.001f, 0.087f, 2.618f, 3.1f})
    for (auto [width, height] : {std::pair(1, 1), std::pair(70, 3), std::pair(3, 70)}) {
      View view = make_view(scene, {0, 0, 0}, 0.3f, 0.1f, fov, width, height);
      Picture picture = draw(raster, view);
      EXPECT_EQ(picture.taken, width * height);
      for (const Hit& hit : picture.hits) {
        if (!hit.valid()) continue;
        EXPECT_TRUE(std::isfinite(hit.t) && hit.t > 0);
        EXPECT_TRUE(hit.barycentric.x >= 0 && hit.barycentric.y >= 0);
        EXPECT_LE(hit.barycentric.x + hit.barycentric.y, 1.00001f);
      }
    }
  View huge = make_view(scene, {0, 0, 0}, 0, 0, 1, Raster::most_pixels + 1, 1);
  raster.draw(huge, {}, [](const RasterRun&) { ADD_FAILURE(); });

  Scene empty = empty_scene();
  World nothing(empty);
  Raster none(nothing);
  EXPECT_EQ(draw(none, view_of(empty, 0)).taken, 160 * 90);
}

}  // namespace
}  // namespace wellspring::test
