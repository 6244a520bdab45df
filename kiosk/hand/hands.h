// SPDX-License-Identifier: Apache-2.0
// Follows the hands of one person: a hand that was read is read again where its own landmarks are
// (Zhang et al. 2020, section 2), another one where a forearm or moving skin says that one may be.
// OpenCV is not known here.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/hand/hand_gestures.h"
#include "kiosk/hand/hand_shape.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct HandLook {
  double time = 0;
  int width = 0, height = 0;      // pixels
  vec3 eye{0};                    // between the person's eyes, in the frame of the screen
  std::span<const Cut> places{};  // places for a new hand, the likeliest first
  size_t most_reads = 2;          // runs of the network in this frame
};

class HandTracks {
 public:
  using Read = std::function<HandMarks(const Cut& square)>;
  explicit HandTracks(const Mount& mount) : mount_(mount) {}
  // Takes a frame; `read` runs the network. Returns the hands that are seen, at most two, the one
  // that is higher first. A time that runs backwards forgets them.
  std::vector<Hand> step(const HandLook& look, const Read& read);
  // Returns how many hands are followed; with two, no place need be found for them.
  size_t followed() const { return tracks_.size(); }
  // Returns the tip of the first hand's index finger, pixels; nothing while no hand is seen.
  std::optional<vec2> index_tip() const;
  // Returns the gesture that became certain in this frame; empty: none.
  const std::string& gesture() const { return gesture_; }

 private:
  struct Track {
    HandMarks marks;
    HandShape shape;
    Hand hand;
    HandGestures gestures;
    OneEuro place, target;
    int candidate = -1, agreed = 0;  // pose and fingers of the newest reads, and how many agree
    double seen = 0;
  };
  struct Failure {
    vec2 middle{0};
    double time = 0;
  };
  bool update(Track& track, const HandLook& look, HandMarks marks);
  bool followed_at(vec2 middle, const Track* except = nullptr) const;

  Mount mount_;
  std::vector<Track> tracks_;  // at most two
  std::vector<Failure> failures_;
  std::string gesture_;
  double last_time_ = -1e9;
  size_t turn_ = 0;
};

}  // namespace wellspring::kiosk
