// SPDX-License-Identifier: Apache-2.0
// Which objects of a view matter to what its visitor is doing: people bring what interests them to
// the middle of the picture and close to the eye (Haber et al. 2001, section 3), and point at it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "attention/saliency.h"
#include "base/vec.h"

namespace wellspring::attention {

// Somebody points there: a visitor's pointer or finger, where a head at a kiosk is turned to, what
// the storyteller shows. Pixels count from the picture's upper left corner: the first pixel's
// middle is (0.5, 0.5).
struct AttentionHint {
  vec2 place{0};
  float radius = 0;  // pixels: beyond it the hint says nothing; 0: only the pixel at the place
  float weight = 1;  // 0 (nothing) to 1 (surely meant)
  bool operator==(const AttentionHint&) const = default;
};

// An object as the view shows it.
struct SeenObject {
  uint32_t object = 0;
  int pixels = 0;
  ivec2 low{0}, high{0};  // bounding box: its first pixel and its last
  float coverage = 0;     // share of the picture's pixels
  float distance = 0;     // of the box's middle from the picture's, over half the diagonal: 0 to 1
  float importance = 0;   // what the task tells, 0 to 1
  // Mean of the saliency over the object's own pixels. Not the largest: a pixel of the map is 16
  // wide, so a wall would be as salient as the brightest thing before it.
  float saliency = 0;
};

// Mean of nearness to the middle, 1 - distance, and of the root of the coverage: how wide and high
// the object is beside the picture. Hints close part of the gap to 1, each for itself:
// 1 - importance is multiplied by 1 - weight * nearness, where nearness falls from 1 at an object's
// own pixels to 0 at the hint's radius. `hint_gap` is the product of these.
float eval_importance(float distance, float coverage, float hint_gap = 1);

// What the computation keeps from picture to picture.
struct TaskWork {
  struct Sums {
    uint32_t object = 0;
    int pixels = 0;
    ivec2 low{0}, high{0};
    uint64_t saliency = 0;  // fixed point, so that the order of addition does not count
  };
  // Objects of some rows, by a hash of their number.
  struct Band {
    std::vector<int> slot;  // index into sums, -1: free
    std::vector<Sums> sums;
    std::vector<float> near;        // [sums * hints]: the hint's nearness to the object
    std::vector<uint32_t> salient;  // sums of a row's saliency from its left on
  };
  std::vector<Band> bands;
  Band all;
  std::vector<int> column;      // of a pixel in the saliency map
  std::vector<float> fraction;  // of the way to the next column
};

// Overwrites `seen` with the objects of the view, sorted by number. `object` holds width * height
// numbers, top row first; 0 is no object. The saliency is that of the view's picture (of the same
// size), or empty. Hints that are not finite count nothing. Deterministic for any number of
// threads; linear in pixels.
void eval_objects(std::span<const uint32_t> object, int width, int height,
                  const SaliencyMap& saliency, std::span<const AttentionHint> hints, TaskWork& work,
                  std::vector<SeenObject>& seen);

}  // namespace wellspring::attention
