// SPDX-License-Identifier: Apache-2.0
// What nodes of points may be that no scanner means: the rasteriser's hard cases.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "raster_scene.h"
#include "scan/draw/fill_holes.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {
ScanCamera small_view() {
  ScanCamera view;
  view.width = 100, view.height = 80;
  return view;
}
PointBuffer drawn(std::vector<PointSet>& sets, const ScanCamera& view, bool blended = false) {
  std::vector<NodePoints> nodes;
  for (PointSet& set : sets) nodes.push_back(set.lend());
  PointBuffer buffer;
  PointRaster().draw(buffer, nodes, view, {.blended = blended});
  return buffer;
}
int count_covered(const PointBuffer& b) {
  return int(std::count_if(b.depth.begin(), b.depth.begin() + b.width * b.height,
                           [](float d) { return std::isfinite(d); }));
}
bool same_pictures(const PointBuffer& a, const PointBuffer& b) {
  return a.depth == b.depth && a.color == b.color && a.normal == b.normal &&
         a.classification == b.classification && a.node == b.node;
}
// A cube of edge `size` around a place on the axis, at a depth, of a view from the origin.
PointSet cube_at(float depth, float size = 1) {
  PointSet set;
  set.size = size, set.spacing = size / 100;
  set.corner = dvec3(-0.5 * double(size), -0.5 * double(size), -double(depth) - 0.5 * double(size));
  return set;
}
}  // namespace

TEST(PointRaster, shows_nothing_of_nothing) {
  std::vector<PointSet> sets;
  PointBuffer buffer = drawn(sets, small_view());
  EXPECT_EQ(count_covered(buffer), 0);
  sets.emplace_back();
  buffer = drawn(sets, small_view());
  fill_holes(buffer, {}, small_view());
  EXPECT_EQ(count_covered(buffer), 0);
  EXPECT_EQ(buffer.node[0], PointBuffer::no_node);
  EXPECT_EQ(buffer.normal[0], PointBuffer::no_normal);
}

TEST(PointRaster, forgets_the_picture_before) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].add_place(32768, 32768, 32768);
  const NodePoints node = sets[0].lend();
  PointRaster raster;
  PointBuffer buffer;
  raster.draw(buffer, {&node, 1}, small_view(), {});
  EXPECT_GT(count_covered(buffer), 0);
  raster.draw(buffer, {}, small_view(), {});
  EXPECT_EQ(count_covered(buffer), 0);
}

TEST(PointRaster, shows_one_point_where_it_is) {
  for (const bool blended : {false, true}) {
    std::vector<PointSet> sets(1, cube_at(2));
    sets[0].spacing = 1e-4f;
    sets[0].add_place(40000, 50000, 32768, 0x40302010, PointSet::normal_of({0, 0, -1}), 6);
    const ScanCamera view = small_view();
    const PointBuffer buffer = drawn(sets, view, blended);
    ASSERT_EQ(count_covered(buffer), 1);
    const double f = double(view.focal());
    const int x = int(50 + 0.11036 * f / 2), y = int(40 - 0.26294 * f / 2);
    const size_t at = size_t(y * view.width + x);
    EXPECT_NEAR(buffer.depth[at], 2, 1e-4);
    EXPECT_EQ(buffer.color[at], 0x40302010u);
    EXPECT_EQ(buffer.classification[at], 6);
    EXPECT_EQ(buffer.node[at], 0u);
    // It is turned to the eye.
    EXPECT_LT(length(point_normal(buffer.normal[at]) - vec3(0, 0, 1)), 1e-3f);
  }
}

TEST(PointRaster, shows_nothing_behind_or_at_the_eye) {
  std::vector<PointSet> sets(1, cube_at(-2));
  sets[0].add_place(32768, 32768, 32768);
  EXPECT_EQ(count_covered(drawn(sets, small_view())), 0);
  // The eye is inside the cube, on the points.
  sets[0] = cube_at(0);
  sets[0].spacing = 0.5f;
  for (int z = 32700; z < 32800; z++) sets[0].add_place(32768, 32768, z);
  const PointBuffer buffer = drawn(sets, small_view());
  for (int i = 0; i < buffer.width * buffer.height; i++) {
    EXPECT_GT(buffer.depth[size_t(i)], 0);
    EXPECT_FALSE(std::isnan(buffer.depth[size_t(i)]));
  }
}

