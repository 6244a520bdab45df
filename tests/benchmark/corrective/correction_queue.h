// SPDX-License-Identifier: Apache-2.0
// Which places are traced next: regions of the picture, each of one object, by priority (Haber,
// Myszkowski, Yamauchi, Seidel 2001, sections 4.2 to 4.4). An analysis says how much each region
// matters; any number of tracers take jobs. A region whose level is done goes on with the next
// level at a lower priority, so others that matter nearly as much are roughly corrected before it
// is wholly so.
#pragma once
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "sqrt5_grid.h"
#include "world/view.h"

namespace wellspring::test {

struct CorrectionRegion {
  uint32_t object = 0;
  PixelBox box;  // pixels; the part outside of the picture is left out
  float priority = 0;
  bool operator==(const CorrectionRegion&) const = default;
};

// Holds the results of a picture's analysis.
struct CorrectionPlan {
  View view;
  uint32_t age = 0;              // the camera's
  std::vector<uint32_t> object;  // each pixel's object, as Frame::object: view.width * view.height
  std::vector<CorrectionRegion> regions;
};

struct CorrectionSettings {
  int levels = 4;
  int job = 64;        // most places of a job: the paper's N_job
  float decay = 0.9f;  // factor of the priority from level to level; the paper takes 0.8 to 0.9
};

// Places of one object and level, for one tracer.
struct CorrectionJob {
  uint64_t plan = 0;  // whose regions these are; see CorrectionQueue::plan()
  View view;
  uint32_t age = 0;
  uint32_t object = 0;
  int level = 1;
  float priority = 0;
  int64_t position = 0;  // index of the job's first place among the level's places in the region
  std::vector<ivec2> places;  // pixels that show the object
};

struct CorrectionStats {
  uint64_t places = 0;   // places that tracers got
  uint64_t skipped = 0;  // places outside of their region's object: nobody traces them
};

// All functions may be called by any thread. The lock is held while a job is taken or a plan comes
// in, never while places are traced; a job that finds no place of its object gives it back after
// `most_scanned` pixels.
class CorrectionQueue {
 public:
  static constexpr int most_scanned = 4096;

  explicit CorrectionQueue(const CorrectionSettings& settings = {});

  // Takes the place of the plan before. Regions that were there with the same object, box, view and
  // object plane go on where they are, at the new priority, lowered for the levels they have done.
  // Regions of object 0, without pixels in the picture, or whose priority is not above 0 are left
  // out; so are all where the plane is not as large as the view.
  void submit(CorrectionPlan plan);
  // The next job of the region of the highest priority, of equal ones that which waits longest.
  // False: nothing is left. At once the rest of the region waits for the next tracer.
  bool take(CorrectionJob& job);
  // Counts the plans that came in. Jobs taken from an older plan belong to an older view.
  uint64_t plan() const;
  bool empty() const;
  CorrectionStats stats() const;

 private:
  struct Entry {
    CorrectionRegion region;  // with the priority of its level
    int level = 1;
    Sqrt5Places places;
    uint64_t turn = 0;  // grows with each entry
  };
  static bool is_later(const Entry& a, const Entry& b);
  void put(Entry entry);
  Entry begin_of(const CorrectionRegion& region) const;
  bool next_level(Entry& entry);

  const CorrectionSettings settings_;
  const Sqrt5Grid grid_;
  mutable std::mutex mutex_;
  CorrectionPlan plan_;
  uint64_t plans_ = 0, turns_ = 0;
  std::vector<Entry> waiting_;  // a heap, the next first
  std::vector<Entry> done_;     // this plan's regions that are done
  CorrectionStats stats_;
};

}  // namespace wellspring::test
