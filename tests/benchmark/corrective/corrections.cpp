// SPDX-License-Identifier: Apache-2.0
#include "corrections.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <unordered_map>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"
#include "light/visible/facet.h"
#include "picture/cells/surface_image.h"

namespace wellspring::test {
namespace {

// The words of a sample are those of a point of its surface (picture/cells/surface_image.h), the
// last as plane_more.
constexpr SurfacePlane word_planes[] = {plane_albedo, plane_rest, plane_smooth};
SampleWords make_words(const Sample& sample) {
  uint32_t noise = sample.flags & sample_sure ? sure_noise : 0;
  return {pack_albedo(sample.albedo), pack_rgb9e5(max(sample.rest - sample.glow, vec3(0))),
          pack_rgb9e5(sample.smooth), pack_normal(sample.normal) | 1u << 16 | noise << 24};
}

// Returns the number of samples in a pixel's own point.
uint32_t own_samples(float more) { return std::bit_cast<uint32_t>(more) >> 16 & 255; }

}  // namespace

std::vector<float> find_shining(const Scene& scene) {
  std::vector<float> shining(scene.objects.size(), 0);
  TextureRanges ranges(scene);
  for (const Instance& instance : scene.instances) {
    if (instance.object >= shining.size()) continue;
    const Material& m = scene.materials[size_t(scene.meshes[size_t(instance.mesh)].material)];
    if (!may_shine(m, ranges)) continue;
    const float roughness = m.roughness * ranges.of(m.metallic_roughness_texture).low.y;
    float& delta = shining[instance.object];
    delta = delta > 0 ? std::min(delta, delta_of(roughness)) : delta_of(roughness);
  }
  return shining;
}

std::vector<uint32_t> group_shining(const Scene& scene, std::span<const float> shining) {
  constexpr float close = 0.3f;  // metres
  struct Thing {
    Bounds box;
    int material = -1;
  };
  std::vector<Thing> things(scene.objects.size());
  for (const Instance& instance : scene.instances) {
    if (instance.object >= shining.size() || shining[instance.object] <= 0) continue;
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    Thing& thing = things[instance.object];
    if (thing.material < 0) thing.material = mesh.material;
    for (vec3 p : mesh.positions) {
      const vec3 place = vec3(instance.to_world * vec4(p, 1));
      thing.box.low = min(thing.box.low, place), thing.box.high = max(thing.box.high, place);
    }
  }
  std::vector<uint32_t> group(things.size());
  for (uint32_t i = 0; i < group.size(); i++) group[i] = i;
  auto first = [&](uint32_t i) {
    while (group[i] != i) i = group[i];
    return i;
  };
  for (uint32_t i = 0; i < things.size(); i++)
    for (uint32_t k = 0; k < i; k++) {
      const Thing &a = things[i], &b = things[k];
      if (a.material < 0 || a.material != b.material) continue;
      bool near = true;
      for (int axis = 0; axis < 3; axis++)
        near &= a.box.low[axis] - close < b.box.high[axis] &&
                b.box.low[axis] - close < a.box.high[axis];
      if (near) group[std::max(first(i), first(k))] = std::min(first(i), first(k));
    }
  for (uint32_t i = 0; i < group.size(); i++) group[i] = first(i);
  return group;
}

void Corrections::begin(const View& view, const VisibilityPass& visibility,
                        std::span<const float> shining) {
  pixels_ = 0;
  if (!std::ranges::equal(shining, shining_)) {
    shining_.assign(shining.begin(), shining.end());
    for (size_t object = 1; object < shining_.size(); object++)
      if (shining_[object] > 0) set_delta(store_, uint32_t(object), shining_[object]);
  }
  if (std::none_of(shining.begin(), shining.end(), [](float delta) { return delta > 0; })) return;
  const size_t pixels = size_t(view.width) * size_t(view.height);
  object_.resize(pixels), group_.resize(pixels), depth_.resize(pixels), words_.resize(pixels),
      level_.resize(pixels);
  std::atomic<int> seen = 0;
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x);
    int here = 0;
    for (int i = 0; i < run.count; i++) {
      uint32_t object = run.object[i];
      bool shines = object < shining_.size() && shining_[object] > 0 && !visibility.moves(object);
      object_[at + size_t(i)] = shines ? object : 0;
      group_[at + size_t(i)] = shines ? group_of(object) : 0;
      depth_[at + size_t(i)] = run.depth[i];
      here += shines;
    }
    seen += here;
  });
  pixels_ = seen;
  const bool moved = view != view_;
  view_ = view;
  if (pixels_ == 0) return;
  counts_.pictures++;
  if (moved) counts_.dropped += uint64_t(age_samples(store_, view.position, ++age_).dropped);
  splat();
}

