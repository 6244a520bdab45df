// SPDX-License-Identifier: Apache-2.0
#include "kiosk_visitors.h"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace wellspring::test {

namespace fs = std::filesystem;

VisitorStage make_kiosk_stage(const BenchOptions& options) {
  std::vector<std::string> files;
  for (const char* name : kiosk_figure_names)
    files.push_back((fs::path(options.content) / "castle/figures" / name).string() + ".x3d");
  return VisitorStage(files);
}

VisitorWatch kiosk_watch(const BenchOptions& options, const std::string& name) {
  const char* weights = std::getenv("WELLSPRING_WEIGHTS");
  if (!weights || !fs::exists(fs::path(weights) / "face"))
    throw std::runtime_error("WELLSPRING_WEIGHTS: has no weights of the face's networks");
  VisitorWatch watch;
  watch.programs = options.programs;
  watch.weights = (fs::path(weights) / "face").string();
  watch.folder = options.plots + name + "_pictures";
  return watch;
}

VisitorSequence begin_visit(int figure, float metres, VisitorLight light, double seconds) {
  VisitorSequence sequence;
  VisitorFrame frame;
  frame.shot.light = light;
  frame.seconds = 0.5, frame.judged = false;
  sequence.frames.push_back(frame);
  Visitor visitor;
  visitor.figure = figure;
  frame.seconds = 0.1;
  for (float steps : {5.f, 4.f, 3.f, 2.f, 1.f, 0.f}) {  // in from the side, turned that way
    visitor.eyes = {0.03f * steps * metres, 0, metres};
    visitor.turn.x = -0.05f * steps;
    frame.shot.visitors = {visitor};
    sequence.frames.push_back(frame);
  }
  sequence.frames.back().seconds = seconds;
  return sequence;
}

}  // namespace wellspring::test
