// SPDX-License-Identifier: Apache-2.0
// The show's own way to keep a picture up, a picture a frame: what show/draw/picture.cpp and
// late_samples.cpp do for one visitor, without warps.
#include <algorithm>

#include "base/rng.h"
#include "cache/broker.h"
#include "cache/plan.h"
#include "cache_visit_method.h"
#include "picture/compose_drawn.h"
#include "picture/compositor.h"
#include "picture/still/reconstruct_still.h"
#include "show/draw/steer.h"
#include "show/state/lamps.h"
#include "show/state/renderer.h"

namespace wellspring::test {
namespace {

// These are the show's values.
constexpr float predicted_frames = 2, barely_covered = 0.1f;
constexpr double predicted_share = 0.3;                     // largest share of the budget
constexpr double more_asked = 1.2;                          // requests for each traced sample
constexpr double tested_share = 0.0625, spread_from = 0.8;  // shares of the samples at rest
constexpr float task_weight = 0.5f;                         // share of attention
constexpr int analysed_every = 3;                           // frames: at most 25 a second
constexpr int still_after = 15;                             // frames
constexpr int first_pass = 29;  // frames; the next pass comes after `growth` times as many samples
constexpr double growth = 1.3;
constexpr uint64_t still_seed = 17;

// The attention of objects depends on these (show/state/lamps.h: use_maps()).
struct MappedObjects {
  std::vector<char> mapped, known;
  MappedObjects() = default;
  MappedObjects(const Scene& scene, const IlluminationMap& maps)
      : mapped(mapped_objects(scene, maps)), known(mapped) {
    const std::vector<char> shining = shining_objects(scene);
    for (size_t i = 0; i < known.size(); i++)
      if (shining[i]) known[i] = 0;
  }
};

class Drawn : public VisitMethod {
 public:
  explicit Drawn(const DrawnWay& way) : way_(way) {
    std::string problem;
    if (way.denoises) denoiser_ = load_denoiser(NetSize::small, problem);
    if (!problem.empty()) throw std::runtime_error(problem);
  }
  void show(const VisitMoment& now, int budget, VisitPicture& shown) override {
    Lights lights = *now.lights;
    if (way_.uses_maps) lights.maps = now.maps;
    VisitMoment moment = now;
    moment.lights = &lights;
    if (moment.frame == 0 || moment.view != last_view_) moved_ = moment.frame;
    last_view_ = moment.view;
    const bool passing = moment.frame - moved_ < still_after;
    const View& view = moment.view;
    follow_light(moment);
    land(broker_.collect(), *moment.world, uint64_t(moment.frame), cache_);
    cache_.project(view);
    cache_.attend();
    const bool late =
        way_.answers == Answers::next_frame && passing && cache_.covered() > barely_covered;
    plan(moment, view, passing, late ? int(more_asked * budget) : budget);
    if (late) ask(moment, view, budget);
    else trace_at_once(moment, view, passing);
    if (passing) compositor_.draw(cache_, view, visibility(moment), shown.frame);
    else if (passed_ == 0)
      compositor_.draw_still(cache_, moment.view, visibility(moment), shown.frame);
    if (learns_ && !reconstruct(moment, shown.frame) && passed_ > 0) cache_.end_frame();
    if (way_.steers && moment.frame % analysed_every == 0) steer(moment, shown.frame);
    shown.stats = cache_.stats();
    shown.empty = shown.stats.empty;
    if (way_.answers != Answers::waited_for) return;
    if (moment.frame > 0) std::swap(shown, before_);
    else before_ = shown;
  }

