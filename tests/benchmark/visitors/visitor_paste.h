// SPDX-License-Identifier: Apache-2.0
// What is laid into finished pictures of visitors: portraits, stripes that move behind people, a
// camera that hangs upside down.
#pragma once
#include "visitor_stage.h"

namespace wellspring::test {

// Holds an area in pixels.
struct PictureArea {
  int x = 0, y = 0, width = 0, height = 0;
};

// Pastes the `part` of `from`, stretched over `to`, with a frame; behind visitors or over them.
void paste_portrait(const Image8& from, const PictureArea& part, const PictureArea& to,
                    bool behind_visitors, VisitorPicture& picture);
// Stripes as of an escalator's steps, `phase` periods on their way, behind visitors.
void paste_stripes(const PictureArea& to, float phase, VisitorPicture& picture);
void turn_upside_down(VisitorPicture& picture);

}  // namespace wellspring::test
