// SPDX-License-Identifier: Apache-2.0
// One visitor of a scene, shown pictures of points alone or such as are drawn.
#pragma once
#include <memory>

#include "cache/cache.h"
#include "cache/compose_drawn.h"
#include "light/technique.h"
#include "scenes/scenes.h"

namespace wellspring {

// A scene, and all that drawing asks of it. `moving`: a mesh that is the scene's last object.
struct Stage {
  Scene scene;
  Mesh ball;
  std::unique_ptr<World> world;
  Lights lights;
  std::unique_ptr<PictureSight> sight;

  explicit Stage(Scene made) : scene(std::move(made)) { open({}, {}); }
  Stage(Scene made, Mesh moving) : scene(std::move(made)), ball(std::move(moving)) {
    open({ball}, {uint32_t(scene.objects.size() - 1)});
  }
  void push_ball(float x) {
    for (vec3& p : ball.positions) p.x += x;
    world->move(0, ball.positions, ball.normals);
    world->commit();
  }
  Frame truth(const View& view, int samples) const {
    StillSettings settings;
    settings.spp = samples;
    return render_still(*find_technique("path"), *world, lights, view, settings);
  }

 private:
  void open(std::vector<Mesh> moving, std::vector<uint32_t> objects) {
    world = std::make_unique<World>(scene, std::move(moving), std::move(objects));
    world->commit();
    lights = make_lights(*world);
    sight = std::make_unique<PictureSight>(*world, lights);
  }
};

// Cornell's box and thin bars in it, and a ball that may be moved.
inline Scene make_barred_box(vec3 bars, float width) {
  Scene scene = scenes::make_cornell_box();
  int material = scenes::add_material(scene, scenes::diffuse(bars));
  for (int i = 0; i < 6; i++)
    scenes::add_quad(scene, material, {-0.25f + 0.1f * float(i), 0, -0.1f}, {width, 0, 0}, {0, 0.5f, 0}, "bar");
  return scene;
}
inline Mesh add_ball(Scene& scene, vec3 place) {
  Mesh ball = scenes::sphere_mesh(scenes::add_material(scene, scenes::diffuse(vec3(0.7f, 0.6f, 0.1f))), 0.08f, 16);
  for (vec3& p : ball.positions) p += place;
  scene.objects.push_back("ball");
  return ball;
}

enum class PictureOf { points, moving, still };  // RenderCache::reconstruct(), draw(), draw_still()

struct DrawnVisit {
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;

  void step(const Stage& stage, const View& view, int budget, PictureOf kind) {
    View light = kind == PictureOf::moving ? light_view(view) : view;
    cache.resize(view.width, view.height);
    cache.move_points(*stage.world);
    cache.project(light);
    cache.attend();
    cache.plan(light, budget, tick++, requests);
    samples.resize(requests.size());
    trace(*find_technique("path"), *stage.world, stage.lights, {}, requests, samples);
    cache.remember(light, requests, samples);
    if (kind == PictureOf::points) cache.reconstruct(view, frame);
    if (kind == PictureOf::moving) cache.draw(view, *stage.sight, frame);
    if (kind == PictureOf::still) cache.draw_still(view, *stage.sight, frame);
  }
};

}  // namespace wellspring
