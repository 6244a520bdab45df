// SPDX-License-Identifier: Apache-2.0
// Lights the blades of lawns in a picture: by what falls on the ground around, the more the nearer
// to the tips, and through blades from behind; by lights that move; less where something that moves
// keeps light away (light/kept/moving_shade.h).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "lawn/draw_lawn.h"
#include "light/kept/moving_shade.h"
#include "light/virtual/dynamic_image.h"
#include "picture/lit_blocks.h"
#include "world/view.h"

namespace wellspring::picture {

// Holds light on a lawn at the nodes of a grid over its rectangle, all as irradiance over pi.
struct LawnLight {
  struct Node {
    vec3 around{0};                  // on level ground, of all light but the lamp's
    vec3 lamp{0};                    // light of the brightest lamp, on what faces it
    vec3 to_lamp{0, 1, 0};           // unit
    bool known = false;              // something grows near
    float lamp_distance = INFINITY;  // metres
  };
  ivec2 size{0};           // columns to +x, rows to +z
  std::vector<Node> node;  // row by row, in the middles of the grid's cells
};

// Borrows a lawn as it stands at the moment.
struct ShownLawn {
  const Lawn* lawn = nullptr;
  const LawnState* state = nullptr;
  Wind wind;
  std::shared_ptr<const LawnLight> light;  // null: the lawn is not shown
  Bounds bounds;                           // around all its blades
  uint64_t moment = 0;                     // differs when blades have moved
  uint32_t object = 0;
};

// Borrows the world around lawns. Null world: it is empty.
struct GrassWorld {
  const World* world = nullptr;
  const Lights* lights = nullptr;
  const DynamicImage* dynamic = nullptr;  // lights that move, as ScanView has them; null: none
};

// Keeps the memory that is needed while a picture is lit.
struct GrassLightWork {
  LitBlocks blocks;
  SurfaceBuffer surfaces;
  SplatPicture bounce;
  LightPlanes light;
  size_t memory_bytes() const;
};

// Turns the colours of a lawn's picture, which shows `window` of the view, into radiance.
void light_grass(const ShownLawn& shown, const GrassWorld& world, const MovingShade& shade,
                 const View& view, vec2 offset, const PictureWindow& window, GrassLightWork& work,
                 LawnPicture& picture);

}  // namespace wellspring::picture
