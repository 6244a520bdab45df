// SPDX-License-Identifier: Apache-2.0
// eval_bsdf eight at a time, for surfaces that most of a scene consists of: opaque, a diffuse layer
// and GGX facets over it, without coats (bsdf.h). Eight surfaces, or one against eight directions.
#pragma once
#include "base/simd3.h"
#include "light/material/bsdf.h"

namespace wellspring::light {

struct BsdfLanes {
  Lanes3 tangent, bitangent, normal, face, view;
  Lanes alpha_x, alpha_y, root_alpha;
  Lanes masked, scale;  // 1 + Smith's function of the view; what the distribution is multiplied by
  Lanes eta, metallic, dielectric_share;
  Lanes3 facet_base, facet_slope, metal, again;
  Lanes glossy;  // 1 or 0: there are facets
  Lanes coat_loss, coat_mirror, coat_fresnel, coat_scale, coated;
  Lanes loss_weight, fresnel_weight;
  const float* loss[2][lane_count];  // rows of the albedo tables, the smoother and the rougher
  const float* fresnel[2][lane_count];
};

// Whether lanes can hold it.
bool fits_lanes(const Bsdf& bsdf);
void set_lane(BsdfLanes& lanes, int lane, const Bsdf& bsdf);
BsdfLanes make_bsdf_lanes(const Bsdf& bsdf);  // in all of them

// As BsdfValue has it, but for the diffuse reflectance: that is left to multiply with.
struct BsdfLanesValue {
  Lanes diffuse;
  Lanes3 specular;
};
BsdfLanesValue eval_bsdf_lanes(const BsdfLanes& lanes, const Lanes3& direction);

}  // namespace wellspring::light
