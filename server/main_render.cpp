// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring render`: renders a still picture of a scene. Exit status: 0 done, 1 the input is
// wrong, 2 the command line is wrong.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <oneapi/tbb/global_control.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/unicode.h"
#include "denoise/denoise.h"
#include "frame/picture_file.h"
#include "light/kept/lamps.h"
#include "light/technique/technique.h"
#include "light/transport_plan.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/moving/exhibit_scene.h"
#include "world/load/lamp.h"
#include "world/load/scene_load.h"
#include "world/sky.h"
#include "world/view.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr int largest_side = 16384;

// Reports a wrong command line: printed on stderr, exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Options {
  std::string scene, technique = "path", camera, eye, target, up = "0,1,0", size = "1280x720", out,
                     environment, sky, replay;
  std::string denoise, albedo, normal;  // network's name; files of guides; empty: none
  double fov = 0, time = 0;
  std::optional<double> exposure, hour;  // without them the exhibit's
  int spp = 16, max_depth = 8, threads = 0;
  uint64_t seed = 1;
  std::vector<std::string> lamps;  // NAME=on, NAME=off
  bool list_techniques = false, explain = false, draw_back_faces = false;
};

// Reads exactly `count` finite numbers with commas between.
std::vector<double> parse_numbers(const std::string& text, size_t count, const char* option) {
  std::vector<double> values;
  const char* p = text.data();
  const char* end = p + text.size();
  while (true) {
    double value = 0;
    auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc() || !std::isfinite(value)) break;
    values.push_back(value);
    if (next == end && values.size() == count) return values;
    if (next == end || *next != ',') break;
    p = next + 1;
  }
  throw UsageError(std::string(option) + " " + text + ": " + std::to_string(count) +
                   " numbers with commas between are expected");
}

dvec3 parse_vector(const std::string& text, const char* option) {
  std::vector<double> v = parse_numbers(text, 3, option);
  return {v[0], v[1], v[2]};
}

ivec2 parse_size(const std::string& text) {
  ivec2 size(0);
  const char* end = text.data() + text.size();
  auto [cross, error] = std::from_chars(text.data(), end, size.x);
  if (error == std::errc() && cross != end && *cross == 'x') {
    auto [last, error2] = std::from_chars(cross + 1, end, size.y);
    if (error2 == std::errc() && last == end && size.x >= 1 && size.y >= 1 &&
        size.x <= largest_side && size.y <= largest_side)
      return size;
  }
  throw UsageError("--size " + text + ": WIDTHxHEIGHT expected, each 1 to 16384");
}

std::string technique_names() {
  std::string names;
  for (const Technique& t : techniques())
    names += (names.empty() ? "" : ", ") + std::string(t.name);
  return names;
}

void check_options(const Options& o) {
  if (!find_technique(o.technique))
    throw UsageError("--technique " + o.technique + ": no such technique; there are " +
                     technique_names());
  if (o.scene.empty()) throw UsageError("no scene given: a .gltf or .glb file");
  if (o.spp < 1) throw UsageError("--spp " + std::to_string(o.spp) + ": at least 1 sample a pixel");
  if (o.max_depth < 1)
    throw UsageError("--max-depth " + std::to_string(o.max_depth) + ": at least 1");
  if (o.threads < 0)
    throw UsageError("--threads " + std::to_string(o.threads) + ": 0 (all cores) or more");
  if (o.exposure && (!std::isfinite(*o.exposure) || *o.exposure < 0))
    throw UsageError("--exposure: a number, 0 or more, expected");
  if (!std::isfinite(o.time) || o.time < 0)
    throw UsageError("--time: seconds, 0 or more, expected");
  if (o.fov != 0 && !(o.fov > 0 && o.fov < 180))
    throw UsageError("--fov: degrees between 0 and 180 expected");
  if (!o.camera.empty() && !o.eye.empty())
    throw UsageError("--camera and --eye exclude each other");
  if (o.eye.empty() != o.target.empty()) throw UsageError("--eye and --target belong together");
  if (o.out.empty() && o.replay.empty() && !o.explain) throw UsageError("--out FILE is missing");
  for (const auto& [option, file] : {std::pair("--out", o.out), std::pair("--albedo", o.albedo),
                                     std::pair("--normal", o.normal)})
    if (!file.empty() && !is_picture_name(file))
      throw UsageError(std::string(option) + " " + file +
                       ": name must end in .png, .jpg, .pfm or .exr");
  if (!o.denoise.empty() && !find_net_size(o.denoise))
    throw UsageError("--denoise " + o.denoise + ": small, base or large expected");
}

