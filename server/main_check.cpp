// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring check content/ID`: lists every problem of an exhibit package with file and
// place.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "about/version.h"
#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/tree/tree_file.h"
#include "show/check/check_scene.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/house/house.h"
#include "show/storyteller/recordings.h"
#include "show/visit/tour.h"
#include "show/visit/walk_map.h"

namespace {

using namespace wellspring;
using namespace wellspring::program;

// Reads the recognition trees of kiosks as kiosks do.
void check_stations(const Exhibit& exhibit, std::vector<Problem>& problems) {
  for (const KioskSettings& kiosk : exhibit.kiosks) {
    if (kiosk.station.empty()) continue;
    try {
      load_tree(exhibit.files.at(kiosk.station).path);
    } catch (const LoadError& error) {
      problems.push_back({error.file, error.where, error.what_});
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("check");
  CLI::App app{"Validates an exhibit package and lists every problem with file and place."};
  std::string folder, schema;
  auto* package = app.add_option("package", folder, "folder of the exhibit, e.g. content/castle");
  app.add_option("--schema", schema, "instead: print the JSON Schema of a file, for editors")
      ->check(CLI::IsMember({"exhibit", "house"}))
      ->excludes(package);
  std::string house;
  app.add_option("--house", house, "a house file that goes with it");
  RecordingOptions recordings;
  app.add_option("--cache", recordings.cache,
                 "folder that keeps what is found out about recordings");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!schema.empty()) {
    const auto fields = schema == "house" ? house_schema() : exhibit_schema();
    std::cout << fields.dump(2) << "\n";
    return 0;
  }
  if (folder.empty()) {
    std::cerr << "check: which package? e.g. content/castle\n";
    return 2;
  }
  std::vector<Problem> problems;
  int fatal = 0;
  try {
    Exhibit exhibit = read_exhibit(folder, problems);
    read_recordings(exhibit, recordings, problems);
    if (!house.empty()) read_house(house, exhibit, problems);
    check_stations(exhibit, problems);
    bool usable =
        std::none_of(problems.begin(), problems.end(), [](const auto& p) { return p.fatal; });
    if (usable) {
      World world(exhibit.scene);
      place_scans(exhibit, world);
      check_places(exhibit, world, problems);
      check_sides(exhibit, world, problems);
      check_lawns(exhibit, world, problems);
      check_light(exhibit, world, problems);
      check_ground(exhibit, world, problems);
      make_tour_roads(exhibit, world, problems);
    }
    // Maps of light are for what stands still, so movers are taken out as servers and bakes do.
    if (usable) {
      take_movers(exhibit);
      take_lights(exhibit);
      check_shipped_light(exhibit, problems);
    }
  } catch (const std::exception& error) {
    problems.push_back({folder, "", error.what(), true});
  }
  for (const Problem& problem : problems) {
    std::cout << (problem.fatal ? "error: " : "note: ") << to_string(problem) << "\n";
    fatal += problem.fatal;
  }
  if (fatal == 0) std::cout << folder << ": good, " << problems.size() << " notes\n";
  else
    std::cout << folder << ": " << fatal << " errors, " << problems.size() - size_t(fatal)
              << " notes\n";
  return fatal == 0 ? 0 : 1;
}
