// SPDX-License-Identifier: Apache-2.0
#include "attention/task.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "base/rng.h"

namespace wellspring::attention {
namespace {

using Band = TaskWork::Band;
using Sums = TaskWork::Sums;

constexpr int rows_a_band = 32;
constexpr float fixed_point = 1 << 16;  // a row of 65535 pixels fits 32 bits

void clear(Band& band) {
  band.sums.clear();
  band.near.clear();
  if (band.slot.empty()) band.slot.resize(64);
  std::fill(band.slot.begin(), band.slot.end(), -1);
}

// Returns the slot of the object, or the free one that waits for it. The number of slots is a power
// of two.
size_t find_slot(const Band& band, uint32_t object) {
  size_t mask = band.slot.size() - 1, at = size_t(mix64(object)) & mask;
  while (band.slot[at] >= 0 && band.sums[size_t(band.slot[at])].object != object)
    at = (at + 1) & mask;
  return at;
}

// Returns the object's place in band.sums, which is added if there is none.
size_t find_sums(Band& band, uint32_t object, size_t hints) {
  size_t at = find_slot(band, object);
  if (band.slot[at] >= 0) return size_t(band.slot[at]);
  band.slot[at] = int(band.sums.size());
  band.sums.push_back({object, 0, ivec2(INT32_MAX), ivec2(-1), 0});
  band.near.resize(band.sums.size() * hints, 0.0f);
  if (2 * band.sums.size() > band.slot.size()) {
    band.slot.assign(2 * band.slot.size(), -1);
    for (size_t i = 0; i < band.sums.size(); i++)
      band.slot[find_slot(band, band.sums[i].object)] = int(i);
  }
  return band.sums.size() - 1;
}

void add(const Sums& from, Sums& to) {
  to.pixels += from.pixels;
  to.low = glm::min(to.low, from.low);
  to.high = glm::max(to.high, from.high);
  to.saliency += from.saliency;
}

float finite_weight(const AttentionHint& hint) {
  bool good = std::isfinite(hint.place.x) && std::isfinite(hint.place.y) &&
              std::isfinite(hint.radius) && std::isfinite(hint.weight);
  return good ? std::clamp(hint.weight, 0.0f, 1.0f) : 0;
}

// Returns how near a hint is to pixels [begin, end) of row y: 1 inside of them, 0 at its radius.
float eval_nearness(const AttentionHint& hint, int begin, int end, int y) {
  vec2 nearest =
      glm::clamp(hint.place, vec2(float(begin), float(y)), vec2(float(end), float(y + 1)));
  float distance = glm::length(hint.place - nearest);
  if (distance == 0) return 1;
  return hint.radius > distance ? 1 - distance / hint.radius : 0;
}

// Sums, for each pixel of a row, the saliency of the pixels to its left.
void sum_saliency(const SaliencyMap& saliency, int y, int width, const TaskWork& work,
                  std::vector<uint32_t>& sums) {
  sums.resize(size_t(width) + 1);
  sums[0] = 0;
  const Plane& map = saliency.map;
  float at =
      std::clamp(saliency.offset.y + float(y) / (1 << saliency_scale), 0.0f, float(map.height - 1));
  int top = int(at);
  float share = at - float(top);
  const float *above = map.row(top), *below = map.row(std::min(top + 1, map.height - 1));
  int last = map.width - 1;
  auto column = [&](int x) { return above[x] + share * (below[x] - above[x]); };
  for (int x = 0; x < width; x++) {
    int left = work.column[size_t(x)];
    float a = column(left), b = column(std::min(left + 1, last));
    float value = a + work.fraction[size_t(x)] * (b - a);
    sums[size_t(x) + 1] = sums[size_t(x)] + uint32_t(fixed_point * value + 0.5f);
  }
}

struct ObjectPlane {
  std::span<const uint32_t> object;
  int width, height;
  const SaliencyMap& saliency;
  std::span<const AttentionHint> hints;
};

// Adds the runs of equal objects of a row.
void add_row(const ObjectPlane& view, int y, const TaskWork& work, Band& band) {
  bool is_salient = !view.saliency.map.value.empty();
  if (is_salient) sum_saliency(view.saliency, y, view.width, work, band.salient);
  const uint32_t* row = view.object.data() + size_t(y) * size_t(view.width);
  for (int begin = 0, end = 0; begin < view.width; begin = end) {
    while (end < view.width && row[end] == row[begin]) end++;
    if (row[begin] == 0) continue;
    size_t i = find_sums(band, row[begin], view.hints.size());
    uint64_t salient =
        is_salient ? band.salient[size_t(end)] - band.salient[size_t(begin)] : uint64_t(0);
    add({row[begin], end - begin, ivec2(begin, y), ivec2(end - 1, y), salient}, band.sums[i]);
    for (size_t h = 0; h < view.hints.size(); h++) {
      float& near = band.near[i * view.hints.size() + h];
      near = std::max(near, eval_nearness(view.hints[h], begin, end, y));
    }
  }
}

void add_band(const Band& from, size_t hints, Band& to) {
  for (size_t k = 0; k < from.sums.size(); k++) {
    size_t i = find_sums(to, from.sums[k].object, hints);
    add(from.sums[k], to.sums[i]);
    for (size_t h = 0; h < hints; h++)
      to.near[i * hints + h] = std::max(to.near[i * hints + h], from.near[k * hints + h]);
  }
}

void place_columns(const SaliencyMap& saliency, int width, TaskWork& work) {
  work.column.resize(size_t(width));
  work.fraction.resize(size_t(width));
  for (int x = 0; x < width; x++) {
    float at = std::clamp(saliency.offset.x + float(x) / (1 << saliency_scale), 0.0f,
                          float(std::max(saliency.map.width - 1, 0)));
    work.column[size_t(x)] = int(at);
    work.fraction[size_t(x)] = at - float(int(at));
  }
}

SeenObject finish(const Sums& sums, const float* near, const ObjectPlane& view) {
  SeenObject seen{sums.object, sums.pixels, sums.low, sums.high};
  vec2 size = vec2(float(view.width), float(view.height));
  vec2 middle = 0.5f * vec2(sums.low + sums.high + 1);
  seen.coverage = float(sums.pixels) / (size.x * size.y);
  seen.distance = glm::length(middle - 0.5f * size) / (0.5f * glm::length(size));
  seen.saliency = std::min(float(double(sums.saliency) / fixed_point / sums.pixels), 1.0f);
  float gap = 1;
  for (size_t h = 0; h < view.hints.size(); h++) gap *= 1 - finite_weight(view.hints[h]) * near[h];
  seen.importance = eval_importance(seen.distance, seen.coverage, gap);
  return seen;
}

}  // namespace

float eval_importance(float distance, float coverage, float hint_gap) {
  float importance = 0.5f * (1 - distance) + 0.5f * std::sqrt(coverage);
  return 1 - (1 - std::clamp(importance, 0.0f, 1.0f)) * hint_gap;
}

void eval_objects(std::span<const uint32_t> object, int width, int height,
                  const SaliencyMap& saliency, std::span<const AttentionHint> hints, TaskWork& work,
                  std::vector<SeenObject>& seen) {
  ObjectPlane view{object, width, height, saliency, hints};
  place_columns(saliency, width, work);
  work.bands.resize(size_t((height + rows_a_band - 1) / rows_a_band));
  parallel_for(int(work.bands.size()), [&](int i) {
    Band& band = work.bands[size_t(i)];
    clear(band);
    int begin = i * rows_a_band, end = std::min(begin + rows_a_band, height);
    for (int y = begin; y < end; y++) add_row(view, y, work, band);
  });
  clear(work.all);
  for (const Band& band : work.bands) add_band(band, hints.size(), work.all);
  seen.clear();
  for (size_t i = 0; i < work.all.sums.size(); i++)
    seen.push_back(finish(work.all.sums[i], work.all.near.data() + i * hints.size(), view));
  std::sort(seen.begin(), seen.end(),
            [](const SeenObject& a, const SeenObject& b) { return a.object < b.object; });
}

namespace {

double usable(float attention) {
  return std::isfinite(attention) && attention > 0 ? double(attention) : 0;
}

double largest_of(std::span<const float> attention) {
  double largest = 0;
  for (float a : attention) largest = std::max(largest, usable(a));
  return largest;
}

// Returns attention over the largest, least_attention to 1; 1 if no object has any.
double relative(float attention, double largest) {
  return largest > 0 ? std::max(usable(attention) / largest, double(least_attention)) : 1;
}

constexpr auto later = std::greater<std::pair<double, int>>();

}  // namespace

void eval_attention(std::span<const SeenObject> seen, float task_weight,
                    std::vector<float>& attention) {
  float weight = std::isfinite(task_weight) ? std::clamp(task_weight, 0.0f, 1.0f) : 0;
  attention.clear();
  for (const SeenObject& object : seen)
    attention.push_back((1 - weight) * object.saliency + weight * object.importance);
}

void AttentionOrder::start(std::span<const float> attention) {
  double largest = largest_of(attention);
  heap_.clear();
  for (size_t i = 0; i < attention.size(); i++)
    heap_.push_back(
        {std::log(relative(attention[i], largest)) / std::log(double(attention_kept)), int(i)});
  std::make_heap(heap_.begin(), heap_.end(), later);
}

int AttentionOrder::next() {
  if (heap_.empty()) return -1;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  heap_.back().first += 1;
  int winner = heap_.back().second;
  std::push_heap(heap_.begin(), heap_.end(), later);
  return winner;
}

void plan_order(std::span<const float> attention, int shares, AttentionOrder& work,
                std::vector<int>& order) {
  work.start(attention);
  order.clear();
  if (attention.empty()) return;
  for (int i = 0; i < shares; i++) order.push_back(work.next());
}

void eval_sample_shares(std::span<const SeenObject> seen, std::span<const float> attention,
                        std::vector<SampleShare>& shares) {
  double largest = largest_of(attention), sum = 0, pixels = 0;
  for (size_t i = 0; i < seen.size(); i++) {
    sum += relative(attention[i], largest) * seen[i].pixels;
    pixels += seen[i].pixels;
  }
  shares.assign(seen.size(), {});
  if (sum <= 0) return;
  for (size_t i = 0; i < seen.size(); i++) {
    double weight = relative(attention[i], largest);
    shares[i] = {float(weight * seen[i].pixels / sum), float(weight * pixels / sum)};
  }
}

void eval_weights(std::span<const SeenObject> seen, std::span<const float> attention,
                  std::vector<float>& weights) {
  const double largest = largest_of(attention);
  std::vector<float> sharper;
  for (float one : attention)
    sharper.push_back(float(std::pow(relative(one, largest), attention_contrast)));
  std::vector<SampleShare> shares;
  eval_sample_shares(seen, sharper, shares);
  weights.clear();
  for (size_t i = 0; i < seen.size(); i++) {
    if (seen[i].object >= weights.size()) weights.resize(size_t(seen[i].object) + 1, 1.0f);
    weights[seen[i].object] = shares[i].factor * shares[i].factor;
  }
}

}  // namespace wellspring::attention
