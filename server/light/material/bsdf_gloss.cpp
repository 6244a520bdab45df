// SPDX-License-Identifier: Apache-2.0
#include "light/material/bsdf_gloss.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_types.h"
#include "light/material/microfacet.h"

namespace wellspring::light {
namespace {

constexpr int brushed_points = 377;  // facets summed for each hit of a brushed surface
constexpr float least_loss = 1e-6f;
// If a dielectric gives back less of what its facets lost, it leaves that to the layer beneath.
constexpr float faint = 0.01f;

float row_loss(const AlbedoRow& row, float root_alpha, float cosine) {
  return eval_loss(row, root_alpha, std::sqrt(cosine));
}

// Returns the colour of light that left after more than one meeting, as a share of what one meeting
// kept back: the series of Kulla and Conty 2017 with each meeting's reflectance at its average.
vec3 again_color(vec3 average, float loss) {
  return average * average * (1 - loss) / (vec3(1) - average * loss);
}

// Draws a direction of multiple scattering. Light that meets several facets mostly meets them, and
// leaves, where one meeting loses most: the loss goes roughly as 1 / (cosine^2 + alpha^2), which
// can be inverted.
vec3 sample_again(const Bsdf& b, vec2 u) {
  float k = b.alpha * b.alpha;
  float height2 = glm::clamp(k * (std::pow(1 + 1 / k, u.x) - 1), 0.0f, 1.0f);
  float radius = std::sqrt(1 - height2), phi = 2 * pi * u.y;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(height2)};
}
float sample_again_pdf(const Bsdf& b, float cosine) {
  return b.again_scale * cosine / (cosine * cosine + b.alpha * b.alpha);
}

void eval_reflection(const Bsdf& b, vec3 l, vec3& value, float& pdf) {
  vec3 h = normalize(b.view + l);
  FacetColor color = facet_color(b, dot(b.view, h));
  float d = ggx_distribution(h, b.alphas) / (4 * b.view.z);
  float masked = ggx_lambda(b.view, b.alphas);
  value = color.reflect * (d / (1 + masked + ggx_lambda(l, b.alphas)));
  pdf = color.reflect_share * d / (1 + masked);
}

void eval_thin_transmission(const Bsdf& b, vec3 l, vec3& value, float& pdf) {
  vec3 mirrored(l.x, l.y, -l.z);
  vec3 h = normalize(b.view + mirrored);
  FacetColor color = facet_color(b, dot(b.view, h));
  float d = ggx_distribution(h, b.alphas) / (4 * b.view.z);
  value = color.transmit * (d * ggx_shadowing(b.view, mirrored, b.alphas));
  pdf = (1 - color.reflect_share) * ggx_masking(b.view, b.alphas) * d;
}

// Computes Walter et al. 2007, equation 21.
void eval_refraction(const Bsdf& b, vec3 l, vec3& value, float& pdf) {
  vec3 h = b.view + b.eta * l;
  float length2 = dot(h, h);
  if (length2 < 1e-12f) return;  // index 1, straight on: all facets look alike
  h /= std::sqrt(length2);
  if (h.z < 0) h = -h;
  float cv = dot(b.view, h), cl = dot(l, h);
  if (cv <= 0 || cl >= 0) return;
  FacetColor color = facet_color(b, cv);
  float denominator = cv + b.eta * cl;
  denominator *= denominator;
  if (denominator < 1e-12f) return;
  vec3 below(l.x, l.y, -l.z);
  float common = ggx_distribution(h, b.alphas) * cv * -cl / (b.view.z * denominator);
  value = color.transmit * (common * ggx_shadowing(b.view, below, b.alphas));
  pdf = (1 - color.reflect_share) * ggx_masking(b.view, b.alphas) * common * b.eta * b.eta;
}

int largest_channel(vec3 c) { return c.x >= c.y && c.x >= c.z ? 0 : c.y >= c.z ? 1 : 2; }

// Sets the multiple scattering of glass: light that facets keep back leaves to either side in such
// shares that both directions agree, eta^2 apart (Kulla and Conty 2017). From outside the average
// Fresnel share is reflected; from inside the share that follows from reciprocity.
void set_glass_again(Bsdf& b, const DielectricAlbedo& albedo, float loss, float transmission) {
  bool inside = !b.thin && b.eta < 1;  // or in a medium denser than the solid
  const AlbedoTable& here = b.thin   ? mirror_loss()
                            : inside ? albedo.glass->out_of
                                     : albedo.glass->into;
  const AlbedoTable& beyond = b.thin   ? mirror_loss()
                              : inside ? albedo.glass->into
                                       : albedo.glass->out_of;
  b.glass_here = albedo_row(here, b.alpha);
  b.glass_beyond = albedo_row(beyond, b.alpha);
  float average_here = std::max(b.glass_here.average, least_loss);
  float average_beyond = std::max(b.glass_beyond.average, least_loss);
  float through = 1 - albedo.fresnel_average;
  if (inside) through *= b.eta * b.eta * average_beyond / average_here;
  float share = (1 - b.metallic) * transmission * (1 - through);
  b.glass_again = vec3(share * loss / (pi * average_here));
  b.glass_again_beyond = b.transmit * (through * loss / (pi * average_beyond));
  if (!b.thin) b.glass_again_beyond /= b.eta * b.eta;
}

}  // namespace

