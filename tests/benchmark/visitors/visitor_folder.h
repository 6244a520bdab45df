// SPDX-License-Identifier: Apache-2.0
// Shows pictures of visitors to the kiosk's eye as a folder: PNG files and truth.json, which says
// how long each is shown and what is true in it. wellspring_kiosk_watch
// (tests/benchmark/kiosk/main_watch.cpp) watches it, so that OpenCV stays out of the benchmark's
// program.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>

#include "visitor_stage.h"

namespace wellspring::test {

struct VisitorFrame {
  VisitorShot shot;
  double seconds = 0.8;                           // shown for so long
  bool judged = true;                             // else it only leads to others
  std::function<void(VisitorPicture&)> change{};  // edits the finished picture
};

// A sequence is what a camera sees without a break; the eye knows nothing before it.
struct VisitorSequence {
  nlohmann::json about;  // fields that tell it apart in reports
  std::vector<VisitorFrame> frames;
};

// Holds the eye's answer to one frame.
struct VisitorSeen {
  struct Person {
    uint32_t id = 0;
    vec3 position{0}, rotation{0};
    std::array<float, 6> expression{};  // in the order of Emotion
  };
  std::vector<Person> people;  // at its end
  double found = 0;            // share of its last half in which anybody was seen
  int most = 0;                // people at once, in that half
};

struct VisitorWatch {
  std::string programs, weights, folder;
  double rate = 30;  // pictures a second
  bool expression = false;
};

// Draws the sequences into the folder, which is emptied before, and has them watched:
// [sequence][frame]. Throws std::runtime_error where files cannot be written or the program fails.
std::vector<std::vector<VisitorSeen>> watch_visitors(VisitorStage& stage,
                                                     const std::vector<VisitorSequence>& sequences,
                                                     const VisitorWatch& watch);

}  // namespace wellspring::test
