// SPDX-License-Identifier: Apache-2.0
// How a visitor's pictures are made: which are drawn, and what their caches keep for that.
#include "show/picture.h"

#include <gtest/gtest.h>

#include "tiny_exhibit.h"

namespace wellspring {
namespace {

// Of the first viewpoint, ticked until there are pictures: large ones, as of small ones every pixel
// may be looked at.
std::unique_ptr<Show> make_visited(Exhibit exhibit, DrawShapes draw) {
  ShowSettings settings;
  settings.draw = draw;
  settings.background = false;
  settings.technique = settings.still_technique = "direct";
  auto show = make_show(std::move(exhibit), settings);
  Arrivals arrivals;
  auto link = std::make_shared<Link>(1, LinkKind::visit, "test");
  arrivals.put(link);
  link->push_text_in(
      R"({"type":"hello","exhibit":"","width":1280,"height":720,"lang":"en","role":"visitor"})");
  for (int i = 0; i < 4; i++) {
    tick(*show, arrivals, 0.05 * i);
    for (Visitor& visitor : show->visitors) visitor.encoder->task.wait();
    for (Link::Out out; link->take_out(out);) {
    }
  }
  return show;
}

// The viewpoint's eye in the middle of a cube of solid glass, or of one that is nothing but pale.
Exhibit make_cubed(bool glass) {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.tours.clear();  // it stands in their way
  Material material;
  material.metallic = 0;
  material.roughness = 0;
  if (glass) material.transmission = 1, material.thickness = 1;
  exhibit.scene.materials.push_back(material);
  Mesh cube;
  cube.material = int(exhibit.scene.materials.size()) - 1;
  vec3 corner(-3, 0.6f, 2), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  add_quad(cube, corner, y, x), add_quad(cube, corner + z, x, y);
  add_quad(cube, corner, z, y), add_quad(cube, corner + x, y, z);
  add_quad(cube, corner, x, z), add_quad(cube, corner + y, z, x);
  exhibit.scene.meshes.push_back(cube);
  exhibit.scene.objects.push_back("cube");
  exhibit.scene.instances.push_back({2, mat4(1), 3});
  return exhibit;
}

TEST(Picture, IsNotDrawnForAnEyeInSolidGlass) {
  for (DrawShapes draw : {DrawShapes::automatic, DrawShapes::always}) {
    auto inside = make_visited(make_cubed(true), draw);
    ASSERT_FALSE(inside->sight->rasterises(inside->visitors.front().last_view));
    const PictureOrder& order = inside->visitors.front().order;
    EXPECT_FALSE(order.display.drawn);
    EXPECT_FALSE(order.coarse);
    EXPECT_GT(inside->totals.drawn, 0u);
    EXPECT_EQ(inside->easel.work.frame.width, 1280);  // and is a picture of points
    auto elsewhere = make_visited(make_cubed(false), draw);
    ASSERT_TRUE(elsewhere->sight->rasterises(elsewhere->visitors.front().last_view));
    EXPECT_TRUE(elsewhere->visitors.front().order.display.drawn || draw != DrawShapes::always);
  }
}

// What mirrors show is kept where its image lies only where no shapes are drawn.
TEST(Picture, CachesKeepImagesWhereNothingIsDrawn) {
  for (DrawShapes draw : {DrawShapes::never, DrawShapes::automatic, DrawShapes::always}) {
    auto show = make_visited(make_tiny_exhibit(), draw);
    ASSERT_EQ(show->visitors.size(), 1u);
    EXPECT_EQ(show->visitors.front().cache.settings().images, draw == DrawShapes::never);
    EXPECT_EQ(show->sight == nullptr, draw == DrawShapes::never);
  }
}

}  // namespace
}  // namespace wellspring
