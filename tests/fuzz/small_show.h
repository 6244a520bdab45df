// SPDX-License-Identifier: Apache-2.0
// A show for targets that order it about: two storytellers, a lamp and a kiosk, and pictures so
// small that they cost next to nothing.
#pragma once
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::fuzz {

inline void begin_small_show(ShowStage& stage) {
  Exhibit exhibit = make_tiny_exhibit();
  add_storyteller(exhibit, "anna", {-2, 0, 1}).greetings["en"].emplace_back().text = "Welcome.";
  add_storyteller(exhibit, "otto", {-2, 0, 2});
  add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
  exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
  ShowSettings settings = settings_for("direct", 10);
  settings.max_pixels = 16 * 16;
  stage.tick_seconds = 0.1;
  stage.begin(std::move(exhibit), settings);
}

}  // namespace wellspring::fuzz
