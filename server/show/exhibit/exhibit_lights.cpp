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
#include "show/exhibit/exhibit_spectra.h"
#include "world/load/lamp.h"

namespace wellspring::show {

void read_lamps(Exhibit& exhibit, FieldReader& root) {
  root.parts("lamps", most_lamps, "what visitors switch", [&](FieldReader& fields) {
    ExhibitLamp lamp;
    if (fields.text("id", lamp.id, "", Need::required) && find_lamp(exhibit, lamp.id) >= 0)
      fields.fail("id", "'" + lamp.id + "' is taken by another lamp");
    lamp.title = read_local_text(fields, "title", "", Need::required);
    for (const std::string& lang : exhibit.languages)
      if (!lamp.title.empty() && !lamp.title.contains(lang))
        fields.warn("title", "has nothing in '" + lang + "'");
    fields.boolean("on", lamp.on, "at first");
    fields.boolean("shared", lamp.shared, "who switches it does so for everybody");
    LampNames names{lamp.id, read_texts(fields, "nodes", "lights and things of the scene"),
                    read_texts(fields, "materials", "all that is made of them")};
    if (names.nodes.empty() && names.materials.empty())
      fields.fail("names neither \"nodes\" nor \"materials\" of the scene");
    const bool loaded = !exhibit.scene.objects.empty();  // else every name would be missed
    for (const LampFault& fault : add_lamp(names, exhibit.scene))
      if (loaded)
        fields.fail((fault.is_material ? "materials/" : "nodes/") + std::to_string(fault.index),
                    fault.what);
    read_lamp_light(exhibit, fields, lamp, int(exhibit.scene.lamps.size()) - 1);
    exhibit.lamps.push_back(std::move(lamp));
  });
}

std::vector<LampSwitch> first_lamps(const Exhibit& exhibit) {
  std::vector<LampSwitch> on;
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

vec3 read_direction(FieldReader& fields, Need need, vec3 otherwise) {
  dvec3 given(otherwise);
  fields.vector("direction", most_metres, given, "where it shines to", need);
  if (glm::length(given) > 1e-6) return vec3(glm::normalize(given));
  fields.fail("direction", "must not be zero");
  return otherwise;
}

// Reads a place in the file's coordinates.
void read_place(const Exhibit& exhibit, FieldReader& fields, Need need, vec3& place) {
  dvec3 given;
  if (fields.vector("position", most_metres, given, "", need))
    place = vec3(given - exhibit.scene.origin);
}

// A light that the scene does not have.
PunctualLight read_new_light(const Exhibit& exhibit, FieldReader& fields) {
  // A schema has the fields of all types, and needs none of them.
  const bool all = fields.describes();
  const Need need = all ? Need::optional : Need::required;
  PunctualLight light;
  fields.choice("type", {"point", "spot", "sun"}, light.type, "of a new light", need);
  if (all || has_place(light)) read_place(exhibit, fields, need, light.position);
  if (all || has_direction(light)) light.direction = read_direction(fields, need, light.direction);
  vec3 color(1);
  fields.vector("color", most_metres, color);
  for (int i = 0; i < 3; i++)
    if (color[i] < 0) fields.fail("color/" + std::to_string(i), "must not be below 0");
  float strength = 1;
  if (all || has_place(light))
    fields.number("candela", 0, most_candela, strength, "of a point or a spot", need);
  if (all || !has_place(light)) fields.number("lux", 0, most_candela, strength, "of a sun", need);
  light.intensity = glm::max(color, vec3(0)) * strength;
  if (all || has_place(light))
    fields.number("reach", 0.1, 1000, light.range, "metres at which it has faded to nothing");
  if (!all && light.type != PunctualType::spot) return light;
  light.outer_cone = glm::radians(45.0f);
  fields.degrees("outer_cone_deg", 1, 90, light.outer_cone, "of a spot");
  light.inner_cone = light.outer_cone / 2;
  fields.degrees("inner_cone_deg", 0, 90, light.inner_cone, "of a spot");
  if (light.inner_cone > light.outer_cone)
    fields.fail("inner_cone_deg", "is wider than the outer cone");
  return light;
}

// Reads a key. A value that it leaves out is as in the one before, in the first as in the light
// itself.
void read_key(const Exhibit& exhibit, ChangingLight& light, FieldReader& fields) {
  const bool first = light.track.empty();
  TrackKey key{0, light.light.position, light.light.direction, 1};
  if (!first) key = light.track.back();
  const double before = key.time;
  const vec3 looked = key.direction;
  key.time = 0;
  fields.number("time", 0, longest_track, key.time, "seconds", Need::required);
  if (first && key.time != 0) fields.fail("time", "of the first entry must be 0");
  if (!first && key.time < before + least_between * (1 - 1e-9))
    fields.fail("time", fmt::format("must be at least {} s after the entry before", least_between));
  if (fields.describes() || has_place(light.light))
    read_place(exhibit, fields, Need::optional, key.position);
  if (fields.describes() || has_direction(light.light))
    key.direction = read_direction(fields, Need::optional, key.direction);
  if (!first && dot(key.direction, looked) < widest_turn)
    fields.fail("direction", "turns by more than 120 degrees: an entry in between says which way");
  fields.number("intensity", 0, 1000, key.intensity, "a factor");
  light.track.push_back(key);
}

bool is_same(const TrackKey& a, const TrackKey& b) {
  return glm::length(a.position - b.position) < same_place &&
         glm::length(a.direction - b.direction) < same_place && a.intensity == b.intensity;
}

void read_track(const Exhibit& exhibit, ChangingLight& light, FieldReader& fields) {
  fields.parts("track", most_track_keys, "at least two entries",
               [&](FieldReader& key) { read_key(exhibit, light, key); });
  fields.boolean("loop", light.loop, "the track begins again at its end");
  std::vector<TrackKey>& track = light.track;
  if (fields.has("track") && track.size() < 2)
    fields.fail("track", "must have at least two entries");
  if (track.size() >= 2 && light.loop && !is_same(track.front(), track.back()))
    fields.fail("track",
                "ends otherwise than it begins, so the light would jump: give the last entry "
                "the values of the first, or say \"loop\": false");
  const bool dims = std::ranges::any_of(
      track, [&](const TrackKey& key) { return key.intensity != track.front().intensity; });
  if (dims && light.flicker.depth > 0)
    fields.fail("flicker", "is there beside an intensity that changes on the track: one of them");
}

// Finds the scene's light of that name; false: there is none to go on with.
bool find_light(const Exhibit& exhibit, ChangingLight& light, FieldReader& fields) {
  fields.text("node", light.name, "a light of the scene",
              fields.describes() ? Need::optional : Need::required);
  if (light.name.empty() || exhibit.scene.objects.empty()) return false;  // nothing was loaded
  std::string fault;
  const std::vector<int> found = find_lights(exhibit.scene, light.name, fault);
  if (found.size() > 1) fault = "'" + light.name + "' means several lights: name one of them";
  for (const ChangingLight& other : exhibit.lights)
    if (!found.empty() && other.of_scene == found.front())
      fault = "'" + light.name + "' is another entry's light already";
  if (!fault.empty()) {
    fields.fail("node", fault);
    return false;
  }
  light.of_scene = found.front();
  light.light = exhibit.scene.lights[size_t(light.of_scene)];
  light.lamp = lamp_of_light(exhibit.scene, light.of_scene);
  return true;
}

// Reads a light that the scene does not have, and the lamp that switches it.
void read_own_light(const Exhibit& exhibit, ChangingLight& light, FieldReader& fields) {
  if (fields.has("node"))
    fields.fail("node", "is there beside a \"type\", which makes a light of its own");
  fields.take("node");
  fields.text("name", light.name, "of a new light",
              fields.describes() ? Need::optional : Need::required);
  light.light = read_new_light(exhibit, fields);
  light.light.name = light.name;
  std::string lamp;
  fields.text("lamp", lamp, "id of the lamp that switches a new light");
  if (lamp.empty()) return;
  light.lamp = find_lamp(exhibit, lamp);
  if (light.lamp < 0) fields.fail("lamp", "there is no lamp '" + lamp + "'");
}

void read_light(Exhibit& exhibit, FieldReader& fields) {
  ChangingLight light;
  fields.describe_choice({{"node"}, {"type", "name"}});
  const bool all = fields.describes();
  const bool own = all || fields.has("type");
  const bool found = (!all && own) || find_light(exhibit, light, fields);
  if (own) read_own_light(exhibit, light, fields);
  for (const ChangingLight& other : exhibit.lights)
    if (found && !light.name.empty() && other.name == light.name)
      fields.fail("name", "'" + light.name + "' is taken by another light");
  light.flicker = read_flicker(fields);
  read_track(exhibit, light, fields);
  if (!fields.has("flicker") && !fields.has("track"))
    fields.fail(
        "has neither \"flicker\" nor \"track\": a light that stays as it is belongs "
        "into the scene");
  if (found) exhibit.lights.push_back(std::move(light));
}

// The scene's sun of that name, if it can be the day's; -1: it cannot.
int find_sun(const Exhibit& exhibit, const std::string& name, int lamp, FieldReader& fields) {
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
  fields.fail("sun", fault);
  return -1;
}

void read_day_fields(Exhibit& exhibit, FieldReader& fields) {
  DaySettings settings;
  fields.number("at", 0, 24, settings.at, "the hour at which the scene has it so", Need::required);
  fields.number("from", 0, 24, settings.from, "the first hour that can be chosen");
  fields.number("to", 0, 24, settings.to, "the last hour that can be chosen");
  fields.number("latitude_deg", -66, 66, settings.latitude);
  if (!(settings.from < settings.to)) fields.fail("to", "must be later than \"from\"");
  else if (settings.at < settings.from || settings.at > settings.to)
    fields.fail("at", "must lie between \"from\" and \"to\"");
  std::string name, sun;
  fields.text("lamp", name, "id of the lamp that is daylight", Need::required);
  fields.text("sun", sun, "node of the scene's sun, a part of that lamp", Need::required);
  const int lamp = find_lamp(exhibit, name);
  if (lamp < 0 && !name.empty()) fields.fail("lamp", "there is no lamp '" + name + "'");
  if (lamp < 0 || sun.empty() || exhibit.scene.objects.empty()) return;
  const int light = find_sun(exhibit, sun, lamp, fields);
  if (light < 0) return;
  const std::string problem = day_problem(settings, exhibit.scene.lights[size_t(light)]);
  if (!problem.empty()) return fields.fail(problem);
  set_day(settings, lamp, light, exhibit);
}

}  // namespace

void read_day(Exhibit& exhibit, FieldReader& root) {
  root.part("day", "visitors may choose the hour of the day",
            [&](FieldReader& fields) { read_day_fields(exhibit, fields); });
}

void set_day(const DaySettings& settings, int lamp, int light, Exhibit& exhibit) {
  Scene& scene = exhibit.scene;
  exhibit.day = make_day(settings, scene.lights[size_t(light)]);
  exhibit.day->lamp = lamp;
  exhibit.day->sun_lamp = int(scene.lamps.size());
  std::erase(scene.lamps[size_t(lamp)].lights, light);
  scene.lamps.push_back({scene.lamps[size_t(lamp)].name + ": sun", {light}, {}});
}

Flicker read_flicker(FieldReader& fields) {
  Flicker flicker;
  fields.part("flicker", "brightness that rises and falls at random", [&](FieldReader& said) {
    flicker = {.depth = 0.3f, .hz = 4};
    said.number("depth", 0, 1, flicker.depth, "up to how much of it");
    said.number("hz", 0.1, most_turns, flicker.hz, "times a second");
  });
  return flicker;
}

void read_lights(Exhibit& exhibit, FieldReader& root) {
  root.parts("lights", most_changing_lights,
             "lights that flicker or move: of the scene (node), or new ones (type)",
             [&](FieldReader& fields) { read_light(exhibit, fields); });
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
