// SPDX-License-Identifier: Apache-2.0
// Estimates which objects of a view matter to what its visitor is doing: people bring what
// interests them to the middle of the picture and close to the eye (Haber et al. 2001, section 3),
// and point at it.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "attention/saliency.h"
#include "base/vec.h"

namespace wellspring::attention {

// A place that somebody points at: a visitor with a pointer or finger, a turned head at a kiosk, or
// the storyteller. Pixels count from the picture's upper left corner: the first pixel's middle is
// (0.5, 0.5).
struct AttentionHint {
  vec2 place{0};
  float radius = 0;  // pixels; beyond it the hint says nothing; 0: only the pixel at the place
  float weight = 1;  // 0 (nothing) to 1 (surely meant)
  bool operator==(const AttentionHint&) const = default;
};

// An object as the view shows it.
struct SeenObject {
  uint32_t object = 0;
  int pixels = 0;
  ivec2 low{0}, high{0};  // bounding box: its first pixel and its last
  float coverage = 0;     // share of the picture's pixels
  // Distance of the box's middle from the picture's, over half the diagonal: 0 to 1.
  float distance = 0;
  float importance = 0;  // importance for the task, 0 to 1
  // Mean of the saliency over the object's own pixels. The largest would not do: a pixel of the map
  // is 16 wide, so a wall would be as salient as the brightest thing before it.
  float saliency = 0;
};

// Returns the mean of nearness to the middle, 1 - distance, and of the root of the coverage: how
// wide and high the object is beside the picture. Hints close part of the gap to 1, each for
// itself: 1 - importance is multiplied by 1 - weight * nearness, where nearness falls from 1 at an
// object's own pixels to 0 at the hint's radius. `hint_gap` is the product of these.
float eval_importance(float distance, float coverage, float hint_gap = 1);

// Holds memory that is kept from picture to picture.
struct TaskWork {
  struct Sums {
    uint32_t object = 0;
    int pixels = 0;
    ivec2 low{0}, high{0};
    uint64_t saliency = 0;  // fixed point, so that the order of addition does not count
  };
  // Holds objects of some rows, by a hash of their number.
  struct Band {
    std::vector<int> slot;  // index into sums, -1: free
    std::vector<Sums> sums;
    std::vector<float> near;        // [sums * hints]: the hint's nearness to the object
    std::vector<uint32_t> salient;  // sums of a row's saliency from its left on
  };
  std::vector<Band> bands;
  Band all;
  std::vector<int> column;      // column of each pixel in the saliency map
  std::vector<float> fraction;  // share of the way to the next column
};

// Overwrites `seen` with the objects of the view, sorted by number. `object` holds width * height
// numbers, top row first; 0 is no object. The saliency is that of the view's picture (of the same
// size), or empty. Hints that are not finite count nothing. Deterministic for any number of
// threads; linear in pixels.
void eval_objects(std::span<const uint32_t> object, int width, int height,
                  const SaliencyMap& saliency, std::span<const AttentionHint> hints, TaskWork& work,
                  std::vector<SeenObject>& seen);

// Computes how much each object of a view is attended to, and in which order objects get what there
// is not enough of, such as corrections of their light (Haber et al. 2001, section 3).

// Sets the attention of every object to (1 - task_weight) * saliency + task_weight * importance.
// The weight is the visitor's slider: with 0 the picture alone counts, with 1 the task alone.
void eval_attention(std::span<const SeenObject> seen, float task_weight,
                    std::vector<float>& attention);

// A winner keeps this share of its attention: it loses the paper's 10 %.
inline constexpr float attention_kept = 0.9f;
// Attention counts at least this share of the largest: 18 losses lead from that down to it. So
// every object wins once before any wins 20 times, and none is forgotten.
inline constexpr float least_attention = 0.15f;

// Finds the order of corrections: the object of the most attention gets a share, loses a tenth of
// its attention, and the next is chosen. Attention that is not finite or negative counts as 0; if
// objects are equal the first one wins. After a while all take turns, since all have lost what set
// them apart.
class AttentionOrder {
 public:
  // Begins anew with this attention.
  void start(std::span<const float> attention);
  // Returns the index of the next winner; -1 if there are no objects. Takes O(log objects).
  int next();

 private:
  // Number of losses that lead from the largest attention to an object's present one, and its
  // index. Counting losses instead of multiplying never becomes 0.
  std::vector<std::pair<double, int>> heap_;
};

// Writes the next winners into `order`, which is overwritten.
void plan_order(std::span<const float> attention, int shares, AttentionOrder& work,
                std::vector<int>& order);

struct SampleShare {
  float share = 0;   // share of all samples for objects; the shares' sum is 1
  float factor = 0;  // the object's samples a pixel over those of all objects on average
};
// Gives objects samples a pixel in proportion to attention. Without objects, or if none has pixels,
// the shares are 0.
void eval_sample_shares(std::span<const SeenObject> seen, std::span<const float> attention,
                        std::vector<SampleShare>& shares);

// Weights are sharper than shares: they say how urgently an object's pixels want samples. Attention
// says which objects the eye prefers, but it looks at one object at a time: weights follow the
// shares of attention to this power.
inline constexpr float attention_contrast = 3;
// Overwrites `weights`: for each object, by its number, the square of SampleShare::factor; 1 if it
// is not seen. Pixels that are sampled often want samples less: n times as many take n^2 times the
// urgency.
void eval_weights(std::span<const SeenObject> seen, std::span<const float> attention,
                  std::vector<float>& weights);

}  // namespace wellspring::attention
