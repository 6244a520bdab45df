// SPDX-License-Identifier: Apache-2.0
#include "attention/attended.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace wellspring::attention {
namespace {

double usable(float attention) {
  return std::isfinite(attention) && attention > 0 ? double(attention) : 0;
}

double largest_of(std::span<const float> attention) {
  double largest = 0;
  for (float a : attention) largest = std::max(largest, usable(a));
  return largest;
}

// Over the largest, least_attention to 1; 1 where nobody has any.
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
