// SPDX-License-Identifier: Apache-2.0
// One visitor of a scene.
#pragma once
#include <memory>
#include <span>

#include "light/technique/technique.h"
#include "picture/compose_drawn.h"
#include "picture/compositor.h"
#include "scenes/scenes.h"

namespace wellspring::test {

// A scene, and all that drawing asks of it. The ball is a mesh that moves, the scene's last object.
struct Stage {
  Scene scene;
  Mesh ball;
  std::unique_ptr<World> world;
  Lights lights;
  std::unique_ptr<VisibilityPass> visibility;

  explicit Stage(Scene made) : scene(std::move(made)) { open({}, {}); }
  Stage(Scene made, Mesh moving) : scene(std::move(made)), ball(std::move(moving)) {
    open({ball}, {uint32_t(scene.objects.size() - 1)});
  }
  void push_ball(float x) {
    for (vec3& p : ball.positions) p.x += x;
    world->move(0, ball.positions, ball.normals);
    world->commit();
  }
  uint32_t object_at(const View& view, float x, float y) const {
    Hit hit = world->intersect(view_ray(view, x, y));
    return hit.valid() ? world->object_of(hit.instance) : 0;
  }
  Frame truth(const View& view, int samples, const TransportSettings& transport = {}) const {
    return render_still(*find_technique("path"), *world, lights, view,
                        {.spp = samples, .transport = transport});
  }

 private:
  void open(std::vector<Mesh> moving, std::vector<uint32_t> objects) {
    world = std::make_unique<World>(scene, std::move(moving), std::move(objects));
    world->commit();
    lights = make_lights(*world);
    visibility = std::make_unique<VisibilityPass>(*world, lights);
  }
};

// Pixels that show an object that a ray through none of their `places` meets: by default about
// their centres, as rays and drawing round otherwise where an edge runs through them.
inline int count_wrong(const Stage& stage, const View& view, const Frame& frame,
                       std::span<const vec2> places = {}) {
  static constexpr vec2 centre[] = {vec2(0.5f), vec2(0.49f), vec2(0.51f), vec2(0.49f, 0.51f),
                                    vec2(0.51f, 0.49f)};
  if (places.empty()) places = centre;
  int wrong = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      uint32_t shown = frame.object[size_t(y * view.width + x)];
      bool right = false;
      for (vec2 place : places)
        right = right || stage.object_at(view, float(x) + place.x, float(y) + place.y) == shown;
      wrong += !right;
    }
  return wrong;
}

// Cornell's box and thin bars in it, and a ball that may be moved.
inline Scene make_barred_box(vec3 bars, float width) {
  Scene scene = scenes::make_cornell_box();
  int material = scenes::add_material(scene, scenes::diffuse(bars));
  for (int i = 0; i < 6; i++)
    scenes::add_quad(scene, material, {-0.25f + 0.1f * float(i), 0, -0.1f}, {width, 0, 0},
                     {0, 0.5f, 0}, "bar");
  return scene;
}
inline Mesh add_ball(Scene& scene, vec3 place) {
  Mesh ball = scenes::sphere_mesh(
      scenes::add_material(scene, scenes::diffuse(vec3(0.7f, 0.6f, 0.1f))), 0.08f, 16);
  for (vec3& p : ball.positions) p += place;
  scene.objects.push_back("ball");
  return ball;
}

// draw(), draw_still()
enum class PictureOf { moving, still };

struct DrawnVisit {
  RenderCache cache;
  Compositor compositor;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;
  const char* technique = "path";
  TransportSettings transport;

  size_t memory_bytes() const { return cache.memory_bytes() + compositor.memory_bytes(); }

  void step(const Stage& stage, const View& view, int budget, PictureOf kind) {
    sample(stage, view, budget);
    cache.remember(view, requests, samples);
    compositor.follow_changes(cache);
    if (kind == PictureOf::still) compositor.add_samples(view, requests, samples);
    if (kind == PictureOf::still) compositor.draw_still(cache, view, *stage.visibility, frame);
    else compositor.draw(cache, view, *stage.visibility, frame);
  }
  // All before the samples are remembered.
  void sample(const Stage& stage, const View& view, int budget) {
    cache.resize(view.width, view.height);
    sample_within(stage, view, budget);
  }
  // The same in a cache of the size that it has.
  void sample_within(const Stage& stage, const View& view, int budget) {
    cache.move_points(*stage.world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    samples.resize(requests.size());
    trace(*find_technique(technique), *stage.world, stage.lights, transport, requests, samples);
  }
};

}  // namespace wellspring::test