// Checks before minutes of work whether the picture can be written, and fits into memory.
void check_resources(const Options& o, ivec2 size) {
  if (o.out.empty()) return;
  std::filesystem::path folder = std::filesystem::path(o.out).parent_path();
  if (folder.empty()) folder = ".";
  if (std::filesystem::is_directory(o.out)) throw LoadError(o.out, "", "is a folder");
  if (!std::filesystem::is_directory(folder))
    throw LoadError(o.out, "", "cannot be written: no such folder");
  if (access(folder.c_str(), W_OK) != 0)
    throw LoadError(o.out, "", "cannot be written: the folder is not writable");
  // The picture has colour, depth and object planes, and is encoded beside them.
  double needed = double(size.x) * double(size.y) * 36;
  std::ifstream meminfo("/proc/meminfo");
  std::string key;
  for (double kilobytes; meminfo >> key >> kilobytes; meminfo.ignore(256, '\n'))
    if (key == "MemAvailable:" && needed > kilobytes * 1024)
      throw LoadError(o.out, "",
                      "a picture of " + o.size + " needs " + std::to_string(int(needed / 1e6)) +
                          " MB, which this machine does not have free");
}

struct LoadedScene {
  Scene scene;
  std::vector<LampSwitch> lamps;
  std::optional<Day> day;
  float exposure = 1;
};

// Loads one kind of scene; the first kind that knows the path is used. A new kind of scene needs
// one more line in the table.
struct SceneKind {
  const char* what;
  bool (*knows)(const std::string& path);
  LoadedScene (*load)(const std::string& path, double time);
};
const SceneKind scene_kinds[] = {
    {"exhibit package",
     [](const std::string& path) { return std::filesystem::exists(path + "/exhibit.json"); },
     [](const std::string& path, double time) {
       Exhibit exhibit = load_exhibit(path);
       std::vector<LampSwitch> lamps = first_lamps(exhibit);
       std::optional<Day> day = exhibit.day;
       float exposure = float(exhibit.exposure);
       return LoadedScene{make_exhibit_scene(std::move(exhibit), time), lamps, day, exposure};
     }},
    {"glTF file", [](const std::string& path) { return !std::filesystem::is_directory(path); },
     [](const std::string& path, double time) {
       SceneLoadOptions options;
       options.time = time;
       return LoadedScene{load_scene(path, options), {}, {}};
     }},
};

LoadedScene load_any_scene(const std::string& path, double time) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw LoadError(path, "", "no such file");
  for (const SceneKind& kind : scene_kinds)
    if (kind.knows(path)) return kind.load(path, time);
  std::string kinds;
  for (const SceneKind& kind : scene_kinds)
    kinds += (kinds.empty() ? "" : ", ") + std::string(kind.what);
  throw LoadError(path, "", "not a scene this program knows (" + kinds + ")");
}

// Applies --lamp, which changes the lamps' first states.
void apply_lamps(const std::vector<std::string>& orders, const Scene& scene,
                 std::vector<LampSwitch>& lamps) {
  for (const std::string& order : orders) {
    size_t cut = std::min(order.rfind('='), order.size());
    std::string name = order.substr(0, cut), names, states;
    size_t found = lamps.size();
    for (size_t i = 0; i < lamps.size(); i++) {
      if (scene.lamps[i].name == nfc(name)) found = i;
      names += (i ? ", " : "") + scene.lamps[i].name;
    }
    if (found == lamps.size())
      throw UsageError("--lamp " + order + ": no such lamp; " +
                       (names.empty() ? "the scene has none" : "there are " + names));
    const auto to = find_switch(scene, scene.lamps[found],
                                order.substr(std::min(cut + 1, order.size())), states);
    if (!to) throw UsageError("--lamp " + order + ": NAME=STATE expected, of: " + states);
    lamps[found] = *to;
  }
}

// Applies --hour, if it is another hour than the exhibit's own: the sun of the scene moves to its
// place at that hour.
LampLevels apply_hour(const Options& o, LoadedScene& loaded) {
  std::optional<double> hour;
  if (o.hour && !loaded.day) throw UsageError("--hour: the scene is no exhibit with a \"day\"");
  if (o.hour) hour = hour_of_day(*loaded.day, *o.hour);
  LampLevels levels = lamp_levels(loaded.day, loaded.lamps, hour);
  if (!hour) return levels;
  put_sun(*loaded.day, *hour, loaded.scene);
  levels[size_t(loaded.day->sun_lamp)] = loaded.lamps[size_t(loaded.day->lamp)] ? lamp_full : 0;
  return levels;
}

