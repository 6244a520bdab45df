// SPDX-License-Identifier: Apache-2.0
#include "light/material/bsdf.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_gloss.h"
#include "light/material/bsdf_types.h"
#include "light/material/microfacet.h"
#include "light/material/wavelengths.h"

namespace wellspring::light {
namespace {

// Sets the roughness. KHR_materials_anisotropy: rougher along the tangent by the square of its
// strength.
void set_roughness(Bsdf& b, const Surface& surface) {
  b.alpha = alpha_of(surface.roughness);
  b.alphas = vec2(b.alpha);
  float strength = clean(surface.anisotropy);
  if (strength > 0) {
    float along = glm::mix(b.alpha, 1.0f, strength * strength);
    if (along >= 1.02f * std::max(b.alpha, smooth_alpha) &&
        make_frame_along(b.normal, surface.tangent, b.tangent, b.bitangent)) {
      b.alphas = {along, std::max(b.alpha, smooth_alpha)};
      b.alpha = std::sqrt(b.alphas.x * b.alphas.y);
      return;
    }
  }
  make_frame_axes(b.normal, b.tangent, b.bitangent);
}

}  // namespace

float refractive_index(const Material& material) {
  if (material.ior == 0) return 1e6f;
  return material.ior > 1 ? std::min(material.ior, 1e6f) : 1.0f;
}

Bsdf make_bsdf(const Surface& surface, const Material& material, vec3 direction,
               const DielectricAlbedo& albedo, float index, float outside) {
  Bsdf b;
  vec3 v = -direction;
  b.geometric_normal = surface.geometric_normal;
  b.normal = usable_normal(surface.normal, surface.geometric_normal, v);
  set_roughness(b, surface);
  b.view = to_local(b, v);
  b.view.z = glm::clamp(b.view.z, 1e-4f, 1.0f);
  b.metallic = clean(surface.metallic);
  vec3 base = clean(surface.base_color);
  float transmission = clean(surface.transmission);
  if (!(index > 0)) index = refractive_index(material);
  index /= outside;
  b.thin = !(material.thickness > 0);
  b.within = !b.thin && !surface.front && transmission > 0;
  b.eta = b.within ? 1 / index : index;
  b.diffuse = base * ((1 - b.metallic) * (1 - transmission));
  b.transmit = base * ((1 - b.metallic) * transmission);
  if (!b.thin && std::abs(b.eta - 1) < 2e-3f && max_component(b.transmit) > 0) {
    // Facets between equal indices bend nothing: however rough, light goes straight on.
    if (b.metallic == 0) b.alpha = 0;
    else b.eta = b.eta < 1 ? 0.998f : 1.002f;
  }
  if (b.metallic > 0) b.metal = base;
  set_gloss(b, albedo, transmission, clean(surface.specular), clean(surface.specular_color, 1e9f));
  if (surface.clearcoat > 0 || max_component(surface.sheen_color) > 0) set_layers(b, surface, v);

  float diffuse = luminance(b.diffuse) * b.coat_passes * b.beneath;
  float specular = luminance(b.transmit) + (1 - b.metallic) * (1 - b.coat_passes) +
                   b.metallic * luminance(fresnel_schlick(b.metal, b.view.z));
  specular = glm::mix(1.0f, specular, b.beneath);
  if (diffuse <= 0) b.diffuse_share = 0;
  else if (specular <= 1e-4f && !has_specular(b)) b.diffuse_share = 1;
  else b.diffuse_share = glm::clamp(diffuse / (diffuse + specular), 0.1f, 0.9f);
  return b;
}

bool has_diffuse(const Bsdf& b) { return max_component(b.diffuse) > 0; }

bool has_specular(const Bsdf& b) { return has_gloss(b) || b.beneath < 1; }

bool is_smooth(const Bsdf& b) {
  return !has_diffuse(b) && b.alpha == 0 &&
         (b.beneath == 1 || (!has_sheen(b) && b.clearcoat.alpha == 0));
}

bool is_clear_solid(const Bsdf& b) {
  return !b.thin && max_component(b.transmit) > 0 && is_smooth(b);
}

namespace {

// Evaluates as if no colours were spread here.
BsdfValue eval_lobes(const Bsdf& b, vec3 direction) {
  BsdfValue value;
  vec3 l = to_local(b, direction);
  float side = dot(direction, b.geometric_normal);
  if (side > 0) {
    if (l.z > 1e-6f) {
      l.z = std::min(l.z, 1.0f);
      value.diffuse_pdf = l.z / pi;
      if (has_diffuse(b)) {
        float passes = b.has_coat ? b.coat_passes * (1 - eval_coat(b, l.z)) * b.coat_scale : 1;
        value.diffuse = b.diffuse * (value.diffuse_pdf * b.beneath * passes);
      }
      if (b.alpha > 0 && has_gloss(b)) eval_gloss(b, l, value.specular, value.specular_pdf);
    }
  } else if (l.z < -1e-6f && side < 0 && b.alpha > 0 && max_component(b.transmit) > 0) {
    eval_gloss(b, l, value.specular, value.specular_pdf);
  }
  if (b.beneath < 1) {
    value.specular *= b.beneath;
    value.specular_pdf *= gloss_share(b);
    if (side > 0) eval_layers(b, direction, value.specular, value.specular_pdf);
  }
  return value;
}

}  // namespace

BsdfValue eval_bsdf(const Bsdf& b, vec3 direction) {
  BsdfValue value = eval_lobes(b, direction);
  if (b.spread && b.spread->made > 0) {
    BsdfValue others[wavelength_count - 1];
    for (int i = 1; i <= b.spread->made; i++)
      others[i - 1] = eval_lobes(b.spread->others[i - 1], direction);
    blend_wavelengths(*b.spread, others, value);
  }
  return value;
}

float sample_bsdf_pdf(const Bsdf& b, const BsdfValue& value, Lobes lobes) {
  if (lobes == Lobes::diffuse) return value.diffuse_pdf;
  if (lobes == Lobes::specular) return value.specular_pdf;
  return glm::mix(value.specular_pdf, value.diffuse_pdf, b.diffuse_share);
}

BsdfSample sample_bsdf(const Bsdf& b, Lobes lobes, Sampler& sampler) {
  float share = lobes == Lobes::all ? b.diffuse_share : lobes == Lobes::diffuse ? 1.0f : 0.0f;
  BsdfSample s;
  // If there is nothing to choose, the number's place in the sequence is left out.
  bool choice = share < 1 && (share > 0 || b.beneath < 1);
  float u = choice ? sampler.next() : (sampler.seek(sampler.drawn + 1), 0.0f);
  if (u < share) {
    s.direction = to_world(b, sample_cosine_hemisphere(sampler.next2()));
  } else if (!has_specular(b)) {
    return {};
  } else {
    float chance = 1 - share;
    u = (u - share) / chance;  // uniform again
    float coat = b.beneath < 1 ? clearcoat_share(b) : 0, sheen = b.beneath < 1 ? sheen_share(b) : 0;
    if (u < coat) {
      if (b.clearcoat.alpha == 0) {
        s = eval_clearcoat_mirror(b);
        s.weight /= chance * coat;
        return s;
      }
      s.direction = sample_clearcoat(b, sampler);
    } else if (u < coat + sheen) {
      s.direction = sample_sheen(b, sampler);
    } else if (b.alpha == 0) {
      s = sample_smooth_gloss(b, sampler.next());
      s.weight *= b.beneath / (chance * gloss_share(b));
      return s;
    } else {
      vec3 l = sample_gloss(b, sampler);
      if (l == vec3(0)) return {};
      s.direction = to_world(b, l);
    }
    if (s.direction == vec3(0)) return {};
  }
  BsdfValue value = eval_lobes(b, s.direction);
  s.pdf = sample_bsdf_pdf(b, value, lobes);
  vec3 sum = (lobes != Lobes::specular ? value.diffuse : vec3(0)) +
             (lobes != Lobes::diffuse ? value.specular : vec3(0));
  if (!(s.pdf > 0)) return {};
  s.weight = sum / s.pdf;
  if (dot(s.direction, b.geometric_normal) < 0) {
    s.bounce = b.thin ? Bounce::reflect : Bounce::refract;
    s.glass = !b.thin;
  }
  return s;
}

BsdfSample eval_mirror(const Bsdf& b) {
  BsdfSample s;
  s.direction = to_world(b, {-b.view.x, -b.view.y, b.view.z});
  if (dot(s.direction, b.geometric_normal) > 0) s.weight = facet_color(b, b.view.z).reflect;
  return s;
}

bool is_pane(const Surface& surface, const Material& material) {
  bool plain = !(surface.anisotropy > 0) && !(surface.clearcoat > 0) &&
               !(max_component(surface.sheen_color) > 0);
  return !(material.thickness > 0) && surface.transmission > 0 && surface.metallic < 1 &&
         alpha_of(surface.roughness) == 0 && plain;
}

vec3 pane_transmittance(const Surface& surface, const Material& material, vec3 direction) {
  Bsdf b;
  vec3 v = -direction;
  vec3 normal = usable_normal(surface.normal, surface.geometric_normal, v);
  b.metallic = clean(surface.metallic);
  b.transmit = clean(surface.base_color) * ((1 - b.metallic) * clean(surface.transmission));
  b.eta = refractive_index(material);
  set_facets(b, clean(surface.specular), clean(surface.specular_color, 1e9f));
  return facet_color(b, glm::clamp(dot(v, normal), 1e-4f, 1.0f)).transmit;
}

namespace {

constexpr float no_row[AlbedoTable::angles] = {};

// Does eval_row, each lane in rows of its own. `position` in [0, 1].
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
  lanes.tangent.set(i, b.tangent);
  lanes.bitangent.set(i, b.bitangent);
  lanes.normal.set(i, b.normal);
  lanes.face.set(i, b.geometric_normal);
  lanes.view.set(i, b.view);
  lanes.alpha_x[i] = b.alphas.x;
  lanes.alpha_y[i] = b.alphas.y;
  lanes.root_alpha[i] = b.root_alpha;
  lanes.masked[i] = 1 + ggx_lambda(b.view, b.alphas);
  lanes.scale[i] = 1 / (4 * pi * b.alphas.x * b.alphas.y * b.view.z);
  lanes.eta[i] = b.eta;
  lanes.metallic[i] = b.metallic;
  lanes.dielectric_share[i] = b.dielectric_share;
  lanes.facet_base.set(i, b.facet_base);
  lanes.facet_slope.set(i, b.facet_slope);
  lanes.metal.set(i, b.metal);
  lanes.again.set(i, facets && b.again_share > 0 ? b.again : vec3(0));
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
  Lanes3 l{dot(direction, b.tangent), dot(direction, b.bitangent), dot(direction, b.normal)};
  LaneMask lit = (dot(direction, b.face) > 0) & (l.z > 1e-6f);
  Lanes cosine = lit ? lanes_min(l.z, one) : one;
  // The loss is the share that one meeting with a facet keeps back, of light along l.
  Lanes root = lanes_sqrt(cosine);
  Lanes loss =
      lanes_max(eval_rows(b.loss, b.loss_weight, root / (root + b.root_alpha)), all_lanes(1e-7f));
  Lanes once = b.coat_mirror + b.coat_fresnel * eval_rows(b.fresnel, b.fresnel_weight, root);
  Lanes coat = lanes_min(b.coat_loss * loss + (1 - loss) * once, one);
  Lanes passes = b.coated > 0 ? b.coat_scale * (1 - coat) : one;
  BsdfLanesValue value;
  value.diffuse = lit ? cosine * passes * (1 / pi) : none;

  Lanes3 h{b.view.x + l.x, b.view.y + l.y, b.view.z + cosine};
  Lanes inverse = 1 / lanes_sqrt(lanes_max(dot(h, h), all_lanes(1e-30f)));
  h = {h.x * inverse, h.y * inverse, h.z * inverse};
  Lanes facet = lanes_min(dot(b.view, h), one);
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
