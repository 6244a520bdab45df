// SPDX-License-Identifier: Apache-2.0
// Illumination maps come by themselves: a thread goes on with the exhibit's bake, on all cores
// while nobody needs them, else in what one core has to spare and first where visitors look. It
// keeps the bake on disk and hands over a map whenever it has become better.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "light/bake/bake.h"
#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"

namespace wellspring::show {

struct BakerSettings {
  std::string file;            // without its ending: .bake is what goes on, .maps what is shown
  std::string source;          // the exhibit's folder
  std::vector<vec3> places;    // scene coordinates: where eyes will be
  std::vector<vec3> eyes;      // and wherever they may be
  double least_error = 0.004;  // of the mean light: good enough for ever
  BakeSettings bake;           // of one that is begun
  float shown_error = 1;       // of the map that is shown already; 1: nobody knows
  std::shared_ptr<const IlluminationMap> known;  // on which walks end, all lamps full; may be null
};

struct BakerStatus {
  bool works = false;  // at the moment, on all cores
  uint64_t passes = 0;
  float error = 1;  // of what is known so far; 1: nothing is
};

enum class BakerCores : uint8_t {
  none,
  spare,  // what other threads leave of one
  all,
};

class Baker {
 public:
  Baker(const Scene& scene, BakerSettings settings);  // borrows the scene
  ~Baker();  // what has been found is saved; tenths of a second
  Baker(const Baker&) = delete;
  Baker& operator=(const Baker&) = delete;

  // From now on; within a tenth of a second.
  void allow(BakerCores cores) { cores_ = cores; }
  // Visitors look along these rays (scene coordinates). The newest replace those before.
  void look(std::vector<Ray> rays);
  // A better map than the last one taken, or null.
  std::shared_ptr<const IlluminationMap> take();
  BakerStatus status() const;

 private:
  void live(const std::stop_token& end);
  void publish(const World& world, Bake& bake, uint64_t key, float& shown);
  bool go_ahead_where_looked(const BakeScene& scene, Bake& bake);
  bool wait_until_allowed(const std::stop_token& end);
  const Scene& scene_;
  BakerSettings settings_;
  std::atomic<BakerCores> cores_ = BakerCores::none;
  mutable std::mutex mutex_;
  std::shared_ptr<const IlluminationMap> found_;
  std::vector<Ray> looks_;
  BakerStatus status_;
  std::jthread thread_;
};

// When the show last told its baker where visitors look, and took a map: show time.
struct BakerLooks {
  double told_at = -1e9, took_at = -1e9;
};

}  // namespace wellspring::show
