// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/new_exhibit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "base/write_file.h"
#include "show/exhibit/exhibit_light.h"
#include "show/exhibit/exhibit_load.h"
#include "show/proposal/propose_views.h"
#include "show/check/scene_scale.h"
#include "world/load/scene_files.h"
#include "world/load/scene_join.h"
#include "world/load/scene_load.h"
#include "world/motion/scene_motion.h"
#include "world/sky.h"

namespace wellspring::show {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr float too_dark = 30;   // an exposure beyond says that the light is not meant to be all
constexpr float lamp_light = 3;  // W/m^2 on a wall, of lamps that are added
constexpr double one_degree = 3.14159265358979323846 / 180;
constexpr SkySettings day{48, 155, 3, 0.2};  // behind the left shoulder of who sees the front

double round_to(double value, double unit) { return std::round(value / unit) * unit + 0.0; }

json numbers(dvec3 v) { return {round_to(v.x, 0.001), round_to(v.y, 0.001), round_to(v.z, 0.001)}; }

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

void copy_model(const std::string& model, const fs::path& folder) {
  const fs::path source = fs::path(model).parent_path();
  std::vector<std::string> names = list_scene_files(model);
  names.push_back(file_name(model));
  for (const std::string& name : names) {
    std::error_code ec;
    fs::create_directories((folder / name).parent_path(), ec);
    fs::copy_file(source / name, folder / name, ec);
    if (ec) throw LoadError((folder / name).string(), "", "cannot be written: " + ec.message());
  }
}

bool shares_node(const gltf::Clip& a, const gltf::Clip& b) {
  for (const gltf::Track& one : a.tracks)
    for (const gltf::Track& other : b.tracks)
      if (one.node == other.node && one.path == other.path) return true;
  return false;
}

// The exhibit while it is made.
struct Maker {
  const std::string id, model;
  const fs::path folder;
  Exhibit exhibit;
  ProposedViews proposed;
  double scale = 1;
  json lamps = json::array();  // places of lamps that are added
  json manifest;
  std::vector<std::string> told;

  void load() {
    SceneLoadOptions options;
    options.motion = true;
    exhibit.scene = load_scene(model, options);
    Bounds box = scene_bounds(exhibit.scene);
    float largest = max_component(box.high - box.low);
    if (!std::isfinite(largest) || !(largest > 0))
      throw LoadError(model, "", "there is nothing to see in this file");
    scale = propose_scale(double(largest), double(WalkSettings{}.eye_height));
    ScenePlace place;
    place.scale = scale;
    place_scene(exhibit.scene, place);
    if (scale == 1) told.push_back(fmt::format("it is {:.3g} m across", largest));
    else
      told.push_back(fmt::format(
          "it is {:.4g} units across, which cannot be metres: scaled by {:g}", largest, scale));
  }

  void find_views() {
    World world(exhibit.scene);
    proposed = propose_views(world, WalkSettings{}.eye_height);
    for (const Viewpoint& view : proposed.views) exhibit.viewpoints.push_back({view, {}, {}});
    told.push_back(proposed.is_room ? "it is a room: visitors walk on its floor"
                                    : "it is seen from outside: visitors fly around it");
  }

  bool is_dark() const {
    World world(exhibit.scene);
    std::optional<float> exposure = measure_exposure(exhibit, world);
    return !exposure || *exposure > too_dark;
  }

  // The model's own light where it has enough, else a sky, else lamps.
  void find_light() {
    bool has_lamps = !exhibit.scene.lights.empty();
    if ((has_lamps || proposed.is_room) && has_light(exhibit.scene) && !is_dark()) {
      told.push_back("its own light is enough");
      manifest["environment"] = {{"radiance", {0, 0, 0}}};
      return;
    }
    add_sky(day, exhibit.scene);
    manifest["environment"]["sky"] = {{"elevation_deg", day.elevation},
                                      {"azimuth_deg", day.azimuth},
                                      {"turbidity", day.turbidity},
                                      {"strength", day.strength}};
    if (!is_dark()) {
      told.push_back("it has no lamps that light it: a sky was added");
      return;
    }
    add_lamps();
    told.push_back("it has no lamps and the sky does not come in: lamps were added (lamps.gltf)");
  }

