// SPDX-License-Identifier: Apache-2.0
// Measures how far a picture is from its reference. Sizes must agree (std::invalid_argument
// otherwise).
#pragma once
#include "frame/frame.h"

namespace wellspring::test {

// Returns the root of the mean squared difference over pixels and channels, linear radiance.
double rmse(const Frame& test, const Frame& reference);
// Returns the mean of squared difference over (reference luminance squared + 0.01): comparable
// across brightness.
double relative_mse(const Frame& test, const Frame& reference);

}  // namespace wellspring::test
