// SPDX-License-Identifier: Apache-2.0
// Every pixel of a picture of another view looks along its epipolar line in a keyframe, from the
// nearest disparity there may be to the farthest, for the first surface that it would see, and a
// step of fixed-point iteration finds it (Bowles, Mitchell, Sumner, Moore, Gross 2012, "Iterative
// Image Warping", section 3), as in server/picture/warp_picture.cpp.
import { block } from './view.js';

export const vertex = `#version 300 es
void main() {  // one triangle over everything
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

export const fragment = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
uniform sampler2D color;    // the keyframe's
uniform usampler2D units;   // its disparities
uniform sampler2D bounds;   // farthest and nearest disparity of the view's blocks
uniform vec3 to[4];         // one, across, down, baseline: from the view to the keyframe
uniform vec3 back[4];       // and back
uniform vec2 size;          // of the keyframe's depth, pixels
uniform float unit;
uniform float height;       // of the picture, pixels
uniform float share;        // how much of the picture it is
uniform bool whole;         // what it does not show is guessed; else left as it is
uniform float seam;         // pixels at its border over which it passes into what lies behind; or 0
uniform bool coarse;        // its pixels are larger: surfaces are not told apart
uniform bool masked;        // where its disparity is 0 there is nothing
uniform bool as_it_is;      // the view is the keyframe's own
out vec4 shown;

const float least_depth = 1e-6, found = 0.5, same = 0.125, half_step = 0.5;
const int most_steps = 96;

float own_disparity(ivec2 at) {
  return unit * float(texelFetch(units, clamp(at, ivec2(0), ivec2(size) - 1), 0).r);
}
// Returns the disparity, in the view, of what the keyframe shows there.
float surface(vec2 at) {
  at = clamp(at, vec2(0), size - 1.0);
  float s = own_disparity(ivec2(at));
  float z = back[0].z + at.x * back[1].z + at.y * back[2].z + s * back[3].z;
  return z > least_depth ? s / z : 0.0;
}
vec3 carry(vec3 base, float w) {
  vec3 h = base + w * to[3];
  float z = max(h.z, least_depth);
  return vec3(h.xy / z, z);
}
// Pixels that a unit of disparity moves the place.
float speed(vec3 place) { return length(to[3].xy - place.xy * to[3].z) / place.z; }

// Bilinear, of the pixels around that lie on the surface of the nearest of them.
vec3 sample_color(vec2 at, float pixels) {
  vec2 place = clamp(at - 0.5, vec2(0), size - 1.0);
  ivec2 corner = ivec2(place);
  float own = own_disparity(ivec2(clamp(at, vec2(0), size - 1.0)));
  float apart = half_step / max(pixels, 1e-3);
  vec4 near;
  for (int i = 0; i < 4; i++)
    near[i] = abs(own_disparity(corner + ivec2(i & 1, i >> 1)) - own) > apart ? 0.0 : 1.0;
  if (near == vec4(1)) return texture(color, at / size).rgb;
  vec2 part = place - vec2(corner);
  vec4 weight = near * vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y),
      (1.0 - part.x) * part.y, part.x * part.y) + vec4(1e-6);
  vec3 sum = vec3(0);
  for (int i = 0; i < 4; i++) {
    vec2 middle = vec2(corner + ivec2(i & 1, i >> 1)) + 0.5;
    sum += weight[i] * near[i] * texture(color, middle / size).rgb;
  }
  float all = dot(weight, near);
  return all > 1e-5 ? sum / all : texture(color, (floor(at) + 0.5) / size).rgb;
}

void main() {
  vec2 pixel = vec2(gl_FragCoord.x, height - gl_FragCoord.y);
  if (as_it_is) {
    shown = vec4(texture(color, pixel / size).rgb, share);
    return;
  }
  vec3 base = to[0] + pixel.x * to[1] + pixel.y * to[2];
  vec2 range = texelFetch(bounds, ivec2(pixel) / ${block}, 0).rg;
  vec3 first = carry(base, range.g), last = carry(base, range.r);
  float apart = length(first.xy - last.xy), pixels = max(speed(first), speed(last));
  vec2 at = first.xy, behind = first.xy;
  bool is_found = false;
  if (!(apart > found)) {
    float w = 0.5 * (range.r + range.g);
    at = carry(base, w).xy;
    if (apart > same) at = carry(base, surface(at)).xy;
    is_found = true;
  } else {
    int steps = int(min(ceil(apart), float(most_steps)));
    float step = (range.g - range.r) / float(steps), farthest = 1e30;
    float candidate = step + found / max(pixels, 1e-30);
    for (int i = 0; i <= steps; i++) {
      float w = range.g - float(i) * step;
      vec2 one = carry(base, w).xy;
      float there = surface(one);
      if (there < farthest) { farthest = there; behind = one; }
      if (abs(there - w) > candidate) continue;
      vec2 two = carry(base, there).xy;
      float again = surface(two);
      if (abs(again - there) * pixels > found) continue;
      at = carry(base, again).xy;
      is_found = true;
      break;
    }
    if (!is_found) at = behind;
  }
  bool inside = all(greaterThanEqual(at, vec2(-found))) && all(lessThanEqual(at, size + found))
      && base.z > least_depth;
  if (!whole && !(is_found && inside)) discard;
  if (masked && own_disparity(ivec2(clamp(at, vec2(0), size - 1.0))) == 0.0) discard;
  vec2 border = min(at, size - at);
  float own = seam > 0.0 ? clamp(min(border.x, border.y) / seam, 0.0, 1.0) : 1.0;
  shown = vec4(sample_color(at, coarse ? 0.0 : pixels), share * own);
}`;