  // One over each viewpoint, half way to the ceiling.
  void add_lamps() {
    World world(exhibit.scene);
    for (const Viewpoint& view : proposed.views) {
      vec3 eye = vec3(view.position - exhibit.scene.origin);
      Hit over = world.intersect({eye, 0, {0, 1, 0}});
      float up = over.valid() ? std::min(0.7f * over.t, 2.0f) : 1.0f;
      lamps.push_back(numbers(view.position + dvec3(0, double(up), 0)));
    }
    Bounds box = scene_bounds(exhibit.scene);
    float reach = 0.25f * glm::length(box.high - box.low);
    json file = {
        {"asset", {{"version", "2.0"}}}, {"extensionsUsed", {"KHR_lights_punctual"}}, {"scene", 0}};
    file["extensions"]["KHR_lights_punctual"]["lights"] = json::array(
        {{{"type", "point"}, {"intensity", round_to(double(lamp_light * reach * reach), 0.01)}}});
    for (size_t i = 0; i < lamps.size(); i++) {
      file["scenes"][0]["nodes"].push_back(i);
      file["nodes"].push_back({{"name", "Lamp " + std::to_string(i + 1)},
                               {"translation", lamps[i]},
                               {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }
    const std::string text = file.dump(2) + "\n";
    write_file((folder / "lamps.gltf").string(), text);
  }

  json viewpoints() const {
    json list = json::array();
    for (const Viewpoint& view : proposed.views) {
      std::string title = view.name;
      title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
      if (title.starts_with("View")) title.insert(4, " ");
      list.push_back({{"name", view.name},
                      {"title", {{"en", title}}},
                      {"position", numbers(view.position)},
                      {"yaw_deg", round_to(double(view.yaw) / one_degree, 0.1)},
                      {"pitch_deg", round_to(double(view.pitch) / one_degree, 0.1)},
                      {"fov_deg", round_to(double(view.fov) / one_degree, 0.1)}});
      if (view.roll != 0) list.back()["roll_deg"] = round_to(double(view.roll) / one_degree, 0.1);
    }
    return list;
  }

  // What moves plays by itself; of clips that pull at the same nodes the first.
  json animations() {
    json list = json::array();
    std::vector<const gltf::Clip*> played;
    for (const PlacedMotion& placed : exhibit.scene.motions)
      for (const gltf::Clip& clip : placed.of->clips) {
        const bool is_seen = std::ranges::any_of(
            placed.of->movers, [&](const Mover& one) { return moves(*placed.of, clip, one); });
        const bool pulls = std::ranges::any_of(
            played, [&](const gltf::Clip* other) { return shares_node(clip, *other); });
        if (!is_seen || pulls || gltf::length_of(clip) <= 0 || list.size() == most_animations)
          continue;
        played.push_back(&clip);
        list.push_back({{"id", fmt::format("animation-{}", list.size() + 1)},
                        {"clip", clip.name},
                        {"play", "loop"}});
      }
    if (!list.empty())
      told.push_back(fmt::format("{} of its animations {} by {}", list.size(),
                                 list.size() == 1 ? "plays" : "play",
                                 list.size() == 1 ? "itself" : "themselves"));
    return list;
  }

  void write() {
    Credit credit = load_credit(model);
    json all;
    std::error_code ec;
    if (fs::exists(folder.parent_path() / "exhibit.schema.json", ec))
      all["$schema"] = "../exhibit.schema.json";
    all["id"] = id;
    all["title"] = {{"en", credit.title.empty() ? id : credit.title}};
    all["languages"] = {"en"};
    if (lamps.empty()) {
      all["scene"] = file_name(model);
      if (scale != 1) all["scale"] = scale;
    } else {
      json placed = {{"file", file_name(model)}};
      if (scale != 1) placed["scale"] = scale;
      all["scenes"] = json::array({placed, {{"file", "lamps.gltf"}}});
    }
    all["environment"] = manifest["environment"];
    all["exposure"] = "auto";
    if (proposed.is_room) all["walk"] = {{"eye_height", 1.65}, {"speed", 1.4}, {"radius", 0.25}};
    all["start"] = proposed.views.front().name;
    all["viewpoints"] = viewpoints();
    if (json list = animations(); !list.empty()) all["animations"] = std::move(list);
    write_file((folder / "exhibit.json").string(), all.dump(2) + "\n");
  }
};

bool is_folder_name(const std::string& id) {
  return !id.empty() && id.size() <= 100 && id[0] != '.' &&
         std::all_of(id.begin(), id.end(), [](unsigned char c) {
           return std::isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

}  // namespace

NewExhibit make_new_exhibit(const std::string& content, const std::string& id,
                            const std::string& model) {
  const fs::path folder = fs::path(content) / id;
  if (!is_folder_name(id))
    throw LoadError(id, "", "an exhibit's id is of letters, digits, '-', '_' and '.'");
  std::error_code ec;
  if (fs::exists(folder, ec)) throw LoadError(folder.string(), "", "is there already");
  Maker maker{id, model, folder, {}, {}, 1, json::array(), {}, {}};
  maker.load();
  if (!fs::create_directories(folder, ec))
    throw LoadError(folder.string(), "", "cannot be made: " + ec.message());
  try {
    copy_model(model, folder);
    maker.find_views();
    maker.find_light();
    maker.write();
  } catch (...) {
    fs::remove_all(folder, ec);
    throw;
  }
  return {folder.string(), maker.told};
}

}  // namespace wellspring::show