 private:
  // Does as show/state/lamps.cpp: follow_lamps().
  void follow_light(const VisitMoment& moment) {
    cache_.set_reference(moment.technique == find_technique("path"));
    cache_.resize(moment.view.width, moment.view.height);
    cache_.move_points(*moment.world);
    const auto& maps = moment.lights->maps;
    if (maps && !maps_) objects_ = MappedObjects(moment.world->scene(), *maps);
    if (maps != maps_) compositor_.set_maps(maps_ = maps);
    if (!moment.change) return;
    cache_.relight([&](const RenderCache::Surface& at, vec3& kept, vec3& added) {
      if (!moment.change->changes(at.place, at.normal, kept, added)) return false;
      const std::vector<char>& mapped = objects_.mapped;
      if (at.object < mapped.size() && mapped[at.object]) kept = vec3(1), added = vec3(0);
      return true;
    });
    broker_.forget();
    compositor_.invalidate_samples();
  }
  void plan(const VisitMoment& moment, const View& view, bool passing, int budget) {
    ahead_.clear();
    if (moment.frame > 0 && view != view_before_)
      cache_.predict(extrapolate(view_before_, view, predicted_frames),
                     int(predicted_share * budget), moment.seed, ahead_);
    view_before_ = view;
    learns_ = denoiser_ && !passing;
    compositor_.set_reconstructed(learns_);
    const double kept = learns_ ? mean_count(compositor_.samples()) : 0;
    const bool spread = kept >= spread_from;
    const int tested = spread ? int(tested_share * budget) : budget - int(ahead_.size());
    cache_.plan(view, tested, moment.seed, requests_);
    if (!learns_) asked_ = 0, passed_ = 0;
    else if (spread) plan_still(view, asked_, budget - tested, still_seed, requests_);
    if (spread) asked_ += uint64_t(budget - tested);
    requests_.insert(requests_.end(), ahead_.begin(), ahead_.end());
  }
  void ask(const VisitMoment& moment, const View& view, int budget) {
    broker_.ask(view, {moment.technique, moment.transport}, requests_);
    // Pieces are whole: what is traced too much is missing from the next frame's.
    for (left_ += budget; left_ > 0;) {
      auto piece = broker_.take();
      if (!piece) left_ = 0;
      if (!piece) break;
      left_ -= int(piece->requests.size());
      Answer answer{std::move(*piece), uint64_t(moment.frame), {}};
      answer.samples.resize(answer.piece.requests.size());
      trace(*moment.technique, *moment.world, *moment.lights, moment.transport,
            answer.piece.requests, answer.samples);
      broker_.answer(std::move(answer));
    }
  }
  void trace_at_once(const VisitMoment& moment, const View& view, bool passing) {
    broker_.forget();
    samples_.resize(requests_.size());
    trace(*moment.technique, *moment.world, *moment.lights, moment.transport, requests_, samples_);
    cache_.remember(view, requests_, samples_);
    compositor_.follow_changes(cache_);
    if (!passing) compositor_.add_samples(view, requests_, samples_);
  }
  // Does as show/draw/steer.cpp, with the picture just drawn, for the next.
  void steer(const VisitMoment& moment, const Frame& frame) {
    PictureJob job;
    job.view = moment.view;
    tonemap(frame, {}, image_);
    analysis_.cause = {note_seen(job, image_, cache_), {}, task_weight, objects_.known};
    if (!analysis_.cause.seen) return;
    analyse(analysis_);
    cache_.set_weights(*analysis_.weights);
  }
  bool reconstruct(const VisitMoment& moment, Frame& frame) {
    double kept = mean_count(compositor_.samples());
    if (moment.frame - moved_ < first_pass || kept < growth * passed_) return false;
    passed_ = kept;
    compositor_.draw_still(cache_, moment.view, visibility(moment), frame);
    for (int place = 0; place < guide_places; place++)
      add_still_guides(*moment.world, *moment.lights, visibility(moment), moment.view,
                       RasterShows::all, place, work_.guides, work_.followed);
    begin_reconstruction(compositor_.samples(), frame, *denoiser_, work_);
    while (denoiser_->advance(1)) {}
    finish_reconstruction(compositor_.samples(), *denoiser_, work_, frame);
    return true;
  }
  const VisibilityPass& visibility(const VisitMoment& moment) {
    if (!visibility_ || sees_ != moment.lights->tables)
      visibility_ = std::make_unique<VisibilityPass>(*moment.world, *moment.lights);
    sees_ = moment.lights->tables;
    return *visibility_;
  }

  DrawnWay way_;
  std::shared_ptr<const IlluminationMap> maps_;
  MappedObjects objects_;
  std::unique_ptr<Denoiser> denoiser_;
  StillReconstruction work_;
  bool learns_ = false;
  uint64_t asked_ = 0;  // samples spread over the view at rest
  double passed_ = 0;   // samples a pixel in the last pass
  int left_ = 0;        // samples that a broker's workers may trace
  View view_before_, last_view_;
  int moved_ = 0;  // frame
  std::vector<Request> requests_, ahead_;
  std::vector<Sample> samples_;
  std::unique_ptr<VisibilityPass> visibility_;
  std::shared_ptr<const LightTables> sees_;
  RenderCache cache_;
  Compositor compositor_;
  Broker broker_;
  Image8 image_;
  AttentionAnalysis analysis_;
  VisitPicture before_;
};

}  // namespace

std::unique_ptr<VisitMethod> make_drawn(const DrawnWay& way) {
  return std::make_unique<Drawn>(way);
}

}  // namespace wellspring::test
