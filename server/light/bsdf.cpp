// SPDX-License-Identifier: Apache-2.0
#include "light/bsdf.h"

#include <algorithm>
#include <cmath>

#include "light/microfacet.h"
#include "light/warp.h"

namespace wellspring {
namespace {

float alpha_of(float roughness) {
  float r = roughness > 0 ? std::min(roughness, 1.0f) : 0.0f;  // NaN is smooth
  return r * r < smooth_alpha ? 0 : r * r;
}

// glTF: 0 means an infinite index, a surface that reflects everything (KHR_materials_ior).
float index_of(const Material& material) {
  if (material.ior == 0) return 1e6f;
  return material.ior > 1 ? std::min(material.ior, 1e6f) : 1.0f;
}

vec3 unit_range(vec3 c) { return glm::clamp(c, vec3(0), vec3(1)); }

// A mapped or interpolated normal may face away from the viewer or mirror him into the surface;
// then it is turned just far enough that its reflection leaves the surface.
vec3 usable_normal(vec3 n, vec3 geometric, vec3 v) {
  float least = std::min(0.01f, 0.9f * dot(v, geometric));
  vec3 mirrored = 2 * dot(v, n) * n - v;
  float height = dot(mirrored, geometric);
  if (dot(n, v) > 0 && height >= least) return n;
  mirrored = dot(n, v) > 0 ? mirrored + geometric * (least - height) : geometric;
  vec3 between = normalize(mirrored) + v;
  float length2 = dot(between, between);
  return length2 > 1e-12f ? between / std::sqrt(length2) : geometric;
}

vec3 to_local(const Bsdf& b, vec3 w) {
  return {dot(w, b.tangent), dot(w, b.bitangent), dot(w, b.normal)};
}
vec3 to_world(const Bsdf& b, vec3 w) {
  return b.tangent * w.x + b.bitangent * w.y + b.normal * w.z;
}

// Reflected and transmitted colour at a facet seen under this cosine.
struct FacetColor {
  vec3 reflect, transmit;
  float reflect_share;  // probability that sampling reflects
};
FacetColor facet_color(const Bsdf& b, float cosine) {
  float f = fresnel_dielectric(std::min(cosine, 1.0f), b.eta);
  FacetColor c;
  c.reflect = vec3((1 - b.metallic) * b.gloss_gain * f);
  if (b.metallic > 0) c.reflect += b.metallic * fresnel_schlick(b.metal, cosine) * b.metal_gain;
  c.transmit = (1 - f) * b.transmit;
  float r = max_component(c.reflect), t = max_component(c.transmit);
  c.reflect_share = r + t > 0 ? r / (r + t) : 1;
  return c;
}

void eval_reflection(const Bsdf& b, vec3 l, BsdfValue& value) {
  vec3 h = normalize(b.view + l);
  float cosine = dot(b.view, h);
  FacetColor color = facet_color(b, cosine);
  float d = ggx_distribution(h, b.alpha);
  value.specular = color.reflect * (d * ggx_shadowing(b.view, l, b.alpha) / (4 * b.view.z));
  value.specular_pdf = color.reflect_share * ggx_masking(b.view, b.alpha) * d / (4 * b.view.z);
}

void eval_thin_transmission(const Bsdf& b, vec3 l, BsdfValue& value) {
  vec3 mirrored(l.x, l.y, -l.z);
  vec3 h = normalize(b.view + mirrored);
  FacetColor color = facet_color(b, dot(b.view, h));
  float d = ggx_distribution(h, b.alpha);
  value.specular = color.transmit * (d * ggx_shadowing(b.view, mirrored, b.alpha) / (4 * b.view.z));
  value.specular_pdf =
      (1 - color.reflect_share) * ggx_masking(b.view, b.alpha) * d / (4 * b.view.z);
}

// Walter et al. 2007, equation 21, for radiance: beyond the boundary it is eta^2 times denser.
void eval_refraction(const Bsdf& b, vec3 l, BsdfValue& value) {
  vec3 h = b.view + b.eta * l;
  float length2 = dot(h, h);
  if (length2 < 1e-12f) return;  // index 1, straight on: no facet is told from any other
  h /= std::sqrt(length2);
  if (h.z < 0) h = -h;
  float cv = dot(b.view, h), cl = dot(l, h);
  if (cv <= 0 || cl >= 0) return;
  FacetColor color = facet_color(b, cv);
  float denominator = cv + b.eta * cl;
  denominator *= denominator;
  if (denominator < 1e-12f) return;
  float d = ggx_distribution(h, b.alpha);
  vec3 below(l.x, l.y, -l.z);
  float common = d * cv * -cl / (b.view.z * denominator);
  value.specular = color.transmit * (common * ggx_shadowing(b.view, below, b.alpha));
  value.specular_pdf =
      (1 - color.reflect_share) * ggx_masking(b.view, b.alpha) * common * b.eta * b.eta;
}

BsdfSample sample_smooth(const Bsdf& b, float u) {
  BsdfSample s;
  FacetColor color = facet_color(b, b.view.z);
  if (u < color.reflect_share) {
    s = eval_mirror(b);
    s.weight /= color.reflect_share;
    return s;
  }
  s.weight = color.transmit / (1 - color.reflect_share);
  if (b.thin) {
    s.bounce = Bounce::pass;
    s.direction = -to_world(b, b.view);
    return s;
  }
  s.bounce = Bounce::refract;
  vec3 l;
  if (!refract_at(b.view, vec3(0, 0, 1), b.eta, l)) return {};
  s.direction = to_world(b, l);
  s.weight /= b.eta * b.eta;
  if (dot(s.direction, b.geometric_normal) >= 0) s.weight = vec3(0);
  return s;
}

// A direction of the rough specular lobes, world space; zero: none.
vec3 sample_rough(const Bsdf& b, Sampler& sampler) {
  float u = sampler.next();
  vec3 h = sample_visible_normal(b.view, b.alpha, sampler.next2());
  float cosine = dot(b.view, h);
  if (cosine <= 0) return vec3(0);
  vec3 reflected = 2 * cosine * h - b.view;
  if (u < facet_color(b, cosine).reflect_share)
    return reflected.z > 0 ? to_world(b, reflected) : vec3(0);
  if (b.thin)
    return reflected.z > 0 ? to_world(b, {reflected.x, reflected.y, -reflected.z}) : vec3(0);
  vec3 l;
  if (!refract_at(b.view, h, b.eta, l) || l.z >= 0) return vec3(0);
  return to_world(b, normalize(l));
}

}  // namespace

Bsdf make_bsdf(const Surface& surface, const Material& material, vec3 direction,
               const DielectricAlbedo& albedo) {
  Bsdf b;
  vec3 v = -direction;
  b.geometric_normal = surface.geometric_normal;
  b.normal = usable_normal(surface.normal, surface.geometric_normal, v);
  make_frame_axes(b.normal, b.tangent, b.bitangent);
  b.view = to_local(b, v);
  b.view.z = std::max(b.view.z, 1e-4f);
  b.alpha = alpha_of(surface.roughness);
  b.metallic = glm::clamp(surface.metallic, 0.0f, 1.0f);
  vec3 base = unit_range(surface.base_color);
  float transmission = glm::clamp(surface.transmission, 0.0f, 1.0f);
  float index = index_of(material);
  b.thin = !(material.thickness > 0);
  b.eta = !b.thin && !surface.front && transmission > 0 ? 1 / index : index;
  b.diffuse = base * ((1 - b.metallic) * (1 - transmission));
  b.transmit = base * ((1 - b.metallic) * transmission);
  if (!b.thin && std::abs(b.eta - 1) < 2e-3f && max_component(b.transmit) > 0) {
    // Facets between equal indices bend nothing: however rough, light goes straight on.
    if (b.metallic == 0) b.alpha = 0;
    else b.eta = b.eta < 1 ? 0.998f : 1.002f;
  }
  if (b.metallic > 0) {
    b.metal = base;
    if (b.alpha > 0) {
      float single = eval_albedo(albedo_row(mirror_albedo(), b.alpha), b.view.z);
      b.metal_gain = vec3(1) + base * ((1 - single) / std::max(single, 0.1f));
    }
  }
  if (b.alpha > 0 && transmission > 0) {
    const AlbedoTable& kept = b.thin ? mirror_albedo() : b.eta < 1 ? albedo.out_of : albedo.into;
    float gain = 1 / std::max(eval_albedo(albedo_row(kept, b.alpha), b.view.z), 0.1f);
    b.gloss_gain = glm::mix(1.0f, gain, transmission);
    b.transmit *= gain;
  }
  b.coat = albedo_row(albedo.coat, b.alpha);
  b.coat_passes = 1 - eval_albedo(b.coat, b.view.z);
  b.coat_scale = 1 / std::max(1 - b.coat.average, 1e-3f);
  float diffuse = luminance(b.diffuse) * b.coat_passes;
  float specular = luminance(b.transmit) + (1 - b.metallic) * (1 - b.coat_passes) +
                   b.metallic * luminance(fresnel_schlick(b.metal, b.view.z));
  if (diffuse <= 0) b.diffuse_share = 0;
  else if (specular <= 1e-4f && !has_specular(b)) b.diffuse_share = 1;
  else b.diffuse_share = glm::clamp(diffuse / (diffuse + specular), 0.1f, 0.9f);
  return b;
}

bool has_diffuse(const Bsdf& b) { return max_component(b.diffuse) > 0; }

bool has_specular(const Bsdf& b) {
  return b.metallic > 0 || max_component(b.transmit) > 0 || b.eta != 1;
}

bool is_smooth(const Bsdf& b) { return !has_diffuse(b) && b.alpha == 0; }

BsdfValue eval_bsdf(const Bsdf& b, vec3 direction) {
  BsdfValue value;
  vec3 l = to_local(b, direction);
  float side = dot(direction, b.geometric_normal);
  if (l.z > 1e-6f && side > 0) {
    value.diffuse_pdf = l.z / pi;
    if (has_diffuse(b))
      value.diffuse = b.diffuse * (value.diffuse_pdf * b.coat_passes *
                                   (1 - eval_albedo(b.coat, l.z)) * b.coat_scale);
    if (b.alpha > 0 && has_specular(b)) eval_reflection(b, l, value);
  } else if (l.z < -1e-6f && side < 0 && b.alpha > 0 && max_component(b.transmit) > 0) {
    b.thin ? eval_thin_transmission(b, l, value) : eval_refraction(b, l, value);
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
  float u = sampler.next();
  BsdfSample s;
  if (u < share) {
    s.direction = to_world(b, sample_cosine_hemisphere(sampler.next2()));
  } else if (!has_specular(b)) {
    return {};
  } else if (b.alpha == 0) {
    s = sample_smooth(b, sampler.next());
    s.weight /= 1 - share;
    return s;
  } else {
    s.direction = sample_rough(b, sampler);
    if (s.direction == vec3(0)) return {};
  }
  BsdfValue value = eval_bsdf(b, s.direction);
  s.pdf = sample_bsdf_pdf(b, value, lobes);
  vec3 sum = (lobes != Lobes::specular ? value.diffuse : vec3(0)) +
             (lobes != Lobes::diffuse ? value.specular : vec3(0));
  if (!(s.pdf > 0)) return {};
  s.weight = sum / s.pdf;
  if (dot(s.direction, b.geometric_normal) < 0)
    s.bounce = b.thin ? Bounce::reflect : Bounce::refract;
  return s;
}

BsdfSample eval_mirror(const Bsdf& b) {
  BsdfSample s;
  s.direction = to_world(b, {-b.view.x, -b.view.y, b.view.z});
  if (dot(s.direction, b.geometric_normal) > 0) s.weight = facet_color(b, b.view.z).reflect;
  return s;
}

bool is_pane(const Surface& surface, const Material& material) {
  return !(material.thickness > 0) && surface.transmission > 0 && surface.metallic < 1 &&
         alpha_of(surface.roughness) == 0;
}

vec3 pane_transmittance(const Surface& surface, const Material& material, vec3 direction) {
  vec3 v = -direction;
  vec3 normal = usable_normal(surface.normal, surface.geometric_normal, v);
  float f = fresnel_dielectric(std::min(std::max(dot(v, normal), 1e-4f), 1.0f), index_of(material));
  float share =
      (1 - glm::clamp(surface.metallic, 0.0f, 1.0f)) * glm::clamp(surface.transmission, 0.0f, 1.0f);
  return unit_range(surface.base_color) * ((1 - f) * share);
}

}  // namespace wellspring
