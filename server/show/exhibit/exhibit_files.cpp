// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_files.h"

#include <optional>

#include "base/load_error.h"
#include "show/exhibit/package_file.h"
#include "world/load/scene_join.h"
#include "world/load/scene_load.h"
#include "world/sky.h"

namespace wellspring::show {
namespace {

constexpr double one_degree = 3.14159265358979323846 / 180;
constexpr double least_scale = 1e-6, most_scale = 1e6;

// The scene of the file that `field` names; nothing where it cannot be read, which is told.
std::optional<Scene> read_file(Exhibit& exhibit, Fields& fields, const char* field,
                               std::vector<Problem>& problems) {
  std::string name = fields.text(field, true);
  std::string path = package_file(fields, field, exhibit.folder, name);
  if (path.empty()) return {};
  try {
    SceneLoadOptions options;
    options.package = exhibit.folder;
    options.motion = true;
    Scene scene = load_scene(path, options);
    for (const std::string& warning : scene.warnings)
      problems.push_back({path, "", warning, false});
    Credit credit = load_credit(path, exhibit.folder);
    credit.file = name;
    if (!credit.empty()) exhibit.credits.push_back(credit);
    return scene;
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
    return {};
  }
}

// All files or none: names would be missed that are in one that cannot be read.
void read_files(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems) {
  if (!root.has("scenes")) {
    if (auto scene = read_file(exhibit, root, "scene", problems)) exhibit.scene = std::move(*scene);
    return;
  }
  if (root.has("scene")) root.problem("scene", "is there beside \"scenes\": one of them only");
  root.value("scene");
  std::optional<Scene> all;
  bool readable = true;
  root.objects("scenes", true, [&](Fields fields) {
    ScenePlace place;
    place.position = fields.triple("position", false);
    place.yaw = fields.number("yaw_deg", false, 0, -720, 720) * one_degree;
    place.scale = fields.number("scale", false, 1, least_scale, most_scale);
    std::optional<Scene> scene = read_file(exhibit, fields, "file", problems);
    fields.finish();
    readable &= scene.has_value();
    if (!scene) return;
    place_scene(*scene, place);
    if (all) join_scene(*all, std::move(*scene));
    else all = std::move(scene);
  });
  if (!all && readable) root.problem("scenes", "must name at least one file");
  if (all && readable) exhibit.scene = std::move(*all);
}

void read_environment(Exhibit& exhibit, Fields fields, std::vector<Problem>& problems) {
  exhibit.scene.environment.radiance = vec3(fields.triple("radiance", false, dvec3(1)));
  std::string picture = fields.text("image", false);
  std::string picture_path = package_file(fields, "image", exhibit.folder, picture);
  if (!picture_path.empty()) {
    try {
      load_environment(picture_path, exhibit.scene);
    } catch (const LoadError& error) {
      problems.push_back({error.file, error.where, error.what_});
    }
  }
  fields.object("sky", false, [&](Fields sky) {
    SkySettings settings;
    settings.elevation = sky.number("elevation_deg", true, settings.elevation, -18, 90);
    settings.azimuth = sky.number("azimuth_deg", true, settings.azimuth, -360, 360);
    settings.turbidity = sky.number("turbidity", false, settings.turbidity, 1, 10);
    settings.strength = sky.number("strength", false, settings.strength, 0, 1e6);
    sky.finish();
    if (!picture.empty()) fields.problem("sky", "is there beside an \"image\": one of them only");
    else if (!sky_problem(settings)) add_sky(settings, exhibit.scene);
  });
  fields.finish();
}

}  // namespace

void read_scene(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems) {
  read_files(exhibit, root, problems);
  const bool loaded = !exhibit.scene.objects.empty();
  ScenePlace place;
  place.scale = root.number("scale", false, 1, least_scale, most_scale);
  exhibit.scene.cull_back_faces = !root.flag("draw_back_faces", false);
  double light = root.number("light_scale", false, 1, 0, 1e6);
  if (loaded) place_scene(exhibit.scene, place);
  if (light != 1) scale_light(exhibit.scene, float(light));
  root.object("environment", false,
              [&](Fields fields) { read_environment(exhibit, std::move(fields), problems); });
  if (loaded && add_missing_light(exhibit.scene))
    root.problem("environment",
                 "the scene has no light of any kind: it is lit from everywhere by a radiance of 1 "
                 "(write \"environment\": {\"radiance\": [1, 1, 1]}, or give it lamps or a sky)",
                 false);
}

}  // namespace wellspring::show
