// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/station.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kiosk/station/box.h"
#include "kiosk/station/code.h"
#include "kiosk/station/glance.h"
#include "kiosk/station/outline.h"
#include "kiosk/station/pattern.h"
#include "kiosk/station/sight.h"
#include "kiosk/station/twins.h"

namespace wellspring::kiosk {

namespace {
constexpr double glance_every = 0.09;  // seconds

// Returns an object's right, down and away in those of one of its sides, as that is seen.
mat3 axes_of_side(const std::string& side) {
  const vec3 right(1, 0, 0), down(0, 1, 0), away(0, 0, 1);
  if (side == "back") return {-right, down, -away};
  if (side == "left") return {away, down, -right};
  if (side == "right") return {-away, down, right};
  if (side == "top") return {right, away, -down};
  if (side == "bottom") return {right, -away, down};
  return mat3(1);
}
}  // namespace

struct Station::Impl {
  RecognitionTree tree;
  StationSettings settings;
  Sight sight;
  ContextStore context;
  PatternSolver pattern;
  TwinSolver twins, colors;
  OutlineSolver outline;
  BoxSolver box;
  CodeSolver code;
  AlwaysSolver always;
  Traversal walk;
  Glance glance;
  bool mirrored = false;
  GrayFrame turned;  // the frame, turned back
  double glanced_at = -1e9, looked_at = -1e9, seen_at = -1e9, undecided_since = -1e9;
  int last = -1, agreed = 0;
  std::optional<Holding> told;

  Impl(RecognitionTree t, const StationSettings& s)
      : tree(std::move(t)),
        settings(s),
        pattern(tree, sight),
        twins(tree, sight, MarkKind::edges),
        colors(tree, sight, MarkKind::colors),
        outline(tree, sight),
        box(tree, sight),
        code(tree, sight),
        walk(tree, {{"pattern", &pattern},
                    {"twins", &twins},
                    {"colors", &colors},
                    {"outline", &outline},
                    {"box", &box},
                    {"code", &code},
                    {"always", &always}}) {
    settings.mount.mirrored = false;  // frames are turned back
    mirrored = s.mount.mirrored;
  }

  Recognition look(const GrayFrame& given) {
    if (mirrored) turn_back(given);
    const GrayFrame& frame = mirrored ? turned : given;
    look_at(sight, frame, focal_length(settings.mount, frame.width, frame.height));
    size_t sum = 0, count = 0;
    for (size_t i = 0; i < frame.pixels.size(); i += 16) sum += frame.pixels[i], count++;
    context.set(light_value, double(sum) / double(std::max<size_t>(count, 1)));
    return walk.step(context);
  }

  void turn_back(const GrayFrame& given) {
    turned = given;
    for (size_t row = 0; row < size_t(given.height); row++) {
      const auto begin = turned.pixels.begin() + long(row * size_t(given.width));
      std::reverse(begin, begin + given.width);
    }
    const size_t across = size_t(given.color_width);
    for (size_t row = 0; row < size_t(given.color_height) && !given.bgr.empty(); row++)
      for (size_t x = 0; x < across; x++)
        for (size_t c = 0; c < 3; c++)
          turned.bgr[3 * (row * across + x) + c] =
              given.bgr[3 * (row * across + across - 1 - x) + c];
  }

  const View* seen_view(int node) const {
    if (pattern.seen() && context.has(pose_value) && !context.has(turns_value))
      return pattern.seen();
    const double* view = context.get<double>(view_value);
    for (int at : walk.path()) {
      const auto& views = tree.data[size_t(at)].views;
      if (view && *view >= 0 && size_t(*view) < views.size()) return &views[size_t(*view)];
    }
    return nullptr;
  }

  // Says where the object is, if its size is known.
  void place(Holding& out, int node) const {
    const mat3* pose = context.get<mat3>(pose_value);
    const View* view = seen_view(node);
    if (!pose || !view || view->size.x <= 0 || view->size.y <= 0) return;
    const GrayFrame& frame = *sight.frame;
    const auto found = solve_rectangle(corners_of(*pose, *view), view->size, sight.focal,
                                       frame.width, frame.height);
    if (!found || found->error > 0.05f * std::sqrt(std::abs(area_of(corners_of(*pose, *view)))))
      return;
    out.position = camera_to_screen(settings.mount, found->position);
    out.rotation = rotation_on_screen(settings.mount, found->rotation * axes_of_side(view->side));
  }

  Holding describe(const Recognition& found) const {
    const RecognitionNode& node = tree.nodes[size_t(found.node)];
    Holding out;
    const RecognitionNode* of_class = node.kind == NodeKind::model ? nullptr : &node;
    if (node.kind == NodeKind::model) {
      out.id = node.id;
      for (const int at : walk.path())
        if (at != found.node && !tree.nodes[size_t(at)].id.empty())
          of_class = &tree.nodes[size_t(at)];
    }
    if (of_class) out.of_class = of_class->id;
    out.title = node.title;
    if (const auto hint = tree.hints.find(found.hint);
        hint != tree.hints.end() && sight.frame->time - undecided_since >= settings.hint_after)
      out.hint = hint->second;
    place(out, found.node);
    return out;
  }

  std::optional<Holding> step(const GrayFrame& given) {
    const double time = given.time;
    if (time < looked_at) forget();
    if (last < 0 && agreed == 0) {
      if (std::abs(time - glanced_at) < glance_every) return keep(time);
      glanced_at = time;
      glance.step(given);
      if (time - looked_at < pause()) return keep(time);
    }
    looked_at = time;
    const Recognition found = look(given);
    if (found.node < 0) glance.note_vain();
    if (found.node != last || found.node < 0) agreed = 0;
    last = found.node;
    if (found.node < 0) return keep(time);
    const bool model = tree.nodes[size_t(found.node)].kind == NodeKind::model;
    if (model) undecided_since = time;
    else if (time - seen_at > 1) undecided_since = time;
    if (++agreed < settings.sure_after) return keep(time);
    seen_at = time;
    told = describe(found);
    return told;
  }

  double pause() const {
    if (!glance.changed()) return settings.look_rarely;
    return glance.rests() ? settings.look_every : settings.look_moving;
  }

  std::optional<Holding> keep(double time) {
    if (time - seen_at > settings.hold) told.reset();
    return told;
  }

  void forget() {
    walk.restart();
    last = -1, agreed = 0;
    looked_at = seen_at = undecided_since = -1e9;
    told.reset();
  }
};

Station::Station(RecognitionTree tree, const StationSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(tree), settings)) {}
Station::~Station() = default;
std::optional<Holding> Station::step(const GrayFrame& frame) { return impl_->step(frame); }
Recognition Station::look(const GrayFrame& frame) { return impl_->look(frame); }
void Station::forget() { impl_->forget(); }
const RecognitionTree& Station::tree() const { return impl_->tree; }
const ContextStore& Station::context() const { return impl_->context; }

}  // namespace wellspring::kiosk
