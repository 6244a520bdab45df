// SPDX-License-Identifier: Apache-2.0
// Every pixel of a picture of another view looks along its epipolar line in a keyframe, from the
// nearest disparity there may be to the farthest, for the first surface that it would see, and a
// step of fixed-point iteration finds it (Bowles, Mitchell, Sumner, Moore, Gross 2012, "Iterative
// Image Warping", section 3). Surfaces that a keyframe does not show are taken from the next, and
// those that none shows go on as the first has them. server/picture/warp_picture.cpp does the same.
import { block } from './view.js';

export const most_layers = 3;

export const vertex = `#version 300 es
void main() {  // one triangle over everything
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

export const fragment = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
struct Layer {    // a keyframe
  bool is_there;
  vec3 to[4];     // one, across, down, baseline: from the view to the keyframe
  vec3 back[4];   // and back
  vec2 size;      // of its depth, pixels
  float unit;
  float seam;     // pixels over which it passes into the next at its border; 0: there is none
  float opacity;
  bool is_coarse; // its pixels are larger than the view's
};
struct Sway {         // how wind has moved a keyframe's grass (sway.js)
  bool is_there;
  vec4 waves[4];      // push, then radians a metre
  float phases[4];
  vec2 rays[3], aside[3];
  vec3 lens;          // axis and focal length, pixels
  float unit;         // pixels a code
};
uniform Sway sways[${most_layers}];
uniform sampler2D codes[${most_layers}];   // how far blocks of pixels sway
uniform Layer layers[${most_layers}];
uniform sampler2D color[${most_layers}];
uniform usampler2D units[${most_layers}];  // their disparities
uniform sampler2D bounds[${most_layers}];  // farthest and nearest disparity of the view's blocks
uniform float height;                      // of the picture, pixels
uniform bool as_it_is;                     // the view is the first one's own
uniform bool masked;                       // there is nothing where the first one's disparity is 0
out vec4 shown;

const float least_depth = 1e-6, found = 0.5, meets = 1.0, same = 0.125, half_step = 0.5;
const int most_steps = 96, sway_steps = 3;
const float most_code = 255.0;

float own_disparity(usampler2D units, Layer layer, ivec2 at) {
  return layer.unit * float(texelFetch(units, clamp(at, ivec2(0), ivec2(layer.size) - 1), 0).r);
}
// Returns the disparity, in the view, of what the keyframe shows there.
float surface(usampler2D units, Layer layer, vec2 at) {
  at = clamp(at, vec2(0), layer.size - 1.0);
  float s = own_disparity(units, layer, ivec2(at));
  float z = layer.back[0].z + at.x * layer.back[1].z + at.y * layer.back[2].z
      + s * layer.back[3].z;
  return z > least_depth ? s / z : 0.0;
}
vec3 carry(Layer layer, vec3 base, float w) {
  vec3 h = base + w * layer.to[3];
  float z = max(h.z, least_depth);
  return vec3(h.xy / z, z);
}
// Pixels that a unit of disparity moves the place.
float speed(Layer layer, vec3 place) {
  return length(layer.to[3].xy - place.xy * layer.to[3].z) / place.z;
}

// Bilinear, of the pixels around that lie on the surface of the nearest of them.
vec3 sample_color(sampler2D color, usampler2D units, Layer layer, vec2 at, float pixels) {
  vec2 last = layer.size - 1.0, place = clamp(at - 0.5, vec2(0), last);
  ivec2 corner = ivec2(place);
  float own = own_disparity(units, layer, ivec2(clamp(at, vec2(0), last)));
  float apart = half_step / max(pixels, 1e-3);
  vec4 near;
  for (int i = 0; i < 4; i++) {
    float there = own_disparity(units, layer, corner + ivec2(i & 1, i >> 1));
    near[i] = abs(there - own) > apart ? 0.0 : 1.0;
  }
  if (near == vec4(1)) return texture(color, at / layer.size).rgb;
  vec2 part = place - vec2(corner);
  vec4 weight = near * vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y),
      (1.0 - part.x) * part.y, part.x * part.y) + vec4(1e-6);
  vec3 sum = vec3(0);
  for (int i = 0; i < 4; i++) {
    vec2 middle = vec2(corner + ivec2(i & 1, i >> 1)) + 0.5;
    sum += weight[i] * near[i] * texture(color, middle / layer.size).rgb;
  }
  float all = dot(weight, near);
  return all > 1e-5 ? sum / all : texture(color, (floor(at) + 0.5) / layer.size).rgb;
}

// Returns the place of what wind has brought to a keyframe's place since: of what is there, the
// grass is known that was moved by as much as it is away, by fixed-point iteration.
vec2 unsway(sampler2D codes, usampler2D units, Sway sway, Layer layer, vec2 at) {
  float s = own_disparity(units, layer, ivec2(clamp(at, vec2(0), layer.size - 1.0)));
  if (!sway.is_there || s == 0.0) return at;
  vec2 place = (sway.rays[0] + at.x * sway.rays[1] + at.y * sway.rays[2]) / s, push = vec2(0);
  for (int i = 0; i < 4; i++)
    push += sway.waves[i].xy * cos(dot(sway.waves[i].zw, place) + sway.phases[i]);
  float away = dot(push, sway.aside[2]) / sway.lens.z;
  vec2 way = sway.unit * most_code * (vec2(dot(push, sway.aside[0]), dot(push, sway.aside[1]))
      - (at - sway.lens.xy) * away);
  vec2 from = at;
  for (int i = 0; i < sway_steps; i++) from = at - way * texture(codes, from / layer.size).r;
  return from;
}

vec3 base_of(Layer layer, vec2 pixel) {
  return layer.to[0] + pixel.x * layer.to[1] + pixel.y * layer.to[2];
}
bool is_inside(Layer layer, vec2 at) {
  return all(greaterThanEqual(at, vec2(-found))) && all(lessThanEqual(at, layer.size + found));
}
// Pixels that a unit of disparity moves the place, at most.
float most_speed(sampler2D bounds, Layer layer, vec2 pixel) {
  vec3 base = base_of(layer, pixel);
  vec2 range = texelFetch(bounds, ivec2(pixel) / ${block}, 0).rg;
  return max(speed(layer, carry(layer, base, range.g)), speed(layer, carry(layer, base, range.r)));
}

// Returns the keyframe's colour of the pixel, or how it goes on there: with the farthest surface on
// the line, which does not stand before what would be seen, or with its border. Its alpha is how
// much of the pixel the keyframe shows.
vec4 look(sampler2D color, usampler2D units, sampler2D bounds, sampler2D codes, Layer layer,
    Sway sway, vec2 pixel, out float disparity) {
  vec3 base = base_of(layer, pixel);
  vec2 range = texelFetch(bounds, ivec2(pixel) / ${block}, 0).rg;
  vec3 first = carry(layer, base, range.g), last = carry(layer, base, range.r);
  float apart = length(first.xy - last.xy);
  float pixels = max(speed(layer, first), speed(layer, last));
  disparity = 0.5 * (range.r + range.g);
  vec2 at = first.xy;
  bool is_found = false;
  if (!(apart > found)) {
    at = carry(layer, base, disparity).xy;
    if (apart > same) {
      disparity = surface(units, layer, at);
      at = carry(layer, base, disparity).xy;
    }
    is_found = true;
  } else {
    int steps = int(min(ceil(apart), float(most_steps)));
    float step = (range.g - range.r) / float(steps), farthest = 1e30;
    float candidate = step + found / max(pixels, 1e-30);
    vec2 behind = at;
    for (int i = 0; i <= steps; i++) {
      float w = range.g - float(i) * step;
      vec2 one = carry(layer, base, w).xy;
      float there = surface(units, layer, one);
      if (there < farthest) { farthest = there; behind = one; }
      if (abs(there - w) > candidate) continue;
      vec2 two = carry(layer, base, there).xy;
      disparity = surface(units, layer, two);
      if (abs(disparity - there) * pixels > meets) continue;
      at = carry(layer, base, disparity).xy;
      is_found = true;
      break;
    }
    if (!is_found) at = behind;
  }
  vec2 border = min(at, layer.size - at);
  float share = layer.seam > 0.0 ? clamp(min(border.x, border.y) / layer.seam, 0.0, 1.0) : 1.0;
  vec2 from = is_found ? unsway(codes, units, sway, layer, at) : at;
  return vec4(sample_color(color, units, layer, from, layer.is_coarse ? 0.0 : pixels),
      is_found && is_inside(layer, at) && base.z > least_depth ? share : 0.0);
}

// Whether the newest keyframe sees past the pixel's place at that disparity: nothing is there any
// more.
bool sees_past(vec2 pixel, float disparity, float pixels) {
  vec2 place = carry(layers[0], base_of(layers[0], pixel), disparity).xy;
  return is_inside(layers[0], place)
      && (disparity - surface(units[0], layers[0], place)) * pixels > meets;
}

void main() {
  vec2 pixel = vec2(gl_FragCoord.x, height - gl_FragCoord.y);
  if (as_it_is) {
    vec2 from = unsway(codes[0], units[0], sways[0], layers[0], pixel);
    shown = vec4(texture(color[0], from / layers[0].size).rgb, 1);
    return;
  }
  float disparity;
  vec4 first = look(color[0], units[0], bounds[0], codes[0], layers[0], sways[0], pixel, disparity);
  if (masked) {
    vec2 at = carry(layers[0], base_of(layers[0], pixel), disparity).xy;
    if (first.a == 0.0 || own_disparity(units[0], layers[0], ivec2(at)) == 0.0) discard;
  }
  float left = 1.0 - first.a * layers[0].opacity;
  vec3 sum = first.rgb * (1.0 - left);
  float pixels = first.a > 0.0 ? 0.0 : most_speed(bounds[0], layers[0], pixel);
${Array.from({ length: most_layers - 1 }, (_, i) => i + 1).map((i) => `
  if (left > 0.0 && layers[${i}].is_there) {
    vec4 next = look(color[${i}], units[${i}], bounds[${i}], codes[${i}], layers[${i}], sways[${i}],
        pixel, disparity);
    if (first.a == 0.0 && sees_past(pixel, disparity, pixels)) next.a = 0.0;
    sum += left * next.a * next.rgb;
    left *= 1.0 - next.a;
  }`).join('')}
  shown = vec4(sum + left * first.rgb, 1);
}`;
