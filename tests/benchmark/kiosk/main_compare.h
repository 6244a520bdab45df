// SPDX-License-Identifier: Apache-2.0
// Parts of wellspring_kiosk_compare; each prints its results by tell().
#pragma once
#include <string>
#include <vector>

#include "tell.h"

namespace wellspring::test {

struct CompareOptions {
  std::string weights, data, kiosk;  // folders, and the kiosk's program
  bool quick = false;
};

double mean(const std::vector<double>& values);  // NAN of none

// One-euro filter and Kalman filter after the same raw poses.
void compare_filters(const CompareOptions& options);
// The landmarks of dlib's regression trees and of the kiosk's network in the same recordings.
void compare_landmarks(const CompareOptions& options);
// Measures the way from a picture given to the eye's process to its observation at the other end of
// the socket.
void measure_way(const CompareOptions& options);
// Measures the memory of the eye's process over simulated minutes.
void measure_memory(const CompareOptions& options);

}  // namespace wellspring::test
