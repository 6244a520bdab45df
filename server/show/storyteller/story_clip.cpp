// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/story_clip.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "light/technique/technique.h"
#include "show/moving/figure.h"
#include "show/storyteller/held_prop.h"
#include "world/view.h"

namespace wellspring::show {
namespace {

Material paint(const char* name, vec3 color, float roughness) {
  Material material;
  material.name = name;
  material.base_color = vec4(color, 1);
  material.metallic = 0;
  material.roughness = roughness;
  return material;
}

void add_instance(Scene& scene, Mesh mesh) {
  scene.instances.push_back({.mesh = int(scene.meshes.size())});
  scene.meshes.push_back(std::move(mesh));
}

// A strip of floor that bends up into a wall behind the figure.
Mesh make_sweep(float size) {
  Mesh mesh;
  mesh.name = "sweep";
  constexpr int bend = 24;
  float radius = 0.8f * size, back = -1.2f * size, half = 12 * size;
  std::vector<std::pair<vec2, vec2>> profile{{{9 * size, 0}, {0, 1}}};  // (z, y), normal
  for (int i = 0; i <= bend; i++) {
    float a = 0.5f * pi * float(i) / bend;
    profile.push_back(
        {{back - radius * std::sin(a), radius * (1 - std::cos(a))}, {std::sin(a), std::cos(a)}});
  }
  profile.push_back({{back - radius, 9 * size}, {1, 0}});
  for (auto [p, n] : profile)
    for (float x : {-half, half}) {
      mesh.positions.push_back({x, p.y, p.x});
      mesh.normals.push_back({0, n.y, n.x});
    }
  for (uint32_t i = 0; i + 1 < profile.size(); i++) {
    uint32_t a = 2 * i;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  return mesh;
}

// A square that emits light towards `at`.
void add_panel(Scene& scene, vec3 place, vec3 at, float side, vec3 radiance) {
  vec3 n = normalize(at - place), u = normalize(cross(vec3(0, 1, 0), n)), v = cross(n, u);
  Material light = paint("panel", vec3(0), 1);
  light.emission = radiance;
  Mesh mesh;
  mesh.name = "panel";
  mesh.material = int(scene.materials.size());
  scene.materials.push_back(light);
  for (vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
    mesh.positions.push_back(place + 0.5f * side * (c.x * u + c.y * v));
    mesh.normals.push_back(n);
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_instance(scene, std::move(mesh));
}

}  // namespace

Frame render_portrait(const Character& character, const Pose& pose, const PortraitShot& shot,
                      std::vector<std::string>& warnings) {
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  skin(character, pose, mat4(1), scratch, positions, normals);
  vec3 low(INFINITY), high(-INFINITY);
  for (vec3 p : positions) low = glm::min(low, p), high = glm::max(high, p);
  if (shot.exhibit && shot.held.prop >= 0) {
    const ExhibitProp& prop = shot.exhibit->props[size_t(shot.held.prop)];
    for (const Instance& instance : prop.scene.instances)
      for (vec3 p : prop.scene.meshes[size_t(instance.mesh)].positions) {
        p = vec3(shot.held.to_world * prop.to_fist * instance.to_world * vec4(p, 1));
        low = glm::min(low, p), high = glm::max(high, p);
      }
  }
  if (positions.empty()) low = vec3(-0.5f, 0, -0.5f), high = vec3(0.5f, 1.8f, 0.5f);
  float height = std::max({high.y - low.y, high.x - low.x, 0.05f});

  // The camera circles the figure; the lights keep their place before and behind it as seen from
  // there.
  vec3 centre = 0.5f * (low + high);
  float reach = 0.55f * height, fov = 0.42f;
  int skull = find_joint(character, "skullbase");
  if (shot.close && skull >= 0) {
    centre = vec3(scratch.joints[size_t(skull)] * vec4(character.joints[size_t(skull)].center, 1));
    centre += vec3(0, 0.030f, 0.03f) * (height / 1.7f);
    reach = 0.165f * height / 1.7f;
    fov = 0.30f;
  }
  float aspect = float(shot.width) / float(shot.height);
  float across = 0.55f * (high.x - low.x) / aspect;
  if (!shot.close) reach = std::max(reach, across);
  // The portrait scene stands where the figure is.
  vec3 middle(0.5f * (low.x + high.x), 0, 0.5f * (low.z + high.z));
  auto round = [&](vec3 v) { return glm::angleAxis(shot.turn, vec3(0, 1, 0)) * v; };
  vec3 eye = centre + round(vec3(0, 0.02f * height, reach / std::tan(0.5f * fov)));

  Scene scene;
  scene.objects = {""};
  scene.materials.push_back(paint("sweep", vec3(0.42f, 0.41f, 0.40f), 0.75f));
  Mesh sweep = make_sweep(height);
  for (vec3& p : sweep.positions) p = round(p + vec3(0, low.y, 0)) + middle;
  for (vec3& n : sweep.normals) n = round(n);
  add_instance(scene, std::move(sweep));
  float h = height;
  vec3 chest = middle + vec3(0, low.y + 0.75f * h, 0);
  auto panel = [&](vec3 at, float side, vec3 radiance) {
    add_panel(scene, round(at * h) + middle + vec3(0, low.y, 0), chest, side * h, radiance);
  };
  panel({-1.15f, 1.55f, 1.25f}, 0.8f, vec3(7.5f, 7.1f, 6.6f));  // key
  panel({1.5f, 1.1f, 1.0f}, 1.0f, vec3(1.4f, 1.5f, 1.7f));      // fill
  panel({1.0f, 1.7f, -0.9f}, 0.6f, vec3(6.0f, 6.0f, 6.2f));     // rim
  scene.environment.radiance = vec3(0.22f, 0.23f, 0.25f);

  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure = make_figure(character, scene, moving, objects);
  std::optional<Prop> prop;
  if (shot.exhibit && shot.held.prop >= 0) {
    prop = make_prop(shot.exhibit->props[size_t(shot.held.prop)], scene, moving, objects);
    DynamicLights lights;
    add_held_lights(*shot.exhibit, shot.held, 0, 0, lights);
    for (const DynamicLight& one : lights) scene.lights.push_back(one.light);
  }
  warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
  World world(scene, std::move(moving), std::move(objects));
  pose_figure(world, figure, character, pose, mat4(1), scratch);
  if (prop) pose_prop(world, *prop, pose_of(*shot.exhibit, shot.held, shot.held.prop, 0));
  world.commit();
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, dvec3(eye), dvec3(centre), vec3(0, 1, 0), fov, shot.width,
                                shot.height);
  StillSettings settings;
  settings.spp = shot.spp;
  settings.transport.clamp = 8;
  return render_still(*find_technique("path"), world, lights, view, settings);
}

}  // namespace wellspring::show

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace wellspring::show {
namespace {

constexpr int gap = 4;

// stb's letters are ASCII; what else there is becomes a question mark.
std::string plain(const std::string& text) {
  std::string result;
  for (char c : text.substr(0, 200)) result += c >= ' ' && c < 127 ? c : '?';
  return result;
}

}  // namespace

int text_width(const std::string& text, int scale) {
  std::string letters = plain(text);
  return stb_easy_font_width(letters.data()) * scale;
}

void draw_text(Frame& frame, const std::string& text, int x, int y, int scale, vec3 color) {
  struct Corner {
    float x, y, z;
    unsigned char color[4];
  };
  std::string letters = plain(text);
  std::vector<Corner> corners(letters.size() * 80 + 4);  // at most 20 strokes a letter
  int count = stb_easy_font_print(0, 0, letters.data(), nullptr, corners.data(),
                                  int(corners.size() * sizeof(Corner)));
  for (int q = 0; q < count; q++) {  // each stroke is an upright rectangle
    const Corner &a = corners[size_t(q) * 4], &b = corners[size_t(q) * 4 + 2];
    int left = std::max(x + int(a.x) * scale, 0),
        right = std::min(x + int(b.x) * scale, frame.width);
    int top = std::max(y + int(a.y) * scale, 0),
        bottom = std::min(y + int(b.y) * scale, frame.height);
    for (int row = top; row < bottom; row++)
      for (int column = left; column < right; column++)
        frame.color[size_t(row) * size_t(frame.width) + size_t(column)] = color;
  }
}

Frame render_sheet(const Character& character, const std::vector<SheetCell>& cells,
                   const PortraitShot& shot, int columns, std::vector<std::string>& warnings) {
  Frame sheet;
  if (cells.empty()) return sheet;
  if (columns <= 0)
    columns =
        int(std::ceil(std::sqrt(double(cells.size()) * shot.height / std::max(shot.width, 1))));
  columns = std::clamp(columns, 1, int(cells.size()));
  int rows = (int(cells.size()) + columns - 1) / columns;
  int scale = std::max(shot.width / 180, 1), strip = 12 * scale;
  sheet.width = columns * (shot.width + gap) + gap;
  sheet.height = rows * (shot.height + strip + gap) + gap;
  sheet.color.assign(size_t(sheet.width) * size_t(sheet.height), vec3(0.02f));
  for (size_t i = 0; i < cells.size(); i++) {
    std::vector<std::string> said;
    Frame picture = render_portrait(character, cells[i].pose, shot, said);
    if (i == 0) warnings.insert(warnings.end(), said.begin(), said.end());
    int left = gap + int(i) % columns * (shot.width + gap);
    int top = gap + int(i) / columns * (shot.height + strip + gap);
    for (int row = 0; row < shot.height; row++)
      std::copy_n(picture.color.begin() + ptrdiff_t(row) * shot.width, shot.width,
                  sheet.color.begin() + ptrdiff_t(top + row) * sheet.width + left);
    int middle = left + (shot.width - text_width(cells[i].label, scale)) / 2;
    draw_text(sheet, cells[i].label, std::max(middle, left), top + shot.height + 3 * scale, scale,
              vec3(0.8f));
  }
  return sheet;
}

std::vector<StoryMoment> act_story(const Exhibit& exhibit, const Character& character,
                                   const mat4& placement, const StoryText& story,
                                   const std::vector<std::shared_ptr<const Speech>>& spoken,
                                   const ClipSettings& settings) {
  Storyteller storyteller{&character, placement};
  StorytellerState state;
  StorytellerEvents events;
  Voice voice;
  tell(voice, story);
  AskSpeech ask = [&](const Utterance&) {
    size_t line = size_t(voice.sentence);
    return SpeechState{line < spoken.size() ? spoken[line] : nullptr, false, settings.lang};
  };
  StorytellerInput input;
  input.humanlike = settings.humanlike;
  input.guests = {{1, vec3(placement * vec4(settings.guest, 1)), vec3(0), true}};
  // She has stood there for a while, has seen who is there and has greeted.
  Pose pose = make_rest_pose(character);
  for (int i = 0; i < 150; i++) {
    input.dt = 1.0f / 30;
    input.time += double(input.dt);
    tick_storyteller(state, storyteller, input, pose, events);
  }
  std::vector<StoryMoment> moments;
  const double step = 1 / std::clamp(settings.fps, 1.0, 240.0);
  for (double time = 0; time < settings.seconds && !voice.queue.empty(); time += step) {
    VoiceEvents said = advance_voice(voice, time == 0 ? 0 : float(step), ask);
    input.dt = float(step);
    input.time += step;
    input.telling = !voice.story.empty();
    input.speaking = speaking(voice);
    input.visemes.reset();
    if (heard(voice)) input.visemes = mouth_shape(voice);
    input.story = make_cue(exhibit, voice, said);
    tick_storyteller(state, storyteller, input, pose, events);
    moments.push_back({time, double(voice.elapsed), voice.sentence, pose});
  }
  return moments;
}

}  // namespace wellspring::show
