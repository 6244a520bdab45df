// SPDX-License-Identifier: Apache-2.0
// Sees bodies, and the hands of people whose faces are followed, and spots what hands do: by
// networks where their weights are installed (kiosk/body, kiosk/hand), else by the colour of skin
// (kiosk/gesture).
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/frame/head.h"
#include "kiosk/gesture/gesture_model.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct LimbSettings {
  Mount mount;
  std::string weights;                      // folder with networks of @vladmandic/human
  bool bodies = false;                      // bodies are asked for
  const GestureModels* gestures = nullptr;  // borrowed; null: hands are not followed
};

// Holds a person whose face is seen in this frame.
struct PersonInView {
  uint32_t id = 0;
  Box face;         // pixels
  float depth = 1;  // metres along the camera's axis
  vec3 eye{0};      // between the eyes, in the frame of the screen
};

class Limbs {
 public:
  // Opens the networks that are asked for; the log says which are not installed.
  explicit Limbs(const LimbSettings& settings);
  ~Limbs();
  // Takes every frame with what moves in it, largest first, and people, nearest first. Without
  // `hands` none are looked for. Networks run at most twice a frame, about 15 ms each.
  void step(const GrayFrame& frame, std::span<const Box> zones,
            std::span<const PersonInView> people, bool hands);

  struct Arms {
    std::vector<Hand> hands;
    std::string gesture;  // one that was recognised within the last half second; empty: none
  };
  // Returns what the hands of a person did in the last frame.
  Arms arms_of(uint32_t id) const;
  void forget(uint32_t id);

  // These are as kiosk/body/body_tracks.h has them; nobody and false without its network.
  std::vector<wire::Body> bodies(double time) const;
  bool somebody_comes() const;
  bool somebody_stays_near(double time) const;

  // Say whether the networks are there; nothing if they are not asked for.
  std::optional<bool> sees_bodies() const;
  std::optional<bool> sees_hands() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
