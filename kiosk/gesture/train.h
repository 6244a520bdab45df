// SPDX-License-Identifier: Apache-2.0
// From recorded movements to models of gestures (Elmezain et al. 2009, sections 3.1 and 3.2).
#pragma once
#include <span>

#include "kiosk/gesture/gesture_model.h"
#include "kiosk/gesture/non_gesture.h"

namespace wellspring::kiosk {

// Trains a model for each label and variant by Baum-Welch, with one state for each straight piece
// of the motion, 3 to 5. `paths` hold one gesture each, or without a label any other motion: the
// latter tells how clear a gesture must be. Gestures with fewer than three paths of five steps are
// left out.
GestureModels train_gestures(std::span<const HandPath> paths,
                             const NonGestureSettings& settings = {});

}  // namespace wellspring::kiosk
