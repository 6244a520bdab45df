// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_method.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/broker.h"
#include "cache/predict.h"
#include "picture/compose_drawn.h"
#include "picture/still/plan_still.h"
#include "picture/still/reconstruct_still.h"
#include "picture/still/still_guides.h"
#include "picture/compositor.h"
#include "show/draw/sample_budget.h"

namespace wellspring {
namespace {

uint32_t object_of(const Sample& sample) { return (sample.flags & sample_hit) ? sample.object : 0; }

void size_frame(Frame& frame, int width, int height) {
  frame.width = width;
  frame.height = height;
  frame.color.resize(size_t(width) * size_t(height), vec3(0));
  frame.object.resize(frame.color.size(), 0);
}

// A ray through a random place of the cell (x, y) of `across` x `down` cells over the view.
Request cell_request(const VisitMoment& moment, uint64_t seed, int x, int y, int across, int down) {
  Request request;
  request.seed = sample_seed(seed, uint32_t(x), uint32_t(y), 0);
  uint64_t random = mix64(request.seed ^ 0x63656c6c);
  float u = float(random & 0xffffff) * 0x1p-24f, v = float((random >> 24) & 0xffffff) * 0x1p-24f;
  const View& view = moment.view;
  float px = (float(x) + u) * float(view.width) / float(across),
        py = (float(y) + v) * float(view.height) / float(down);
  request.ray = view_ray(view, px, py);
  int column = std::min(int(px), view.width - 1), row = std::min(int(py), view.height - 1);
  request.pixel = uint32_t(row) * uint32_t(view.width) + uint32_t(column);
  return request;
}

// Requests, their answers, and the tracing between them.
struct Batch {
  std::vector<Request> requests;
  std::vector<Sample> samples;
  void trace(const VisitMoment& moment) {
    samples.resize(requests.size());
    wellspring::trace(*moment.technique, *moment.world, *moment.lights, moment.transport, requests,
                      samples);
  }
};

constexpr double displayed_rate = 60;    // frames a second
constexpr float predicted_frames = 2;    // as show/draw/picture.cpp
constexpr double predicted_share = 0.3;  // of the budget, at most

class PublishedCache : public VisitMethod {
 public:
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    cache_.set_reference(moment.technique == find_technique("path"));
    cache_.resize(moment.view.width, moment.view.height);
    cache_.move_points(*moment.world);
    cache_.project(moment.view);
    cache_.attend();
    cache_.plan(moment.view, budget, moment.seed, batch_.requests);
    batch_.trace(moment);
    for (Sample& sample : batch_.samples) sample.glow = vec3(0);  // points show all of it
    cache_.remember(moment.view, batch_.requests, batch_.samples);
    cache_.reconstruct(moment.view, frame_);
    shown.frame = frame_;
    shown.stats = cache_.stats();
    shown.empty = shown.stats.empty;
  }

 private:
  RenderCache cache_;
  Batch batch_;
  Frame frame_;  // pixels without points around stay
};

class Deferred : public VisitMethod {
 public:
  explicit Deferred(Answers answers, bool denoises = false) : answers_(answers) {
    std::string problem;
    if (denoises) denoiser_ = load_denoiser(NetSize::small, problem);
    if (!problem.empty()) throw std::runtime_error(problem);
  }
  // Points of now on count in multiples of the light of these maps; null: by themselves.
  void use_maps(std::shared_ptr<const IlluminationMap> maps) {
    cache_.clear();
    compositor_.set_maps(std::move(maps));
  }
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    if (moment.frame == 0 || moment.view != last_view_) moved_ = moment.frame;
    last_view_ = moment.view;
    // As show/draw/picture.cpp draws what moves.
    bool passing = moment.frame - moved_ < still_after;
    double pixels = double(moment.view.width) * double(moment.view.height);
    bool coarse = passing && !affords_fine_light(budget * displayed_rate / pixels, false);
    const View view = coarse ? light_view(moment.view) : moment.view;
    cache_.set_reference(moment.technique == find_technique("path"));
    cache_.resize(moment.view.width, moment.view.height);
    cache_.move_points(*moment.world);
    uint64_t pose = uint64_t(moment.frame);
    land(broker_.collect(), *moment.world, pose, cache_);
    cache_.project(view);
    cache_.attend();
    ahead_.clear();
    if (moment.frame > 0 && view != view_before_)
      cache_.predict(extrapolate(view_before_, view, predicted_frames),
                     int(predicted_share * budget), moment.seed, ahead_);
    view_before_ = view;
    bool learns = denoiser_ && !passing;
    compositor_.set_reconstructed(learns);
    double kept = learns ? mean_count(compositor_.samples()) : 0;
    bool spread = kept >= spread_from;
    int tested = spread ? int(tested_share * budget) : budget - int(ahead_.size());
    cache_.plan(view, tested, moment.seed, batch_.requests);
    if (!learns) asked_ = 0, passed_ = 0;
    else if (spread) plan_still(view, asked_, budget - tested, still_seed, batch_.requests);
    if (spread) asked_ += uint64_t(budget - tested);
    batch_.requests.insert(batch_.requests.end(), ahead_.begin(), ahead_.end());
    if (answers_ == Answers::next_frame) {
      broker_.ask(view, {moment.technique, moment.transport}, batch_.requests);
      while (auto piece = broker_.take()) {
        Answer answer{std::move(*piece), pose, {}};
        answer.samples.resize(answer.piece.requests.size());
        trace(*moment.technique, *moment.world, *moment.lights, moment.transport,
              answer.piece.requests, answer.samples);
        broker_.answer(std::move(answer));
      }
    } else {
      batch_.trace(moment);
      cache_.remember(view, batch_.requests, batch_.samples);
      compositor_.follow_changes(cache_);
      if (!passing) compositor_.add_samples(view, batch_.requests, batch_.samples);
    }
    if (passing) compositor_.draw(cache_, moment.view, visibility(moment), shown.frame);
    else if (passed_ == 0)
      compositor_.draw_still(cache_, moment.view, visibility(moment), shown.frame);
    if (learns && !reconstruct(moment, shown.frame) && passed_ > 0) cache_.end_frame();
    shown.stats = cache_.stats();
    shown.empty = shown.stats.empty;
    if (answers_ != Answers::waited_for) return;
    if (moment.frame > 0) std::swap(shown, before_);
    else before_ = shown;
  }

