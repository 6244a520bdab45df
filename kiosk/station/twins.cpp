// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/twins.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kiosk/station/pattern.h"

namespace wellspring::kiosk {
namespace {

constexpr double remembered = 8;  // seconds
constexpr float newest_weight = 0.4f;
constexpr float differ = 0.25f;       // marks of two objects that tell them apart
constexpr float sure_margin = 0.4f;   // 1: as far from the other as the two marks are
constexpr float explained = 0.55f;    // how far the nearest child's mark may be from the picture
constexpr float color_unit = 50;      // distance in Lab that counts as 1
constexpr float least_scale = 0.45f;  // pixels of the picture a pixel of the view
constexpr double dark = 45;           // mean brightness of a picture
constexpr float glare = 0.25f;        // share of a mark's pixels that are white
constexpr int play = 4;               // pixels that a pose may be wrong by

vec3 mean_color(const std::vector<uint8_t>& bgr) {
  vec3 sum(0);
  for (size_t i = 0; i + 2 < bgr.size(); i += 3) sum += vec3(bgr[i], bgr[i + 1], bgr[i + 2]);
  return sum / std::max(1.f, float(bgr.size() / 3));
}

// Converts blue, green, red of sRGB, 0..255, to CIE Lab under D65.
vec3 to_lab(vec3 bgr) {
  auto linear = [](float v) {
    v = std::clamp(v / 255, 0.f, 1.f);
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  const float b = linear(bgr.x), g = linear(bgr.y), r = linear(bgr.z);
  auto f = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.f / 116; };
  const float x = f((0.4124f * r + 0.3576f * g + 0.1805f * b) / 0.95047f);
  const float y = f(0.2126f * r + 0.7152f * g + 0.0722f * b);
  const float z = f((0.0193f * r + 0.1192f * g + 0.9505f * b) / 1.08883f);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

std::vector<uint8_t> gray_of_mark(const Mark& mark) {
  std::vector<uint8_t> out(size_t(mark.width) * size_t(mark.height));
  for (size_t i = 0; i < out.size(); i++)
    out[i] = uint8_t(0.114f * mark.bgr[3 * i] + 0.587f * mark.bgr[3 * i + 1] +
                     0.299f * mark.bgr[3 * i + 2] + 0.5f);
  return out;
}

// Returns how far a mark is from a larger picture that has it somewhere.
float edges_apart(const Mark& mark, int width, int height, const uint8_t* picture) {
  const auto own = gray_of_mark(mark);
  float best = -1;
  for (int y = 0; y + mark.height <= height; y++)
    for (int x = 0; x + mark.width <= width; x++)
      best = std::max(best, correlate(mark.width, mark.height, own.data(), mark.width,
                                      picture + y * width + x, width));
  return std::clamp(1 - best, 0.f, 1.f);
}

}  // namespace

float marks_apart(MarkKind kind, const Mark& a, const Mark& b) {
  if (kind == MarkKind::colors)
    return std::min(
        1.f, glm::distance(to_lab(mean_color(a.bgr)), to_lab(mean_color(b.bgr))) / color_unit);
  // The middle of one is sought within the other, so that a shift is no difference.
  const int edge = std::min({play, a.width / 4, a.height / 4});
  Mark middle{a.view, 0, 0, a.width - 2 * edge, a.height - 2 * edge, {}};
  for (int y = 0; y < middle.height; y++) {
    const auto row = a.bgr.begin() + 3 * ((y + edge) * a.width + edge);
    middle.bgr.insert(middle.bgr.end(), row, row + 3 * middle.width);
  }
  return edges_apart(middle, b.width, b.height, gray_of_mark(b).data());
}

TwinSolver::TwinSolver(const RecognitionTree& tree, Sight& sight, MarkKind kind)
    : tree_(tree), sight_(sight), kind_(kind) {
  for (size_t n = 0; n < tree.nodes.size(); n++) {
    const RecognitionNode& node = tree.nodes[n];
    const char* own = kind == MarkKind::edges ? "twins" : "colors";
    if (std::ranges::none_of(node.solvers, [&](const auto& one) { return one.solver == own; }))
      continue;
    const size_t children = node.children.size();
    auto& apart = apart_[int(n)];
    apart.resize(tree.data[size_t(node.children[0])].marks.size());
    for (size_t m = 0; m < apart.size(); m++) {
      apart[m].assign(children * children, 0.f);
      for (size_t a = 0; a < children; a++)
        for (size_t b = 0; b < a; b++)
          apart[m][a * children + b] = apart[m][b * children + a] =
              marks_apart(kind, tree.data[size_t(node.children[a])].marks[m],
                          tree.data[size_t(node.children[b])].marks[m]);
    }
  }
}

std::vector<std::string> TwinSolver::needs() const { return {pose_value, view_value, scale_value}; }

// Returns how far the picture is from each child's mark; nothing if the mark cannot be judged, and
// why.
std::vector<float> TwinSolver::measure(int node, size_t at, const mat3& pose, const View& view,
                                       float scale, std::string& trouble) const {
  const std::vector<int>& children = tree_.nodes[size_t(node)].children;
  const Mark& place = tree_.data[size_t(children[0])].marks[at];
  const int more = kind_ == MarkKind::edges ? play : 0;
  const Box part{float(place.x - more), float(place.y - more), float(place.width + 2 * more),
                 float(place.height + 2 * more)};
  std::vector<float> out;
  const Patch gray = take_gray(sight_, pose, part, 1);
  if (gray.inside < 1) return trouble = "whole", out;
  const auto white = std::ranges::count_if(gray.pixels, [](uint8_t v) { return v >= 250; });
  const bool shines = float(white) > glare * float(gray.pixels.size());
  vec3 color(0);
  if (kind_ == MarkKind::colors) {
    const Patch seen = take_color(sight_, pose, part, 0.5f);
    const Box whole{0, 0, float(view.width), float(view.height)};
    const Patch all = take_color(sight_, pose, whole, 0.15f);
    if (seen.pixels.empty()) return out;
    // The whole view says how the light is.
    const vec3 now = glm::max(mean_color(all.pixels), vec3(1));
    const vec3 gain = view.mean.x > 0 ? glm::clamp(view.mean / now, 0.33f, 3.f) : vec3(1);
    color = to_lab(mean_color(seen.pixels) * gain);
  }
  for (const int child : children) {
    const Mark& mark = tree_.data[size_t(child)].marks[at];
    out.push_back(
        kind_ == MarkKind::edges
            ? edges_apart(mark, gray.width, gray.height, gray.pixels.data())
            : std::min(1.f, glm::distance(color, to_lab(mean_color(mark.bgr))) / color_unit));
  }
  if (*std::ranges::min_element(out) <= explained) return out;
  trouble = shines ? "tilt" : scale < 2 * least_scale ? "closer" : "still";
  return {};
}

// Looks at all marks of the view that is seen.
void TwinSolver::look(int node, const ContextStore& context, Memory& memory, std::string& trouble) {
  const auto& views = tree_.data[size_t(node)].views;
  const auto& children = tree_.nodes[size_t(node)].children;
  const auto& first = tree_.data[size_t(children[0])].marks;
  const int view = int(*context.get<double>(view_value));
  if (view < 0 || size_t(view) >= views.size()) return;
  const double time = sight_.frame->time;
  const float scale = float(*context.get<double>(scale_value));
  memory.views[size_t(view)] = time;
  if (scale < least_scale) {
    trouble = "closer";
    return;
  }
  const View& seen = views[size_t(view)];
  const mat3& pose = *context.get<mat3>(pose_value);
  // An outline that looks the same when it is turned may be seen in any of these ways.
  const double* ways = context.get<double>(turns_value);
  const int turns = ways ? int(*ways) : 1;
  std::vector<std::vector<float>> best(first.size());
  float least = 1e9f;
  for (int turn = 0; turn < turns; turn++) {
    const float angle = 2 * pi * float(turn) / float(turns);
    const float w = float(seen.width), h = float(seen.height);
    const mat3 to_middle(vec3(1, 0, 0), vec3(0, 1, 0), vec3(-w / 2, -h / 2, 1));
    const mat3 spin(vec3(std::cos(angle), std::sin(angle), 0),
                    vec3(-std::sin(angle), std::cos(angle), 0), vec3(0, 0, 1));
    const mat3 from_middle(vec3(1, 0, 0), vec3(0, 1, 0), vec3(w / 2, h / 2, 1));
    const mat3 turned = turns > 1 ? pose * from_middle * spin * to_middle : pose;
    std::vector<std::vector<float>> now(first.size());
    float sum = 0;
    std::vector<float> sums(children.size(), 0.f);
    for (size_t m = 0; m < first.size(); m++) {
      if (first[m].view != view) continue;
      now[m] = measure(node, m, turned, seen, scale, trouble);
      for (size_t c = 0; c < children.size(); c++) sums[c] += now[m].empty() ? 1 : now[m][c];
    }
    sum = *std::ranges::min_element(sums);
    if (sum < least) least = sum, best = std::move(now);
  }
  for (size_t m = 0; m < first.size(); m++) {
    if (best[m].empty()) continue;
    Seen& kept = memory.marks[m];
    if (kept.apart.empty()) kept.apart = best[m];
    for (size_t c = 0; c < children.size(); c++)
      kept.apart[c] += newest_weight * (best[m][c] - kept.apart[c]);
    kept.time = time;
  }
}

Answer TwinSolver::decide(int node, int child, int view, const Memory& memory,
                          const std::string& trouble) const {
  const auto& children = tree_.nodes[size_t(node)].children;
  const auto& apart = apart_.at(node);
  const auto& marks = tree_.data[size_t(children[0])].marks;
  const size_t count = children.size(), a = size_t(child);
  Answer out{Verdict::sure, 1e9};
  float fits = 0, known = 0;
  for (size_t b = 0; b < count; b++) {
    if (b == a) continue;
    float nearer = 0, differs = 0;
    bool here = false, elsewhere = tree_.data[size_t(children[a])].views.size() > 0;
    for (size_t m = 0; m < marks.size(); m++) {
      const float between = apart[m][a * count + b];
      if (between < differ) continue;
      (marks[m].view == view ? here : elsewhere) = true;
      const auto& seen = memory.marks[m].apart;
      if (seen.empty()) continue;
      nearer += seen[b] - seen[a], differs += between;
      fits += seen[a], known += 1;
    }
    const float margin = differs > 0 ? nearer / differs : 0;
    out.score = std::min(out.score, double(margin));
    if (margin < -sure_margin) return {Verdict::no, margin};
    if (margin >= sure_margin) continue;
    if (out.verdict == Verdict::undecided) continue;
    out.verdict = Verdict::undecided;
    const bool turned_just_now = std::ranges::any_of(memory.views, [&](const double& time) {
      return &time - memory.views.data() != view && sight_.frame->time - time < remembered;
    });
    if (!here && elsewhere && !turned_just_now) out.hint = "turn";
    else if (!trouble.empty()) out.hint = trouble;
    else out.hint = elsewhere && !here ? "closer" : "still";
  }
  // An object that only outlines told must also have the colours themselves.
  if (out.verdict == Verdict::sure && known > 0 && fits / known > explained)
    return {Verdict::no, out.score};
  if (count == 1) {
    float sum = 0, seen = 0;
    for (size_t m = 0; m < marks.size(); m++)
      if (!memory.marks[m].apart.empty()) sum += memory.marks[m].apart[0], seen += 1;
    const bool good = 2 * seen >= float(marks.size()) && seen > 0 && sum / seen < explained / 2;
    return {good ? Verdict::sure : Verdict::no, good ? 1.0 : 0.0};
  }
  return out;
}

void TwinSolver::judge(int node, const ContextStore& context) {
  const auto& children = tree_.nodes[size_t(node)].children;
  Memory& memory = memories_[node];
  const double time = sight_.frame->time;
  memory.marks.resize(tree_.data[size_t(children[0])].marks.size());
  memory.views.resize(tree_.data[size_t(node)].views.size(), -1e9);
  for (Seen& one : memory.marks)
    if (std::abs(time - one.time) > remembered) one.apart.clear();
  std::string trouble;
  look(node, context, memory, trouble);
  const double* light = context.get<double>(light_value);
  if (!trouble.empty() && trouble != "closer" && light && *light < dark) trouble = "light";
  const int view = int(*context.get<double>(view_value));
  judged_ = {sight_.number, node, {}};
  for (size_t c = 0; c < children.size(); c++)
    judged_.answers.push_back(decide(node, int(c), view, memory, trouble));
}

Answer TwinSolver::match(int node, int child, ContextStore& context) {
  if (judged_.sight != sight_.number || judged_.node != node) judge(node, context);
  const auto& children = tree_.nodes[size_t(node)].children;
  const size_t index = size_t(std::ranges::find(children, child) - children.begin());
  return judged_.answers[index];
}

}  // namespace wellspring::kiosk
