// SPDX-License-Identifier: Apache-2.0
// show.storyteller.flip: a visitor stands before the storyteller of the castle, who tells a story.
// It measures FLIP of the storyteller's visible head, in pictures of moving things as the show lays
// them over a backdrop, against `path` with many samples of the same moment. The clock is
// simulated: samples are those that so many a second allow, so that the machine's speed is stated
// and not in the result. show.storyteller.ms, by `part`: what a picture of the storyteller costs
// one core, and what finding the figure's light costs, which is done skin_rate times a second.
// show.storyteller.places, .bytes: of the light kept on figures.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/clock.h"
#include "base/rng.h"
#include "cache_visit_stage.h"
#include "cache_visit_truth.h"
#include "frame/picture_file.h"
#include "frame/tonemap.h"
#include "judge/flip.h"
#include "light/kept/skin/skin_light.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "report.h"

namespace wellspring::test {
namespace {

constexpr int width = 1280, height = 720;
constexpr double rate = 25;                          // pictures a second of what moves
constexpr double skin_rate = 5, skin_share = 0.125;  // as the show finds its light
constexpr int head_width = 240, head_height = 160;
constexpr float moving_clamp = 4;  // as ShowSettings
constexpr float head = 0.29f;      // metres from the crown down

float crown_of(const World& world) {
  float top = -INFINITY;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++)
    if (world.is_moving(i) && world.is_visible(i))
      for (vec3 p : world.mesh_of(i).positions) top = std::max(top, p.y);
  return top;
}

// The head and some around it, in pixels as wide as those of the whole picture.
View view_of_head(const World& world, const View& whole) {
  vec3 low(INFINITY), high(-INFINITY);
  const float top = crown_of(world);
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++)
    if (world.is_moving(i) && world.is_visible(i))
      for (vec3 p : world.mesh_of(i).positions)
        if (p.y > top - head) low = min(low, p), high = max(high, p);
  View view = whole;
  view.forward = normalize(0.5f * (low + high) - whole.position);
  view.right = normalize(cross(view.forward, whole.up));
  view.up = cross(view.right, view.forward);
  view.width = head_width, view.height = head_height;
  view.tan_half_fov = whole.tan_half_fov * float(head_height) / float(height);
  return view;
}

// Finds the pixels that show the storyteller's head.
std::vector<bool> find_mask(const World& world, const View& view) {
  const float top = crown_of(world);
  std::vector<bool> mask;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      Hit hit = world.intersect(ray);
      mask.push_back(hit.valid() && world.is_moving(hit.instance) &&
                     ray.origin.y + hit.t * ray.direction.y > top - head);
    }
  return mask;
}

// Returns the mean FLIP in the mask; everything outside of it counts as right.
double judge(Image8 shown, const Image8& truth, const std::vector<bool>& mask) {
  for (size_t i = 0; i < mask.size(); i++)
    if (!mask[i]) std::copy_n(&truth.rgb[3 * i], 3, &shown.rgb[3 * i]);
  FlipMap map = eval_flip(shown, truth);
  double sum = 0, count = 0;
  for (size_t i = 0; i < mask.size(); i++)
    if (mask[i]) sum += double(map.error[i]), count++;
  return sum / std::max(count, 1.0);
}

// Draws for a visitor at rest as the show does.
struct Visit {
  const VisitStage& stage;
  const View view;
  const double samples_a_second;
  VisibilityPass visibility{stage.world(), stage.lights()};
  SkinLight skin = make_skin_light(stage.world());
  Compositor compositor;
  Keyframe backdrop;
  MovingLight light;
  MovingPicture moving;
  Image8 picture;
  double lit_at = -1, owed = 0;

  Visit(const VisitStage& stage, const View& view, double samples)
      : stage(stage), view(view), samples_a_second(samples) {
    compositor.set_skin(&skin, &stage.lights());
    const size_t pixels = size_t(view.width) * size_t(view.height);
    Image8 black{view.width, view.height, std::vector<uint8_t>(3 * pixels)};
    make_keyframe(view, black, std::vector<float>(pixels, INFINITY), backdrop);
  }
  void find_light(double time) {
    if (time - lit_at < 1 / skin_rate - 1e-6) return;
    owed += samples_a_second * skin_share * (lit_at < 0 ? 1 / skin_rate : time - lit_at);
    lit_at = time;
    SkinUpdate update;
    update.samples = int(owed);
    owed -= update.samples;
    update.seed = mix64(uint64_t(1000 * time) + 1);
    update.views = std::span(&view, 1);
    update.transport = stage.settings().transport;
    update.transport.clamp = moving_clamp;
    update_skin(stage.world(), stage.lights(), update, skin);
    smooth_skin(stage.world(), skin, time == 0 ? 6 : 2);
  }
  void draw() {
    compositor.draw_moving(stage.world(), backdrop, nullptr, visibility,
                           Tonemap{stage.exhibit().exposure}, false, light, moving);
  }
  void show(double time) {
    find_light(time);
    draw();
    copy_colors(backdrop, {0, 0, view.width, view.height}, picture);
    if (!moving.empty()) lay_over(moving, picture);
  }
};

