// SPDX-License-Identifier: Apache-2.0
// Makes a volume of light of one picture of a planetary nebula (Wenger and others, "Algebraic 3D
// Reconstruction of Planetary Nebulae"). The three channels are three filters of the telescope.
#pragma once
#include <optional>
#include <string>

#include "image/image.h"
#include "volume/nebula/axis.h"
#include "volume/nebula/cubes.h"
#include "volume/nebula/solve.h"
#include "volume/nebula/stars.h"

namespace wellspring::volume {

struct NebulaSettings {
  // The axis's angle from the picture's right, counter-clockwise, and its tilt out of the picture:
  // positive if the end that the angle points to leans to the visitor. None: proposed. A picture
  // tells forward from backward tilts in no way; those that are proposed lean forward.
  std::optional<double> angle_degrees, tilt_degrees;
  glm::ivec2 rings{60, 120};  // along the radius, and along the axis
  SolveSettings solve{RingSolver::fista, 40, 20, 1e-3};
  bool remove_stars = true;
  StarSettings stars;
  double light_inside = 0.998;  // part of the light that the rings shall reach
  int most_side = 256;          // the volume's: larger pictures are shrunk by a whole number
  int most_rays = 40000;        // likewise for the solver
  CubeSettings cubes;
};

// Tells what was found, and how well.
struct NebulaReport {
  int stars = 0, star_pixels = 0;
  vec3 sky{0};  // light of the sky that was taken off
  double angle_degrees = 0, tilt_degrees = 0;
  bool angle_proposed = false, tilt_proposed = false;
  image::ImagePart crop;  // the part that was taken, in pixels of the shrunk picture
  int shrunk = 1;         // by how much the file's picture was shrunk before
  int rays = 0, rings = 0;
  size_t entries = 0;                // lengths in the matrix
  std::vector<glm::dvec3> residual;  // as SolveResult has it
  CubeReport cubes;
  double prepare_seconds = 0, system_seconds = 0, solve_seconds = 0, cubes_seconds = 0;
};

// Holds what stays the same whatever the tilt: the clean picture around the nebula, its axis, and
// the rays.
struct NebulaPicture {
  image::LinearImage picture;  // a value is what a pixel's ray gathers
  PictureAxis axis;
  glm::dvec2 extent{1};  // half the length along the axis and half the width beside it, in pixels
  std::vector<glm::dvec2> rays;         // along and beside the axis
  std::vector<ColorLanes> gathered;     // by each ray
  std::optional<double> proposed_tilt;  // radians
};

// Cleans the picture, finds the axis and cuts the nebula out. Sides are 1 pixel and more. Throws
// LoadError for settings that make no sense.
NebulaPicture prepare_nebula(const image::LinearImage& picture, const NebulaSettings& settings,
                             NebulaReport& report);

// Solves for the rings' light at a tilt in radians. `before`: the rings of another tilt, to begin
// with, or null: a slider's next answer then needs fewer iterations.
RingMap solve_nebula(const NebulaPicture& nebula, double tilt, const NebulaSettings& settings,
                     NebulaReport& report, const RingMap* before = nullptr);

// Makes the volume of a picture of linear light.
Volume make_nebula(const image::LinearImage& picture, const NebulaSettings& settings,
                   NebulaReport& report);

// Reads a picture (PNG, JPEG or WebP) as linear light. Throws LoadError.
image::LinearImage load_nebula_picture(const std::string& file);

}  // namespace wellspring::volume
