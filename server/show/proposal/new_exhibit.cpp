// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/new_exhibit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "base/write_file.h"
#include "show/check/check_scene.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"
#include "world/load/scene_join.h"
#include "world/load/scene_load.h"
#include "world/motion/scene_motion.h"
#include "world/sky.h"
#include "world/view.h"

namespace wellspring::show {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr float too_dark = 30;   // a larger exposure says that the light is not meant to be all
constexpr float lamp_light = 3;  // W/m^2 on a wall, for added lamps
constexpr double one_degree = 3.14159265358979323846 / 180;
// behind the left shoulder of a visitor who sees the front
constexpr SkySettings day{48, 155, 3, 0.2};

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

// Makes the exhibit, and holds it meanwhile.
struct Maker {
  const std::string id, model;
  const fs::path folder;
  Exhibit exhibit;
  ProposedViews proposed;
  double scale = 1;
  json lamps = json::array();  // places of added lamps
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

  // Keeps the model's own light if there is enough, else adds a sky, else lamps.
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

  // Adds a lamp over each viewpoint: 0.7 of the way to the ceiling, 2 m at most.
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

  // Lets animations play by themselves; of clips that pull at the same nodes, only the first.
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

std::string name_folder(const std::string& content, const std::string& id) {
  const fs::path folder = fs::path(content) / id;
  if (!is_folder_name(id))
    throw LoadError(id, "", "an exhibit's id is of letters, digits, '-', '_' and '.'");
  std::error_code ec;
  if (fs::exists(folder, ec)) throw LoadError(folder.string(), "", "is there already");
  return folder.string();
}

void fill_folder(const std::string& folder, const std::function<void()>& fill) {
  std::error_code ec;
  if (!fs::create_directories(folder, ec))
    throw LoadError(folder, "", "cannot be made: " + ec.message());
  try {
    fill();
  } catch (...) {
    fs::remove_all(folder, ec);
    throw;
  }
}

NewExhibit make_new_exhibit(const std::string& content, const std::string& id,
                            const std::string& model) {
  const std::string folder = name_folder(content, id);
  Maker maker{id, model, folder, {}, {}, 1, json::array(), {}, {}};
  maker.load();
  fill_folder(folder, [&] {
    copy_model(model, folder);
    maker.find_views();
    maker.find_light();
    maker.write();
  });
  return {folder, maker.told};
}

namespace {

constexpr float degree = pi / 180;
constexpr int grid = 14;    // places along either side of a room
constexpr int around = 12;  // directions tried at each place
constexpr float room_fov = 60 * degree, object_fov = 40 * degree;
constexpr float headroom = 0.15f;   // metres of free height over the eye
constexpr float elbow_room = 0.5f;  // metres of free space around the eye
constexpr float closed = 0.7f;      // share of the directions in which a room has walls
constexpr float least_room = 2.5f;  // metres from wall to wall
constexpr float farthest = 12;      // metres; seeing farther is not better
constexpr size_t most_views = 4;
constexpr int columns = 12, rows = 7;  // rays of a view

// Holds a place in a room and how good its best view is.
struct Stand {
  vec3 eye{0};
  float yaw = 0, worth = 0;
};

Hit look(const World& world, vec3 from, vec3 way) { return world.intersect({from, 1e-4f, way}); }

// Returns whether nothing is nearer than elbow room, and walls are nearly all around.
bool is_in_room(const World& world, vec3 eye) {
  constexpr int count = 48;
  int walls = 0;
  for (int i = 0; i < count; i++) {
    float y = 1 - 2 * (float(i) + 0.5f) / count, r = std::sqrt(1 - y * y);
    float turn = float(i) * pi * (3 - std::sqrt(5.0f));
    Hit hit = look(world, eye, {r * std::cos(turn), y, r * std::sin(turn)});
    if (!hit.valid()) continue;
    walls++;
    if (hit.t < elbow_room) return false;
  }
  std::string inside;
  return float(walls) > closed * count && !is_in_solid(world, eye, inside);
}

// Returns how much there is to see: far walls, many things, little emptiness.
float worth_of(const World& world, vec3 eye, float yaw) {
  View view = make_view(world.scene(), world.scene().origin + dvec3(eye), yaw, -4 * degree,
                        room_fov, columns, rows);
  float sum = 0;
  std::vector<uint32_t> seen;
  for (int i = 0; i < columns * rows; i++) {
    Hit hit = world.intersect(view_ray(view, float(i % columns) + 0.5f, float(i / columns) + 0.5f));
    if (!hit.valid()) continue;
    sum += std::log1p(std::min(hit.t, farthest));
    uint32_t object = world.object_of(hit.instance);
    if (std::find(seen.begin(), seen.end(), object) == seen.end()) seen.push_back(object);
  }
  return sum / (columns * rows) * (1 + 0.05f * float(std::min<size_t>(seen.size(), 12)));
}

// Adds eyes over every floor below (x, z) that leaves room for a visitor.
void find_stands(const World& world, vec3 from, float eye_height, std::vector<Stand>& stands) {
  vec3 place = from;
  for (int floors = 0; floors < 8; floors++) {
    Hit hit = look(world, place, {0, -1, 0});
    if (!hit.valid()) return;
    place.y -= hit.t;
    vec3 eye = place + vec3(0, eye_height, 0);
    Hit over = look(world, place + vec3(0, 0.01f, 0), {0, 1, 0});
    if (over.t > eye_height + headroom && is_in_room(world, eye)) {
      Stand stand{eye};
      for (int i = 0; i < around; i++) {
        float yaw = 2 * pi * float(i) / around, worth = worth_of(world, eye, yaw);
        if (worth > stand.worth) stand.yaw = yaw, stand.worth = worth;
      }
      stands.push_back(stand);
    }
    place.y -= 1e-3f;
  }
}

Viewpoint make_viewpoint(const World& world, std::string name, vec3 eye, float yaw, float pitch,
                         float fov) {
  Viewpoint view;
  view.name = std::move(name);
  view.position = world.scene().origin + dvec3(eye);
  view.yaw = yaw;
  view.pitch = pitch;
  view.fov = fov;
  return view;
}

std::vector<Viewpoint> propose_inside(const World& world, const Bounds& box, float eye_height) {
  const vec3 size = box.high - box.low;
  if (std::min(size.x, size.z) < least_room || size.y < eye_height) return {};
  std::vector<Stand> stands;
  for (int i = 0; i < grid * grid; i++) {
    vec2 at = (vec2(float(i % grid), float(i / grid)) + 0.5f) / float(grid);
    find_stands(world, {box.low.x + size.x * at.x, box.high.y + 0.1f, box.low.z + size.z * at.y},
                eye_height, stands);
  }
  if (stands.size() < 3) return {};
  // Chooses the best stand, then those that are good and far from the chosen ones, or look the
  // other way.
  std::vector<Stand> chosen;
  const float reach = glm::length(size);
  while (chosen.size() < most_views) {
    const Stand* best = nullptr;
    float most = 0;
    for (const Stand& stand : stands) {
      float apart = 1;
      for (const Stand& other : chosen) {
        float turned = 0.5f - 0.5f * std::cos(stand.yaw - other.yaw);
        apart = std::min(apart, glm::length(stand.eye - other.eye) / reach + 0.4f * turned);
      }
      if (!chosen.empty() && apart < 0.2f) continue;
      if (stand.worth * std::sqrt(apart) > most)
        best = &stand, most = stand.worth * std::sqrt(apart);
    }
    if (!best) break;
    chosen.push_back(*best);
  }
  if (chosen.size() < 2) return {};
  std::vector<Viewpoint> views;
  for (const Stand& stand : chosen)
    views.push_back(make_viewpoint(world, "view" + std::to_string(views.size() + 1), stand.eye,
                                   stand.yaw, -4 * degree, room_fov));
  return views;
}

std::vector<Viewpoint> propose_outside(const World& world, const Bounds& box) {
  struct Side {
    const char* name;
    float yaw, height;  // degrees from the front, and over the horizon
  };
  constexpr Side solid[] = {{"front", 24, 14},
                            {"right", 90, 10},
                            {"back", 204, 14},
                            {"left", -90, 10},
                            {"above", 35, 50}};
  constexpr Side flat[] = {{"front", 0, 0}, {"right", 40, 8}, {"left", -40, 8}};
  constexpr Side lying[] = {{"front", 20, 40}, {"back", 200, 40}, {"above", 0, 80}};
  const vec3 size = box.high - box.low, half = 0.5f * size;
  const float thin = 0.08f * max_component(size);
  const bool is_flat = std::min(size.x, size.z) < thin && size.y >= thin;
  const bool is_lying = size.y < thin && !is_flat;
  float front = is_flat && size.x < size.z ? 90.0f : 0.0f;
  std::span<const Side> sides = is_flat    ? std::span<const Side>(flat)
                                : is_lying ? std::span<const Side>(lying)
                                           : std::span<const Side>(solid);
  const float tan_y = std::tan(0.5f * object_fov);
  auto view_from = [&](const Side& side) {
    float yaw = (side.yaw + front) * degree, pitch = side.height * degree;
    vec3 back(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
    float distance = 1.08f * distance_to_fit(half, back, tan_y * 4 / 3, tan_y);
    return make_viewpoint(world, side.name, box.low + half + back * distance, yaw, -pitch,
                          object_fov);
  };
  if (is_flat && !sees_something(world, view_from(sides[0]))) front += 180;  // its front is there
  std::vector<Viewpoint> views, all;
  for (const Side& side : sides) {
    all.push_back(view_from(side));
    if (sees_something(world, all.back())) views.push_back(all.back());
  }
  return views.empty() ? all : views;
}

}  // namespace

ProposedViews propose_views(const World& world, float eye_height) {
  ProposedViews proposed;
  const Bounds box = scene_bounds(world.scene());
  proposed.views = propose_inside(world, box, eye_height);
  proposed.is_room = !proposed.views.empty();
  if (!proposed.is_room) proposed.views = propose_outside(world, box);
  return proposed;
}

}  // namespace wellspring::show
