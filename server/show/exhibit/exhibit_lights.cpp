// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_lights.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/worker.h"
#include "light/kept/lamps.h"
#include "light/technique/technique.h"
#include "light/visible/guides.h"
#include "world/load/lamp.h"

namespace wellspring::show {

void read_lamps(Exhibit& exhibit, Fields& root) {
  root.objects("lamps", false, [&](Fields fields) {
    ExhibitLamp lamp;
    lamp.id = fields.text("id", true);
    if (!lamp.id.empty() && find_lamp(exhibit, lamp.id) >= 0)
      fields.problem("id", "'" + lamp.id + "' is taken by another lamp");
    lamp.title = fields.local_text("title", true);
    for (const std::string& lang : exhibit.languages)
      if (!lamp.title.empty() && !lamp.title.contains(lang))
        fields.problem("title", "has nothing in '" + lang + "'", false);
    lamp.on = fields.flag("on", true);
    lamp.shared = fields.flag("shared", false);
    LampNames names{lamp.id, fields.texts("nodes"), fields.texts("materials")};
    if (names.nodes.empty() && names.materials.empty())
      fields.problem("", "names neither \"nodes\" nor \"materials\" of the scene");
    fields.finish();
    if (exhibit.lamps.size() == most_lamps) {
      fields.problem(
          "", "is one more than the " + std::to_string(most_lamps) + " lamps an exhibit may have");
      return;
    }
    const bool loaded = !exhibit.scene.objects.empty();  // else every name would be missed
    for (const LampFault& fault : add_lamp(names, exhibit.scene))
      if (loaded)
        fields.problem((fault.is_material ? "materials/" : "nodes/") + std::to_string(fault.index),
                       fault.what);
    exhibit.lamps.push_back(std::move(lamp));
  });
}

std::vector<char> first_lamps(const Exhibit& exhibit) {
  std::vector<char> on;
  for (const ExhibitLamp& lamp : exhibit.lamps) on.push_back(lamp.on);
  return on;
}

LampLevels first_levels(const Exhibit& exhibit) {
  return lamp_levels(exhibit.day, first_lamps(exhibit), {});
}

namespace {

constexpr double most_candela = 1e6, longest_track = 3600;
constexpr float widest_turn = -0.5f;              // cosine of 120 degrees, from a key to the next
constexpr float same_place = 1e-3f;               // metres, or of a unit vector
constexpr double least_between = 1 / most_turns;  // seconds

bool has_place(const PunctualLight& light) { return light.type != PunctualType::directional; }
bool has_direction(const PunctualLight& light) { return light.type != PunctualType::point; }

vec3 read_direction(Fields& fields, bool required, vec3 otherwise) {
  const dvec3 given = fields.triple("direction", required, dvec3(otherwise));
  if (glm::length(given) > 1e-6) return vec3(glm::normalize(given));
  fields.problem("direction", "must not be zero");
  return otherwise;
}

// A light that the scene does not have.
PunctualLight read_new_light(const Exhibit& exhibit, Fields& fields) {
  PunctualLight light;
  const std::string type = fields.text("type", true);
  if (type == "spot") light.type = PunctualType::spot;
  else if (type == "sun") light.type = PunctualType::directional;
  else if (type != "point" && !type.empty())
    fields.problem("type", "'" + type + "' is none of point, spot and sun");
  if (has_place(light))
    light.position = vec3(fields.triple("position", true) - exhibit.scene.origin);
  if (has_direction(light)) light.direction = read_direction(fields, true, light.direction);
  const dvec3 color = fields.triple("color", false, dvec3(1));
  for (int i = 0; i < 3; i++)
    if (color[i] < 0) fields.problem("color/" + std::to_string(i), "must not be below 0");
  light.intensity =
      vec3(glm::max(color, dvec3(0))) *
      float(fields.number(has_place(light) ? "candela" : "lux", true, 1, 0, most_candela));
  if (has_place(light) && fields.has("reach"))
    light.range = float(fields.number("reach", false, 10, 0.1, 1000));
  if (light.type != PunctualType::spot) return light;
  light.outer_cone = float(glm::radians(fields.number("outer_cone_deg", false, 45, 1, 90)));
  const double inner = glm::degrees(double(light.outer_cone)) / 2;
  light.inner_cone = float(glm::radians(fields.number("inner_cone_deg", false, inner, 0, 90)));
  if (light.inner_cone > light.outer_cone)
    fields.problem("inner_cone_deg", "is wider than the outer cone");
  return light;
}

// Reads a key. A value that it leaves out is as in the one before, in the first as in the light
// itself.
void read_key(const Exhibit& exhibit, ChangingLight& light, Fields fields) {
  const bool first = light.track.empty();
  TrackKey key{0, light.light.position, light.light.direction, 1};
  if (!first) key = light.track.back();
  const double before = key.time;
  const vec3 looked = key.direction;
  key.time = fields.number("time", true, 0, 0, longest_track);
  if (first && key.time != 0) fields.problem("time", "of the first entry must be 0");
  if (!first && key.time < before + least_between * (1 - 1e-9))
    fields.problem("time",
                   fmt::format("must be at least {} s after the entry before", least_between));
  if (has_place(light.light))
    key.position =
        vec3(fields.triple("position", false, dvec3(key.position) + exhibit.scene.origin) -
             exhibit.scene.origin);
  if (has_direction(light.light)) key.direction = read_direction(fields, false, key.direction);
  if (!first && dot(key.direction, looked) < widest_turn)
    fields.problem("direction",
                   "turns by more than 120 degrees: an entry in between says which way");
  key.intensity = float(fields.number("intensity", false, double(key.intensity), 0, 1000));
  fields.finish();
  light.track.push_back(key);
}

bool is_same(const TrackKey& a, const TrackKey& b) {
  return glm::length(a.position - b.position) < same_place &&
         glm::length(a.direction - b.direction) < same_place && a.intensity == b.intensity;
}

void read_track(const Exhibit& exhibit, ChangingLight& light, Fields& fields) {
  fields.objects("track", false, [&](Fields key) { read_key(exhibit, light, std::move(key)); });
  light.loop = fields.flag("loop", true);
  std::vector<TrackKey>& track = light.track;
  if (fields.has("track") && track.size() < 2)
    fields.problem("track", "must have at least two entries");
  if (track.size() > most_track_keys)
    fields.problem("track", fmt::format("has more than {} entries", most_track_keys));
  if (track.size() >= 2 && light.loop && !is_same(track.front(), track.back()))
    fields.problem("track",
                   "ends otherwise than it begins, so the light would jump: give the last entry "
                   "the values of the first, or say \"loop\": false");
  const bool dims = std::ranges::any_of(
      track, [&](const TrackKey& key) { return key.intensity != track.front().intensity; });
  if (dims && light.flicker.depth > 0)
    fields.problem("flicker",
                   "is there beside an intensity that changes on the track: one of them");
}

// The scene's light of that name; false: there is none to go on with.
bool find_light(const Exhibit& exhibit, ChangingLight& light, Fields& fields) {
  light.name = fields.text("node", true);
  if (light.name.empty() || exhibit.scene.objects.empty()) return false;  // nothing was loaded
  std::string fault;
  const std::vector<int> found = find_lights(exhibit.scene, light.name, fault);
  if (found.size() > 1) fault = "'" + light.name + "' means several lights: name one of them";
  for (const ChangingLight& other : exhibit.lights)
    if (!found.empty() && other.of_scene == found.front())
      fault = "'" + light.name + "' is another entry's light already";
  if (!fault.empty()) {
    fields.problem("node", fault);
    return false;
  }
  light.of_scene = found.front();
  light.light = exhibit.scene.lights[size_t(light.of_scene)];
  light.lamp = lamp_of_light(exhibit.scene, light.of_scene);
  return true;
}

void read_light(Exhibit& exhibit, Fields fields) {
  ChangingLight light;
  if (fields.has("type")) {
    if (fields.has("node"))
      fields.problem("node", "is there beside a \"type\", which makes a light of its own");
    fields.value("node");
    light.name = fields.text("name", true);
    light.light = read_new_light(exhibit, fields);
    light.light.name = light.name;
    if (const std::string lamp = fields.text("lamp", false); !lamp.empty()) {
      light.lamp = find_lamp(exhibit, lamp);
      if (light.lamp < 0) fields.problem("lamp", "there is no lamp '" + lamp + "'");
    }
  } else if (!find_light(exhibit, light, fields)) {
    return;
  }
  for (const ChangingLight& other : exhibit.lights)
    if (!light.name.empty() && other.name == light.name)
      fields.problem("name", "'" + light.name + "' is taken by another light");
  light.flicker = read_flicker(fields);
  read_track(exhibit, light, fields);
  if (!fields.has("flicker") && !fields.has("track"))
    fields.problem("",
                   "has neither \"flicker\" nor \"track\": a light that stays as it is belongs "
                   "into the scene");
  fields.finish();
  exhibit.lights.push_back(std::move(light));
}

// The scene's sun of that name, if it can be the day's; -1: it cannot.
int find_sun(const Exhibit& exhibit, const std::string& name, int lamp, Fields& fields) {
  std::string fault;
  const std::vector<int> found = find_lights(exhibit.scene, name, fault);
  if (fault.empty()) {
    const int light = found.front(), owner = lamp_of_light(exhibit.scene, light);
    if (found.size() > 1) fault = "'" + name + "' means several lights: name one of them";
    else if (has_place(exhibit.scene.lights[size_t(light)])) fault = "'" + name + "' is no sun";
    else if (owner >= 0 && owner != lamp)
      fault =
          "'" + name + "' belongs to the lamp '" + exhibit.scene.lamps[size_t(owner)].name + "'";
    else if (std::ranges::any_of(exhibit.lights, [&](const ChangingLight& other) {
               return other.of_scene == light;
             }))
      fault = "'" + name + "' is one of \"lights\" already";
    if (fault.empty()) return light;
  }
  fields.problem("sun", fault);
  return -1;
}

void read_day_fields(Exhibit& exhibit, Fields fields) {
  DaySettings settings;
  settings.at = fields.number("at", true, settings.at, 0, 24);
  settings.from = fields.number("from", false, settings.from, 0, 24);
  settings.to = fields.number("to", false, settings.to, 0, 24);
  settings.latitude = fields.number("latitude_deg", false, settings.latitude, -66, 66);
  if (!(settings.from < settings.to)) fields.problem("to", "must be later than \"from\"");
  else if (settings.at < settings.from || settings.at > settings.to)
    fields.problem("at", "must lie between \"from\" and \"to\"");
  const std::string name = fields.text("lamp", true), sun = fields.text("sun", true);
  const int lamp = find_lamp(exhibit, name);
  if (lamp < 0 && !name.empty()) fields.problem("lamp", "there is no lamp '" + name + "'");
  fields.finish();
  if (lamp < 0 || sun.empty() || exhibit.scene.objects.empty()) return;
  const int light = find_sun(exhibit, sun, lamp, fields);
  if (light < 0) return;
  const std::string problem = day_problem(settings, exhibit.scene.lights[size_t(light)]);
  if (!problem.empty()) return fields.problem("", problem);
  set_day(settings, lamp, light, exhibit);
}

}  // namespace

void read_day(Exhibit& exhibit, Fields& root) {
  root.object("day", false, [&](Fields fields) { read_day_fields(exhibit, std::move(fields)); });
}

void set_day(const DaySettings& settings, int lamp, int light, Exhibit& exhibit) {
  Scene& scene = exhibit.scene;
  exhibit.day = make_day(settings, scene.lights[size_t(light)]);
  exhibit.day->lamp = lamp;
  exhibit.day->sun_lamp = int(scene.lamps.size());
  std::erase(scene.lamps[size_t(lamp)].lights, light);
  scene.lamps.push_back({scene.lamps[size_t(lamp)].name + ": sun", {light}, {}});
}

Flicker read_flicker(Fields& fields) {
  Flicker flicker;
  fields.object("flicker", false, [&](Fields said) {
    flicker.depth = float(said.number("depth", false, 0.3, 0, 1));
    flicker.hz = float(said.number("hz", false, 4, 0.1, most_turns));
    said.finish();
  });
  return flicker;
}

void read_lights(Exhibit& exhibit, Fields& root) {
  root.objects("lights", false, [&](Fields fields) { read_light(exhibit, std::move(fields)); });
  if (exhibit.lights.size() > most_changing_lights)
    root.problem("lights", fmt::format("are more than {}", most_changing_lights));
}

void take_lights(Exhibit& exhibit) {
  std::vector<int> taken;
  for (ChangingLight& light : exhibit.lights)
    if (light.of_scene >= 0) taken.push_back(std::exchange(light.of_scene, -1));
  if (!taken.empty()) remove_lights(taken, exhibit.scene);
  exhibit.scene.dynamic_lights = int(exhibit.lights.size()) + (exhibit.day ? 1 : 0);
}

void put_lights(const std::vector<ChangingLight>& lights, double time, Scene& scene) {
  for (const ChangingLight& light : lights) {
    if (light.lamp >= 0) scene.lamps[size_t(light.lamp)].lights.push_back(int(scene.lights.size()));
    scene.lights.push_back(eval_light(light, time));
  }
}

void put_sun(const Day& day, double hour, Scene& scene) {
  Lamp& lamp = scene.lamps[size_t(day.sun_lamp)];
  scene.lights[size_t(lamp.lights.front())] = eval_sun(day, hour);
}

namespace {

constexpr int width = 48, height = 27, samples = 16, bounces = 6;
constexpr size_t most_viewpoints = 16;
constexpr float least_albedo = 0.04f;  // darker surfaces tell little about the light
constexpr float well_lit = 0.55f;      // mean light of a room that looks right, white wall: 1
constexpr float brightest = 2.5f;      // the lightest tenth of a picture is at most so bright
constexpr float least = 1e-6f, most = 1e6f;

// Exposure of one picture: the geometric mean of the light on what is seen, but not so much that a
// tenth of it is white.
std::optional<float> exposure_of(const Frame& frame, const GuidePlanes& guides) {
  std::vector<float> lights;
  double sum = 0;
  for (size_t i = 0; i < frame.color.size(); i++) {
    if (frame.object[i] == 0) continue;  // the sky
    float light = luminance(frame.color[i]) / std::max(luminance(guides.albedo[i]), least_albedo);
    if (!(light > 0) || !std::isfinite(light)) continue;
    lights.push_back(light);
    sum += std::log(double(light));
  }
  if (lights.empty()) return {};
  float mean = float(std::exp(sum / double(lights.size())));
  auto tenth = lights.begin() + std::ptrdiff_t(lights.size() * 9 / 10);
  std::nth_element(lights.begin(), tenth, lights.end());
  return std::min(well_lit / mean, brightest / *tenth);
}

}  // namespace

std::optional<float> measure_exposure(const Exhibit& exhibit, World& world) {
  const Lights all = make_lights(world);  // while all lamps are full
  const LampLevels levels = first_levels(exhibit);
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), levels[i]);
  const Lights lights = levels.empty() ? all : relit(all, world);
  StillSettings settings;
  settings.spp = samples;
  settings.transport.max_depth = bounces;
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < std::min(exhibit.viewpoints.size(), most_viewpoints); i++) {
    check_cancelled();
    const Viewpoint& at = exhibit.viewpoints[i].view;
    View view = make_view(exhibit.scene, at, width, height);
    Frame frame = render_still(*find_technique("path"), world, lights, view, settings);
    std::optional<float> exposure = exposure_of(frame, make_guides(world, lights, view, 4));
    if (exposure) sum += std::log(double(*exposure)), count++;
  }
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), lamp_full);
  if (count == 0) return {};
  return std::clamp(float(std::exp(sum / count)), least, most);
}

float measure_exposure(const Exhibit& exhibit) {
  World world(exhibit.scene);
  return measure_exposure(exhibit, world).value_or(1.0f);
}

}  // namespace wellspring::show
