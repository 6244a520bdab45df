// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/writer.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace wellspring::kiosk {

namespace {

// Returns the displacement after a share of the arc.
vec2 along_arc(const Stroke& stroke, float share) {
  if (std::abs(stroke.bend) < 1e-3f) return stroke.chord * share;
  const float radius = glm::length(stroke.chord) / (2 * std::sin(stroke.bend / 2));
  const float first = std::atan2(stroke.chord.y, stroke.chord.x) - stroke.bend / 2;
  const float now = first + stroke.bend * share;
  return radius * vec2(std::sin(now) - std::sin(first), std::cos(first) - std::cos(now));
}

}  // namespace

float normal(Rng& rng) {
  const float radius = std::sqrt(-2 * std::log(1 - rng.uniform()));
  return radius * std::cos(2 * pi * rng.uniform());
}

float between(Rng& rng, float low, float high) { return low + (high - low) * rng.uniform(); }

vec2 turned(vec2 v, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

vec2 eval_strokes(std::span<const Stroke> strokes, double time) {
  vec2 place{0};
  for (const Stroke& stroke : strokes) {
    // `seconds` reaches from three deviations before the median to three after it.
    const double median = stroke.seconds / (2 * std::sinh(3.0 * stroke.sigma));
    const double passed = time - stroke.begin + median * std::exp(-3.0 * stroke.sigma);
    if (passed <= 0) continue;
    const double z = std::log(passed / median) / stroke.sigma;
    place += along_arc(stroke, float(0.5 * std::erfc(-z / std::sqrt(2.0))));
  }
  return place;
}

std::vector<HandPlace> watch_strokes(std::span<const Stroke> strokes, vec2 start, double seconds,
                                     const HandCamera& camera, Rng& rng) {
  std::vector<HandPlace> places;
  const double step = 1 / double(camera.rate);
  const float keep = std::exp(-float(step) / 0.2f);
  vec2 slow = camera.tremor * vec2(normal(rng), normal(rng));
  for (double time = 0; time < seconds; time += step) {
    const vec2 fresh(normal(rng), normal(rng)), noise(normal(rng), normal(rng));
    slow = keep * slow + std::sqrt(1 - keep * keep) * camera.tremor * fresh;
    if (rng.uniform() < camera.lost) continue;
    places.push_back({time, start + eval_strokes(strokes, time) + slow + camera.noise * noise});
  }
  return places;
}

namespace {

// This is a stroke in a box one digit high; bend in degrees.
struct Form {
  float x, y, bend;
};
struct Shape {
  const char* label;
  const char* variant;
  std::vector<Form> forms;
};

// Returns digits as they are drawn in one line (Elmezain et al. 2009, figure 4).
const std::vector<Shape>& digits() {
  static const std::vector<Shape> shapes = {
      {"0",
       "",
       {{-0.32f, 0.5f, -90}, {0.32f, 0.5f, -90}, {0.32f, -0.5f, -90}, {-0.32f, -0.5f, -90}}},
      {"1", "", {{0.38f, -0.38f, 0}, {0, 1, 0}}},
      {"2", "", {{0.58f, 0.12f, 140}, {-0.58f, 0.72f, 15}, {0.72f, 0, 0}}},
      {"3", "", {{0.06f, 0.46f, 215}, {-0.08f, 0.54f, 215}}},
      {"4", "", {{-0.45f, 0.62f, 0}, {0.75f, 0, 0}, {-0.2f, -0.4f, 0}, {0, 0.8f, 0}}},
      {"5", "", {{-0.52f, 0, 0}, {-0.03f, 0.4f, 0}, {-0.03f, 0.58f, 205}}},
      {"6", "", {{-0.42f, 0.72f, -55}, {0.5f, 0.02f, -150}, {-0.45f, 0, -150}}},
      {"7", "", {{0.65f, 0, 0}, {-0.38f, 1, 0}}},
      {"8", "", {{-0.05f, 0.5f, -200}, {0, 0.5f, 200}, {0, -0.5f, 200}, {0.05f, -0.5f, -200}}},
      {"9", "", {{-0.5f, 0.18f, -150}, {0.5f, -0.18f, -150}, {-0.05f, 0.95f, 8}}}};
  return shapes;
}

constexpr float degree = pi / 180;

struct Limits {
  float rotation, slant, aspect, size, pace, habit;
};
constexpr Limits limits_of(WriterGroup group) {
  return group == WriterGroup::training ? Limits{9, 8, 0.2f, 0.28f, 0.3f, 0.05f}
                                        : Limits{12, 10, 0.26f, 0.34f, 0.36f, 0.06f};
}

// Holds strokes one after the other, and the hand's place after them.
struct Score {
  std::vector<Stroke> strokes;
  double end = 0;  // end of the last stroke, seconds
  vec2 place{0};
};

void add(Score& score, vec2 chord, float bend, double begin, double seconds, float sigma) {
  score.strokes.push_back({chord, bend, begin, seconds, sigma});
  score.end = begin + seconds;
  score.place += chord;
}

// Adds a way that is no part of a gesture.
void go_to(Score& score, const HandWriter& w, Rng& rng, vec2 place, double pause) {
  const vec2 chord = place - score.place;
  const double seconds =
      w.pace * (0.35 + 0.45 * std::sqrt(glm::length(chord))) * between(rng, 0.8f, 1.2f);
  // It overlaps with the stroke before, if there is no pause.
  const double begin =
      pause > 0 ? score.end + pause : score.end - 0.5 * double(w.overlap) * seconds;
  add(score, chord, between(rng, -60, 60) * degree, std::max(begin, 0.0), seconds, w.sigma);
}

// Holds the strokes of a gesture in this writer's hand, with its own habits and the moment's
// looseness.
struct Plan {
  std::vector<Stroke> strokes;  // their begins count from the gesture's own
  std::string variant;
  double dwell = 0;
  vec2 low{0}, high{0};  // bounds of all places, from the first one
};

void finish(Plan& plan, float overlap) {
  double begin = 0;
  for (Stroke& stroke : plan.strokes) {
    stroke.begin = begin;
    begin += stroke.seconds * (1 - double(overlap));
  }
  const double end = plan.strokes.back().begin + plan.strokes.back().seconds;
  for (int i = 0; i <= 40; i++) {
    const vec2 p = eval_strokes(plan.strokes, end * i / 40);
    plan.low = glm::min(plan.low, p), plan.high = glm::max(plan.high, p);
  }
}

Plan plan_digit(const HandWriter& w, const Shape& shape, Rng& rng) {
  Plan plan;
  plan.variant = shape.variant;
  Rng habits(w.habits ^ mix64(uint64_t(shape.label[0])));
  const float size = w.size * (1 + w.looseness * normal(rng));
  const float turn = w.rotation + 0.6f * w.looseness * normal(rng);
  const double pace = w.pace * (1 + 1.5f * w.looseness * normal(rng));
  for (const Form& form : shape.forms) {
    const float habit = limits_of(WriterGroup::training).habit;
    const float scale = 1 + habit * normal(habits) + w.looseness * normal(rng);
    const float way = habit * normal(habits) + w.looseness * normal(rng);
    const float bend = 1 + 1.5f * (habit * normal(habits) + w.looseness * normal(rng));
    vec2 chord = turned({form.x, form.y}, way) * scale;
    chord = vec2(chord.x * w.aspect - chord.y * w.slant, chord.y) * size;
    const float length = glm::length(chord) * (1 + std::abs(form.bend) / 400);
    const double seconds = 0.95 * pace * std::sqrt(double(length)) * between(rng, 0.9f, 1.1f);
    plan.strokes.push_back({turned(chord, turn), form.bend * bend * degree, 0, seconds, w.sigma});
  }
  finish(plan, w.overlap);
  return plan;
}

Plan plan_wave(const HandWriter& w, Rng& rng) {
  Plan plan;
  float side = rng.uniform() < 0.5f ? -1.f : 1.f;
  plan.variant = side < 0 ? "left first" : "right first";
  const int strokes = 4 + int(rng.next() % 4);
  const float size = w.size * between(rng, 0.5f, 0.8f);
  for (int i = 0; i < strokes; i++, side = -side) {
    const float width = size * (1 + 2 * w.looseness * normal(rng));
    const vec2 chord = turned({side * width, 0.05f * width * normal(rng)}, 0.5f * w.rotation);
    // The hand swings round the elbow below it.
    const float bend = side * between(rng, 15, 60) * degree;
    plan.strokes.push_back({chord, bend, 0, w.pace * between(rng, 0.3f, 0.45f), w.sigma});
  }
  finish(plan, 0.8f * w.overlap);
  return plan;
}

Plan plan_swipe(const HandWriter& w, const std::string& label, Rng& rng) {
  Plan plan;
  const std::string_view way = std::string_view(label).substr(6);
  const vec2 to = way == "left"    ? vec2(-1, 0)
                  : way == "right" ? vec2(1, 0)
                  : way == "up"    ? vec2(0, -1)
                                   : vec2(0, 1);
  const float length = w.size * between(rng, 0.85f, 1.4f);
  const float turn = 0.5f * w.rotation + 5 * degree * normal(rng);
  plan.strokes.push_back({turned(to * length, turn), between(rng, -30, 30) * degree, 0,
                          w.pace * between(rng, 0.28f, 0.45f), w.sigma});
  finish(plan, 0);
  return plan;
}

Plan plan_point(const HandWriter& w, Rng& rng) {
  Plan plan;
  const float length = between(rng, 0.6f, 1.1f);
  const float turn = between(rng, -50, 50);
  plan.variant = turn < -17 ? "left" : turn < 17 ? "up" : "right";
  const vec2 chord = turned({0, -length}, turn * degree);
  plan.strokes.push_back(
      {chord, between(rng, -35, 35) * degree, 0, w.pace * between(rng, 0.7f, 1.1f), w.sigma});
  plan.dwell = between(rng, 0.9f, 1.6f);
  finish(plan, 0);
  return plan;
}

Plan plan_gesture(const HandWriter& w, const std::string& label, Rng& rng) {
  for (const Shape& shape : digits())
    if (label == shape.label) return plan_digit(w, shape, rng);
  if (label == "wave") return plan_wave(w, rng);
  if (label == "point") return plan_point(w, rng);
  return plan_swipe(w, label, rng);
}

// Chooses where the gesture may begin: digits and waves in front of chest and face, pointing from
// below to where the hand does not hide the face.
vec2 choose_start(const Plan& plan, const std::string& label, Rng& rng) {
  const vec2 way = plan.strokes[0].chord;
  while (label == "point") {
    const vec2 start(between(rng, -0.3f, 0.6f), between(rng, 1.2f, 1.6f));
    if (glm::length(start + way) > 0.45f) return start;
  }
  const vec2 middle(between(rng, -0.2f, 0.7f), between(rng, 0.3f, 0.9f));
  return middle - 0.5f * (plan.low + plan.high);
}

void add(Score& score, const Plan& plan, double begin) {
  for (Stroke stroke : plan.strokes)
    add(score, stroke.chord, stroke.bend, begin + stroke.begin, stroke.seconds, stroke.sigma);
  score.end += plan.dwell;
}

vec2 low_place(Rng& rng) { return {between(rng, 0.2f, 0.8f), between(rng, 1.9f, 2.4f)}; }

// Adds small strokes there and back, as when talking or scratching.
void fidget(Score& score, const HandWriter& w, Rng& rng, int strokes, float size, float seconds) {
  const vec2 home = score.place;
  for (int i = 0; i < strokes; i++) {
    const vec2 to = home + size * vec2(normal(rng), 0.7f * normal(rng));
    const double pause = rng.uniform() < 0.4f ? between(rng, 0.05f, 0.7f) : 0;
    const double begin = pause > 0 ? score.end + pause : score.end - 0.2 * seconds;
    add(score, to - score.place, between(rng, -90, 90) * degree, begin,
        w.pace * seconds * between(rng, 0.7f, 1.3f), w.sigma);
  }
}

}  // namespace

HandWriter make_writer(WriterGroup group, uint64_t seed) {
  Rng rng(mix64(seed * 2 + (group == WriterGroup::held_out ? 1 : 0)));
  const Limits limits = limits_of(group);
  HandWriter w;
  auto spread = [&](float most) { return between(rng, -most, most); };
  w.rotation = spread(limits.rotation) * degree;
  w.slant = std::tan(spread(limits.slant) * degree);
  w.aspect = std::exp(spread(limits.aspect));
  w.size = 0.65f * std::exp(spread(limits.size));
  w.pace = std::exp(spread(limits.pace));
  w.overlap = between(rng, 0.2f, 0.45f);
  w.sigma = between(rng, 0.2f, 0.35f);
  w.looseness = limits.habit * between(rng, 0.5f, 1);
  w.habits = mix64(seed);
  w.camera.rate = between(rng, 15, 30);
  return w;
}

const std::vector<std::string>& gesture_labels() {
  static const std::vector<std::string> labels = {
      "0", "1", "2",    "3",     "4",          "5",           "6",        "7",
      "8", "9", "wave", "point", "swipe_left", "swipe_right", "swipe_up", "swipe_down"};
  return labels;
}

WrittenPath write_gestures(const HandWriter& w, const std::vector<std::string>& labels,
                           uint64_t seed) {
  Rng rng(mix64(seed));
  WrittenPath out;
  Score score;
  score.place = low_place(rng);
  const vec2 start = score.place;
  score.end = between(rng, 0.2f, 0.6f);
  for (const std::string& label : labels) {
    const Plan plan = plan_gesture(w, label, rng);
    const float rest = between(rng, 0, 0.4f);
    go_to(score, w, rng, choose_start(plan, label, rng), rng.uniform() < 0.5f ? rest : 0);
    const double begin =
        score.end + (rng.uniform() < 0.5f ? between(rng, 0, 0.4f) : -0.06f * w.overlap);
    add(score, plan, begin);
    out.gestures.push_back({label, begin, score.end});
    out.path.variant = plan.variant;
  }
  go_to(score, w, rng, low_place(rng), rng.uniform() < 0.5f ? between(rng, 0, 0.4f) : 0);
  out.path.places = watch_strokes(score.strokes, start, score.end + 0.8, w.camera, rng);
  return out;
}

HandPath write_gesture(const HandWriter& w, const std::string& label, uint64_t seed) {
  WrittenPath written = write_gestures(w, {label}, seed);
  HandPath path{label, written.path.variant, {}};
  for (const HandPlace& seen : written.path.places)
    if (seen.time >= written.gestures[0].begin && seen.time <= written.gestures[0].end)
      path.places.push_back(seen);
  return path;
}

HandPath write_other(const HandWriter& w, double seconds, uint64_t seed) {
  Rng rng(mix64(seed));
  Score score;
  score.place = low_place(rng);
  const vec2 start = score.place;
  while (score.end < seconds) {
    const double pause = between(rng, 0.1f, 1.5f);
    switch (rng.next() % 5) {
      case 0:  // shifts where it is
        fidget(score, w, rng, 1 + int(rng.next() % 3), 0.08f, 0.5f);
        break;
      case 1:  // scratches the face
        go_to(score, w, rng, {between(rng, -0.2f, 0.25f), between(rng, -0.1f, 0.35f)}, pause);
        fidget(score, w, rng, 3 + int(rng.next() % 5), 0.05f, 0.22f);
        go_to(score, w, rng, low_place(rng), pause);
        break;
      case 2:  // talks
        go_to(score, w, rng, {between(rng, 0, 0.7f), between(rng, 0.7f, 1.3f)}, pause);
        fidget(score, w, rng, 3 + int(rng.next() % 8), 0.2f, 0.45f);
        go_to(score, w, rng, low_place(rng), pause);
        break;
      case 3:  // goes from place to place
        for (int i = 0; i < 4; i++)
          go_to(score, w, rng, {between(rng, -0.5f, 1), between(rng, 0, 1.2f)}, i == 0 ? pause : 0);
        go_to(score, w, rng, low_place(rng), pause);
        break;
      default:  // reaches for something
        go_to(score, w, rng, {between(rng, -0.6f, 1.2f), between(rng, 0, 1.4f)}, pause);
        go_to(score, w, rng, low_place(rng), between(rng, 0.1f, 0.7f));
    }
  }
  return {"", "", watch_strokes(score.strokes, start, seconds, w.camera, rng)};
}

std::vector<HandPath> write_set(WriterGroup group, int writers, int each, uint64_t seed) {
  std::vector<HandPath> out;
  for (int i = 0; i < writers; i++) {
    const HandWriter writer = make_writer(group, seed + uint64_t(i));
    for (int k = 0; k < 2 * each; k++)
      out.push_back(write_other(writer, 30, mix64(seed) + uint64_t(i * 64 + k)));
    for (size_t g = 0; g < gesture_labels().size(); g++)
      for (int k = 0; k < each; k++)
        out.push_back(write_gesture(writer, gesture_labels()[g],
                                    mix64(seed) + uint64_t((i * 64 + int(g)) * 64 + k)));
  }
  return out;
}

}  // namespace wellspring::kiosk