void set_facets(Bsdf& b, float specular, vec3 color) {
  if (specular == 1 && color == vec3(1)) return;
  float normal = (b.eta - 1) / (b.eta + 1);
  normal *= normal;
  vec3 tinted = glm::min(normal * color, vec3(1)) * specular;
  if (normal < 0.999f) {
    b.facet_slope = (vec3(specular) - tinted) / (1 - normal);
    b.facet_base = tinted - b.facet_slope * normal;
  } else {
    b.facet_slope = vec3(0);
    b.facet_base = tinted;
  }
}

FacetColor facet_color(const Bsdf& b, float cosine) {
  float f = fresnel_dielectric(std::min(cosine, 1.0f), b.eta);
  FacetColor c;
  vec3 dielectric = f < 1 ? glm::max(b.facet_base + b.facet_slope * f, vec3(0)) : vec3(1);
  c.reflect = b.dielectric_share * dielectric;
  if (b.metallic > 0) c.reflect += b.metallic * fresnel_schlick(b.metal, cosine);
  c.transmit = (1 - max_component(dielectric)) * b.transmit;
  float r = max_component(c.reflect), t = max_component(c.transmit);
  c.reflect_share = r + t > 0 ? r / (r + t) : 1;
  return c;
}

float eval_coat(const Bsdf& b, float cosine) {
  if (b.alpha == 0)
    return b.coat_mirror + b.coat_fresnel * fresnel_dielectric(std::min(cosine, 1.0f), b.eta);
  float t = std::sqrt(cosine);
  float loss = eval_loss(b.loss, b.root_alpha, t);
  float once = b.coat_mirror + b.coat_fresnel * eval_row(b.fresnel, std::min(t, 1.0f));
  return std::min(b.coat_loss * loss + (1 - loss) * once, 1.0f);
}

void set_gloss(Bsdf& b, const DielectricAlbedo& albedo, float transmission, float specular,
               vec3 specular_color) {
  set_facets(b, specular, specular_color);
  if (!has_gloss(b)) return;
  bool inside = b.within;
  // Seen from within a solid, its opaque part lies in its substance: nothing reflects first.
  b.dielectric_share = (1 - b.metallic) * (inside ? transmission : 1);
  b.has_coat = !inside && b.metallic < 1;
  int channel = 0;
  if (b.has_coat) {
    channel = largest_channel(b.facet_base + b.facet_slope * albedo.fresnel_average);
    b.coat_mirror = b.facet_base[channel];
    b.coat_fresnel = b.facet_slope[channel];
  }
  bool brushed = b.alphas.x != b.alphas.y;
  float average = b.coat_mirror + b.coat_fresnel * albedo.fresnel_average;
  if (b.alpha == 0) {
    if (b.has_coat) b.coat_passes = 1 - eval_coat(b, b.view.z);
    b.coat_scale = 1 / std::max(1 - average, 1e-3f);
    return;
  }
  b.root_alpha = std::sqrt(b.alpha);
  const AlbedoPlace place = albedo_place(b.root_alpha);
  b.loss = albedo_row(mirror_loss(), place);
  b.fresnel = albedo_row(albedo.fresnel, place);
  float loss = b.loss.average;
  vec3 dielectric_again =
      again_color(glm::max(b.facet_base + b.facet_slope * albedo.fresnel_average, vec3(0)), loss);
  bool strong = max_component(dielectric_again) > faint;
  strong = strong && !inside;
  if (strong) b.coat_loss = dielectric_again[channel];
  float coat_average =
      b.coat_loss * loss + b.coat_mirror * (1 - loss) + b.coat_fresnel * b.fresnel.average;
  b.coat_scale = 1 / std::max(1 - coat_average, 1e-3f);

  bool clear = transmission > 0 && b.metallic < 1;
  float lost = 0, glass_lost = 0, coat = 0;  // to the viewer
  if (brushed) {
    FacetAlbedo sum = sum_albedo(b.view, b.alphas, b.eta, clear && !b.thin, brushed_points);
    lost = 1 - sum.kept;
    glass_lost = b.thin ? lost : 1 - sum.passed;
    coat = b.coat_loss * lost + b.coat_mirror * sum.kept + b.coat_fresnel * sum.reflected;
  } else {
    if (b.has_coat) coat = eval_coat(b, b.view.z);
    if (b.metallic > 0 || strong) lost = row_loss(b.loss, b.root_alpha, b.view.z);
  }
  b.coat_passes = 1 - coat;
  vec3 again(0);
  if (b.metallic > 0) again = b.metallic * again_color(fresnel_schlick_average(b.metal), loss);
  if (strong) again += (1 - b.metallic) * (1 - transmission) * dielectric_again;
  b.again = again * (lost / (pi * std::max(loss, least_loss)));
  if (clear) {
    if (!brushed) {
      const AlbedoTable& here = b.thin      ? mirror_loss()
                                : b.eta < 1 ? albedo.glass->out_of
                                            : albedo.glass->into;
      glass_lost = row_loss(albedo_row(here, b.alpha), b.root_alpha, b.view.z);
    }
    set_glass_again(b, albedo, glass_lost, transmission);
  }
  // Each lobe's chance is its share of the light; any chances would do.
  float here =
      max_component(again) * lost + max_component(b.glass_again) * pi * b.glass_here.average;
  float beyond = max_component(b.glass_again_beyond) * pi * b.glass_beyond.average *
                 (b.thin ? 1 : b.eta * b.eta);
  float once = b.metallic * max_component(b.metal) * (1 - lost) +
               (1 - b.metallic) * glm::mix(coat, 1 - glass_lost, transmission);
  b.again_share = here + beyond > 1e-9f ? (here + beyond) / (here + beyond + once) : 0;
  b.again_here = here + beyond > 0 ? here / (here + beyond) : 1;
  if (b.again_share > 0) b.again_scale = 1 / (pi * std::log(1 + 1 / (b.alpha * b.alpha)));
}

