// SPDX-License-Identifier: Apache-2.0
// A visitor's pictures where hardly anything can be rasterised.
#include "show/draw/picture.h"
#include "show/state/make_show.h"
#include "show/tick.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "frame/jpeg.h"
#include "frame/tonemap.h"
#include "unit/show/tiny_exhibit.h"
#include "wire/packet.h"

namespace wellspring {
namespace {

// A visitor of the first viewpoint, after two seconds, and the last picture sent.
struct Visited {
  std::unique_ptr<Show> show;
  Packet picture;
  explicit Visited(Exhibit exhibit) {
    ShowSettings settings;
    settings.background = false;
    settings.technique = settings.still_technique = "direct";
    show = make_show(std::move(exhibit), settings);
    Arrivals arrivals;
    auto link = std::make_shared<Link>(1, LinkKind::visit, "test");
    arrivals.put(link);
    link->push_text_in(
        R"({"type":"hello","exhibit":"","width":160,"height":90,"lang":"en","role":"visitor"})");
    for (int i = 0; i < 40; i++) {
      tick(*show, arrivals, 0.05 * i);
      for (Visitor& visitor : show->visitors) visitor.shown.encoder->task.wait();
      for (Link::Out out; link->take_out(out);)
        if (out.picture) picture = *out.packet;
    }
  }
};

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

TEST(Picture, IsRightForAnEyeInSolidGlassToo) {
  for (bool glass : {true, false}) {
    Visited visited(make_cubed(glass));
    const Show& show = *visited.show;
    const View& view = show.visitors.front().place.last_view;
    EXPECT_EQ(show.visibility->rasterises(view), !glass);
    StillSettings settings;
    settings.spp = 64;
    settings.transport = show.settings.transport;
    Image8 truth, shown = decode_jpeg(read_packet(visited.picture)->payload, "picture");
    tonemap(render_still(*show.still_technique, *show.world, show.lights, view, settings),
            Tonemap{show.exhibit.exposure}, truth);
    ASSERT_EQ(shown.rgb.size(), truth.rgb.size());
    double difference = 0, light = 0, shown_light = 0;
    for (size_t i = 0; i < truth.rgb.size(); i++) {
      difference += std::abs(int(shown.rgb[i]) - int(truth.rgb[i]));
      light += truth.rgb[i], shown_light += shown.rgb[i];
    }
    if (glass) {
      EXPECT_GT(light, 20 * double(truth.rgb.size())) << "else there is nothing to see";
    }
    EXPECT_LT(difference, 7 * double(truth.rgb.size())) << glass;
    EXPECT_NEAR(shown_light, light, 0.05 * light) << glass;
  }
}

}  // namespace
}  // namespace wellspring
