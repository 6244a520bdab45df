// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/load/exhibit_load.h"

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
#include "show/exhibit/exhibit_collection.h"
#include "show/exhibit/exhibit_spectra.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/pieces/exhibit_pieces.h"
#include "show/exhibit/load/exhibit_story.h"
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

void read_exposure(Exhibit& exhibit, FieldReader& root) {
  constexpr double least = 1e-6, most = 1e6;
  const auto value = root.take(
      "exposure",
      {{"anyOf",
        {{{"const", "auto"}}, {{"type", "number"}, {"minimum", least}, {"maximum", most}}}}},
      "multiplies brightness; \"auto\" measures the light");
  if (!value) return;
  exhibit.auto_exposure = value->value() == "auto";
  if (value->value().is_string() && !exhibit.auto_exposure)
    value->fail("must be a number, or \"auto\"");
  else if (!exhibit.auto_exposure) value->number(least, most, exhibit.exposure);
}

void read_walk(Exhibit& exhibit, FieldReader& fields) {
  WalkSettings walk;
  fields.number("eye_height", 0.2, 10, walk.eye_height, "metres");
  fields.number("speed", 0.05, 20, walk.speed, "metres a second");
  fields.number("radius", 0.01, 5, walk.radius, "metres kept from walls");
  fields.part("bounds", "the box that visitors stay in", [&](FieldReader& box) {
    dvec3 low(0), high(1);
    box.vector("low", most_metres, low, "", Need::required);
    box.vector("high", most_metres, high, "", Need::required);
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
      box.fail("low must be below high on every axis");
    walk.bounds = Bounds{vec3(low), vec3(high)};
  });
  exhibit.walk = walk;
}

void read_viewpoints(Exhibit& exhibit, FieldReader& root) {
  root.parts("viewpoints", SIZE_MAX, "", [&](FieldReader& fields) {
    ExhibitViewpoint viewpoint;
    viewpoint.where = fields.where();
    viewpoint.view.fov = float(55 * degree);
    if (fields.text("name", viewpoint.view.name, "", Need::required) &&
        find_viewpoint(exhibit, viewpoint.view.name) >= 0)
      fields.fail("name", "'" + viewpoint.view.name + "' is taken by another viewpoint");
    viewpoint.title = read_local_text(fields, "title", "");
    fields.vector("position", most_metres, viewpoint.view.position, "", Need::required);
    fields.degrees("yaw_deg", -720, 720, viewpoint.view.yaw,
                   "0 looks towards -z, positive turns left");
    fields.degrees("pitch_deg", -89, 89, viewpoint.view.pitch, "positive looks up");
    fields.degrees("roll_deg", -180, 180, viewpoint.view.roll, "positive leans to the left");
    fields.degrees("fov_deg", 5, 150, viewpoint.view.fov, "vertical");
    exhibit.viewpoints.push_back(std::move(viewpoint));
  });
}

int read_viewpoint_name(const Exhibit& exhibit, FieldReader& fields, const char* name,
                        const char* about, Need need = Need::optional) {
  std::string viewpoint;
  if (!fields.text(name, viewpoint, about, need) || viewpoint.empty()) return 0;
  int index = find_viewpoint(exhibit, viewpoint);
  if (index < 0) fields.fail(name, unknown_viewpoint(exhibit, viewpoint));
  return std::max(index, 0);
}

// A file of expressions or gestures in place of those that come with the program.
template <class Language, class Load>
void read_language(const Exhibit& exhibit, FieldReader& fields, const char* name, const char* about,
                   std::optional<Language>& language, const Load& load,
                   std::vector<Problem>& problems) {
  std::string file;
  if (!fields.text(name, file, about) || file.empty()) return;
  std::string path = package_file(fields, name, exhibit.folder, file);
  if (path.empty()) return;
  try {
    language = load(path);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  }
}

// Returns the folder of the exhibit beside this one that lends its figure; empty: there is none.
std::string lender_folder(const Exhibit& exhibit, FieldReader& fields, const std::string& lender) {
  std::error_code ec;
  const fs::path all = fs::weakly_canonical(exhibit.folder, ec).parent_path();
  const bool is_name = is_identifier(lender) && lender.find_first_not_of('.') != lender.npos;
  if (is_name && fs::is_regular_file(all / lender / "exhibit.json", ec))
    return (all / lender).string();
  fields.fail("figure_from", "there is no exhibit '" + lender + "' beside this one");
  return "";
}