 private:
  static constexpr int still_after = 15;  // frames
  static constexpr int first_pass = 29;   // likewise; then at so many times as many samples:
  static constexpr double growth = 1.3;
  // As show/draw/picture.cpp spreads samples.
  static constexpr double tested_share = 0.0625, spread_from = 0.8;
  static constexpr uint64_t still_seed = 17;
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
  Answers answers_;
  std::unique_ptr<Denoiser> denoiser_;
  StillReconstruction work_;
  uint64_t asked_ = 0;  // samples spread over the view at rest
  double passed_ = 0;   // samples a pixel in the last pass
  View view_before_;
  std::vector<Request> ahead_;
  std::unique_ptr<VisibilityPass> visibility_;
  std::shared_ptr<const LightTables> sees_;
  RenderCache cache_;
  Compositor compositor_;
  View last_view_;
  int moved_ = 0;
  Batch batch_;
  Broker broker_{
      {.piece = 512, .most_waiting = 1 << 20, .most_traced = 1 << 20, .most_answered = 1 << 20}};
  VisitPicture before_;
};

class Mapped : public VisitMethod {
 public:
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    if (moment.maps != maps_) drawn_.use_maps(maps_ = moment.maps);
    Lights lights = *moment.lights;
    lights.maps = maps_;
    VisitMoment mapped = moment;
    mapped.lights = &lights;
    drawn_.show(mapped, budget, shown);
  }

 private:
  Deferred drawn_{Answers::at_once};
  std::shared_ptr<const IlluminationMap> maps_;
};

// Each moving picture goes through the network, at a part of its resolution: what changes there
// is multiplied with the full picture.
class ReconstructedInMotion : public VisitMethod {
 public:
  explicit ReconstructedInMotion(int scale) : scale_(scale) {
    std::string problem;
    denoiser_ = load_denoiser(NetSize::small, problem);
    if (!denoiser_) throw std::runtime_error(problem);
  }
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    drawn_.show(moment, budget, shown);
    View view = moment.view;
    view.width = (view.width + scale_ - 1) / scale_;
    view.height = (view.height + scale_ - 1) / scale_;
    view.tan_half_fov *= float(view.height * scale_) / float(moment.view.height);
    const Frame& full = shown.frame;
    fit_frame(view.width, view.height, low_);
    fit_frame(full.width, full.height, change_);
    for (int y = 0; y < view.height; y++)
      for (int x = 0; x < view.width; x++) {
        vec3 sum(0);
        for (int k = 0; k < scale_ * scale_; k++) {
          int column = std::min(x * scale_ + k % scale_, full.width - 1),
              row = std::min(y * scale_ + k / scale_, full.height - 1);
          sum += full.color[size_t(row) * size_t(full.width) + size_t(column)];
        }
        low_.color[size_t(y) * size_t(view.width) + size_t(x)] = sum / float(scale_ * scale_);
      }
    GuidePlanes guides = make_guides(*moment.world, *moment.lights, view, 4);
    found_.resize(low_.color.size());
    denoiser_->run({view.width, view.height, low_.color, guides.albedo, guides.normal}, found_);
    constexpr float dark = 1e-3f;
    for (size_t i = 0; i < found_.size(); i++)
      low_.color[i] = clamp((found_[i] + dark) / (low_.color[i] + dark), 0.25f, 4.0f);
    upsample(low_, change_);
    for (size_t i = 0; i < full.color.size(); i++) shown.frame.color[i] *= change_.color[i];
  }

 private:
  Deferred drawn_{Answers::at_once};
  int scale_;
  std::unique_ptr<Denoiser> denoiser_;
  Frame low_, change_;
  std::vector<vec3> found_;
};

