// SPDX-License-Identifier: Apache-2.0
// Measures cache.switch.right: a lamp is switched before a visitor, and of the pixels that this
// changes by more than 10 % a share is within 10 % of right (converged `path`) some time later. The
// cache is told (relight), has to find out, or begins from nothing (cleared), which says what so
// few samples can show at all. Pictures are 60 a second. If the lamp is an exhibit's own, the cache
// is told where light changes and by how much (light/kept/lamps.h), and the time for that is
// measured: cache.switch.light_ms once for everybody, cache.switch.visitor_ms for each visitor.
#include <cmath>
#include <filesystem>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/rng.h"
#include "cache_visit_truth.h"
#include "frame/picture_file.h"
#include "light/kept/lamps.h"
#include "light_scenes.h"
#include "picture/compose_drawn.h"
#include "picture/compositor.h"
#include "report.h"

namespace wellspring::test {
namespace {

constexpr int before = 120;  // pictures in the old light
constexpr int judged_after[] = {1, 6, 15, 30, 60, 120};
constexpr float tolerance = 0.1f, darkest = 1e-4f;

// A scene in one of its lights.
struct Lit {
  Scene scene;
  LampLevels lamps;  // levels of an exhibit's lamps; empty: another scene is another light
  std::unique_ptr<World> world;
  Lights lights, all;  // `all`: while all of the exhibit's lamps are full
  std::shared_ptr<const LampCells> cells;
  std::unique_ptr<VisibilityPass> visibility;
  View view;
  Truth truth;
};

struct Switch {
  std::string scene;
  std::string technique;
  int max_depth = 8;
  Lit off, on;
};

bool is_right(vec3 shown, vec3 wanted) {
  return std::abs(luminance(shown) - luminance(wanted)) <= tolerance * luminance(wanted) + darkest;
}

// Returns whether the converged picture is sure of pixel `i`. An exhibit's pictures are noisy at
// some pixels even after many samples; only pixels are judged where both halves agree.
bool is_known(const Lit& lit, size_t i) {
  return lit.lamps.empty() || is_right(lit.truth.half[0].color[i], lit.truth.half[1].color[i]);
}

bool is_affected(const Lit& a, const Lit& b, size_t i) {
  if (!is_known(a, i) || !is_known(b, i)) return false;
  float one = luminance(a.truth.picture.color[i]), other = luminance(b.truth.picture.color[i]);
  return std::abs(one - other) > tolerance * std::max(one, other) + darkest;
}

// Returns the share of the affected pixels that are right. `map` shows right ones green, too bright
// ones red, too dark ones blue.
float share_right(const Frame& shown, const Lit& was, const Lit& is, Frame& map) {
  int affected = 0, all_right = 0;
  map = shown;
  for (size_t i = 0; i < shown.color.size(); i++) {
    vec3 wanted = is.truth.picture.color[i];
    map.color[i] = vec3(0);
    if (!is_affected(was, is, i)) continue;
    bool right = is_right(shown.color[i], wanted),
         bright = luminance(shown.color[i]) > luminance(wanted);
    map.color[i] = right ? vec3(0, 0.3f, 0) : bright ? vec3(1, 0, 0) : vec3(0, 0, 1);
    affected++;
    all_right += right;
  }
  return float(all_right) / float(std::max(affected, 1));
}

enum class Way { moving, still };
constexpr const char* way_names[] = {"moving", "still"};
enum class News { told, found, cleared };
constexpr const char* event_names[] = {"told", "found", "cleared"};

struct Onlooker {
  const Switch& scene;
  Way way;
  RenderCache cache{};
  Compositor compositor{};
  std::vector<Request> requests{};
  std::vector<Sample> samples{};
  Frame frame{};
  int pictures = 0;
  // A moving visitor passes the judged place every second picture.
  void show(const Lit& lit, int mismatch) {
    View view = lit.view;
    if (way == Way::moving && pictures % 2 == 0)
      view.position += 0.004f * (pictures % 4 ? -1.0f : 1.0f) * view.right;
    uint64_t seed = mix64(uint64_t(++pictures) * 0x9e3779b9u);
    TransportSettings transport;
    transport.max_depth = scene.max_depth;
    transport.clamp = 4;  // as ShowSettings::moving_clamp
    cache.resize(view.width, view.height);
    cache.move_points(*lit.world);
    cache.project(view);
    cache.attend();
    cache.plan(view, view.width * view.height / mismatch, seed, requests);
    samples.resize(requests.size());
    trace(*find_technique(scene.technique), *lit.world, lit.lights, transport, requests, samples);
    cache.remember(view, requests, samples);
    compositor.follow_changes(cache);
    compositor.add_samples(view, requests, samples);
    if (way == Way::moving) compositor.draw(cache, view, *lit.visibility, frame);
    else compositor.draw_still(cache, view, *lit.visibility, frame);
  }
};

// Tells the cache as the show does. Milliseconds that the light takes for everybody, and its cache
// for each visitor.
struct Told {
  double light_ms = 0, visitor_ms = 0;
};
Told tell(const Lit& was, const Lit& is, RenderCache& cache) {
  if (is.lamps.empty()) {
    cache.relight([](const RenderCache::Surface&, vec3&, vec3&) { return true; });
    return {};
  }
  auto put = [&](const LampLevels& lamps) {
    for (size_t i = 0; i < lamps.size(); i++) is.world->set_lamp(int(i), lamps[i]);
  };
  put(was.lamps);
  double start = seconds_now();
  put(is.lamps);
  Lights lights = relit(is.all, *is.world);
  double lit = seconds_now();
  LightChange change(is.scene, is.all, is.cells, was.lamps, is.lamps);
  cache.relight([&](const RenderCache::Surface& at, vec3& kept, vec3& added) {
    return change.changes(at.place, at.normal, kept, added);
  });
  return {1e3 * (lit - start), 1e3 * (seconds_now() - lit)};
}

void run(BenchReport& report, const BenchOptions& options, const Switch& scene, Way way, News news,
         bool on, int mismatch) {
  const Lit &was = on ? scene.off : scene.on, &is = on ? scene.on : scene.off;
  Onlooker visitor{.scene = scene, .way = way};
  if (news != News::cleared)
    for (int i = 0; i < before; i++) visitor.show(was, mismatch);
  if (news == News::told) {
    Told told = tell(was, is, visitor.cache);
    nlohmann::json fields = {{"scene", scene.scene},
                             {"way", way_names[int(way)]},
                             {"light", on ? "on" : "off"},
                             {"mismatch", mismatch}};
    if (!is.lamps.empty()) {
      report.add("cache.switch.light_ms", told.light_ms, "ms", fields);
      report.add("cache.switch.visitor_ms", told.visitor_ms, "ms", fields);
    }
  }
  int picture = 0;
  Frame map;
  for (int after : judged_after) {
    after += way == Way::moving ? after % 2 : 0;
    for (; picture < after; picture++) visitor.show(is, mismatch);
    report.add("cache.switch.right", share_right(visitor.frame, was, is, map), "share",
               {{"scene", scene.scene},
                {"way", way_names[int(way)]},
                {"cache", event_names[int(news)]},
                {"light", on ? "on" : "off"},
                {"mismatch", mismatch},
                {"pictures", after}});
    if (options.visit_pictures.empty()) continue;
    std::string file = options.visit_pictures + "/switch_" + scene.scene + "_" +
                       way_names[int(way)] + "_" + event_names[int(news)] +
                       (on ? "_on_" : "_off_") + std::to_string(mismatch) + "_" +
                       std::to_string(after);
    save_picture(file + ".png", visitor.frame, {});
    save_picture(file + "_right.png", map, {});
  }
}

void prepare(const std::string& name, const BenchScene& scene, const TruthSettings& truths,
             int width, Lit& lit) {
  lit.world = std::make_unique<World>(lit.scene);
  lit.world->commit();
  lit.lights = make_lights(*lit.world);
  lit.visibility = std::make_unique<VisibilityPass>(*lit.world, lit.lights);
  lit.view = bench_view(scene, width, (width * 9 + 8) / 16);
  const Technique& technique = *find_technique(name);
  if (technique.prepare)
    technique.prepare(*lit.world, std::span(&lit.view.position, 1), lit.lights);
  if (!lit.lamps.empty()) {
    for (size_t i = 0; i < lit.lamps.size(); i++) lit.world->set_lamp(int(i), lit.lamps[i]);
    lit.all = lit.lights;
    if (lit.all.known)
      lit.cells = std::make_shared<LampCells>(make_lamp_cells(*lit.world, *lit.all.known));
    lit.lights = relit(lit.all, *lit.world);
  }
  lit.truth = find_truth(*lit.world, lit.lights, lit.view, truths);
}

// One of the exhibit's lamps, while all others are on.
void make_exhibit_lamps(const std::string& name, Lit& off, Lit& on) {
  for (Lit* lit : {&off, &on}) lit->lamps.assign(lit->scene.lamps.size(), lamp_full);
  for (size_t i = 0; i < off.lamps.size(); i++)  // with the day's sun
    if (off.scene.lamps[i].name.starts_with(name)) off.lamps[i] = 0;
  if (off.lamps == on.lamps) throw LoadError("castle", "/lamps", "there is no '" + name + "'");
}

// Makes the lamps before and after the switch. `what` is switched: a spot light beside the box's
// lamp, or beside a point light instead of that lamp; the box's lamp beside a point light; or all
// lamps of the castle but its sun.
void make_lamps(const std::string& what, Scene& off, Scene& on) {
  off.lamps.clear(), on.lamps.clear();
  PunctualLight lamp;
  if (what == "box_points") {
    for (Scene* scene : {&off, &on}) {
      for (Material& material : scene->materials) material.emission = vec3(0);
      lamp.position = {0.1f, 0.5f, -0.2f};
      lamp.intensity = {0.12f, 0.11f, 0.1f};
      scene->lights.push_back(lamp);
    }
  }
  if (what == "box_spot" || what == "box_points") {
    lamp.type = PunctualType::spot;
    lamp.position = {-0.2f, 0.5f, 0.1f};
    lamp.direction = normalize(vec3(0.45f, -0.75f, -0.6f));
    lamp.inner_cone = 0.5f, lamp.outer_cone = 0.6f;
    lamp.intensity = {0.7f, 0.65f, 0.5f};
    on.lights.push_back(lamp);
  } else if (what == "box_lamp") {
    lamp.position = {0.15f, 0.5f, -0.05f};
    lamp.intensity = {0.05f, 0.06f, 0.08f};
    off.lights.push_back(lamp), on.lights.push_back(lamp);
    for (Material& material : off.materials) material.emission = vec3(0);
  } else {
    std::erase_if(off.lights, [](const PunctualLight& light) {
      return light.type != PunctualType::directional;
    });
  }
}

}  // namespace

void bench_cache_switch(BenchReport& report, const BenchOptions& options) {
  if (!options.visit_pictures.empty()) std::filesystem::create_directories(options.visit_pictures);
  TruthSettings truths;
  truths.folder = truths_folder(options);
  int width = options.visit_width > 0 ? options.visit_width : 192;
  std::vector<int> mismatches = options.visit_mismatches;
  if (mismatches.empty()) mismatches = {4, 16, 64};
  for (std::string what : {"box_spot", "box_points", "box_lamp", "castle", "daylight"}) {
    if (!options.visit_trace.empty() && options.visit_trace != what) continue;
    const bool box = what.starts_with("box"), exhibit = !box && what != "castle";
    BenchScene bench = load_bench_scene(options, box ? "cornell_box" : "castle");
    Switch scene{what, options.visit_technique, bench.max_depth, {}, {}};
    truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 96 : 512;
    truths.max_depth = bench.max_depth;
    scene.off.scene = bench.scene, scene.on.scene = bench.scene;
    // Light that falls directly owes little to chance: what is wrong then is the cache's fault.
    if (what == "box_points") scene.technique = "path", scene.max_depth = truths.max_depth = 2;
    if (exhibit) make_exhibit_lamps(what, scene.off, scene.on);
    else make_lamps(what, scene.off.scene, scene.on.scene);
    for (Lit* lit : {&scene.off, &scene.on}) prepare(scene.technique, bench, truths, width, *lit);
    int affected = 0, pixels = int(scene.on.truth.picture.color.size());
    for (int i = 0; i < pixels; i++) affected += is_affected(scene.off, scene.on, size_t(i));
    report.add("cache.switch.affected", double(affected) / pixels, "share", {{"scene", what}});
    for (const Lit* lit : {&scene.off, &scene.on}) {
      int alike = 0;
      for (size_t i = 0; i < lit->truth.picture.color.size(); i++)
        alike += is_right(lit->truth.half[0].color[i], lit->truth.half[1].color[i]);
      report.add("cache.switch.truth_halves_alike",
                 double(alike) / double(lit->truth.picture.color.size()), "share",
                 {{"scene", what}, {"light", lit == &scene.on ? "on" : "off"}});
    }
    for (int mismatch : mismatches)
      for (Way way : {Way::moving, Way::still})
        for (bool on : {true, false})
          for (News news : {News::told, News::found, News::cleared})
            run(report, options, scene, way, news, on, mismatch);
  }
}

}  // namespace wellspring::test
