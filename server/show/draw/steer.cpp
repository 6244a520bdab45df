// SPDX-License-Identifier: Apache-2.0
#include "show/draw/steer.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "show/draw/pace.h"
#include "show/kiosk/kiosk.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"

namespace wellspring::show {
namespace {

// Holds a kind of hint: radius over the picture's width, and weight. A pointer is exact, and beside
// its object lies what is behind it. A head shows within some 10 degrees where the eyes look.
struct HintKind {
  float radius, weight;
};
constexpr HintKind pointer_hint{0.02f, 1}, head_hint{0.15f, 0.5f}, shown_hint{0.04f, 0.8f};
constexpr float far_away = 1e4f;  // metres

// Averages `scale` x `scale` pixels for each pixel of a row.
void reduce_row(const Image8& image, int scale, int y, Image8& small) {
  for (int x = 0; x < small.width; x++)
    for (int c = 0; c < 3; c++) {
      int sum = 0;
      for (int v = y * scale; v < (y + 1) * scale; v++)
        for (int u = x * scale; u < (x + 1) * scale; u++)
          sum += image.rgb[3 * (size_t(v) * size_t(image.width) + size_t(u)) + size_t(c)];
      small.rgb[3 * (size_t(y) * size_t(small.width) + size_t(x)) + size_t(c)] =
          uint8_t(sum / (scale * scale));
    }
}

// Returns the object of the middle of such pixels, or of the first around it with a point.
uint32_t find_object(const PointCache& points, const PointImage& image, int x, int y, int around) {
  for (int away = 0; away <= around; away++)
    for (ivec2 step : {ivec2(1, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1)}) {
      ivec2 at = ivec2(x, y) + away * step;
      if (at.x < 0 || at.y < 0 || at.x >= image.width || at.y >= image.height) continue;
      uint32_t point = image.point[size_t(at.y) * size_t(image.width) + size_t(at.x)];
      if (point != no_point) return points.color[point].object;
    }
  return 0;
}

// Adds a hint where a place is seen in that picture, if it is.
void add_hint(const SeenPicture& seen, vec3 place, HintKind kind, std::vector<AttentionHint>& to) {
  Projected at = project_point(seen.view, place);
  AttentionHint hint{vec2(at.x, at.y) / float(seen.scale), kind.radius * float(seen.picture.width),
                     kind.weight};
  if (at.depth > 0 && std::isfinite(hint.place.x) && std::isfinite(hint.place.y) &&
      std::isfinite(hint.weight))
    to.push_back(hint);
}

// Returns a far place in the direction of `place`, which is in the visitor's picture, 0 to 1.
vec3 place_in_picture(const View& view, vec2 place) {
  Ray ray = view_ray(view, place.x * float(view.width), place.y * float(view.height));
  return ray.origin + ray.direction * far_away;
}

const Person* nearest_person(const Show& show, const Visitor& visitor) {
  const Person* nearest = nullptr;
  const std::string kiosk = kiosk_name(show, visitor.name);
  for (const Eye& eye : show.kiosks.eyes) {
    if (eye.kiosk != kiosk || show.time - eye.received > observation_lifetime) continue;
    for (const Person& person : eye.seen.people)
      if (!nearest || glm::length(person.position) < glm::length(nearest->position))
        nearest = &person;
  }
  return nearest;
}

// Returns where on the screen a head is turned to: 0 to 1 within, any number beside it.
vec2 faced_place(const Person& person, const ScreenSize& screen, const View& rest) {
  vec2 at = vec2(person.position) +
            person.position.z * vec2(std::tan(person.rotation.x), std::tan(person.rotation.y));
  float half_height = 0.5f * picture_height(screen, rest);
  float half_width = half_height * float(rest.width) / float(rest.height);
  return {0.5f + 0.5f * at.x / half_width, 0.5f - 0.5f * at.y / half_height};
}

const PointOfInterest* find_shown(const ExhibitStage& stage, const Voice& voice) {
  if (voice.queue.empty() || voice.paused) return nullptr;
  const std::string& object = voice.held.point.empty() ? voice.held.look : voice.held.point;
  return object.empty() ? nullptr : find_point(stage.exhibit, object);
}

AttentionCause find_cause(const Show& show, const Visitor& visitor) {
  const VisitorAttention& looks = visitor.looks;
  return {looks.seen, find_hints(show, visitor, *looks.seen), visitor.wants.task_weight,
          show.stage.known};
}

// Returns the visitor whose turn it is, longest ago first; null: nobody's.
Visitor* next_to_analyse(Show& show, AttentionCause& cause) {
  Visitor* next = nullptr;
  for (Visitor& visitor : show.visits.visitors) {
    const VisitorAttention& looks = visitor.looks;
    if (!visitor.welcomed || !visitor.wants.attention || !looks.seen) continue;
    if (show.time - looks.analysed_at < 1 / analysis_rate) continue;
    if (next && next->looks.analysed_at <= looks.analysed_at) continue;
    if (!asks_for_samples(show, visitor)) continue;
    AttentionCause own = find_cause(show, visitor);
    if (looks.weights && own == looks.cause) continue;
    next = &visitor;
    cause = std::move(own);
  }
  return next;
}

void take_analysis(Show& show) {
  AttentionAnalysis& analysis = show.drawing->analysis;
  for (Visitor& visitor : show.visits.visitors) {
    if (visitor.link->id != analysis.visitor) continue;
    visitor.looks.weights = std::move(analysis.weights);
    visitor.looks.cause = std::move(analysis.cause);
  }
  analysis.visitor = 0;
  analysis.cause = {};
  analysis.weights = nullptr;
  show.totals.attention_analyses++;
  show.totals.attention_ms = float(1000 * analysis.seconds);
}

}  // namespace

void analyse(AttentionAnalysis& a) {
  double began = seconds_now();
  const SeenPicture& seen = *a.cause.seen;
  eval_saliency(seen.picture, a.work, a.saliency);
  eval_objects(seen.object, seen.picture.width, seen.picture.height, a.saliency, a.cause.hints,
               a.task, a.objects);
  eval_attention(a.objects, a.cause.task_weight, a.attention);
  for (size_t i = 0; i < a.objects.size(); i++) {
    uint32_t object = a.objects[i].object;
    if (object < a.cause.known.size() && a.cause.known[object]) a.attention[i] = 0;
  }
  auto weights = std::make_shared<ObjectWeights>();
  eval_weights(a.objects, a.attention, *weights);
  a.weights = std::move(weights);
  a.seconds = seconds_now() - began;
}

bool wants_seen(const Show& show, const Visitor& visitor) {
  return visitor.wants.attention && show.time - visitor.looks.seen_at >= 1 / analysis_rate &&
         asks_for_samples(show, visitor);
}

std::shared_ptr<const SeenPicture> note_seen(const PictureJob& job, const Image8& image,
                                             const RenderCache& cache) {
  if (!cache.has_projected(job.view) || image.width <= 0 || image.height <= 0) return nullptr;
  auto seen = std::make_shared<SeenPicture>();
  seen->view = job.view;
  const int scale = seen->scale = (image.width + widest_seen - 1) / widest_seen;
  Image8& small = seen->picture;
  small.width = std::max(image.width / scale, 1), small.height = image.height / scale;
  if (small.height < 1) return nullptr;
  small.rgb.resize(size_t(small.width) * size_t(small.height) * 3);
  seen->object.resize(size_t(small.width) * size_t(small.height));
  parallel_ranges(small.height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++) {
      reduce_row(image, scale, y, small);
      for (int x = 0; x < small.width; x++)
        seen->object[size_t(y) * size_t(small.width) + size_t(x)] = find_object(
            cache.points(), cache.image(), x * scale + scale / 2, y * scale + scale / 2, scale / 2);
    }
  });
  return seen;
}

