// SPDX-License-Identifier: Apache-2.0
// An order of a pass's point lights in which neighbours do much the same to a picture: on one
// surface and near each other. Every so many-th of them then stands for all, as systematic sampling
// wants it.
#pragma once
#include <cstdint>
#include <vector>

#include "light/instant/instant_pass.h"

namespace wellspring::light {

// Numbers of all lights of `pass` that are not exact: those from infinity, those without a side and
// those that face each of six ways apart from each other, and each of these along the curve of
// Morton (1966) through the box around them.
std::vector<uint32_t> order_lights(const InstantPass& pass);

}  // namespace wellspring::light
