// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_load.h"

#include <algorithm>
#include <filesystem>

#include "avatar/face/expression_sum.h"
#include "avatar/load/character_load.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/worker.h"
#include "show/exhibit/exhibit_book.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/exhibit_story.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

namespace fs = std::filesystem;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

bool is_identifier(const std::string& id) {
  return !id.empty() && id.size() <= 100 && std::all_of(id.begin(), id.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_' || c == '.';
  });
}

void read_exposure(Exhibit& exhibit, Fields& root) {
  const nlohmann::json* value = root.value("exposure");
  exhibit.auto_exposure = value && *value == "auto";
  if (value && value->is_string() && !exhibit.auto_exposure)
    root.problem("exposure", "must be a number, or \"auto\"");
  else if (!exhibit.auto_exposure)
    exhibit.exposure = float(root.number("exposure", false, 1, 1e-6, 1e6));
}

void read_walk(Exhibit& exhibit, Fields fields) {
  WalkSettings walk;
  walk.eye_height = float(fields.number("eye_height", false, 1.65, 0.2, 10));
  walk.speed = float(fields.number("speed", false, 1.4, 0.05, 20));
  walk.radius = float(fields.number("radius", false, 0.25, 0.01, 5));
  fields.object("bounds", false, [&](Fields box) {
    dvec3 low = box.triple("low", true), high = box.triple("high", true);
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
      box.problem("", "low must be below high on every axis");
    walk.bounds = Bounds{vec3(low), vec3(high)};
    box.finish();
  });
  fields.finish();
  exhibit.walk = walk;
}

void read_viewpoints(Exhibit& exhibit, Fields& root) {
  root.objects("viewpoints", false, [&](Fields fields) {
    ExhibitViewpoint viewpoint;
    viewpoint.where = fields.where();
    viewpoint.view.name = fields.text("name", true);
    if (find_viewpoint(exhibit, viewpoint.view.name) >= 0)
      fields.problem("name", "'" + viewpoint.view.name + "' is taken by another viewpoint");
    viewpoint.title = fields.local_text("title", false);
    viewpoint.view.position = fields.triple("position", true);
    viewpoint.view.yaw = float(fields.number("yaw_deg", false, 0, -720, 720) * degree);
    viewpoint.view.pitch = float(fields.number("pitch_deg", false, 0, -89, 89) * degree);
    viewpoint.view.roll = float(fields.number("roll_deg", false, 0, -180, 180) * degree);
    viewpoint.view.fov = float(fields.number("fov_deg", false, 55, 5, 150) * degree);
    fields.finish();
    exhibit.viewpoints.push_back(std::move(viewpoint));
  });
}

int read_viewpoint_name(const Exhibit& exhibit, Fields& fields, const char* name, bool required) {
  std::string viewpoint = fields.text(name, required);
  if (viewpoint.empty()) return 0;
  int index = find_viewpoint(exhibit, viewpoint);
  if (index < 0) fields.problem(name, unknown_viewpoint(exhibit, viewpoint));
  return std::max(index, 0);
}

// A file of expressions or gestures in place of those that come with the program.
template <class Language, class Load>
void read_language(const Exhibit& exhibit, Fields& fields, const char* name,
                   std::optional<Language>& language, const Load& load,
                   std::vector<Problem>& problems) {
  std::string file = fields.text(name, false);
  if (file.empty()) return;
  std::string path = package_file(fields, name, exhibit.folder, file);
  if (path.empty()) return;
  try {
    language = load(path);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  }
}