void steer(Show& show) {
  AttentionAnalysis& analysis = show.drawing->analysis;
  if (analysis.visitor != 0) {
    if (analysis.worker.busy()) return;
    take_analysis(show);
  }
  Visitor* next = next_to_analyse(show, analysis.cause);
  if (!next) return;
  analysis.visitor = next->link->id;
  next->looks.analysed_at = show.time;
  analysis.worker.run([&analysis] { analysis.cores.execute([&] { analyse(analysis); }); });
}

std::vector<AttentionHint> find_hints(const Show& show, const Visitor& visitor,
                                      const SeenPicture& seen) {
  std::vector<AttentionHint> hints;
  const View& now = visitor.place.last_view;
  const VisitorAttention& looks = visitor.looks;
  if (looks.pointer && show.time - looks.pointed_at < pointer_lifetime)
    add_hint(seen, place_in_picture(now, *looks.pointer), pointer_hint, hints);
  if (const Person* person = visitor.kiosk ? nearest_person(show, visitor) : nullptr) {
    HintKind kind = head_hint;
    kind.weight *= std::clamp(person->confidence, 0.0f, 1.0f);
    const Kiosk* kiosk = kiosk_of(show, visitor);
    vec2 place = faced_place(*person, kiosk ? kiosk->settings.screen : ScreenSize(),
                             rest_view(show.stage, visitor));
    bool faces =
        std::abs(person->rotation.x) < 0.4f * pi && std::abs(person->rotation.y) < 0.4f * pi;
    if (faces) add_hint(seen, place_in_picture(now, place), kind, hints);
  }
  const PointOfInterest* shown = find_shown(show.stage, visitor.hearing.narration.voice);
  if (!shown) shown = find_shown(show.stage, teller_of(show.cast, show.visits, visitor).voice);
  if (shown)
    add_hint(seen, vec3(shown->place - show.stage.exhibit.scene.origin), shown_hint, hints);
  return hints;
}

}  // namespace wellspring::show
