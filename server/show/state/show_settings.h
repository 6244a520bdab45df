// SPDX-License-Identifier: Apache-2.0
// Holds what whoever starts a show may choose.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "light/transport_settings.h"
#include "show/house/house.h"
#include "wire/tokens.h"
#include "workers/settings.h"

namespace wellspring::show {

// Says how a visitor's pictures get their diffuse light.
enum class Display : uint8_t {
  automatic,  // by illumination maps, if there are any
  points,     // by the points of the visitor's render cache alone
  maps,       // by illumination maps; until there are any, by points
};
inline constexpr const char* display_names[] = {"automatic", "points", "maps"};

struct ShowSettings {
  float fps = 60;                    // pictures a second for a walking visitor, machine permitting
  std::string technique = "gather";  // used while anything moves
  std::string still_technique =
      "path";  // used while the visitor stands still: the picture becomes the reference
  TransportSettings transport{.max_depth = 6, .clamp = 12, .instant = {}, .splat = {}};
  // Folder of the networks' weights (denoise/denoise.h); empty: pictures at rest are only drawn.
  std::string weights;
  // Folder for what is found once about an exhibit and kept for the next start; empty: none.
  std::string cache;
  bool bakes = true;  // light is baked while nobody needs the cores, if there is a cache
  Display display = Display::automatic;
  // samples of walking visitors are traced after the picture, for the next
  bool late_samples = true;
  float moving_clamp = 4;  // instead of transport.clamp while the visitor moves: fewer fireflies
  int max_pixels = 1920 * 1200;
  HouseSettings house;
  std::vector<Token> kiosk_tokens;  // show/answer/cameras.h
  CrewSettings workers;             // machines that trace samples, too (show/workers)
  bool watched = false;  // a curator works at the exhibit: pages show what helps with that
  // Seconds (show/answer/idle.h): without input until visitors are asked whether they are there,
  // and until they have answered; of a hidden page until its visit rests. 0: never.
  double idle_after = 300, idle_answer = 60, hidden_after = 20;
};

}  // namespace wellspring::show
