// SPDX-License-Identifier: Apache-2.0
// The default storyteller's tick on one core: animate, skin, and the refit of its meshes in the world.
#include <filesystem>
#include <oneapi/tbb/global_control.h>

#include "avatar/storyteller.h"
#include "base/clock.h"
#include "report.h"
#include "show/exhibit_load.h"
#include "show/figure.h"

namespace wellspring {

void bench_avatar(BenchReport& report, const BenchOptions& options) {
  Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
  if (castle.storytellers.empty()) return;
  const Character& character = castle.storytellers.front().character;
  oneapi::tbb::global_control one_core(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Scene scene = castle.scene;
  Figure figure = make_figure(character, scene, moving, objects);
  World world(scene, std::move(moving), std::move(objects));
  Storyteller storyteller;
  storyteller.character = &character;
  StorytellerState state;
  Pose pose;
  SkinScratch scratch;
  std::vector<double> animate, skinned, refit, whole;
  const int ticks = options.quick ? 60 : 300;
  for (int i = 0; i < ticks + 10; i++) {
    StorytellerInput input;
    input.dt = 1 / 30.0f;
    input.time = i * double(input.dt);
    StorytellerEvents events;
    double a = seconds_now();
    tick_storyteller(state, storyteller, input, pose, events);
    double b = seconds_now();
    pose_figure(world, figure, character, pose, storyteller.placement, scratch);
    double c = seconds_now();
    world.commit();
    double d = seconds_now();
    if (i < 10) continue;
    animate.push_back(1000 * (b - a));
    skinned.push_back(1000 * (c - b));
    refit.push_back(1000 * (d - c));
    whole.push_back(1000 * (d - a));
  }
  size_t triangles = 0;
  for (const Part& part : character.parts) triangles += part.triangles.size();
  nlohmann::json fields = {{"scene", "castle"}, {"triangles", triangles}, {"cores", 1}};
  report.add("avatar.tick.ms", quantile(whole, 0.5), "ms", fields);
  report.add("avatar.animate.ms", quantile(animate, 0.5), "ms", fields);
  report.add("avatar.skin.ms", quantile(skinned, 0.5), "ms", fields);
  report.add("avatar.refit.ms", quantile(refit, 0.5), "ms", fields);
}

}  // namespace wellspring