TEST(PointRaster, shows_nothing_before_the_near_plane) {
  std::vector<PointSet> sets(1, cube_at(2));
  for (const int z : {60000, 20000}) sets[0].add_place(32768, 32768, z);  // 1.58 and 2.19 metres
  ScanCamera view = small_view();
  EXPECT_NEAR(drawn(sets, view).depth[40 * 100 + 50], 1.5845, 1e-3);
  view.near = 2;
  EXPECT_NEAR(drawn(sets, view).depth[40 * 100 + 50], 2.1948, 1e-3);
}

TEST(PointRaster, endures_a_million_points_in_one_pixel) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].spacing = 1e-5f;
  for (int i = 0; i < 1000000; i++)
    sets[0].add_place(32770 + i % 3, 32760, 65535 - i % 65000, uint32_t(i));
  for (const bool blended : {false, true}) {
    const PointBuffer buffer = drawn(sets, small_view(), blended);
    ASSERT_EQ(count_covered(buffer), 1);
    const size_t at = std::isfinite(buffer.depth[3950]) ? 3950 : 4050;
    EXPECT_NEAR(buffer.depth[at], 1.5, 1e-3);
    if (!blended) {
      EXPECT_EQ(buffer.color[at], 0u);  // the first of those that are as near
    }
  }
}

TEST(PointRaster, covers_large_discs_in_bounded_time) {
  // Every point is a disc of the largest size, all over the picture: without a bound, 10^9 pixels.
  std::vector<PointSet> sets(1, cube_at(1.2f));
  sets[0].spacing = 1;
  std::mt19937 random(1);
  for (int i = 0; i < 500000; i++)
    sets[0].add_place(int(random() & 0xffff), int(random() & 0xffff), int(random() & 0xffff));
  EXPECT_EQ(count_covered(drawn(sets, small_view())), 8000);
}

TEST(PointRaster, takes_points_without_normals) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].spacing = 0.2f;
  sets[0].add_place(32768, 32768, 32768, 0xff112233);
  for (const bool blended : {false, true}) {
    const PointBuffer buffer = drawn(sets, small_view(), blended);
    // A circle: 0.15 metres at a depth of 2.
    const double radius = 0.15 / 2 * double(small_view().focal());
    EXPECT_NEAR(count_covered(buffer), double(pi) * radius * radius, 12);
    EXPECT_EQ(buffer.normal[40 * 100 + 50], PointBuffer::no_normal);
    EXPECT_EQ(buffer.color[40 * 100 + 50], 0xff112233u);
  }
}

TEST(PointRaster, takes_a_scan_without_classification) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].add_place(32768, 32768, 32768, 0xff112233, 0x8080, 7);
  NodePoints node = sets[0].lend();
  node.classification = nullptr;
  PointBuffer buffer;
  PointRaster().draw(buffer, {&node, 1}, small_view(), {});
  EXPECT_EQ(buffer.color[40 * 100 + 50], 0xff112233u);
  EXPECT_EQ(buffer.classification[40 * 100 + 50], 0);
}

TEST(PointRaster, shows_the_first_of_equal_points) {
  std::vector<PointSet> sets(3, cube_at(2));
  for (int s = 0; s < 3; s++)
    for (int i = 0; i < 20000; i++)
      sets[size_t(s)].add_place(32768, 32768, 32768, uint32_t(1 + s * 20000 + i));
  const PointBuffer buffer = drawn(sets, small_view());
  EXPECT_GT(count_covered(buffer), 0);
  for (int i = 0; i < 8000; i++) {
    if (std::isfinite(buffer.depth[size_t(i)])) {
      EXPECT_EQ(buffer.color[size_t(i)], 1u);
    }
  }
}

TEST(PointRaster, sees_farther_than_a_thousand_kilometres) {
  std::vector<PointSet> sets(1, cube_at(3e6f, 1e6f));
  sets[0].add_place(32768, 32768, 32768, 5, PointSet::normal_of({0, 0, 1}));
  const PointBuffer buffer = drawn(sets, small_view());
  EXPECT_NEAR(buffer.depth[40 * 100 + 50], 3e6, 20);
  EXPECT_EQ(buffer.color[40 * 100 + 50], 5u);
}