void Corrections::splat() { warp_and_splat(store_, view_, group_, scratch_, words_, level_); }

void Corrections::find_regions(std::span<const float> weights) {
  std::unordered_map<uint32_t, PixelBox> boxes;
  for (int y = 0; y < view_.height; y++) {
    const uint32_t* row = &group_[size_t(y) * size_t(view_.width)];
    for (int x = 0; x < view_.width; x++) {
      if (row[x] == 0) continue;
      int end = x + 1;
      while (end < view_.width && row[end] == row[x]) end++;
      PixelBox& box = boxes.try_emplace(row[x], PixelBox{x, y, end, y + 1}).first->second;
      box = {std::min(box.x0, x), box.y0, std::max(box.x1, end), y + 1};
      x = end - 1;
    }
  }
  CorrectionPlan plan{view_, age_, group_, {}};
  for (const auto& [object, box] : boxes) {
    float weight = object < weights.size() ? weights[object] : 1;
    plan.regions.push_back({object, box, weight});
  }
  auto first = [](const auto& a, const auto& b) { return a.object < b.object; };
  std::sort(plan.regions.begin(), plan.regions.end(), first);
  queue_.submit(std::move(plan));
}

Request Corrections::request_at(ivec2 place, uint64_t seed) {
  Request request;
  request.seed = sample_seed(seed, uint32_t(place.x), uint32_t(place.y), 0);
  request.ray = view_ray(view_, float(place.x) + 0.5f, float(place.y) + 0.5f);
  request.pixel = uint32_t(place.y) * uint32_t(view_.width) + uint32_t(place.x);
  counts_.asked++;
  return request;
}

void Corrections::request(std::span<const float> weights, int most, uint64_t seed,
                          std::vector<Request>& requests) {
  if (pixels_ == 0 || most <= 0) return;
  find_regions(weights);
  CorrectionJob job;
  const size_t full = requests.size() + size_t(most);
  while (requests.size() < full && queue_.take(job))
    for (ivec2 place : job.places) {
      const uint32_t pixel = uint32_t(place.y) * uint32_t(view_.width) + uint32_t(place.x);
      if (level_[pixel] >= job.level || requests.size() >= full) continue;
      requests.push_back(request_at(place, seed));
    }
}

void Corrections::request_evenly(int most, uint64_t seed, std::vector<Request>& requests) {
  if (pixels_ == 0 || most <= 0) return;
  const size_t full = requests.size() + size_t(most);
  Rng rng(mix64(seed ^ 0x6576656e));
  const uint64_t pixels = object_.size();
  for (int tries = 0; tries < 40 * most && requests.size() < full; tries++) {
    const uint32_t pixel = uint32_t(uint64_t(rng.next()) * pixels >> 32);
    if (object_[pixel] == 0 || level_[pixel] >= store_.grid.levels) continue;
    level_[pixel] = uint8_t(store_.grid.levels);
    const ivec2 place(int(pixel) % view_.width, int(pixel) / view_.width);
    requests.push_back(request_at(place, seed));
  }
}

void Corrections::remember(const View& view, std::span<const Request> requests,
                           std::span<const Sample> samples) {
  if (shining_.empty()) return;
  const uint32_t pixels = uint32_t(view.width) * uint32_t(view.height);
  found_.clear();
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& sample = samples[i];
    const uint32_t pixel = requests[i].pixel;
    bool shines = (sample.flags & sample_hit) && !(sample.flags & sample_moving) &&
                  sample.object < shining_.size() && shining_[sample.object] > 0;
    if (!shines || pixel >= pixels) continue;
    // Light that is not as the map has it, near what moves, points tell.
    if ((sample.flags & sample_mapped) && sample.smooth != vec3(1)) continue;
    ivec2 place(int(pixel) % view.width, int(pixel) / view.width);
    found_.push_back({group_of(sample.object), level_of_pixel(store_.grid, place), sample.position,
                      sample.normal, make_words(sample)});
  }
  counts_.kept += uint64_t(add_samples(store_, view, age_, found_));
}

void Corrections::show(const View& lit, Frame& light) {
  if (pixels_ == 0 || lit != view_) return;
  splat();
  parallel_ranges(light.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < light.width; x++) {
        const size_t at = size_t(y) * size_t(light.width) + size_t(x);
        if (level_[at] == 0) continue;
        if (light.object[at] == object_[at] && own_samples(light.confidence[at]) > 0) continue;
        light.object[at] = object_[at];
        light.depth[at] = depth_[at];
        for (size_t k = 0; k < 3; k++) packed_word(light, x, y, word_planes[k]) = words_[at][k];
        std::memcpy(&light.confidence[at], &words_[at][3], sizeof(uint32_t));
      }
  });
}

}  // namespace wellspring::test
