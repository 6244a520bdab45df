// SPDX-License-Identifier: Apache-2.0
// Proposes the axis of a nebula from its picture (Wenger and others, section 3): the angle by
// principal components, the tilt from a bright ellipse that is taken for a circle.
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "image/image.h"

namespace wellspring::volume {

// Says how an axis lies in a picture. Places are in pixels from the upper left corner, y downwards.
struct PictureAxis {
  glm::dvec2 centre{0};
  double angle = 0;  // radians from the picture's right, counter-clockwise as it is seen

  // Returns how far along the axis a place lies, and how far beside it.
  glm::dvec2 along_and_beside(glm::dvec2 place) const;
};

// Returns the longest axis of the light through its centre, with an angle of more than -90 and at
// most 90 degrees. Light that is as long as wide has angle 0, as has none, whose centre is the
// picture's.
PictureAxis propose_axis(const image::LinearImage& picture);

// Returns the tilt out of the picture, in radians, at which the flattest of the picture's bright
// shapes would be a circle round the axis; none if that is more than 49 degrees, where a ball looks
// nearly the same. It is positive, but the other sign fits as well: forward and backward tilts give
// the same picture.
std::optional<double> propose_tilt(const image::LinearImage& picture, const PictureAxis& axis);

// Returns half the length along the axis and half the width beside it that hold `part` of the
// light, in pixels, 0.5 at least each.
glm::dvec2 light_extent(const image::LinearImage& picture, const PictureAxis& axis, double part);

}  // namespace wellspring::volume