TEST(PointRaster, never_loses_discs_that_graze_the_view) {
  // Normals at right angles to the ray, and nearly so.
  for (const vec3 n : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0), vec3(1, 0, 1e-3f)}) {
    std::vector<PointSet> sets(1, cube_at(2));
    sets[0].spacing = 0.2f;
    sets[0].add_place(32768, 32768, 32768, 9, PointSet::normal_of(n));
    const PointBuffer buffer = drawn(sets, small_view());
    EXPECT_GT(count_covered(buffer), 4);
    EXPECT_LT(count_covered(buffer), 40);  // a stroke of 15 pixels, two wide
    for (int i = 0; i < 8000; i++) {
      if (std::isfinite(buffer.depth[size_t(i)])) {
        EXPECT_NEAR(buffer.depth[size_t(i)], 2, 0.3);
      }
    }
  }
}

TEST(PointRaster, draws_a_picture_of_one_pixel) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].add_place(32768, 32768, 32768, 0xff000001);
  ScanCamera view;
  PointBuffer buffer = drawn(sets, view);
  EXPECT_EQ(count_covered(buffer), 1);
  EXPECT_EQ(buffer.color[0], 0xff000001u);
  const NodePoints node = sets[0].lend();
  fill_holes(buffer, {&node, 1}, view);
  EXPECT_EQ(buffer.color[0], 0xff000001u);
}

TEST(PointRaster, does_not_feel_how_far_the_origin_is) {
  std::vector<PointSet> near(1, cube_at(2));
  std::mt19937 random(2);
  for (int i = 0; i < 3000; i++)
    near[0].add_place(int(random() & 0xffff), int(random() & 0xffff), int(random() & 0xffff),
                      random(), uint16_t(random()));
  std::vector<PointSet> far = near;
  const dvec3 move(1e7, -2e7, 3e7);
  far[0].corner += move;
  ScanCamera view = small_view();
  const PointBuffer expected = drawn(near, view);
  view.eye += move;
  EXPECT_TRUE(same_pictures(drawn(far, view), expected));
}

TEST(PointRaster, draws_the_same_for_any_number_of_threads) {
  std::vector<PointSet> sets(5, cube_at(2, 2));
  std::mt19937 random(3);
  for (PointSet& set : sets) {
    set.spacing = 0.03f;
    for (int i = 0; i < 20000; i++)
      set.add_place(int(random() & 0xffff), int(random() & 0xffff), int(random() & 0xfff), random(),
                    uint16_t(random()));
  }
  ScanCamera view = small_view();
  view.width = 300, view.height = 200;
  for (const bool blended : {false, true}) {
    std::vector<PointSet> copy = sets;
    const PointBuffer expected = [&] {
      oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
      return drawn(copy, view, blended);
    }();
    for (int i = 0; i < 3; i++) {
      copy = sets;
      EXPECT_TRUE(same_pictures(drawn(copy, view, blended), expected));
    }
  }
}

TEST(PointRaster, moves_the_picture_by_the_offset_in_pixels) {
  // A point on the border of two pixels belongs to one or the other, as the sampling place says.
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].spacing = 1e-5f;
  sets[0].add_place(32768, 32768, 32768);  // a little right of the middle, and above
  ScanCamera view = small_view();
  view.offset = {0.9f, 0.5f};
  PointBuffer buffer = drawn(sets, view);
  EXPECT_TRUE(std::isfinite(buffer.depth[39 * 100 + 49]) ||
              std::isfinite(buffer.depth[40 * 100 + 49]));
  view.offset = {0.1f, 0.9f};
  buffer = drawn(sets, view);
  EXPECT_TRUE(std::isfinite(buffer.depth[39 * 100 + 50]));
  view.offset = {0.1f, 0.1f};
  buffer = drawn(sets, view);
  EXPECT_TRUE(std::isfinite(buffer.depth[40 * 100 + 50]));
}

TEST(PointRaster, has_its_axis_where_the_view_says) {
  std::vector<PointSet> sets(1, cube_at(2));
  sets[0].spacing = 1e-5f;
  sets[0].add_place(32768, 32768, 32768);
  ScanCamera view = small_view();
  view.axis = vec2(10.5f, 20.5f);
  EXPECT_TRUE(std::isfinite(drawn(sets, view).depth[20 * 100 + 10]));
}

}  // namespace wellspring::test