// Sets the lamps' levels; `lights` were made, and prepared, while all lamps were full.
void light_lamps(const LampLevels& levels, World& world, Lights& lights) {
  if (levels.empty()) return;
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), levels[i]);
  lights = relit(lights, world);
}

void apply_sky(const std::string& text, Scene& scene) {
  bool three = std::count(text.begin(), text.end(), ',') == 2;
  std::vector<double> v = parse_numbers(text, three ? 3 : 2, "--sky");
  SkySettings sky;
  sky.elevation = v[0], sky.azimuth = v[1];
  if (three) sky.turbidity = v[2];
  if (const char* problem = sky_problem(sky)) throw UsageError("--sky " + text + ": " + problem);
  add_sky(sky, scene);
}

void apply_environment(const std::string& text, Scene& scene) {
  if (text == "none") {
    scene.environment = {};
  } else if (!text.empty() && text.find(".hdr") != std::string::npos) {
    scene.environment = {};
    load_environment(text, scene);
  } else if (!text.empty()) {
    dvec3 radiance = parse_vector(text, "--environment");
    if (radiance.x < 0 || radiance.y < 0 || radiance.z < 0)
      throw UsageError("--environment " + text + ": radiance is not negative");
    scene.environment = {vec3(radiance), -1};
  } else if (add_missing_light(scene)) {
    std::cerr << "the scene has no light: lit by a uniform environment of radiance 1 "
                 "(--environment none to see it dark)\n";
  } else if (scene.lights.empty() && max_component(scene.environment.radiance) <= 0) {
    std::cerr << "the scene is lit by its emitting surfaces alone (--environment 1,1,1 adds light "
                 "from everywhere)\n";
  }
}

// Returns a view from the front, a little to the right and above, as near as the whole scene fits.
View frame_scene(const Scene& scene, float fov, ivec2 size) {
  Bounds bounds = scene_bounds(scene);
  if (!is_finite(bounds.low) || !is_finite(bounds.high)) bounds = {vec3(-1), vec3(1)};
  vec3 center = 0.5f * (bounds.low + bounds.high), half = 0.5f * (bounds.high - bounds.low);
  vec3 back = normalize(vec3(0.45f, 0.35f, 1));
  float tan_y = std::tan(0.5f * fov), tan_x = tan_y * float(size.x) / float(size.y);
  float distance = distance_to_fit(half, back, tan_x, tan_y);
  dvec3 target = scene.origin + dvec3(center);
  return make_view_towards(scene, target + dvec3(back * (distance * 1.06f)), target, {0, 1, 0}, fov,
                           size.x, size.y);
}

View choose_view(const Options& o, const Scene& scene, ivec2 size) {
  float fov = o.fov > 0 ? glm::radians(float(o.fov)) : glm::radians(45.0f);
  if (!o.eye.empty()) {
    dvec3 eye = parse_vector(o.eye, "--eye"), target = parse_vector(o.target, "--target");
    if (eye == target) throw UsageError("--eye and --target are the same place");
    vec3 up = vec3(parse_vector(o.up, "--up"));
    if (up == vec3(0)) throw UsageError("--up 0,0,0 is no direction");
    return make_view_towards(scene, eye, target, up, fov, size.x, size.y);
  }
  const Viewpoint* chosen =
      o.camera.empty() && !scene.viewpoints.empty() ? &scene.viewpoints[0] : nullptr;
  for (const Viewpoint& v : scene.viewpoints)
    if (!o.camera.empty() && v.name == nfc(o.camera)) {
      chosen = &v;
      break;
    }
  if (!chosen && !o.camera.empty()) {
    std::string names;
    for (const Viewpoint& v : scene.viewpoints) names += (names.empty() ? "" : ", ") + v.name;
    throw UsageError(
        "--camera " + o.camera + ": no such camera; " +
        (names.empty() ? "the scene has none (use --eye and --target)" : "there are " + names));
  }
  if (!chosen) return frame_scene(scene, fov, size);
  Viewpoint at = *chosen;
  if (o.fov > 0) at.fov = fov;
  return make_view(scene, at, size.x, size.y);
}

// Prints the size of the scene, and which parts of light transport it needs.
void print_plan(const Options& o, const Scene& scene) {
  TransportPlan plan = make_transport_plan(scene);
  size_t in_use = 0;
  for (const MaterialUse& use : plan.materials) in_use += use.visible;
  std::printf("%s: %zu triangles, %zu of %zu materials in use\n%s", o.scene.c_str(),
              triangle_count(scene), in_use, plan.materials.size(), explain(plan).c_str());
}

