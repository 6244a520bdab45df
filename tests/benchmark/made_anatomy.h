// SPDX-License-Identifier: Apache-2.0
// A made volume of colours that is like photographed slices of a body (a cryosection).
#pragma once
#include <cstdint>

#include "volume/volume.h"

namespace wellspring::test {

// Returns a piece of a trunk with two long bones, on black: skin, fat in lobes, muscles of fibres,
// bones with marrow of fine beams, organs, vessels down to two voxels across. Lengths are in
// voxels, so a larger volume shows more of a body, not the same finer. Each sample has noise of a
// standard deviation of `noise` display codes, as a camera's.
Volume made_anatomy(glm::ivec3 size, float noise, uint64_t seed);

}  // namespace wellspring::test
