// SPDX-License-Identifier: Apache-2.0
// Illumination maps come by themselves: a thread that finds coarse light at once where there is no
// other, goes on with the exhibit's bake while nobody needs the cores, keeps it on disk, and hands
// over a map whenever it has become better.
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

namespace wellspring {

struct BakerSettings {
  std::string file;            // without its ending: .bake is what goes on, .maps what is shown
  std::string source;          // the exhibit's folder
  std::vector<vec3> places;    // scene coordinates: where eyes will be
  std::vector<vec3> eyes;      // and wherever they may be
  double least_error = 0.004;  // of the mean light: good enough for ever
  BakeSettings bake;           // of one that is begun
  float shown_error = 1;       // of the map that is shown already; 1: there is none
};

struct BakerStatus {
  bool works = false;  // at the moment
  uint64_t passes = 0;
  float error = 1;  // of what is known so far; 1: nothing is
};

class Baker {
 public:
  Baker(const Scene& scene, BakerSettings settings);  // borrows the scene
  ~Baker();  // what has been found is saved; tenths of a second
  Baker(const Baker&) = delete;
  Baker& operator=(const Baker&) = delete;

  // From now on the cores are free, or not: then it stops within a tenth of a second.
  void allow(bool on) { allowed_ = on; }
  // A better map than the last one taken, or null.
  std::shared_ptr<const IlluminationMap> take();
  BakerStatus status() const;

 private:
  void live(const std::stop_token& end);
  void publish(const World& world, Bake& bake, uint64_t key, float& shown);
  bool wait_until_allowed(const std::stop_token& end);
  const Scene& scene_;
  BakerSettings settings_;
  std::atomic<bool> allowed_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const IlluminationMap> found_;
  BakerStatus status_;
  std::jthread thread_;
};

}  // namespace wellspring