void print_replay(const Options& o, const World& world, const Lights& lights, const View& view,
                  const StillSettings& settings) {
  std::vector<double> at = parse_numbers(o.replay, 3, "--replay");
  for (int i = 0; i < 3; i++)
    if (at[size_t(i)] != std::floor(at[size_t(i)]) || at[size_t(i)] < 0 ||
        at[size_t(i)] >= (i == 0   ? view.width
                          : i == 1 ? view.height
                                   : settings.spp))
      throw UsageError("--replay " + o.replay +
                       ": pixel x, y and sample i inside --size and --spp expected");
  Sample sample = replay_sample(*find_technique(o.technique), world, lights, view, settings,
                                int(at[0]), int(at[1]), int(at[2]));
  vec3 c = sample.radiance();
  std::printf("radiance %.9g %.9g %.9g\n", double(c.x), double(c.y), double(c.z));
  if (sample.flags & sample_hit)
    std::printf("hit %s at %.9g %.9g %.9g, distance %.9g\n",
                world.scene().objects[sample.object].c_str(), double(sample.position.x),
                double(sample.position.y), double(sample.position.z), double(sample.distance));
  else std::printf("hit nothing\n");
}

void add_options(CLI::App& app, Options& o) {
  app.add_option("scene", o.scene, "glTF 2.0 file (.gltf, .glb)");
  app.add_option("--technique", o.technique, "how light is sampled (--list-techniques)")
      ->capture_default_str();
  app.add_flag("--list-techniques", o.list_techniques, "print the names of the techniques and end");
  app.add_flag("--explain", o.explain,
               "print which parts of light transport the scene needs, which not and why, and end");
  app.add_option("--camera", o.camera,
                 "a camera of the file; without --camera and --eye its first");
  app.add_option("--eye", o.eye, "x,y,z of the eye, metres");
  app.add_option("--target", o.target, "x,y,z looked at");
  app.add_option("--up", o.up, "x,y,z upwards")->capture_default_str();
  app.add_option("--fov", o.fov, "vertical field of view, degrees");
  app.add_option("--size", o.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  app.add_option("--spp", o.spp, "samples a pixel")->capture_default_str();
  app.add_option("--seed", o.seed, "of all random numbers")->capture_default_str();
  app.add_option("--time", o.time, "seconds into the file's animation")->capture_default_str();
  app.add_option("--out", o.out, "picture: .png .jpg tone-mapped, .pfm .exr linear radiance");
  app.add_option("--denoise", o.denoise,
                 "learned reconstruction of few samples, by the network small, base (without a "
                 "name) or large")
      ->expected(0, 1)
      ->default_str("base");
  app.add_option("--albedo", o.albedo, "another picture: what of the light leaves, 0 to 1");
  app.add_option("--normal", o.normal,
                 "another: normals in world space; n / 2 + 1 / 2 in .png and .jpg");
  app.add_option("--exposure", o.exposure,
                 "factor before tone mapping; without it the exhibit's, or 1");
  app.add_option("--max-depth", o.max_depth,
                 "path edges counted from the eye, but for what glass does")
      ->capture_default_str();
  app.add_option("--environment", o.environment, "none, or radiance r,g,b, or a picture FILE.hdr");
  app.add_option("--sky", o.sky,
                 "ELEVATION,AZIMUTH[,TURBIDITY] of a sun and its sky instead: degrees over the "
                 "horizon, degrees clockwise from -Z, 1 (pure air) to 10 (haze)")
      ->excludes("--environment");
  app.add_flag("--draw-back-faces", o.draw_back_faces, "of single-sided materials, too");
  app.add_option("--lamp", o.lamps,
                 "NAME=on or NAME=off: a lamp of the exhibit that is not to be as it begins");
  app.add_option("--hour", o.hour, "of the exhibit's day, 17.5: half past five")
      ->check(CLI::Range(0.0, 24.0));
  app.add_option("--threads", o.threads, "0: all cores")->capture_default_str();
  app.add_option("--replay", o.replay,
                 "x,y,i: print the radiance of sample i of pixel x,y instead");
}

// Saves guides of `frame` as a picture of their own.
void save_guide(const std::string& path, const Frame& frame, const std::vector<vec3>& plane,
                bool is_normal) {
  if (path.empty()) return;
  Frame guide;
  guide.width = frame.width, guide.height = frame.height;
  guide.color = plane;
  if (!is_normal || is_linear_picture_name(path)) return save_picture(path, guide, {});
  Image8 image{frame.width, frame.height, {}};
  for (vec3 n : plane)
    for (int c = 0; c < 3; c++)
      image.rgb.push_back(uint8_t(std::clamp(n[c] * 127.5f + 128.0f, 0.0f, 255.0f)));
  save_image8(path, image);
}

// Writes the guides that the options ask for, and denoises `frame` if they ask for that. Returns a
// text that says how it was denoised.
std::string use_guides(const Options& o, Denoiser* denoiser, const World& world,
                       const Lights& lights, const View& view, Frame& frame) {
  if (!denoiser && o.albedo.empty() && o.normal.empty()) return "not denoised";
  GuidePlanes guides = make_guides(world, lights, view);
  save_guide(o.albedo, frame, guides.albedo, false);
  save_guide(o.normal, frame, guides.normal, true);
  if (!denoiser) return "not denoised";
  denoiser->run({view.width, view.height, frame.color, guides.albedo, guides.normal}, frame.color);
  return "denoised by the network " + o.denoise;
}

void render(const Options& o) {
  ivec2 size = parse_size(o.size);
  check_options(o);
  check_resources(o, size);
  std::unique_ptr<Denoiser> denoiser;
  std::string problem;
  if (!o.denoise.empty()) denoiser = load_denoiser(*find_net_size(o.denoise), problem);
  if (!problem.empty()) throw LoadError("--denoise " + o.denoise, "", problem);
  LoadedScene loaded = load_any_scene(o.scene, o.time);
  if (o.draw_back_faces) loaded.scene.cull_back_faces = false;
  Scene& scene = loaded.scene;
  for (const std::string& warning : scene.warnings) std::cerr << o.scene << ": " << warning << "\n";
  apply_lamps(o.lamps, scene, loaded.lamps);
  const LampLevels levels = apply_hour(o, loaded);
  if (!o.sky.empty()) apply_sky(o.sky, scene);
  else apply_environment(o.environment, scene);
  if (o.explain) return print_plan(o, scene);
  View view = choose_view(o, scene, size);
  World world(scene);
  Lights lights = make_lights(world);
  if (auto* prepare = find_technique(o.technique)->prepare)
    prepare(world, std::span(&view.position, 1), lights);
  light_lamps(levels, world, lights);
  StillSettings settings;
  settings.spp = o.spp;
  settings.seed = o.seed;
  settings.transport.max_depth = o.max_depth;
  settings.transport.sees_volumes = true;
  if (!o.replay.empty()) return print_replay(o, world, lights, view, settings);
  double start = seconds_now();
  fetch_pieces(world, lights, view);
  Progress progress("render");
  settings.progress = [&](double done) { progress.tell(done); };
  Frame frame = render_still(*find_technique(o.technique), world, lights, view, settings);
  progress.clear();
  double seconds = seconds_now() - start;
  std::string comment = std::to_string(o.spp) + " samples a pixel by " + o.technique + ", " +
                        use_guides(o, denoiser.get(), world, lights, view, frame);
  double all_seconds = seconds_now() - start;
  save_picture(o.out, frame, {float(o.exposure.value_or(loaded.exposure))}, comment);
  double samples = double(size.x) * double(size.y) * double(o.spp);
  std::fprintf(
      stderr, "%s: %dx%d, %d samples a pixel by %s, %.2f s, %.2f million samples a second\n",
      o.out.c_str(), size.x, size.y, o.spp, o.technique.c_str(), seconds, samples / seconds * 1e-6);
  if (denoiser)
    std::fprintf(stderr, "%s: guides and reconstruction took %.2f s\n", o.out.c_str(),
                 all_seconds - seconds);
  if (uint64_t bad = lights.bad_samples->load())
    std::fprintf(stderr, "%s: %llu samples were not finite and count as black\n", o.out.c_str(),
                 static_cast<unsigned long long>(bad));
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("render");
  Options options;
  CLI::App app{"Renders a still picture of a scene."};
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (options.list_techniques) {
    for (const Technique& t : techniques()) std::cout << t.name << "\n";
    return 0;
  }
  try {
    std::optional<oneapi::tbb::global_control> threads;
    if (options.threads > 0)
      threads.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                      size_t(options.threads));
    render(options);
    return 0;
  } catch (const UsageError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  } catch (const std::bad_alloc&) {
    std::cerr << options.scene << ": not enough memory\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
