// SPDX-License-Identifier: Apache-2.0
// What is around visitors in pictures of them: a plain room, and what they wear.
#pragma once
#include <vector>

#include "world/scene.h"

namespace wellspring::test {

// Floor, wall and a picture's frame behind whoever stands up to 4 m before the origin, along +z.
void add_room(Scene& scene);
// A bright window in that wall, lit from outside.
void add_window(Scene& scene, vec3 radiance);

// Glasses, a hat, a mask over mouth and nose, a hand held before the mouth, for an adult's head:
// metres, origin between the pupils, +y up, +z out of the face. Adds their materials to the scene.
std::vector<Mesh> make_worn(Scene& scene);

}  // namespace wellspring::test
