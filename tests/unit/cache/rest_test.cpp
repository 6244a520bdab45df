// SPDX-License-Identifier: Apache-2.0
// At rest the projected image is kept from frame to frame: whatever changes the points must still
// be seen at once.
#include <gtest/gtest.h>

#include <cmath>

#include "cache/cache.h"
#include "cache/project.h"
#include "unit/cache/visit.h"

namespace wellspring::test {
namespace {

View hall() { return look_at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2), 60, 160, 90); }

TEST(Rest, TheKeptImageIsTheOneProjectedAnew) {
  // Two visits alike; then one is made to project every frame by answers for another view (none).
  auto visit = [](bool always) {
    Visit r;
    for (int i = 0; i < 40; i++) r.step(hall(), 700);
    View other = hall();
    other.position.x += 1;
    for (int i = 0; i < 9; i++) {
      if (always) r.cache.remember(other, {}, {});
      r.step(hall(), 0);
    }
    return r.frame;
  };
  Frame kept = visit(false), anew = visit(true);
  EXPECT_EQ(kept.color, anew.color);
  EXPECT_EQ(kept.depth, anew.depth);
  EXPECT_EQ(kept.object, anew.object);
}

TEST(Rest, APictureOfAnotherViewInBetweenChangesNothing) {
  const View view = look_at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2), 60, 160, 90);
  Visit visits[3];
  for (Visit& visit : visits) {
    for (int i = 0; i < 12; i++) {
      visit.step(view, 1500);
      if (&visit != &visits[1]) continue;
      const uint64_t before = visit.cache.projection();
      auto aside = visit.cache.put_aside();
      Compositor other;
      Frame glass;
      const View elsewhere = look_at(vec3(-1, 1.6f, 4), vec3(1, 1.2f, -2), 20, 64, 64);
      other.draw(visit.cache, elsewhere, visit.visibility(), glass);
      EXPECT_EQ(glass.width, 64);
      visit.cache.put_back(std::move(aside));
      EXPECT_EQ(visit.cache.projection(), before);
      EXPECT_TRUE(visit.cache.has_projected(view));
    }
  }
  EXPECT_TRUE(visits[0].frame.color == visits[2].frame.color);
  EXPECT_TRUE(visits[0].frame.color == visits[1].frame.color);
  EXPECT_EQ(visits[0].cache.still_frames(), visits[1].cache.still_frames());
}

TEST(Rest, LateAnswersShowInTheNextPicture) {
  Visit r;
  View before = hall();
  before.position.x += 0.05f;
  r.step(before, 3000);
  std::vector<Request> late = r.requests;
  std::vector<Sample> answers = r.samples;
  for (int i = 0; i < 5; i++) r.step(hall(), 0);
  r.cache.clear();
  r.step(hall(), 0);
  r.step(hall(), 0);
  ASSERT_EQ(r.cache.stats().empty, 1);
  r.cache.remember(before, late, answers);
  r.step(hall(), 0);
  // Most of a fifth of the pixels, seen from 5 cm beside, fall into a pixel of their own.
  EXPECT_GT(r.cache.stats().reprojected, 0.1);
}

TEST(Rest, WhatMovesBeforeAStillCameraLeavesItsPlace) {
  Mesh mesh{.positions = {vec3(-1, -1, -3), vec3(1, -1, -3), vec3(0, 1, -3)},
            .normals = {vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)},
            .triangles = {uvec3(0, 1, 2)}};
  Scene scene;
  scene.materials.resize(1);
  scene.objects = {"", "figure"};
  World world(scene, {mesh}, {1});
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 64, 48);
  RenderCache cache;
  Frame frame;
  // A wall everywhere; before it, in the middle, the figure.
  std::vector<Request> requests;
  std::vector<Sample> samples;
  for (uint32_t pixel = 0; pixel < 64 * 48; pixel++) {
    Request request{.ray = view_ray(view, float(pixel % 64) + 0.5f, float(pixel / 64) + 0.5f),
                    .pixel = pixel};
    vec3 d = request.ray.direction;
    bool figure = pixel % 64 >= 30 && pixel % 64 < 34 && pixel / 64 >= 22 && pixel / 64 < 26;
    Sample sample{.position = d * ((figure ? 3.0f : 5.0f) / -d.z),
                  .normal = vec3(0, 0, 1),
                  .object = figure ? 7u : 1u};
    sample.albedo = sample.smooth = vec3(0.5f);
    sample.flags = sample_hit;
    if (figure) {
      vec2 p(sample.position);  // x = -w + u, y = -w - u + v, w + u + v = 1
      float v = 0.5f * (p.y + 1), u = 0.5f * (1 - v + p.x);
      sample.flags |= sample_moving;
      sample.barycentric = vec2(u, v);
    }
    requests.push_back(request);
    samples.push_back(sample);
  }
  auto show = [&] {
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    frame = {};  // pixels without points stay as they were
    cache.reconstruct(view, frame);
  };
  cache.resize(64, 48);
  cache.project(view);
  cache.remember(view, requests, samples);
  for (int i = 0; i < 4; i++) show();
  auto at = [&](int x, int y) { return frame.object[size_t(y * 64 + x)]; };
  ASSERT_EQ(at(32, 24), 7u);
  ASSERT_EQ(at(45, 24), 1u);
  std::vector<vec3> moved = mesh.positions, normals = mesh.normals;
  // 13 pixels to the right: focal length 48 / 2 / tan(30 degrees), distance 3.
  for (vec3& p : moved) p.x += 13 * 3 / (24 / std::tan(pi / 6));
  world.move(0, moved, normals);
  world.commit();
  show();
  EXPECT_EQ(at(45, 24), 7u);
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 40; x++) EXPECT_NE(at(x, y), 7u) << x << " " << y;
}

TEST(Rest, CoplanarSurfacesHideNothingOfEachOther) {
  // Two objects in one plane, pixel by pixel in turn, and both at some pixels: of equals always the
  // same shows, and nobody is culled.
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 64, 48);
  PointCache points;
  PointImage image;
  Scratch scratch;
  resize_points(points, 2 * 64 * 48);
  resize_image(image, 64, 48);
  for (uint32_t i = 0; i < 2 * 64 * 48; i++) {
    uint32_t pixel = i / 2, object = 1 + (pixel + i) % 2;
    if (i % 2 == 1 && pixel % 3 != 0) continue;
    vec3 d = view_ray(view, float(pixel % 64) + 0.5f, float(pixel / 64) + 0.5f).direction;
    vec3 p = d * (2.0f / -d.z);
    points.x[i] = p.x, points.y[i] = p.y, points.z[i] = p.z;
    points.flags[i] = point_used;
    points.age[i] = 0;
    points.normal[i] = 254 / 2 | 254 / 2 << 8;  // towards the viewer
    points.color[i].object = object;
  }
  project_points(points, view, false, scratch, image);
  depth_cull(points, 0.1f, image);
  auto first = image.point;
  int shown = 0;
  for (uint32_t p : first) shown += p != no_point;
  EXPECT_EQ(shown, 64 * 48);
  project_points(points, view, false, scratch, image);
  depth_cull(points, 0.1f, image);
  EXPECT_EQ(image.point, first);
}

}  // namespace
}  // namespace wellspring::test
