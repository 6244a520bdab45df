// SPDX-License-Identifier: Apache-2.0
// Has workers trace further samples of a picture that is made beside a show's visitors
// (show/http/still.h), from a sequence of their own. They are worth less than what visitors wait
// for, so workers trace them last; nobody waits for them.
#pragma once
#include <mutex>
#include <vector>

#include "cache/broker.h"
#include "frame/frame.h"
#include "workers/crew.h"

namespace wellspring::show {

// Says of which world the samples are.
struct AwayScene {
  Crew* crew = nullptr;  // none: nothing is asked for
  std::string state;     // as write_world_state() has it
  uint64_t light = 0;    // number of its illumination maps
};

class AwayStill {
 public:
  // At most `most` samples a pixel of `view`. `trace` finds the same samples here
  // (CrewSettings::verifies). Everything is borrowed.
  AwayStill(const AwayScene& scene, const View& view, const cache::TraceJob& job, int most,
            Crew::TraceHere trace);
  ~AwayStill();
  AwayStill(const AwayStill&) = delete;
  AwayStill& operator=(const AwayStill&) = delete;

  // Sends what workers would take now, and takes what has come. Any thread; returns at once.
  void ask();
  // Puts what has come into a picture of so many samples a pixel. Returns the mean number of
  // samples a pixel that it has then.
  float add_to(Frame& frame, int here);

 private:
  void take();
  const AwayScene& scene_;
  const View& view_;
  const cache::TraceJob job_;
  const Crew::TraceHere trace_;
  const uint64_t most_;  // samples
  const uint64_t asker_;
  std::mutex mutex_;
  Broker broker_;
  std::vector<Request> requests_;
  uint64_t asked_ = 0;
  std::vector<vec3> light_;  // sums of radiance, by pixel; none before any came
  std::vector<int> counts_;
};

}  // namespace wellspring::show
