// SPDX-License-Identifier: Apache-2.0
// Bakes illumination maps while the show goes on: a thread works on the exhibit's bake, on all
// cores while nobody needs them, else in the spare time of one core and first where visitors look.
// It keeps the bake on disk and hands over a map whenever the map has become better.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "light/kept/bake.h"
#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"
#include "show/state/totals.h"

namespace wellspring::show {

struct BakerSettings {
  // path without ending: .bake is the unfinished bake, .maps the map that is shown
  std::string file;
  std::string source;          // the exhibit's folder
  std::vector<vec3> places;    // expected places of eyes, in scene coordinates
  std::vector<vec3> eyes;      // all places where eyes may be
  double least_error = 0.004;  // share of the mean light; the bake ends at this error
  BakeSettings bake;           // settings of a bake that begins anew
  float shown_error = 1;       // error of the map that is shown already; 1: not known
  // map on which walks end, all lamps full; may be null
  std::shared_ptr<const IlluminationMap> known;
  bool as_kept = false;  // maps are handed over as their file has them, for others who read it
  std::vector<PlacedVolume> volumes;  // as World has them: they throw shadows
};

enum class BakerCores : uint8_t {
  none,
  spare,  // the spare time of one core
  all,
};

class Baker {
 public:
  Baker(const Scene& scene, BakerSettings settings);  // borrows the scene
  ~Baker();                                           // saves the bake; takes tenths of a second
  Baker(const Baker&) = delete;
  Baker& operator=(const Baker&) = delete;

  // Sets the cores that it may use from now on; it obeys within a tenth of a second.
  void allow(BakerCores cores) { cores_ = cores; }
  // Takes the rays along which visitors look (scene coordinates). The newest replace those before.
  void look(std::vector<Ray> rays);
  // Returns a better map than the last one taken, or null.
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

// Holds the show times when the show last gave its baker the visitors' rays, and took a map.
struct BakerLooks {
  double told_at = -1e9, took_at = -1e9;
};

}  // namespace wellspring::show
