// SPDX-License-Identifier: Apache-2.0
// Light for pixels of which no cell beside them knows the surface: that of cells farther around
// which show the same object. What they count for ends nowhere at once, so that where few points
// tell, light has no border where the surface has none.
#pragma once
#include "picture/cells.h"
#include "picture/pixel_light.h"

namespace wellspring {

// Where eight pixels lie among the cells, one of which lies around each whole number. The columns
// of all lie within two.
struct CellPlaces {
  Lanes x;
  float y = 0;
};

enum class LightOf : uint8_t { same_object, any_object };

// Adds the light and reflectances of the cells around to `sum`, for the lanes `asked`, and returns
// their weight there: less the farther off they are and the more they are turned away, 0 where
// there is none. Cells without a reflectance, which tell of no light that falls there, count for
// such pixels of the same object alone. Reads the pixels' objects and normals.
Lanes add_object_light(const Cells& cells, const CellPlaces& at, const Pixels& pixels,
                       const LaneMask& asked, const LaneMask& mirrors, LightOf of,
                       Surroundings& sum);

// Reflectances below that are those of mirrors, lamps and the sky.
inline constexpr float no_reflectance = 0.01f;
// Light of lamps over smooth light, of which more is a lamp seen.
inline constexpr float most_rest = 4;

}  // namespace wellspring