template <class Work>
double milliseconds_of(const Work& work) {
  constexpr int times = 20;
  double spent = 0;
  oneapi::tbb::task_arena one(1);
  one.execute([&] {
    double began = thread_seconds_now();
    for (int i = 0; i < times; i++) work();
    spent = thread_seconds_now() - began;
  });
  return 1000 * spent / times;
}

void measure(BenchReport& report, const VisitStage& stage, const View& view) {
  Visit visit(stage, view, 200e3);
  visit.show(0);
  uint32_t shown = 0;
  for (const SkinPlace& place : visit.skin.places)
    shown += stage.world().is_visible(place.instance);
  report.add("show.storyteller.places", double(shown), "", {{"all", visit.skin.places.size()}});
  report.add("show.storyteller.bytes", double(memory_bytes(visit.skin)), "B");
  auto add = [&](const char* part, const auto& work) {
    report.add("show.storyteller.ms", milliseconds_of(work), "ms of one core", {{"part", part}});
  };
  add("draw", [&] { visit.draw(); });
  add("smooth", [&] { smooth_skin(stage.world(), visit.skin); });
  SkinUpdate update;
  update.samples = 1000;
  update.views = std::span(&view, 1);
  add("thousand samples", [&] { update_skin(stage.world(), stage.lights(), update, visit.skin); });
}

}  // namespace

void bench_show_storyteller(BenchReport& report, const BenchOptions& options) {
  VisitStage stage(options.content + "/castle", "gather");
  VisitTrace trace;
  const Viewpoint& at =
      stage.exhibit().viewpoints[size_t(find_viewpoint(stage.exhibit(), "storyteller"))].view;
  trace.telling = true;
  trace.samples = {{0, at.position, at.yaw, at.pitch, at.fov}};
  const View whole = stage.view(trace, 0, width, height);
  // Pictures are judged at once, half a second after, and while the story is told.
  const std::vector<int> judged =
      options.quick ? std::vector{0, 12, 75} : std::vector{0, 5, 12, 25, 50, 75, 100, 125};
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 32 : 256;
  truths.content = hash_files(options.content + "/castle");
  truths.folder = truths_folder(options);
  stage.begin(trace);
  // The story has begun by then.
  for (int i = 0; i < 50; i++) stage.advance(trace, i / rate, float(1 / rate));
  measure(report, stage, whole);
  const View view = view_of_head(stage.world(), whole);
  std::vector<std::unique_ptr<Visit>> visits;
  for (double samples : {60e3, 200e3})
    visits.push_back(std::make_unique<Visit>(stage, view, samples));
  if (!options.visit_pictures.empty()) std::filesystem::create_directories(options.visit_pictures);
  auto save = [&](const std::string& name, const Image8& image) {
    if (!options.visit_pictures.empty())
      save_image8(options.visit_pictures + "/teller_" + name + ".png", image);
  };
  const Tonemap curve{stage.exhibit().exposure};
  for (int frame = 0; frame <= judged.back(); frame++) {
    stage.advance(trace, 2 + frame / rate, float(1 / rate));
    for (auto& visit : visits) visit->show(frame / rate);
    if (std::find(judged.begin(), judged.end(), frame) == judged.end()) continue;
    std::string time = std::to_string(int(std::lround(1000 * frame / rate)));
    const std::vector<bool> mask = find_mask(stage.world(), view);
    Truth truth = find_truth(stage.world(), stage.lights(), view, truths);
    Image8 wanted, halves[2];
    tonemap(truth.picture, curve, wanted);
    for (int k = 0; k < 2; k++) tonemap(truth.half[k], curve, halves[k]);
    save("true_" + time, wanted);
    report.add("show.storyteller.truth_halves_flip", judge(halves[0], halves[1], mask), "FLIP",
               {{"seconds", frame / rate}, {"spp", truths.spp}});
    for (auto& visit : visits) {
      save(std::to_string(int(visit->samples_a_second / 1000)) + "k_" + time, visit->picture);
      report.add("show.storyteller.flip", judge(visit->picture, wanted, mask), "FLIP",
                 {{"scene", "castle"},
                  {"seconds", frame / rate},
                  {"samples_a_second", visit->samples_a_second},
                  {"spp", truths.spp}});
    }
  }
}

}  // namespace wellspring::test
