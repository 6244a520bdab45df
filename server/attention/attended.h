// SPDX-License-Identifier: Apache-2.0
// How much each object of a view is attended to, and in which order objects get what there is not
// enough of, such as corrections of their light (Haber et al. 2001, section 3).
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "attention/task.h"

namespace wellspring::attention {

// (1 - task_weight) * saliency + task_weight * importance of every object. The weight is the
// visitor's slider: 0 listens to the picture alone, 1 to the task alone.
void eval_attention(std::span<const SeenObject> seen, float task_weight,
                    std::vector<float>& attention);

// Who wins loses a tenth of its attention (the paper's 10 %).
inline constexpr float attention_kept = 0.9f;
// Attention counts at least this share of the largest: 18 losses lead from that down to it. So
// everybody wins once before anybody wins 20 times, and nobody is forgotten.
inline constexpr float least_attention = 0.15f;

// The order of corrections: the object of the most attention gets a share, loses a tenth of its
// attention, and the next is chosen. Attention that is not finite or negative counts as 0; of equal
// ones the first wins. After a while all take turns, since all have lost what set them apart.
class AttentionOrder {
 public:
  // Forgets what was before.
  void start(std::span<const float> attention);
  // The index of the next winner; -1 where there are no objects. Takes O(log objects).
  int next();

 private:
  // Losses that lead from the largest attention to what is left, and the index. Counting losses
  // instead of multiplying never becomes 0.
  std::vector<std::pair<double, int>> heap_;
};

// The next winners into `order`, which is overwritten.
void plan_order(std::span<const float> attention, int shares, AttentionOrder& work,
                std::vector<int>& order);

struct SampleShare {
  float share = 0;   // of all samples for objects; the shares' sum is 1
  float factor = 0;  // the object's samples a pixel over those of all objects on average
};
// Samples a pixel in proportion to attention. No objects, or none with pixels: no shares.
void eval_sample_shares(std::span<const SeenObject> seen, std::span<const float> attention,
                        std::vector<SampleShare>& shares);

// The same, told sharper, as a factor of how urgently an object's pixels want samples. Attention
// tells whom the eye prefers, but what is looked at is one object at a time: shares are those of
// attention to this power.
inline constexpr float attention_contrast = 3;
// Pixels that are sampled often want samples less: n times as many take n^2 times the urgency.
// Overwrites `weights`: of each object by its number the square of SampleShare::factor. 1: not
// seen.
void eval_weights(std::span<const SeenObject> seen, std::span<const float> attention,
                  std::vector<float>& weights);

}  // namespace wellspring::attention
