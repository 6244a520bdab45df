// SPDX-License-Identifier: Apache-2.0
// kiosk.hard: how far the kiosk's eye holds where cameras and visitors make it difficult.
#include <algorithm>
#include <map>
#include <set>

#include "kiosk_visitors.h"
#include "visitors/visitor_paste.h"

namespace wellspring::test {

namespace {

constexpr float a_degree = pi / 180;

VisitorSequence named(const std::string& name, VisitorSequence sequence) {
  sequence.about = {{"case", name}};
  return sequence;
}

// One visitor, who looks about a little.
VisitorSequence look_about(const std::string& name, int figure, VisitorLight light, Worn worn,
                           float size = 1) {
  VisitorSequence sequence = named(name, begin_visit(figure, 0.8f, light, 1.5));
  Visitor& visitor = sequence.frames.back().shot.visitors[0];
  visitor.worn = worn, visitor.size = size;
  for (float yaw : {15.f, 0.f, -15.f}) {
    VisitorFrame frame = sequence.frames.back();
    frame.shot.visitors[0].turn.x = yaw * a_degree;
    frame.seconds = 0.8, frame.judged = true;
    sequence.frames.push_back(frame);
  }
  return sequence;
}

// Visitor 0 and visitor 1 from here to there, in so many pictures of a tenth of a second.
VisitorSequence walk(const std::string& name, const Visitor& from0, vec3 to0, const Visitor& from1,
                     vec3 to1, int pictures) {
  VisitorSequence sequence = named(name, {});
  VisitorFrame frame;
  frame.seconds = 0.5, frame.judged = false;
  sequence.frames.push_back(frame);
  frame.shot.visitors = {from0, from1};
  frame.seconds = 1.5;
  sequence.frames.push_back(frame);
  frame.seconds = 0.1, frame.judged = true;
  for (int k = 1; k <= pictures; k++) {
    const float at = float(k) / float(pictures);
    frame.shot.visitors[0].eyes = glm::mix(from0.eyes, to0, at);
    frame.shot.visitors[1].eyes = glm::mix(from1.eyes, to1, at);
    sequence.frames.push_back(frame);
  }
  return sequence;
}

Visitor at(int figure, vec3 eyes) {
  Visitor visitor;
  visitor.figure = figure, visitor.eyes = eyes;
  return visitor;
}

VisitorSequence spin() {
  VisitorSequence sequence =
      named("full spin in 3 s", begin_visit(0, 1, VisitorLight::normal, 1.5));
  const VisitorFrame stands = sequence.frames.back();
  for (int k = 1; k <= 24; k++) {
    VisitorFrame frame = stands;
    const float yaw = 15 * float(k);
    frame.shot.visitors[0].turn.x = (yaw > 180 ? yaw - 360 : yaw) * a_degree;
    frame.seconds = k < 24 ? 0.125 : 1, frame.judged = true;
    sequence.frames.push_back(frame);
  }
  return sequence;
}

VisitorSequence switched_light() {
  VisitorSequence sequence =
      named("light switched", begin_visit(0, 0.8f, VisitorLight::normal, 1.5));
  for (auto light : {VisitorLight::dim, VisitorLight::bright}) {
    VisitorFrame frame = sequence.frames.back();
    frame.shot.light = light, frame.seconds = 1, frame.judged = true;
    sequence.frames.push_back(frame);
  }
  return sequence;
}

VisitorSequence upside_down() {
  VisitorSequence sequence =
      look_about("camera upside down", 0, VisitorLight::normal, Worn::nothing);
  for (VisitorFrame& frame : sequence.frames) frame.change = turn_upside_down;
  return sequence;
}

// Steps move behind a visitor, or behind nobody.
VisitorSequence escalator(bool somebody) {
  VisitorSequence sequence = begin_visit(0, 1, VisitorLight::normal, 1.5);
  sequence.about = {{"case", somebody ? "escalator behind" : "escalator, nobody"}};
  if (!somebody) sequence.frames.resize(1);
  const VisitorFrame before = sequence.frames.back();
  for (int k = 0; k < 20; k++) {
    VisitorFrame frame = before;
    frame.seconds = 0.1, frame.judged = k > 4;
    frame.change = [k](VisitorPicture& picture) {
      paste_stripes({380, 0, 260, 480}, 0.13f * float(k), picture);
    };
    sequence.frames.push_back(frame);
  }
  return sequence;
}

// A portrait of the other figure hangs behind the visitor, or is printed on the shirt.
VisitorSequence portrait(bool on_shirt, const Image8& face, double seconds) {
  VisitorSequence sequence = begin_visit(0, 0.8f, VisitorLight::normal, 1.5);
  sequence.about = {{"case", on_shirt ? "portrait on a shirt" : "portrait on the wall, 22 s"}};
  VisitorFrame frame = sequence.frames.back();
  frame.seconds = 2, frame.judged = true;
  for (double time = 0; time < seconds; time += frame.seconds) {
    // People stir; who never does is taken for a portrait.
    frame.shot.visitors[0].turn.x = (sequence.frames.size() % 2 ? 4 : -4) * a_degree;
    sequence.frames.push_back(frame);
  }
  for (VisitorFrame& one : sequence.frames) {
    if (on_shirt && one.shot.visitors.empty()) continue;
    one.change = [face, on_shirt](VisitorPicture& picture) {
      const PictureArea part{245, 150, 150, 180};
      const PictureArea to =
          on_shirt ? PictureArea{290, 400, 60, 72} : PictureArea{470, 130, 100, 120};
      paste_portrait(face, part, to, !on_shirt, picture);
    };
  }
  return sequence;
}

std::vector<VisitorSequence> make_sequences(VisitorStage& stage) {
  using enum VisitorLight;
  using enum Worn;
  std::vector<VisitorSequence> all;
  for (int figure : {0, 1}) {
    all.push_back(look_about("nothing special", figure, normal, nothing));
    all.push_back(look_about("backlight", figure, back, nothing));
    all.push_back(look_about("half-lit face", figure, side, nothing));
    all.push_back(look_about("glasses", figure, normal, glasses));
    all.push_back(look_about("hat with a brim", figure, normal, hat));
    all.push_back(look_about("mask over mouth and nose", figure, normal, mask));
    all.push_back(look_about("hand before the face", figure, normal, hand));
    // At five years faces are about that large (Farkas 1994: pupils 51 mm apart, adults' 63).
    all.push_back(look_about("child of 1.1 m", figure, normal, nothing, 0.82f));
  }
  all.push_back(walk("two cross", at(0, {-0.4f, 0, 0.9f}), {0.4f, 0, 0.9f}, at(1, {0.5f, 0, 1.5f}),
                     {-0.6f, 0, 1.5f}, 20));
  all.push_back(walk("somebody walks behind", at(0, {0, 0, 0.8f}), {0, 0, 0.8f},
                     at(1, {-0.9f, 0.05f, 2}), {0.9f, 0.05f, 2}, 20));
  all.push_back(spin());
  all.push_back(switched_light());
  all.push_back(upside_down());
  all.push_back(escalator(true));
  all.push_back(escalator(false));
  VisitorShot model;
  model.visitors = {at(1, {0, 0, 0.8f})};
  const Image8 face = stage.draw(model, 4).image;
  all.push_back(portrait(false, face, 22));
  all.push_back(portrait(true, face, 2));
  return all;
}

struct Outcome {
  VisitorMean found, rotation, position;
  int most = 0;
  std::map<int, std::set<uint32_t>> numbers;  // numbers that each figure had
  std::map<uint32_t, std::set<int>> owners;   // figures that each number was given to
};

// Nobody is nearer to a place where somebody is seen than who really stands there.
void judge(const VisitorFrame& frame, const VisitorSeen& seen, Outcome& outcome) {
  outcome.most = std::max(outcome.most, seen.most);
  for (const Visitor& truth : frame.shot.visitors) {
    const VisitorSeen::Person* best = nullptr;
    auto off = [&](const VisitorSeen::Person& one) {  // by the picture
      return glm::length(vec2(one.position) / one.position.z - vec2(truth.eyes) / truth.eyes.z);
    };
    for (const auto& one : seen.people)
      if (off(one) < 0.12f && (!best || off(one) < off(*best))) best = &one;
    outcome.found.add(best != nullptr);
    if (!best) continue;
    const vec3 turn = glm::abs(best->rotation - truth.turn) / a_degree;
    if (std::abs(truth.turn.x) < 61 * a_degree)
      outcome.rotation.add((turn.x + turn.y + turn.z) / 3);
    outcome.position.add(glm::length(best->position - truth.eyes) / glm::length(truth.eyes));
    outcome.numbers[truth.figure].insert(best->id);
    outcome.owners[best->id].insert(truth.figure);
  }
}

}  // namespace

void bench_kiosk_hard(BenchReport& report, const BenchOptions& options) {
  VisitorStage stage = make_kiosk_stage(options);
  const auto sequences = make_sequences(stage);
  const auto seen = watch_visitors(stage, sequences, kiosk_watch(options, "hard"));
  std::vector<std::string> order;
  std::map<std::string, Outcome> outcomes;
  for (size_t s = 0; s < sequences.size(); s++) {
    const std::string name = sequences[s].about["case"];
    if (!outcomes.count(name)) order.push_back(name);
    Outcome& outcome = outcomes[name];
    Outcome one;  // numbers begin again with each sequence
    for (size_t f = 0; f < sequences[s].frames.size(); f++)
      if (sequences[s].frames[f].judged) judge(sequences[s].frames[f], seen[s][f], one);
    outcome.found.sum += one.found.sum, outcome.found.count += one.found.count;
    outcome.rotation.sum += one.rotation.sum, outcome.rotation.count += one.rotation.count;
    outcome.position.sum += one.position.sum, outcome.position.count += one.position.count;
    outcome.most = std::max(outcome.most, one.most);
    for (const auto& [figure, numbers] : one.numbers)
      outcome.numbers[int(100 * s) + figure] = numbers;
    for (const auto& [number, owners] : one.owners)
      outcome.owners[uint32_t(100 * s) + number] = owners;
  }
  for (const std::string& name : order) {
    const Outcome& outcome = outcomes[name];
    const nlohmann::json fields{{"case", name}};
    int swapped = 0, renamed = 0;
    for (const auto& [number, owners] : outcome.owners) swapped += int(owners.size()) - 1;
    for (const auto& [figure, numbers] : outcome.numbers) renamed += int(numbers.size()) - 1;
    report.add("kiosk.hard.people", outcome.most, "", fields);
    if (outcome.found.count == 0) continue;
    report.add("kiosk.hard.found", outcome.found.value(), "1", fields);
    report.add("kiosk.hard.swapped", swapped, "", fields);
    report.add("kiosk.hard.renamed", renamed, "", fields);
    if (outcome.position.count == 0) continue;
    if (outcome.rotation.count)
      report.add("kiosk.hard.deg", outcome.rotation.value(), "degrees", fields);
    report.add("kiosk.hard.position", outcome.position.value(), "1", fields);
  }
}

ReportPage kiosk_hard_page() {
  return {"kiosk.hard",
          "How far does the kiosk's eye hold where cameras and visitors make it difficult? The "
          "castle's two figures, ray-traced with what they wear; portraits and stripes are laid "
          "into finished pictures.",
          {"Found: of those who stand there. People: most at once who are taken for visitors.",
           "Swapped: a number that went from one person to the other. Renamed: a new number for "
           "somebody who was known.",
           "Errors: mean of the three axes; of the position over the distance. A child's face is "
           "smaller, but its irises are as wide as an adult's."},
          {{.caption = "",
            .rows = {{"case", "case"}},
            .columns = {{"kiosk.hard.found", "found", 100, "%"},
                        {"kiosk.hard.people", "people"},
                        {"kiosk.hard.swapped", "swapped"},
                        {"kiosk.hard.renamed", "renamed"},
                        {"kiosk.hard.deg", "rotation"},
                        {"kiosk.hard.position", "position", 100, "%"}},
            .most_rows = 18}}};
}

}  // namespace wellspring::test
