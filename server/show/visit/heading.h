// SPDX-License-Identifier: Apache-2.0
// Where a visitor is heading: what its view has done in the last moments, and where that leads by
// when a picture that is drawn now is seen.
#pragma once
#include <vector>

#include "world/view.h"

namespace wellspring::show {

struct Heading {
  struct PastView {
    double time = 0;
    View view;
  };
  std::vector<PastView>
      past;  // of the last twentieth of a second, at most 32; at least the last one before
};

// The view at a later `time`. True: it has leapt to another place, so that nothing of before helps.
bool note_view(Heading& heading, double time, const View& view);

// Where the view is to be expected `seconds` after it was last noted, as `now`: straight on, and
// round the same axis. Keys start and stop at once, so that motion is measured over as short a time
// as inputs allow, which come in steps of their own; to expect less of motion the younger it is
// gains nothing more (cache.turns.unknown).
View expected_view(const Heading& heading, const View& now, double seconds);
// By how many radians the view may turn away from there in `seconds` more or less.
float expected_turn(const Heading& heading, const View& now, double seconds);

struct EyeMotion {
  float speed = 0, turn = 0;  // metres and radians a second
};
EyeMotion motion_of(const Heading& heading, const View& now);

// Returns a view of all that a visitor may turn to within a moment, in an eighth of the pixels.
View wide_view(const View& now);
// The visitor has moved away from what such a view shows well.
bool is_elsewhere(const View& wide, const View& now);

}  // namespace wellspring::show
