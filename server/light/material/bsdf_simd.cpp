// SPDX-License-Identifier: Apache-2.0
#include "light/material/bsdf_simd.h"

#include "light/material/bsdf_gloss.h"
#include "light/material/microfacet.h"

namespace wellspring::light {
namespace {

constexpr float no_row[AlbedoTable::angles] = {};

Lanes dot3(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void set3(Lanes3& lanes, int i, vec3 v) { lanes.x[i] = v.x, lanes.y[i] = v.y, lanes.z[i] = v.z; }

// eval_row, each lane in rows of its own. `position` in [0, 1].
Lanes eval_rows(const float* const (&rows)[2][lane_count], Lanes weight, Lanes position) {
  position *= AlbedoTable::angles - 1;
  LaneMask at = __builtin_convertvector(position, LaneMask);
  at = at < AlbedoTable::angles - 2 ? at : LaneMask{} + (AlbedoTable::angles - 2);
  Lanes along = position - __builtin_convertvector(at, Lanes);
  Lanes low0, low1, high0, high1;
  for (int i = 0; i < lane_count; i++) {
    low0[i] = rows[0][i][at[i]], low1[i] = rows[0][i][at[i] + 1];
    high0[i] = rows[1][i][at[i]], high1[i] = rows[1][i][at[i] + 1];
  }
  Lanes low = low0 + (low1 - low0) * along, high = high0 + (high1 - high0) * along;
  return low + (high - low) * weight;
}

Lanes fresnel_lanes(Lanes cosine, Lanes eta) {
  Lanes sin2 = (1 - cosine * cosine) / (eta * eta);
  Lanes beyond = lanes_sqrt(lanes_max(1 - sin2, all_lanes(0)));
  Lanes parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  Lanes perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
  Lanes f = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return sin2 >= 1 ? all_lanes(1) : f;
}

}  // namespace

bool fits_lanes(const Bsdf& b) {
  bool facets = has_gloss(b);
  return max_component(b.transmit) == 0 && b.beneath == 1 && !b.spread && (!facets || b.alpha > 0);
}

void set_lane(BsdfLanes& lanes, int i, const Bsdf& b) {
  bool facets = has_gloss(b);
  set3(lanes.tangent, i, b.tangent);
  set3(lanes.bitangent, i, b.bitangent);
  set3(lanes.normal, i, b.normal);
  set3(lanes.face, i, b.geometric_normal);
  set3(lanes.view, i, b.view);
  lanes.alpha_x[i] = b.alphas.x;
  lanes.alpha_y[i] = b.alphas.y;
  lanes.root_alpha[i] = b.root_alpha;
  lanes.masked[i] = 1 + ggx_lambda(b.view, b.alphas);
  lanes.scale[i] = 1 / (4 * pi * b.alphas.x * b.alphas.y * b.view.z);
  lanes.eta[i] = b.eta;
  lanes.metallic[i] = b.metallic;
  lanes.dielectric_share[i] = b.dielectric_share;
  set3(lanes.facet_base, i, b.facet_base);
  set3(lanes.facet_slope, i, b.facet_slope);
  set3(lanes.metal, i, b.metal);
  set3(lanes.again, i, facets && b.again_share > 0 ? b.again : vec3(0));
  lanes.glossy[i] = facets ? 1 : 0;
  lanes.coated[i] = b.has_coat ? 1 : 0;
  lanes.coat_loss[i] = b.coat_loss;
  lanes.coat_mirror[i] = b.coat_mirror;
  lanes.coat_fresnel[i] = b.coat_fresnel;
  lanes.coat_scale[i] = b.coat_passes * b.coat_scale;
  lanes.loss_weight[i] = b.loss.weight;
  lanes.fresnel_weight[i] = b.fresnel.weight;
  lanes.loss[0][i] = b.loss.low ? b.loss.low : no_row;
  lanes.loss[1][i] = b.loss.low ? b.loss.high : no_row;
  lanes.fresnel[0][i] = b.fresnel.low ? b.fresnel.low : no_row;
  lanes.fresnel[1][i] = b.fresnel.low ? b.fresnel.high : no_row;
}

BsdfLanes make_bsdf_lanes(const Bsdf& bsdf) {
  BsdfLanes lanes;
  for (int i = 0; i < lane_count; i++) set_lane(lanes, i, bsdf);
  return lanes;
}

BsdfLanesValue eval_bsdf_lanes(const BsdfLanes& b, const Lanes3& direction) {
  const Lanes none = all_lanes(0), one = all_lanes(1);
  Lanes3 l{dot3(direction, b.tangent), dot3(direction, b.bitangent), dot3(direction, b.normal)};
  LaneMask lit = (dot3(direction, b.face) > 0) & (l.z > 1e-6f);
  Lanes cosine = lit ? lanes_min(l.z, one) : one;
  // How much one meeting with a facet keeps back, of light along l.
  Lanes root = lanes_sqrt(cosine);
  Lanes loss =
      lanes_max(eval_rows(b.loss, b.loss_weight, root / (root + b.root_alpha)), all_lanes(1e-7f));
  Lanes once = b.coat_mirror + b.coat_fresnel * eval_rows(b.fresnel, b.fresnel_weight, root);
  Lanes coat = lanes_min(b.coat_loss * loss + (1 - loss) * once, one);
  Lanes passes = b.coated > 0 ? b.coat_scale * (1 - coat) : one;
  BsdfLanesValue value;
  value.diffuse = lit ? cosine * passes * (1 / pi) : none;

  Lanes3 h{b.view.x + l.x, b.view.y + l.y, b.view.z + cosine};
  Lanes inverse = 1 / lanes_sqrt(lanes_max(dot3(h, h), all_lanes(1e-30f)));
  h = {h.x * inverse, h.y * inverse, h.z * inverse};
  Lanes facet = lanes_min(dot3(b.view, h), one);
  Lanes f = fresnel_lanes(facet, b.eta);
  Lanes x = h.x / b.alpha_x, y = h.y / b.alpha_y, d = x * x + y * y + h.z * h.z;
  x = l.x * b.alpha_x, y = l.y * b.alpha_y;
  Lanes lambda = 0.5f * (lanes_sqrt(1 + (x * x + y * y) / (cosine * cosine)) - 1);
  Lanes facets = b.scale / (d * d * (b.masked + lambda));
  facets = (lit & (b.glossy > 0)) ? facets : none;
  Lanes more = lit ? cosine * loss : none;
  Lanes m = 1 - lanes_max(facet, none), m2 = m * m, schlick = m2 * m2 * m;
  auto channel = [&](Lanes base, Lanes slope, Lanes metal, Lanes again) {
    Lanes dielectric = f < 1 ? lanes_max(base + slope * f, none) : one;
    Lanes reflect = b.dielectric_share * dielectric + b.metallic * (metal + (1 - metal) * schlick);
    return reflect * facets + again * more;
  };
  value.specular = {channel(b.facet_base.x, b.facet_slope.x, b.metal.x, b.again.x),
                    channel(b.facet_base.y, b.facet_slope.y, b.metal.y, b.again.y),
                    channel(b.facet_base.z, b.facet_slope.z, b.metal.z, b.again.z)};
  return value;
}

}  // namespace wellspring::light
