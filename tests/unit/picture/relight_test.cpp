// SPDX-License-Identifier: Apache-2.0
// Light that moves, put over a picture at rest, is as if it had been there before the tone curve.
#include "picture/compositor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "light/virtual/dynamic_image.h"
#include "light/visible/surface_buffer.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A floor, and a lamp's glowing ball above it.
struct Room : Stage {
  View view = make_view_towards(scene, {0, 1.5, 3}, {0, 0.5, 0}, {0, 1, 0}, 0.7f, 128, 96);
  Room() : Stage(make_lamp_over_floor(vec3(1, 0.5f, 0.2f))) {}
};

// The light of a lamp there.
struct Backdrop {
  BackdropSurfaces surfaces;
  LightPlanes planes;
  Backdrop(const Room& room, const DynamicLight& from) {
    find_backdrop_surfaces(*room.visibility, room.view, surfaces);
    DynamicBounce bounce;
    const DynamicLights lights{from};
    begin_bounce(*room.world, room.lights, lights, surfaces.surfaces, {}, {}, bounce);
    light_surfaces(*room.world, room.lights, lights, surfaces.surfaces, {}, bounce, planes);
  }
  BackdropLight both() const { return {surfaces, planes}; }
};

// Makes a picture at rest: from black to twice as bright as white.
Frame make_rest(const View& view) {
  Frame frame;
  fit_frame(view.width, view.height, frame);
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const float level = 2.0f * float(x) / float(view.width);
      const size_t at = size_t(y) * size_t(view.width) + size_t(x);
      frame.color[at] = level * vec3(1, 0.3f + 0.5f * float(y) / float(view.height), 0.4f);
      frame.depth[at] = 1;
    }
  return frame;
}

Image8 shown(const Frame& frame, const Tonemap& curve) {
  Image8 image;
  tonemap(frame, curve, image);
  return image;
}

int largest_difference(const Image8& a, const Image8& b, size_t pixel) {
  int most = 0;
  for (size_t k = 3 * pixel; k < 3 * pixel + 3; k++)
    most = std::max(most, std::abs(int(a.rgb[k]) - int(b.rgb[k])));
  return most;
}

TEST(Relight, AddsLightBeforeTheToneCurve) {
  Room room;
  const Tonemap curve{1.3f};
  Frame rest = make_rest(room.view);
  Keyframe keyframe;
  make_keyframe(room.view, shown(rest, curve), rest.depth, keyframe);

  DynamicLight torch;
  torch.light.position = {1, 1.2f, 1};
  torch.light.intensity = {9, 6, 3};
  const Backdrop light(room, torch);
  Image8 picture;
  std::vector<uint8_t> peaks;
  relight(keyframe, light.both(), curve, picture, peaks);

  Frame sum = rest;
  std::vector<uint8_t> glows(sum.color.size(), 0);
  room.visibility->see(room.view, vec2(0.5f), [&](const VisibleRun& run) {
    RunPixels p;
    RunGlow emitting = describe_run(run, p);
    for (int i = 0; i < run.count; i++) {
      const size_t at = size_t(run.y) * size_t(room.view.width) + size_t(run.x + i);
      glows[at] = emitting.only >> i & 1;
      if (!glows[at] && run.object[i])
        sum.color[at] += vec3(light.planes.red[at], light.planes.green[at], light.planes.blue[at]) *
                         vec3(p.surface.red[i], p.surface.green[i], p.surface.blue[i]);
    }
  });
  const Image8 before = shown(rest, curve), after = shown(sum, curve);
  size_t changed = 0, glowing = 0;
  for (size_t i = 0; i < sum.color.size(); i++) {
    // Beyond white a code does not tell how far.
    const bool told = curve.exposure * max_component(rest.color[i]) < 1.2f;
    if (told) EXPECT_LE(largest_difference(picture, after, i), 3) << i;
    changed += largest_difference(before, after, i) > 10;
    glowing += glows[i];
    if (glows[i]) EXPECT_EQ(largest_difference(picture, before, i), 0);
  }
  EXPECT_GT(changed, sum.color.size() / 10);
  EXPECT_GT(glowing, 50u);
}

// A light that is black, or shines elsewhere, changes nothing.
TEST(Relight, DarkLightChangesNothing) {
  Room room;
  Frame rest = make_rest(room.view);
  const Image8 before = shown(rest, {});
  Keyframe keyframe;
  make_keyframe(room.view, before, rest.depth, keyframe);
  DynamicLight black, below;
  black.light.intensity = vec3(0);
  below.light.position = {0, -1, 0};
  for (const DynamicLight& one : {black, below}) {
    const Backdrop light(room, one);
    Image8 picture;
    std::vector<uint8_t> peaks;
    relight(keyframe, light.both(), {}, picture, peaks);
    EXPECT_EQ(picture.rgb, before.rgb);
  }
}

}  // namespace
}  // namespace wellspring::test