void eval_gloss(const Bsdf& b, vec3 l, vec3& value, float& pdf) {
  value = vec3(0);
  pdf = 0;
  bool here = l.z > 0;
  float cosine = std::abs(l.z);
  if (here) eval_reflection(b, l, value, pdf);
  else if (max_component(b.transmit) > 0)
    b.thin ? eval_thin_transmission(b, l, value, pdf) : eval_refraction(b, l, value, pdf);
  else return;
  if (b.again_share == 0) return;
  float side = here ? b.again_here : 1 - b.again_here;
  pdf = glm::mix(pdf, side * sample_again_pdf(b, cosine), b.again_share);
  if (here) {
    if (max_component(b.again) > 0)
      value += b.again * (cosine * row_loss(b.loss, b.root_alpha, cosine));
    if (b.glass_again.x > 0)
      value += b.glass_again * (cosine * row_loss(b.glass_here, b.root_alpha, cosine));
  } else {
    value += b.glass_again_beyond * (cosine * row_loss(b.glass_beyond, b.root_alpha, cosine));
  }
}

vec3 sample_gloss(const Bsdf& b, Sampler& sampler) {
  float u = sampler.next();
  vec2 place = sampler.next2();
  if (u < b.again_share) {
    vec3 l = sample_again(b, place);
    if (u >= b.again_share * b.again_here) l.z = -l.z;
    return l;
  }
  u = (u - b.again_share) / (1 - b.again_share);
  vec3 h = sample_visible_normal(b.view, b.alphas, place);
  float cosine = dot(b.view, h);
  if (cosine <= 0) return vec3(0);
  vec3 reflected = 2 * cosine * h - b.view;
  if (u < facet_color(b, cosine).reflect_share) return reflected.z > 0 ? reflected : vec3(0);
  if (b.thin) return reflected.z > 0 ? vec3(reflected.x, reflected.y, -reflected.z) : vec3(0);
  vec3 l;
  if (!refract_at(b.view, h, b.eta, l) || l.z >= 0) return vec3(0);
  return normalize(l);
}

