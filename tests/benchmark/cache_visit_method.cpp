// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_method.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/rng.h"
#include "denoise/denoise.h"
#include "light/visible/guides.h"

namespace wellspring::test {
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
    wellspring::light::trace(*moment.technique, *moment.world, *moment.lights, moment.transport,
                             requests, samples);
  }
};

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
    drawn_->show(moment, budget, shown);
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
  std::unique_ptr<VisitMethod> drawn_ = make_drawn({});
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
    if (started_ && traced_ >= pixels) {  // the picture begun frames ago is complete
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
    {"primary", "the show's own way", false, [] { return make_drawn({}); }},
    {"at_once", "the same, answers at once", false,
     [] { return make_drawn({.answers = Answers::at_once}); }, true},
    {"behind", "the same, pictures a frame late", false,
     [] { return make_drawn({.answers = Answers::waited_for}); }, true},
    {"unmapped", "the same, without illumination maps", false,
     [] { return make_drawn({.uses_maps = false}); }, true},
    {"unsteered", "the same, without attention", false,
     [] { return make_drawn({.steers = false}); }, true},
    {"reconstructed", "the same, each picture through the small network", false,
     [] { return make_reconstructed(1); }, true},
    {"reconstructed_half", "the same at half the resolution", false,
     [] { return make_reconstructed(2); }, true},
    {"cache", "render cache as published, points alone", true, make_published_cache},
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

}  // namespace wellspring::test
