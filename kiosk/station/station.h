// SPDX-License-Identifier: Apache-2.0
// Tells what a visitor holds to the camera: a recognition tree with the solvers of this folder, and
// what is handed on of their results. Pixels stay here.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "kiosk/frame/head.h"
#include "kiosk/station/traversal.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct StationSettings {
  Mount mount;
  // Seconds between looks while nothing is held: if something has come and rests, if something
  // moves, and otherwise.
  double look_every = 0.2, look_moving = 0.6, look_rarely = 2;
  int sure_after = 2;       // looks in a row that must agree before a name is told
  double hold = 0.6;        // seconds that a name is told after the object was seen last
  double hint_after = 0.7;  // seconds that a class must be undecided before a hint is told
};

class Station {
 public:
  // Throws std::invalid_argument for a tree that names a solver which is not there.
  explicit Station(RecognitionTree tree, const StationSettings& settings = {});
  ~Station();
  // Takes every frame. About 10 ms while an object is followed, 50 ms for a look at anything else,
  // 0.3 ms ten times a second between looks.
  std::optional<Holding> step(const GrayFrame& frame);
  // Looks at a frame now and says what the tree says, for measurements.
  Recognition look(const GrayFrame& frame);
  void forget();  // forgets what was seen
  const RecognitionTree& tree() const;
  const ContextStore& context() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
