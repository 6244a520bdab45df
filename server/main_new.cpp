// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring new ID MODEL`: makes an exhibit of a glTF file, or of an IIIF manifest, with
// viewpoints and light, that can be shown at once. Exit status: 0 done, 1 the input is wrong, 2 the
// command line is wrong.
#include <CLI/CLI.hpp>
#include <iostream>

#include "about/version.h"
#include "base/log.h"
#include "show/check/check_scene.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/proposal/new_exhibit.h"
#include "show/proposal/new_gallery.h"

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("new");
  CLI::App app{"Makes an exhibit of a glTF file, or of an IIIF manifest."};
  std::string id, model, content = "content";
  app.add_option("id", id, "its name: a new folder below content")->required();
  app.add_option("model", model,
                 "glTF 2.0 file (.glb, .gltf), which is copied, or manifest of IIIF Presentation 2 "
                 "or 3 (.json)")
      ->required();
  app.add_option("--content", content, "folder of exhibit packages")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    NewExhibit made = is_manifest(model) ? make_new_gallery(content, id, model)
                                         : make_new_exhibit(content, id, model);
    for (const std::string& line : made.told) std::cout << line << "\n";
    std::vector<Problem> problems;
    Exhibit exhibit = read_exhibit(made.folder, problems);
    bool usable = std::none_of(problems.begin(), problems.end(), [](auto& p) { return p.fatal; });
    if (usable) {
      World world(exhibit.scene);
      check_places(exhibit, world, problems);
      check_sides(exhibit, world, problems);
      check_light(exhibit, world, problems);
    }
    for (const Problem& problem : problems)
      std::cout << (problem.fatal ? "error: " : "note: ") << to_string(problem) << "\n";
    if (!usable) return 1;
    std::cout << made.folder << ": " << exhibit.viewpoints.size()
              << " viewpoints. Walk through it: ./wellspring run --exhibit " << id << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
