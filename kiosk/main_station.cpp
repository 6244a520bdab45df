// SPDX-License-Identifier: Apache-2.0
// Runs wellspring_station: learns from photographs what visitors may hold to a kiosk's camera.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <opencv2/core/utility.hpp>

#include "about/version.h"
#include "base/log.h"
#include "kiosk/station/learn.h"
#include "kiosk/tree/tree_file.h"

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv, {"CLI11", "GLM", "nlohmann-json"})) return 0;
  CLI::App app{
      "Learns what visitors may hold to a kiosk's camera: a folder of photographs for each object "
      "becomes a recognition tree, which `wellspring kiosk --station FILE` reads."};
  app.name("wellspring station");
  std::string folder, out;
  app.add_option("--learn", folder, "folder with one of photographs for each object")->required();
  app.add_option("--out", out, "file of the recognition tree")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return 2;
  }
  log::start("station");
  cv::setNumThreads(1);
  try {
    const Learnt learnt = learn_tree(load_objects(folder), folder);
    for (const std::string& note : learnt.notes) std::cerr << note << '\n';
    save_tree(learnt.tree, out);
    size_t objects = 0, classes = 0;
    for (const RecognitionNode& node : learnt.tree.nodes)
      (node.kind == NodeKind::model ? objects : classes) += !node.id.empty();
    std::printf("%zu objects, %zu classes of nearly equal ones -> %s\n", objects, classes,
                out.c_str());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