BsdfSample sample_smooth_gloss(const Bsdf& b, float u) {
  BsdfSample s;
  s.glass = !b.thin && max_component(b.transmit) > 0;
  FacetColor color = facet_color(b, b.view.z);
  if (u < color.reflect_share) {
    s.direction = to_world(b, {-b.view.x, -b.view.y, b.view.z});
    if (dot(s.direction, b.geometric_normal) > 0) s.weight = color.reflect / color.reflect_share;
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

namespace {

constexpr float clearcoat_index = 1.5f;
constexpr float least_sheen_roughness = 0.07f;

vec3 in_frame(const Clearcoat& c, vec3 w) {
  return {dot(w, c.tangent), dot(w, c.bitangent), dot(w, c.normal)};
}
vec3 from_frame(const Clearcoat& c, vec3 w) {
  return c.tangent * w.x + c.bitangent * w.y + c.normal * w.z;
}

float clearcoat_reflects(float cosine, float alpha) {
  if (alpha == 0) return fresnel_dielectric(cosine, clearcoat_index);
  static const DielectricAlbedo& albedo = dielectric_albedo(clearcoat_index, false);
  float t = std::sqrt(cosine);
  float loss = eval_loss(albedo_row(mirror_loss(), alpha), std::sqrt(alpha), t);
  return (1 - loss) * eval_row(albedo_row(albedo.fresnel, alpha), t);
}

void eval_clearcoat(const Bsdf& b, vec3 direction, vec3& value, float& pdf) {
  const Clearcoat& c = b.clearcoat;
  vec3 l = in_frame(c, direction);
  if (l.z <= 1e-6f) return;
  vec3 h = normalize(c.view + l);
  float d = ggx_distribution(h, vec2(c.alpha)) / (4 * c.view.z);
  float masked = ggx_lambda(c.view, vec2(c.alpha)), hidden = ggx_lambda(l, vec2(c.alpha));
  float f = fresnel_dielectric(std::min(dot(c.view, h), 1.0f), clearcoat_index);
  value += vec3(c.strength * f * d / (1 + masked + hidden));
  pdf += c.share * d / (1 + masked);
}

// Returns equation 3 and table 1 of the paper: the logarithm of the masking function.
float sheen_curve(float x, float blend) {
  auto mixed = [&](float smooth, float rough) { return glm::mix(rough, smooth, blend); };
  float a = mixed(25.3245f, 21.5473f), b = mixed(3.32435f, 3.82987f), c = mixed(0.16801f, 0.19823f);
  float d = mixed(-1.27393f, -1.97760f), e = mixed(-4.85967f, -4.32054f);
  return a / (1 + b * std::pow(x, c)) + d * x + e;
}
float sheen_lambda(float cosine, float alpha) {
  float blend = (1 - alpha) * (1 - alpha);
  if (cosine < 0.5f) return std::exp(sheen_curve(cosine, blend));
  return std::exp(2 * sheen_curve(0.5f, blend) - sheen_curve(1 - cosine, blend));
}

// Takes both directions with z > 0; the value carries the cosine of l.
float eval_white_sheen(vec3 v, vec3 l, float alpha) {
  vec3 h = normalize(v + l);
  float sine2 = std::max(h.x * h.x + h.y * h.y, 0.0f), power = 1 / alpha;
  float distribution = (2 + power) * std::pow(sine2, 0.5f * power) / (2 * pi);
  float seen =
      1 / (1 + sheen_lambda(std::min(v.z, 1.0f), alpha) + sheen_lambda(std::min(l.z, 1.0f), alpha));
  return distribution * seen / (4 * v.z);
}

// Holds the directional albedo by sqrt(cosine) and the root of the perceptual roughness above the
// least.
struct SheenTable {
  static constexpr int angles = 32, roughnesses = 24;
  float value[roughnesses][angles];
};

SheenTable make_sheen_table() {
  SheenTable table;
  constexpr int around = 16, down = 48;
  for (int r = 0; r < SheenTable::roughnesses; r++) {
    float y = float(r) / (SheenTable::roughnesses - 1);
    float root = glm::mix(least_sheen_roughness, 1.0f, y * y);
    for (int a = 0; a < SheenTable::angles; a++) {
      float t = float(a) / (SheenTable::angles - 1), cosine = std::max(t * t, 1e-4f);
      vec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
      double sum = 0;
      for (int i = 0; i < around; i++)
        for (int j = 0; j < down; j++) {
          // The samples cover half the azimuths, by symmetry; they are close near the horizon and
          // near the viewer's plane, where smooth sheen is bright.
          float x = (float(i) + 0.5f) / around, phi = pi * x * x * (3 - 2 * x);
          float s = (float(j) + 0.5f) / down, z = s * s, radius = std::sqrt(1 - z * z);
          vec3 l(radius * std::cos(phi), radius * std::sin(phi), z);
          sum += double(eval_white_sheen(v, l, root * root) * 2 * pi * 6 * x * (1 - x) * 2 * s);
        }
      table.value[r][a] = float(sum / (around * down));
    }
  }
  return table;
}

}  // namespace

float sheen_albedo(float cosine, float alpha) {
  static const SheenTable table = make_sheen_table();
  constexpr int rows = SheenTable::roughnesses, columns = SheenTable::angles;
  float above = (std::sqrt(alpha) - least_sheen_roughness) / (1 - least_sheen_roughness);
  float y = std::sqrt(glm::clamp(above, 0.0f, 1.0f)) * (rows - 1);
  float x = std::sqrt(glm::clamp(cosine, 0.0f, 1.0f)) * (columns - 1);
  int row = glm::clamp(int(y), 0, rows - 2), column = std::min(int(x), columns - 2);
  float down = glm::clamp(y - float(row), 0.0f, 1.0f), along = x - float(column);
  auto at = [&](int i) {
    return glm::mix(table.value[i][column], table.value[i][column + 1], along);
  };
  return glm::mix(at(row), at(row + 1), down);
}

void set_layers(Bsdf& b, const Surface& surface, vec3 view) {
  vec3 color = clean(surface.sheen_color);
  float brightest = max_component(color);
  float sheen = 0;
  if (brightest > 0) {
    b.sheen.color = color;
    float root = surface.sheen_roughness > least_sheen_roughness ? surface.sheen_roughness
                                                                 : least_sheen_roughness;
    b.sheen.alpha = std::min(root * root, 1.0f);
    sheen = brightest * sheen_albedo(b.view.z, b.sheen.alpha);
    if (sheen > 1) b.sheen.color /= sheen;
    sheen = std::min(sheen, 1.0f);
    b.beneath = 1 - sheen;
  }
  Clearcoat& c = b.clearcoat;
  float coat = 0;
  if (surface.clearcoat > 0) {
    c.strength = std::min(surface.clearcoat, 1.0f);
    c.alpha = alpha_of(surface.clearcoat_roughness);
    c.normal = usable_normal(surface.clearcoat_normal, surface.geometric_normal, view);
    make_frame_axes(c.normal, c.tangent, c.bitangent);
    c.view = in_frame(c, view);
    c.view.z = glm::clamp(c.view.z, 1e-4f, 1.0f);
    coat = c.strength * clearcoat_reflects(c.view.z, c.alpha);
    c.reflected = coat;
    b.sheen.color *= 1 - coat;
    b.beneath *= 1 - coat;
  }
  // Each chance is what a lobe reflects, as a share of what all specular lobes reflect.
  float base = 0;
  if (has_gloss(b)) {
    bool strong = b.metallic > 0 || max_component(b.transmit) > 0;
    base = b.beneath * (strong ? 1 : std::max(1 - b.coat_passes, 0.05f));
  }
  float sum = coat + sheen * (1 - coat) + base;
  if (!(sum > 0)) return;
  c.share = coat / sum;
  b.sheen.share = sheen * (1 - coat) / sum;
}

void eval_layers(const Bsdf& b, vec3 direction, vec3& value, float& pdf) {
  if (has_clearcoat(b) && b.clearcoat.alpha > 0) eval_clearcoat(b, direction, value, pdf);
  if (!has_sheen(b)) return;
  vec3 l(dot(direction, b.tangent), dot(direction, b.bitangent), dot(direction, b.normal));
  if (l.z <= 1e-6f) return;
  value += b.sheen.color * eval_white_sheen(b.view, l, b.sheen.alpha);
  pdf += b.sheen.share / (4 * pi * std::sqrt(l.z));
}

BsdfSample eval_clearcoat_mirror(const Bsdf& b) {
  const Clearcoat& c = b.clearcoat;
  BsdfSample s;
  s.direction = from_frame(c, {-c.view.x, -c.view.y, c.view.z});
  if (dot(s.direction, b.geometric_normal) > 0) s.weight = vec3(c.reflected);
  return s;
}

vec3 sample_clearcoat(const Bsdf& b, Sampler& sampler) {
  const Clearcoat& c = b.clearcoat;
  vec3 h = sample_visible_normal(c.view, vec2(c.alpha), sampler.next2());
  float cosine = dot(c.view, h);
  vec3 l = 2 * cosine * h - c.view;
  return cosine > 0 && l.z > 0 ? from_frame(c, l) : vec3(0);
}

vec3 sample_sheen(const Bsdf& b, Sampler& sampler) {
  vec2 u = sampler.next2();
  float z = u.x * u.x, radius = std::sqrt(1 - z * z), phi = 2 * pi * u.y;
  vec3 l(radius * std::cos(phi), radius * std::sin(phi), z);
  return b.tangent * l.x + b.bitangent * l.y + b.normal * l.z;
}

}  // namespace wellspring::light
