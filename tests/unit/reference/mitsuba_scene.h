// SPDX-License-Identifier: Apache-2.0
// Reads Mitsuba 3 scenes as ours, for tests against its reference pictures. Materials that our
// model expresses exactly are converted; a shape of any other material keeps its geometry, so that
// its shadows fall right, and is named in `inexact`: the pixels that see it are not judged. A scene
// whose lights we do not have is refused with a reason.
//   exact: diffuse (with textures and mesh attributes), twosided and masked diffuse, blends of
//     diffuse, smooth dielectrics; area, point, constant, envmap and directional emitters; box and
//     Gaussian pixel filters
//   not: conductors (complex Fresnel; ours is Schlick's), plastic (its coupling of coat and diffuse
//     layer is another), rough dielectrics (Beckmann, or GGX with shadowing apart from masking and
//     without what scatters twice), normal maps (theirs darkens near the horizon, Estevez et al.
//     2019; ours turns the normal), bump maps, spots (linear in the angle, ours a smooth function
//     of the cosine; and textured), projectors
#pragma once
#include <map>

#include "mitsuba_xml.h"
#include "world/scene.h"
#include "world/view.h"

namespace wellspring::mitsuba {

struct ReferenceScene {
  Scene scene;
  View view;
  bool gaussian_filter = false;             // else box; standard deviation 0.5, cut off at 2 pixels
  int max_depth = 2;                        // edges from the eye
  std::map<uint32_t, std::string> inexact;  // instance: why
};

// Throws LoadError, also for what cannot be expressed ("cannot be expressed: ...").
ReferenceScene load_reference_scene(const std::filesystem::path& file);

// A spectrum given as "wavelength:value, ..." as linear Rec. 709 (CIE 1931, 2 degrees), 0 outside.
vec3 spectrum_to_rgb(const std::string& list);

}  // namespace wellspring::mitsuba