class ResolutionDrop : public VisitMethod {
 public:
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    int width = moment.view.width, height = moment.view.height;
    ivec2 size = affordable_size(width, height, budget);
    size_frame(low_, size.x, size.y);
    size_t pixels = size_t(width) * size_t(height);
    if (moment.changed || own_.size() != pixels) {
      pictures_ = 0;
      own_.assign(pixels, vec3(0));
      counts_.assign(pixels, 0);
    }
    batch_.requests.clear();
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++)
        batch_.requests.push_back(cell_request(moment, moment.seed, x, y, size.x, size.y));
    batch_.trace(moment);
    pictures_++;
    for (size_t i = 0; i < batch_.samples.size(); i++) {
      const Sample& sample = batch_.samples[i];
      vec3 light = sample.radiance(), before = pictures_ == 1 ? vec3(0) : low_.color[i];
      low_.color[i] = before + (light - before) / float(pictures_);
      low_.object[i] = object_of(sample);
      uint32_t pixel = batch_.requests[i].pixel;
      own_[pixel] += light;
      counts_[pixel]++;
    }
    size_frame(shown.frame, width, height);
    upsample(low_, shown.frame);
    shown.empty = 0;
    if (pictures_ == 1) return;
    // The low picture counts as one sample of a pixel.
    for (size_t i = 0; i < pixels; i++)
      shown.frame.color[i] = (shown.frame.color[i] + own_[i]) / float(1 + counts_[i]);
  }

 private:
  Batch batch_;
  Frame low_;
  int pictures_ = 0;       // since the last change
  std::vector<vec3> own_;  // sums of the samples of each full pixel since then
  std::vector<int> counts_;
};

class Hold : public VisitMethod {
 public:
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    int width = moment.view.width, height = moment.view.height, pixels = width * height;
    changed_ |= moment.changed;
    size_frame(shown_, width, height);
    if (started_ && traced_ >= pixels) {  // what was begun frames ago is complete
      complete_ = true;
      pictures_ = begun_changed_ ? 1 : pictures_ + 1;
      for (size_t i = 0; i < shown_.color.size(); i++) {
        vec3 before = pictures_ == 1 ? vec3(0) : shown_.color[i];
        shown_.color[i] = before + (batch_.samples[i].radiance() - before) / float(pictures_);
        shown_.object[i] = object_of(batch_.samples[i]);
      }
      traced_ -= pixels;
      started_ = false;
    }
    if (!started_) {
      // Traced at once, so that everything in the picture belongs to one moment; paid for by and
      // by.
      started_ = true;
      begun_changed_ = changed_;
      changed_ = false;
      batch_.requests.clear();
      for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
          batch_.requests.push_back(cell_request(moment, moment.seed, x, y, width, height));
      batch_.trace(moment);
    }
    traced_ += budget;
    shown.frame = shown_;
    shown.empty = complete_ ? 0 : 1;
  }

 private:
  Batch batch_;
  Frame shown_;
  bool started_ = false, complete_ = false;
  bool changed_ = true;        // since the present picture was begun
  bool begun_changed_ = true;  // before it was begun, since the one before
  int traced_ = 0, pictures_ = 0;
};

class Frameless : public VisitMethod {
 public:
  void show(const VisitMoment& moment, int budget, VisitPicture& shown) override {
    int width = moment.view.width, height = moment.view.height, pixels = width * height;
    size_frame(shown_, width, height);
    if (int(order_.size()) != pixels) {
      order_.resize(size_t(pixels));
      std::iota(order_.begin(), order_.end(), 0u);
      Rng rng(0x6672616d65);
      for (size_t i = order_.size(); i-- > 1;)
        std::swap(order_[i], order_[size_t(uint64_t(rng.next()) * (i + 1) >> 32)]);
      counts_.assign(order_.size(), 0);
      changes_.assign(order_.size(), -1);
      filled_ = 0;
    }
    if (moment.changed) change_++;
    batch_.requests.clear();
    for (int i = 0; i < std::min(budget, pixels); i++) {
      uint32_t pixel = order_[next_++ % order_.size()];
      batch_.requests.push_back(
          cell_request(moment, moment.seed, int(pixel) % width, int(pixel) / width, width, height));
    }
    batch_.trace(moment);
    for (size_t i = 0; i < batch_.samples.size(); i++) {
      uint32_t pixel = batch_.requests[i].pixel;
      filled_ += changes_[pixel] < 0;
      if (changes_[pixel] != change_) counts_[pixel] = 0;
      changes_[pixel] = change_;
      vec3& color = shown_.color[pixel];
      color += (batch_.samples[i].radiance() - color) / float(++counts_[pixel]);
      shown_.object[pixel] = object_of(batch_.samples[i]);
    }
    shown.frame = shown_;
    shown.empty = 1 - double(filled_) / pixels;
  }