// The figure, as the package wants it skinned, and what it goes without.
void read_figure(const Exhibit& exhibit, FieldReader& fields, StorytellerPlace& place,
                 std::vector<Problem>& problems) {
  std::string skinning;
  fields.word("skinning", {"linear", "dual_quaternion"}, skinning,
              "without it the figure's file says");
  std::string lender, folder = exhibit.folder;
  if (fields.text("figure_from", lender, "id of the exhibit beside this one whose file it is") &&
      !lender.empty())
    folder = lender_folder(exhibit, fields, lender);
  if (folder.empty()) return;
  const std::string path = package_file(fields, "figure", folder, place.figure);
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

void read_storyteller(Exhibit& exhibit, FieldReader& fields, bool one_of_many,
                      std::vector<Problem>& problems) {
  check_cancelled();
  StorytellerPlace place;
  if (!one_of_many) place.id = "storyteller";
  fields.text("id", place.id, "", one_of_many ? Need::required : Need::optional);
  if (find_storyteller(exhibit, place.id) >= 0)
    fields.fail("id", "'" + place.id + "' is taken by another storyteller");
  fields.text("figure", place.figure, "X3D, VRML97, glTF or VRM", Need::required);
  place.name = read_local_text(fields, "name", "");
  fields.vector("position", most_metres, place.position, "", Need::required);
  fields.degrees("yaw_deg", -720, 720, place.yaw, "0 looks towards -z, positive turns left");
  place.greetings = read_script(exhibit, fields, "greetings", false, problems);
  place.farewells = read_script(exhibit, fields, "farewells", false, problems);
  place.voice = read_manner(fields, "voice", {});
  place.kiosk_viewpoint =
      read_viewpoint_name(exhibit, fields, "kiosk_viewpoint", "the view of kiosks before it");
  for (const std::string& lang : exhibit.languages) {
    if (!place.greetings.contains(lang)) fields.warn("greetings", "has nothing in '" + lang + "'");
    if (!place.farewells.contains(lang)) fields.warn("farewells", "has nothing in '" + lang + "'");
  }
  read_language(exhibit, fields, "expressions", "file of expressions of its own", place.expressions,
                load_expressions, problems);
  read_language(exhibit, fields, "gestures", "file of gestures of its own", place.gestures,
                load_gestures, problems);
  read_figure(exhibit, fields, place, problems);
  exhibit.storytellers.push_back(std::move(place));
}

void read_storytellers(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems) {
  root.part("storyteller", "the only one",
            [&](FieldReader& fields) { read_storyteller(exhibit, fields, false, problems); });
  if (root.has("storyteller") && root.has("storytellers"))
    root.fail("storytellers", "is there beside a \"storyteller\": one of them only");
  root.parts("storytellers", SIZE_MAX, "instead of \"storyteller\"",
             [&](FieldReader& fields) { read_storyteller(exhibit, fields, true, problems); });
  root.boolean("shared_storyteller", exhibit.shared_storyteller,
               "one storyteller for all visitors");
}

TourStop read_stop(const Exhibit& exhibit, FieldReader& fields, std::vector<Problem>& problems) {
  TourStop stop;
  stop.viewpoint = read_viewpoint_name(exhibit, fields, "viewpoint", "", Need::required);
  stop.text = read_script(exhibit, fields, "text", true, problems);
  stop.way_text = read_script(exhibit, fields, "way_text", true, problems);
  stop.sound = read_sounds(exhibit, fields, "sound", stop.text);
  stop.way_sound = read_sounds(exhibit, fields, "way_sound", stop.way_text);
  fields.number("travel_seconds", 0, 600, stop.travel_seconds, "the way takes at least so long");
  if (stop.text.empty()) stop.stay_seconds = 6;
  fields.number("stay_seconds", 0, 3600, stop.stay_seconds, "and as long as its text takes");
  return stop;
}

void read_tours_and_stories(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems) {
  root.parts("tours", SIZE_MAX, "", [&](FieldReader& fields) {
    TourPlan tour;
    fields.text("id", tour.id, "", Need::required);
    tour.title = read_local_text(fields, "title", "");
    fields.parts(
        "stops", SIZE_MAX, "at least one",
        [&](FieldReader& stop) { tour.stops.push_back(read_stop(exhibit, stop, problems)); },
        Need::required);
    if (tour.stops.empty()) fields.fail("stops", "must name at least one stop");
    exhibit.tours.push_back(std::move(tour));
  });
  root.parts("stories", SIZE_MAX, "", [&](FieldReader& fields) {
    StoryText story;
    fields.text("id", story.id, "", Need::required);
    story.title = read_local_text(fields, "title", "");
    story.text = read_script(exhibit, fields, "text", false, problems, Need::required);
    story.sound = read_sounds(exhibit, fields, "sound", story.text);
    if (std::string id;
        fields.text("teller", id, "id of the storyteller whose story it is") && !id.empty()) {
      story.storyteller_index = find_storyteller(exhibit, id);
      if (story.storyteller_index < 0) fields.fail("teller", unknown_storyteller(exhibit, id));
    }
    exhibit.stories.push_back(std::move(story));
  });
}

// Reads exhibit.json, in the order in which its parts need each other.
void read_manifest(Exhibit& exhibit, FieldReader& root, const std::string& cache,
                   std::vector<Problem>& problems) {
  std::string schema, id = exhibit.id, poster;
  root.text("$schema", schema, "this schema, for editors");
  root.text("id", id, "the folder's name");
  if (id != exhibit.id)
    root.fail("id", "'" + id + "' is not the folder's name '" + exhibit.id + "'");
  exhibit.title = read_local_text(root, "title", "", Need::required);
  exhibit.description = read_local_text(root, "description", "");
  if (root.text("poster", poster, "a JPEG or PNG: its picture on the front page") &&
      !poster.empty() && add_served_file(exhibit, root, "poster", poster, Medium::image))
    exhibit.poster = poster;
  if (auto languages = read_texts(root, "languages", "the first one is the default");
      !languages.empty())
    exhibit.languages = languages;
  read_exposure(exhibit, root);
  root.part("walk", "how visitors walk; without it they fly",
            [&](FieldReader& fields) { read_walk(exhibit, fields); });
  read_scene(exhibit, root, problems);
  read_spectra(exhibit, root);
  read_lamps(exhibit, root);
  read_lights(exhibit, root);
  read_day(exhibit, root);
  read_viewpoints(exhibit, root);
  for (const Viewpoint& view : exhibit.scene.viewpoints)
    if (find_viewpoint(exhibit, view.name) < 0) exhibit.viewpoints.push_back({view, {}, {}});
  if (exhibit.viewpoints.empty())
    root.fail("viewpoints", "there is no viewpoint here and no camera in the scene");
  exhibit.start = read_viewpoint_name(exhibit, root, "start", "name of the first viewpoint");
  read_storytellers(exhibit, root, problems);
  read_props(exhibit, root, problems);
  read_kiosks(exhibit, root);
  read_tours_and_stories(exhibit, root, problems);
  read_pieces(exhibit, root, problems, cache);
  read_objects(exhibit, root);
  read_animations(exhibit, root);
  check_marks(exhibit, problems);
  read_collection(exhibit, root);
  read_book(exhibit, root);
  read_questions(exhibit, root);
  read_ambient_sounds(exhibit, root);
}

}  // namespace

