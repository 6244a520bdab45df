// SPDX-License-Identifier: Apache-2.0
// Small geometry of node trees.
#pragma once
#include "gltf/pose.h"

namespace wellspring::avatar {

std::vector<size_t> gltf_parents_first(const std::vector<gltf::Node>& nodes);
// The turn in a matrix that may also scale; a mirrored one loses its mirroring.
glm::dquat gltf_rotation(const dmat4& matrix);
// The one of the 24 turns of a cube that is most like this one.
glm::dquat nearest_right_turn(glm::dquat turn);

}  // namespace wellspring::avatar
