// SPDX-License-Identifier: Apache-2.0
// Reads and writes recordings of movements and trained models as JSON files.
//
// A recording is one file for one movement:
//   {"label": "3", "variant": "", "places": [[0.00, 0.31, 0.52], [0.05, 0.32, 0.51], ...]}
// `places` are time (seconds, growing), x and y in shoulder widths from the middle of the face: x
// to the right as the visitor sees the screen, y down. A recording begins and ends with the
// gesture, or with the rest after it if that belongs to the gesture. Without `label` it is any
// other motion, of any length. `variant` names one of several orders of strokes.
#pragma once
#include <string>
#include <vector>

#include "kiosk/gesture/gesture_model.h"

namespace wellspring::kiosk {

inline constexpr size_t most_label = 32;  // bytes

// Loads every .json file below `folder`, in the order of their names. Throws LoadError for the
// first file that is wrong, with the place in it, and for a folder without any.
std::vector<HandPath> load_recordings(const std::string& folder);

// Loads models. Throws LoadError.
GestureModels load_gesture_models(const std::string& file);
// Saves models. Throws LoadError when the file cannot be written.
void save_gesture_models(const GestureModels& models, const std::string& file);

}  // namespace wellspring::kiosk
