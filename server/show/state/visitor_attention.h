// SPDX-License-Identifier: Apache-2.0
// Holds what is found out about where one visitor looks, and the analysis that is under way
// (show/draw/steer.h).
#pragma once
#include <cstdint>
#include <memory>
#include <oneapi/tbb/task_arena.h>
#include <optional>
#include <vector>

#include "attention/task.h"
#include "base/worker.h"
#include "frame/frame.h"
#include "world/view.h"

namespace wellspring::show {

// Holds a drawn picture, made small, and the object that each of its pixels shows; 0: none.
struct SeenPicture {
  View view;      // view that was drawn
  int scale = 1;  // pixels of the drawn picture along a side of one of these
  Image8 picture;
  std::vector<uint32_t> object;
};
using ObjectWeights = std::vector<float>;  // RenderCache::set_weights()

// Holds what an analysis is made from; equal ones have equal answers.
struct AttentionCause {
  std::shared_ptr<const SeenPicture> seen;
  std::vector<AttentionHint> hints;  // places in pixels of that picture
  float task_weight = 0;
  std::vector<char> known;  // objects that need no samples: attention would not make them better
  bool operator==(const AttentionCause&) const = default;
};

struct VisitorAttention {
  std::optional<vec2> pointer;  // place, 0 to 1 from the upper left of the visitor's picture
  double pointed_at = -1e9;     // show time when it pointed there
  std::shared_ptr<const SeenPicture> seen;       // newest picture; null: none
  double seen_at = -1e9;                         // show time of its job
  AttentionCause cause;                          // cause of the last analysis
  double analysed_at = -1e9;                     // show time of its beginning
  std::shared_ptr<const ObjectWeights> weights;  // null: all are 1
};

// Holds the analysis, which is one for all visitors, who take turns.
struct AttentionAnalysis {
  uint64_t visitor = 0;  // link id of the visitor whose analysis is under way; 0: none
  AttentionCause cause;
  std::shared_ptr<const ObjectWeights> weights;  // its result
  double seconds = 0;                            // seconds that it took
  // Memory that is kept from one analysis to the next:
  SaliencyWork work;
  SaliencyMap saliency;
  TaskWork task;
  std::vector<SeenObject> objects;
  std::vector<float> attention;
  // One core, so that pictures have the others.
  oneapi::tbb::task_arena cores{1, 1, oneapi::tbb::task_arena::priority::low};
  Worker worker;  // the last member: it is waited for before the others end
};

}  // namespace wellspring::show
