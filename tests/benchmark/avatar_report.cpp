// SPDX-License-Identifier: Apache-2.0
// The tick of figures on one core: animate, skin, and the refit of their meshes in the world. The
// default storyteller, and an avatar made here that has what such files bring along, with and
// without each of it.
#include <filesystem>
#include <oneapi/tbb/global_control.h>

#include "avatar/mind/storyteller.h"
#include "avatar_made.h"
#include "base/clock.h"
#include "frame/picture_file.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/moving/figure.h"

namespace wellspring::test {
namespace {

// One figure in a world, ticking.
struct Ticking {
  const Character& character;
  Scene scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure;
  World world;
  StorytellerState state;
  Pose pose;
  SkinScratch scratch;
  double time = 0;
  std::vector<double> animate, skinned, refit, whole;  // milliseconds of each tick

  Ticking(const Character& of, const Scene& place)
      : character(of),
        scene(place),
        figure(make_figure(of, scene, moving, objects)),
        world(scene, std::move(moving), std::move(objects)) {}

  // `clock`: seconds by the wall, or of this thread.
  void tick(double (*clock)(), bool speaks) {
    StorytellerInput input;
    input.dt = 1 / 30.0f;
    input.time = time += double(input.dt);
    input.speaking = speaks ? 1 : 0;
    StorytellerEvents events;
    Storyteller storyteller;
    storyteller.character = &character;
    double a = clock();
    tick_storyteller(state, storyteller, input, pose, events);
    double b = clock();
    pose_figure(world, figure, character, pose, storyteller.placement, scratch);
    double c = clock();
    world.commit();
    double d = clock();
    animate.push_back(1000 * (b - a));
    skinned.push_back(1000 * (c - b));
    refit.push_back(1000 * (d - c));
    whole.push_back(1000 * (d - a));
  }
  void forget() {
    for (auto* list : {&animate, &skinned, &refit, &whole}) list->clear();
  }
  void report(BenchReport& to, const std::string& name, nlohmann::json fields) const {
    size_t triangles = 0;
    for (const Part& part : character.parts) triangles += part.triangles.size();
    fields["triangles"] = triangles;
    fields["cores"] = 1;
    to.add(name + ".tick.ms", quantile(whole, 0.5), "ms", fields);
    to.add(name + ".animate.ms", quantile(animate, 0.5), "ms", fields);
    to.add(name + ".skin.ms", quantile(skinned, 0.5), "ms", fields);
    to.add(name + ".refit.ms", quantile(refit, 0.5), "ms", fields);
  }
};

constexpr int ticks_before = 10;  // ticks before any counts

// The made avatar in all its variants, ticking in turns, in processor time: a speaking face bends
// and repaints.
void bench_made(BenchReport& report, int ticks) {
  std::string normals =
      (std::filesystem::temp_directory_path() / "wellspring_bench_normals.png").string();
  Frame flat;
  flat.width = flat.height = 16;
  flat.color.assign(256, vec3(0.21f, 0.21f, 1));
  save_picture(normals, flat, Tonemap{});
  struct Variant {
    const char* name;
    MadeAvatar what;
    Character character;
  };
  std::vector<Variant> variants = {{"plain", {false, false, false, false}, {}},
                                   {"springs", {true, false, false, false}, {}},
                                   {"normal_map", {false, true, false, false}, {}},
                                   {"constraints", {false, false, true, false}, {}},
                                   {"paint", {false, false, false, true}, {}},
                                   {"all", {}, {}}};
  std::vector<std::unique_ptr<Ticking>> figures;
  for (Variant& variant : variants) {
    variant.character = make_avatar(variant.what, normals);
    Scene scene;
    scene.materials.push_back({});
    figures.push_back(std::make_unique<Ticking>(variant.character, scene));
  }
  std::filesystem::remove(normals);
  for (int i = 0; i < ticks + ticks_before; i++) {
    if (i == ticks_before)
      for (auto& figure : figures) figure->forget();
    for (auto& figure : figures) figure->tick(thread_seconds_now, true);
  }
  for (size_t i = 0; i < figures.size(); i++)
    figures[i]->report(report, "avatar.made",
                       {{"scene", "made avatar"},
                        {"technique", variants[i].name},
                        {"springs", variants[i].character.springs.size()}});
}

}  // namespace

void bench_avatar(BenchReport& report, const BenchOptions& options) {
  const int ticks = options.quick ? 60 : 300;
  oneapi::tbb::global_control one_core(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  bench_made(report, ticks);
  Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
  if (castle.storytellers.empty()) return;
  Ticking storyteller_place(castle.storytellers.front().character, castle.scene);
  for (int i = 0; i < ticks + ticks_before; i++) {
    if (i == ticks_before) storyteller_place.forget();
    storyteller_place.tick(seconds_now, false);
  }
  storyteller_place.report(report, "avatar", {{"scene", "castle"}});
}

}  // namespace wellspring::test
