// SPDX-License-Identifier: Apache-2.0
// kiosk.figures: how well the kiosk's eye sees the project's own figures, ray-traced as visitors.
// Nothing of the eye was fitted to their heads.
#include <cmath>
#include <map>

#include "kiosk_visitors.h"

namespace wellspring::test {

namespace {

constexpr float degree = pi / 180;

// Comes to stand before the camera and takes these poses one after the other.
VisitorSequence take_poses(int figure, float metres, VisitorLight light,
                           const std::vector<vec3>& poses, nlohmann::json about) {
  VisitorSequence sequence = begin_visit(figure, metres, light, 1.5);
  sequence.about = std::move(about);
  sequence.about["figure"] = kiosk_figure_names[size_t(figure)];
  sequence.about["metres"] = metres;
  sequence.about["light"] = name_of(light);
  for (vec3 pose : poses) {
    VisitorFrame frame = sequence.frames.back();
    frame.shot.visitors[0].turn = pose * degree;
    frame.seconds = 0.8, frame.judged = true;
    sequence.frames.push_back(frame);
  }
  return sequence;
}

std::vector<VisitorSequence> make_figure_sequences(bool quick) {
  std::vector<VisitorSequence> all;
  auto row = [](vec3 from, vec3 to, int steps) {
    std::vector<vec3> poses;
    for (int k = 1; k <= steps; k++) poses.push_back(glm::mix(from, to, float(k) / float(steps)));
    return poses;
  };
  for (auto light : {VisitorLight::normal, VisitorLight::bright, VisitorLight::dim,
                     VisitorLight::side, VisitorLight::back})
    for (int figure = 0; figure < int(std::size(kiosk_figure_names)); figure++) {
      const std::vector<vec3> some = {{20, 0, 0}, {0, 10, 0}, {-20, 0, 0}, {0, -10, 10}};
      if (!quick || (light != VisitorLight::bright && light != VisitorLight::side))
        all.push_back(take_poses(figure, 1, light, some, {{"part", "light"}}));
      if (light != VisitorLight::normal) continue;
      auto turn = [&](vec3 from, vec3 to, int steps) {
        all.push_back(take_poses(figure, 0.8f, light, row(from, to, steps), {{"part", "turn"}}));
      };
      for (float side : {-1.f, 1.f}) {
        turn({0, 0, 0}, {60 * side, 0, 0}, 6);
        turn({0, 0, 0}, {0, 30 * side, 0}, 3);
        turn({0, 0, 0}, {0, 0, 30 * side}, 3);
        if (quick) continue;
        for (float pitch : {-15.f, 15.f}) turn({0, pitch, 0}, {60 * side, pitch, 0}, 6);
        for (float yaw : {-30.f, 30.f}) turn({yaw, 0, 0}, {yaw, 30 * side, 0}, 3);
        turn({0, 0, 0}, {45 * side, -15, 15 * side}, 3);
      }
      for (float metres : {0.5f, 1.f, 1.5f, 2.f, 2.5f, 3.f, 3.5f}) {
        if (quick && metres != 0.5f && metres != 2 && metres != 3.5f) continue;
        all.push_back(take_poses(figure, metres, light, some, {{"part", "distance"}}));
      }
    }
  return all;
}

// Holds the errors in one group of pictures.
struct Errors {
  VisitorMean axis[3], signed_axis[3], position, found;
  void add(const Visitor& truth, const VisitorSeen& seen) {
    found.add(seen.found);
    if (seen.people.empty()) return;
    const VisitorSeen::Person& person = seen.people[0];
    const vec3 off = (person.rotation - truth.turn) / degree;
    for (int k = 0; k < 3; k++) axis[k].add(std::abs(off[k])), signed_axis[k].add(off[k]);
    position.add(glm::length(person.position - truth.eyes) / glm::length(truth.eyes));
  }
  double rotation() const { return (axis[0].value() + axis[1].value() + axis[2].value()) / 3; }
};

constexpr const char* axes[] = {"yaw", "pitch", "roll"};

}  // namespace

void bench_kiosk_figures(BenchReport& report, const BenchOptions& options) {
  VisitorStage stage = make_kiosk_stage(options);
  const auto sequences = make_figure_sequences(options.quick);
  const auto seen = watch_visitors(stage, sequences, kiosk_watch(options, "figures"));
  std::map<std::string, std::map<int, Errors>> by_range;  // errors by figure, and of all figures
  std::map<int, Errors> by_yaw;
  std::map<std::string, Errors> by_light;
  std::map<float, Errors> by_distance;
  for (size_t s = 0; s < sequences.size(); s++)
    for (size_t f = 0; f < sequences[s].frames.size(); f++) {
      const VisitorFrame& frame = sequences[s].frames[f];
      if (!frame.judged) continue;
      const Visitor& truth = frame.shot.visitors[0];
      const nlohmann::json& about = sequences[s].about;
      if (about["part"] == "light") by_light[about["light"]].add(truth, seen[s][f]);
      if (about["part"] == "distance") by_distance[about["metres"]].add(truth, seen[s][f]);
      if (about["part"] != "turn") continue;
      const float yaw = std::abs(truth.turn.x) / degree;
      for (const std::string& figure : {about["figure"].get<std::string>(), std::string("all")})
        for (int range : {35, 60})
          if (yaw <= float(range) + 0.01f) by_range[figure][range].add(truth, seen[s][f]);
      by_yaw[int(std::lround(yaw / 10)) * 10].add(truth, seen[s][f]);
    }
  for (const auto& [figure, ranges] : by_range)
    for (const auto& [range, errors] : ranges) {
      const nlohmann::json fields{{"figure", figure}, {"range", range}};
      for (int k = 0; k < 3; k++) {
        nlohmann::json more = fields;
        more["axis"] = axes[k], more["mean"] = errors.signed_axis[k].value();
        report.add("kiosk.figures.mae_deg", errors.axis[k].value(), "degrees", more);
      }
      report.add("kiosk.figures.position", errors.position.value(), "1", fields);
      report.add("kiosk.figures.found", errors.found.value(), "1", fields);
    }
  auto tell = [&](const std::string& by, const nlohmann::json& at, const Errors& errors) {
    const nlohmann::json fields{{by, at}};
    report.add("kiosk.figures.by_" + by + ".found", errors.found.value(), "1", fields);
    if (errors.position.count == 0) return;
    report.add("kiosk.figures.by_" + by + ".deg", errors.rotation(), "degrees", fields);
    report.add("kiosk.figures.by_" + by + ".position", errors.position.value(), "1", fields);
  };
  for (const auto& [yaw, errors] : by_yaw) tell("yaw", yaw, errors);
  for (const auto& [metres, errors] : by_distance) tell("metres", metres, errors);
  for (const auto& [light, errors] : by_light) tell("light", light, errors);
}

ReportPage kiosk_figures_page() {
  auto table = [](const char* caption, const std::string& by, const char* heading, int rows) {
    const std::string name = "kiosk.figures.by_" + by;
    return PageTable{.caption = caption,
                     .rows = {{by, heading}},
                     .columns = {{name + ".deg", "error of the rotation"},
                                 {name + ".position", "of the position", 100, "%"},
                                 {name + ".found", "found", 100, "%"}},
                     .most_rows = rows};
  };
  return {"kiosk.figures",
          "How well does the kiosk's eye see heads that are not its model's? The castle's two "
          "figures, ray-traced before the camera at 640x480, 60 degrees across, with a sensor's "
          "noise; they turn the head by 10 degrees at a time.",
          {"Wanted: at most 5 degrees an axis within 35 of yaw and 8 within 60; 5 % of the "
           "position; found to 3.5 m.",
           "Pitch 0 is where each figure's author has it, not where the fitted model has it. The "
           "chronicler wears a full beard."},
          {{.caption = "Mean absolute error at 0.8 m, degrees",
            .rows = {{"figure", "figure"}, {"range", "yaw up to"}},
            .columns = {{"kiosk.figures.mae_deg", "error"}},
            .across = "axis",
            .only = {{"figure", {"storyteller", "chronicler"}}},
            .most_rows = 4},
           table("Over the distance", "metres", "m", 7),
           table("", "light", "light, at 1 m", 5)}};
}

}  // namespace wellspring::test