 private:
  Batch batch_;
  Frame shown_;
  std::vector<uint32_t> order_;
  size_t next_ = 0;
  std::vector<int> counts_, changes_;  // changes_: `change_` when last drawn; -1: never
  int change_ = 0, filled_ = 0;
};

constexpr VisitMethodEntry list[] = {
    {"cache", "render cache as published, points alone", false, make_published_cache},
    {"primary", "shapes and reflectances drawn in the cache's light", false,
     [] { return make_deferred(Answers::at_once); }},
    {"mapped", "primary, with illumination maps", false, make_mapped, true},
    {"primary_late", "the same, answers a frame late", false,
     [] { return make_deferred(Answers::next_frame); }},
    {"primary_behind", "the same, pictures a frame late", false,
     [] { return make_deferred(Answers::waited_for); }},
    {"reconstructed", "primary, each picture through the small network", false,
     [] { return make_reconstructed(1); }, true},
    {"reconstructed_half", "the same at half the resolution", false,
     [] { return make_reconstructed(2); }, true},
    {"resolution_drop", "whole pictures, as coarse as the budget", true, make_resolution_drop},
    {"hold", "the last complete picture", true, make_hold},
    {"frameless", "random pixels replaced", true, make_frameless},
};

}  // namespace

std::span<const VisitMethodEntry> visit_methods() { return list; }
std::unique_ptr<VisitMethod> make_visit_method(const std::string& name) {
  for (const VisitMethodEntry& entry : list)
    if (entry.name == name) return entry.make();
  return nullptr;
}
std::unique_ptr<VisitMethod> make_published_cache() { return std::make_unique<PublishedCache>(); }
std::unique_ptr<VisitMethod> make_mapped() { return std::make_unique<Mapped>(); }
std::unique_ptr<VisitMethod> make_deferred(Answers answers) {
  return std::make_unique<Deferred>(answers);
}
std::unique_ptr<VisitMethod> make_denoised() {
  return std::make_unique<Deferred>(Answers::at_once, true);
}
std::unique_ptr<VisitMethod> make_reconstructed(int scale) {
  return std::make_unique<ReconstructedInMotion>(scale);
}
std::unique_ptr<VisitMethod> make_resolution_drop() { return std::make_unique<ResolutionDrop>(); }
std::unique_ptr<VisitMethod> make_hold() { return std::make_unique<Hold>(); }
std::unique_ptr<VisitMethod> make_frameless() { return std::make_unique<Frameless>(); }

ivec2 affordable_size(int width, int height, int budget) {
  double cells = std::clamp(double(budget), 1.0, double(width) * height);
  int columns = std::clamp(int(std::lround(std::sqrt(cells * width / height))), 1, width);
  columns = std::min(columns, int(cells));
  int rows = std::clamp(int(cells / columns), 1, height);
  return {columns, rows};
}

void upsample(const Frame& small, Frame& large) {
  float sx = float(small.width) / float(large.width),
        sy = float(small.height) / float(large.height);
  auto at = [&](int x, int y) {
    x = std::clamp(x, 0, small.width - 1);
    y = std::clamp(y, 0, small.height - 1);
    return size_t(y) * size_t(small.width) + size_t(x);
  };
  parallel_ranges(large.height, 16, [&](int begin, int end) {
    for (int row = begin; row < end; row++)
      for (int column = 0; column < large.width; column++) {
        float x = (float(column) + 0.5f) * sx, y = (float(row) + 0.5f) * sy;
        size_t pixel = size_t(row) * size_t(large.width) + size_t(column);
        large.object[pixel] = small.object[at(int(x), int(y))];
        int left = int(std::floor(x - 0.5f)), top = int(std::floor(y - 0.5f));
        float fx = x - 0.5f - float(left), fy = y - 0.5f - float(top);
        vec3 upper = glm::mix(small.color[at(left, top)], small.color[at(left + 1, top)], fx);
        vec3 lower =
            glm::mix(small.color[at(left, top + 1)], small.color[at(left + 1, top + 1)], fx);
        large.color[pixel] = glm::mix(upper, lower, fy);
      }
  });
}

}  // namespace wellspring