// The figure, as the package wants it skinned, and what it goes without.
void read_figure(const Exhibit& exhibit, Fields& fields, StorytellerPlace& place,
                 std::vector<Problem>& problems) {
  std::string skinning = fields.text("skinning", false);
  if (!skinning.empty() && skinning != "linear" && skinning != "dual_quaternion")
    fields.problem("skinning",
                   "is 'linear' or 'dual_quaternion'; without it the figure's file says");
  std::string path = package_file(fields, "figure", exhibit.folder, place.figure);
  if (path.empty()) return;
  try {
    place.character = load_character(path);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
    return;
  }
  if (skinning == "linear") place.character.skinning = Skinning::linear;
  if (skinning == "dual_quaternion") place.character.skinning = Skinning::dual_quaternion;
  for (const std::string& warning : place.character.warnings)
    problems.push_back({path, "", warning, false});
  const ExpressionSet& set = place.expressions ? *place.expressions : default_expressions();
  std::string missing;
  for (const std::string& name : make_expression_rig(set, place.character).missing)
    missing += (missing.empty() ? "" : ", ") + name;
  if (!missing.empty())
    problems.push_back({path, "", "the figure goes without these expressions: " + missing, false});
}

void read_storyteller(Exhibit& exhibit, Fields fields, bool one_of_many,
                      std::vector<Problem>& problems) {
  check_cancelled();
  StorytellerPlace place;
  place.id = fields.text("id", one_of_many, one_of_many ? "" : "storyteller");
  if (find_storyteller(exhibit, place.id) >= 0)
    fields.problem("id", "'" + place.id + "' is taken by another storyteller");
  place.figure = fields.text("figure", true);
  place.name = fields.local_text("name", false);
  place.position = fields.triple("position", true);
  place.yaw = float(fields.number("yaw_deg", false, 0, -720, 720) * degree);
  place.greetings = read_script(exhibit, fields, "greetings", false, false, problems);
  place.farewells = read_script(exhibit, fields, "farewells", false, false, problems);
  place.voice = read_manner(fields, "voice", {});
  place.kiosk_viewpoint = read_viewpoint_name(exhibit, fields, "kiosk_viewpoint", false);
  for (const std::string& lang : exhibit.languages) {
    if (!place.greetings.contains(lang))
      fields.problem("greetings", "has nothing in '" + lang + "'", false);
    if (!place.farewells.contains(lang))
      fields.problem("farewells", "has nothing in '" + lang + "'", false);
  }
  read_language(exhibit, fields, "expressions", place.expressions, load_expressions, problems);
  read_language(exhibit, fields, "gestures", place.gestures, load_gestures, problems);
  read_figure(exhibit, fields, place, problems);
  fields.finish();
  exhibit.storytellers.push_back(std::move(place));
}

void read_storytellers(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems) {
  root.object("storyteller", false, [&](Fields fields) {
    read_storyteller(exhibit, std::move(fields), false, problems);
  });
  if (root.has("storyteller") && root.has("storytellers"))
    root.problem("storytellers", "is there beside a \"storyteller\": one of them only");
  root.objects("storytellers", false, [&](Fields fields) {
    read_storyteller(exhibit, std::move(fields), true, problems);
  });
  exhibit.shared_storyteller = root.flag("shared_storyteller", false);
}

void read_tours_and_stories(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems) {
  root.objects("tours", false, [&](Fields fields) {
    TourPlan tour;
    tour.id = fields.text("id", true);
    tour.title = fields.local_text("title", false);
    fields.objects("stops", true, [&](Fields stop_fields) {
      TourStop stop;
      stop.viewpoint = read_viewpoint_name(exhibit, stop_fields, "viewpoint", true);
      stop.text = read_script(exhibit, stop_fields, "text", false, true, problems);
      stop.way_text = read_script(exhibit, stop_fields, "way_text", false, true, problems);
      stop.sound = read_sounds(exhibit, stop_fields, "sound", stop.text);
      stop.way_sound = read_sounds(exhibit, stop_fields, "way_sound", stop.way_text);
      stop.travel_seconds = float(stop_fields.number("travel_seconds", false, 0, 0, 600));
      double stay = stop.text.empty() ? 6 : 1.5;
      stop.stay_seconds = float(stop_fields.number("stay_seconds", false, stay, 0, 3600));
      stop_fields.finish();
      tour.stops.push_back(std::move(stop));
    });
    if (tour.stops.empty()) fields.problem("stops", "must name at least one stop");
    fields.finish();
    exhibit.tours.push_back(std::move(tour));
  });
  root.objects("stories", false, [&](Fields fields) {
    StoryText story;
    story.id = fields.text("id", true);
    story.title = fields.local_text("title", false);
    story.text = read_script(exhibit, fields, "text", true, false, problems);
    story.sound = read_sounds(exhibit, fields, "sound", story.text);
    if (std::string id = fields.text("teller", false); !id.empty()) {
      story.storyteller_index = find_storyteller(exhibit, id);
      if (story.storyteller_index < 0) fields.problem("teller", unknown_storyteller(exhibit, id));
    }
    fields.finish();
    exhibit.stories.push_back(std::move(story));
  });
}

}  // namespace