Exhibit read_exhibit(const std::string& folder, std::vector<Problem>& problems,
                     const std::string& cache) {
  Exhibit exhibit;
  std::error_code ec;
  exhibit.folder = folder;
  exhibit.id = fs::weakly_canonical(folder, ec).filename().string();
  std::string file = (fs::path(folder) / "exhibit.json").string();
  if (!is_identifier(exhibit.id))
    problems.push_back({folder, "", "the folder's name must be letters, digits, '-', '_' or '.'"});
  read_fields(file, problems,
              [&](FieldReader& root) { read_manifest(exhibit, root, cache, problems); });
  const bool usable =
      std::none_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; });
  if (exhibit.auto_exposure && usable) {
    exhibit.exposure = measure_exposure(exhibit);
    log::info("{}: exposure {:.3g}", exhibit.id, exhibit.exposure);
  }
  return exhibit;
}

nlohmann::ordered_json exhibit_schema() {
  return describe_fields("An exhibit of Wellspring (content/README.md explains every field)",
                         [](FieldReader& root) {
                           Exhibit none;
                           std::vector<Problem> unused;
                           read_manifest(none, root, "", unused);
                         });
}

Exhibit load_exhibit(const std::string& folder, const std::string& cache) {
  std::vector<Problem> problems;
  Exhibit exhibit = read_exhibit(folder, problems, cache);
  if (std::any_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; }))
    throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
  take_movers(exhibit);
  take_lights(exhibit);
  return exhibit;
}

}  // namespace wellspring::show
