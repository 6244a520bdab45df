// SPDX-License-Identifier: Apache-2.0
// Shows keyframes with depth as a page does that draws for itself (web/display): from any view, by
// the same warp (picture/warp_picture.h), newest keyframe over the one before over the wide one. It
// does not pass from one to the next in time, and leaves out layers of what moves.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "picture/warp_picture.h"

namespace wellspring::test {

class LocalDisplay {
 public:
  // Views are told relative to `origin`, in metres of the exhibit.
  explicit LocalDisplay(dvec3 origin = dvec3(0)) : origin_(origin) {}
  // Takes a binary message. False: it is no picture for such a display. Throws LoadError where it
  // is damaged.
  bool receive(std::span<const uint8_t> message);
  // The newest keyframe's own view; of width 0 before the first.
  const View& newest_view() const { return newest_.view; }
  // Black before the first keyframe.
  Image8 picture(const View& view);

 private:
  struct Shown {
    View view;
    uint32_t cuts = 0;
    Image8 color;              // any size
    std::vector<float> depth;  // the view's size; empty: there is none
    Keyframe keyframe;         // made of these; empty: not yet
  };
  void take(Shown shown, bool is_around);
  const dvec3 origin_;
  Shown newest_, before_, around_;
  WarpScratch scratch_;
};

// Draws what a page has drawn, too: FOLDER/steps.json is a list of {"packet": FILE}, a message that
// comes, and {"name": NAME, "view": {"eye", "right", "up", "forward", "tan_half_fov", "middle",
// "width", "height"}}, a view that is drawn then, as web/display/view.js has it, into
// FOLDER/NAME.png. FOLDER/NAME.rgb has the page's pixels, row after row. Returns {NAME: FLIP}
// between both. Throws LoadError, nlohmann::json::exception.
nlohmann::json draw_steps(const std::string& folder);

}  // namespace wellspring::test
