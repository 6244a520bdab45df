// SPDX-License-Identifier: Apache-2.0
// cache.mirror.*: a visitor walks past a plane mirror, a ball of polished metal, and glass. What
// they show is kept where its image lies (light/mirror_image.h), or on their surfaces and forgotten
// fast. Error where the picture shows them: RMSE of display values, and FLIP, against converged
// pictures.
#include <algorithm>
#include <cmath>

#include "../scenes/build.h"
#include "base/rng.h"
#include "cache_visit_method.h"
#include "frame/flip.h"
#include "frame/picture_file.h"
#include "light/technique.h"
#include "report.h"

namespace wellspring {
namespace {

using namespace scenes;

constexpr int width = 192, height = 108, frames = 90, judged_every = 15, judged_from = 44;

// A lit room, 5 m by 6 m, with things in it that a mirror can show, and the object looked at.
Scene make_room(const std::string& what) {
  Scene scene = empty_scene();
  auto paint = [&](vec3 color) { return add_material(scene, diffuse(color)); };
  int white = paint(vec3(0.7f)), red = paint({0.6f, 0.1f, 0.08f}),
      green = paint({0.12f, 0.4f, 0.15f}), blue = paint({0.1f, 0.15f, 0.5f});
  add_quad(scene, white, {-2.5f, 0, 3}, {5, 0, 0}, {0, 0, -6}, "floor");
  add_quad(scene, white, {-2.5f, 3, -3}, {5, 0, 0}, {0, 0, 6}, "ceiling");
  add_quad(scene, white, {-2.5f, 0, -3}, {5, 0, 0}, {0, 3, 0}, "far wall");
  add_quad(scene, white, {2.5f, 0, 3}, {-5, 0, 0}, {0, 3, 0}, "near wall");
  add_quad(scene, red, {-2.5f, 0, 3}, {0, 0, -6}, {0, 3, 0}, "left wall");
  add_quad(scene, green, {2.5f, 0, -3}, {0, 0, 6}, {0, 3, 0}, "right wall");
  add_quad(scene, add_material(scene, emitter(vec3(9))), {-0.6f, 2.99f, -0.5f}, {1.2f, 0, 0},
           {0, 0, 1.2f}, "lamp");
  for (int i = 0; i < 5; i++)
    add_mesh(scene, box_mesh(i % 2 ? blue : red, {0.3f, 0.5f + 0.25f * float(i), 0.3f}), "pillar",
             at({-1.8f + 0.9f * float(i), 0.25f + 0.125f * float(i), i % 2 ? 2.2f : 0.4f}));
  for (int i = 0; i < 6; i++)
    add_quad(scene, i % 2 ? green : blue, {2.2f - 0.8f * float(i), 1.3f, 2.99f}, {-0.4f, 0, 0},
             {0, 0.9f, 0}, "picture");
  int mirror = add_material(scene, metal(vec3(0.95f), 0));
  if (what == "plane mirror")
    add_quad(scene, mirror, {-2, 0.4f, -2.9f}, {4, 0, 0}, {0, 2.2f, 0}, "subject");
  if (what == "metal ball")
    add_mesh(scene, sphere_mesh(mirror, 0.8f, 96), "subject", at({0, 1.5f, -1.6f}));
  if (what == "glass") {
    Material clear = glass(1.5f, 0, 0.4f);
    add_mesh(scene, box_mesh(add_material(scene, clear), {1.6f, 1.8f, 0.4f}), "subject",
             at({0, 1.5f, -1.2f}));
  }
  return scene;
}

struct Error {
  double flip = 0, square = 0;
  size_t pixels = 0;
};

void judge(const Frame& shown, const Frame& truth, uint32_t subject, Error& error) {
  Image8 image, wanted;
  tonemap(shown, {}, image);
  tonemap(truth, {}, wanted);
  FlipMap map = eval_flip(image, wanted);
  for (size_t i = 0; i < map.error.size(); i++) {
    if (truth.object[i] != subject) continue;
    error.pixels++;
    error.flip += double(map.error[i]);
    for (size_t c = 0; c < 3; c++)
      error.square += std::pow((image.rgb[3 * i + c] - wanted.rgb[3 * i + c]) / 255.0, 2) / 3;
  }
}

}  // namespace

void bench_cache_mirror(BenchReport& report, const BenchOptions& options) {
  const Technique& technique = *find_technique("path");
  for (const char* what : {"plane mirror", "metal ball", "glass"}) {
    Scene scene = make_room(what);
    uint32_t subject = uint32_t(scene.objects.size()) - 1;
    World world(scene);
    world.commit();
    Lights lights = make_lights(world);
    auto view_at = [&](int frame) {  // a metre a second
      double x = -0.75 + frame / 60.0;
      return make_view_towards(scene, {x, 1.6, 1.6}, {0.4 * x, 1.5, -2}, {0, 1, 0}, 0.9f, width,
                               height);
    };
    std::vector<Frame> truth;
    StillSettings still;
    still.spp = options.quick ? 64 : 512;
    for (int frame = judged_from; frame < frames; frame += judged_every)
      truth.push_back(render_still(technique, world, lights, view_at(frame), still));
    for (int mismatch : {16, 64})
      for (bool images : {false, true}) {
        CacheSettings settings;
        settings.images = images;
        auto method = make_cache_method(Answers::at_once, settings);
        VisitPicture shown;
        Error error;
        VisitMoment moment;
        moment.world = &world;
        moment.lights = &lights;
        moment.technique = &technique;
        for (int frame = 0; frame < frames; frame++) {
          moment.view = view_at(frame);
          moment.frame = frame;
          moment.seed = mix64(uint64_t(frame + 1) * 0x9e3779b9u);
          method->show(moment, width * height / mismatch, shown);
          int after = frame - judged_from;
          if (after < 0 || after % judged_every != 0) continue;
          judge(shown.frame, truth[size_t(after / judged_every)], subject, error);
          if (!options.visit_pictures.empty())
            save_picture(options.visit_pictures + "/" + what + (images ? "_image_" : "_surface_") +
                             std::to_string(mismatch) + "_" + std::to_string(frame) + ".png",
                         shown.frame, {});
        }
        nlohmann::json fields = {{"scene", what}, {"mismatch", mismatch},
                                 {"kept", images ? "at the image" : "on the surface"}};
        double pixels = double(std::max<size_t>(error.pixels, 1));
        report.add("cache.mirror.flip", error.flip / pixels, "FLIP", fields);
        report.add("cache.mirror.rmse", std::sqrt(error.square / pixels), "display", fields);
      }
  }
}

}  // namespace wellspring