Exhibit read_exhibit(const std::string& folder, std::vector<Problem>& problems) {
  Exhibit exhibit;
  std::error_code ec;
  exhibit.folder = folder;
  exhibit.id = fs::weakly_canonical(folder, ec).filename().string();
  std::string file = (fs::path(folder) / "exhibit.json").string();
  if (!is_identifier(exhibit.id))
    problems.push_back({folder, "", "the folder's name must be letters, digits, '-', '_' or '.'"});
  const auto manifest = read_json_file(file, problems);
  if (!manifest) return exhibit;
  Fields root(*manifest, file, "", problems);
  root.text("$schema", false);  // for editors
  std::string id = root.text("id", false, exhibit.id);
  if (id != exhibit.id)
    root.problem("id", "'" + id + "' is not the folder's name '" + exhibit.id + "'");
  exhibit.title = root.local_text("title", true);
  exhibit.description = root.local_text("description", false);
  if (const std::string poster = root.text("poster", false);
      !poster.empty() && add_served_file(exhibit, root, "poster", poster, Medium::image))
    exhibit.poster = poster;
  if (auto languages = root.texts("languages"); !languages.empty()) exhibit.languages = languages;
  read_exposure(exhibit, root);
  root.object("walk", false, [&](Fields fields) { read_walk(exhibit, std::move(fields)); });
  read_scene(exhibit, root, problems);
  read_lamps(exhibit, root);
  read_lights(exhibit, root);
  read_day(exhibit, root);
  read_viewpoints(exhibit, root);
  for (const Viewpoint& view : exhibit.scene.viewpoints)
    if (find_viewpoint(exhibit, view.name) < 0) exhibit.viewpoints.push_back({view, {}, {}});
  if (exhibit.viewpoints.empty())
    root.problem("viewpoints", "there is no viewpoint here and no camera in the scene");
  exhibit.start = read_viewpoint_name(exhibit, root, "start", false);
  read_storytellers(exhibit, root, problems);
  read_props(exhibit, root, problems);
  read_kiosks(exhibit, root);
  read_tours_and_stories(exhibit, root, problems);
  read_objects(exhibit, root);
  read_animations(exhibit, root);
  check_marks(exhibit, problems);
  read_book(exhibit, root);
  read_questions(exhibit, root);
  read_ambient_sounds(exhibit, root);
  root.finish();
  const bool usable =
      std::none_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; });
  if (exhibit.auto_exposure && usable) {
    exhibit.exposure = measure_exposure(exhibit);
    log::info("{}: exposure {:.3g}", exhibit.id, exhibit.exposure);
  }
  return exhibit;
}

Exhibit load_exhibit(const std::string& folder) {
  std::vector<Problem> problems;
  Exhibit exhibit = read_exhibit(folder, problems);
  if (std::any_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; }))
    throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
  take_movers(exhibit);
  take_lights(exhibit);
  return exhibit;
}

}  // namespace wellspring::show
