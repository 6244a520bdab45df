// SPDX-License-Identifier: Apache-2.0
// Draws the well (GLSL ES 3.00). The axis of the well is z, the water lies at z = 0 with radius 1.
// Still things (stone, ground) are drawn once for a camera, in two lights; only the water is traced
// for each picture.

export const triangle = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

const head = `#version 300 es
precision highp float;
precision highp sampler2D;
`;

// Tiling noise: red and green a sum of octaves, coarse and fine; blue distance to the cells' edges.
export const noise = `${head}
uniform float size;
out vec4 color;
float hash(vec2 p, float s) {
  uvec2 q = uvec2(ivec2(p)) * uvec2(1597334677u, 3812015801u) + uint(s) * 374761393u;
  uint n = (q.x ^ q.y) * 1597334677u;
  n = (n ^ (n >> 15)) * 2246822519u;
  return float(n >> 8) / 16777216.0;
}
float value(vec2 p, float period) {
  vec2 i = floor(p), f = fract(p), u = f * f * (3.0 - 2.0 * f);
  vec2 a = mod(i, period), b = mod(i + 1.0, period);
  return mix(mix(hash(a, period), hash(vec2(b.x, a.y), period), u.x),
             mix(hash(vec2(a.x, b.y), period), hash(b, period), u.x), u.y);
}
float octaves(vec2 p, float period, int n) {
  float sum = 0.0, weight = 0.5;
  for (int i = 0; i < n; i++) {
    sum += weight * value(p * period, period);
    period *= 2.0;
    weight *= 0.5;
  }
  return sum;
}
float edges(vec2 p, float period) {
  p *= period;
  float first = 9.0, second = 9.0;
  for (int y = -1; y <= 1; y++)
    for (int x = -1; x <= 1; x++) {
      vec2 cell = floor(p) + vec2(x, y), at = mod(cell, period);
      vec2 seed = vec2(hash(at, 3.0), hash(at, 7.0));
      float d = length(cell + 0.15 + 0.7 * seed - p);
      if (d < first) { second = first; first = d; } else second = min(second, d);
    }
  return second - first;
}
void main() {
  vec2 p = gl_FragCoord.xy / size;
  color = vec4(octaves(p, 4.0, 6), octaves(p + 0.37, 16.0, 5), edges(p, 8.0), 1.0);
}`;

const camera = `
uniform vec2 size, shift;
uniform vec3 eye, right, up, forward;
uniform float tangent;
vec3 ray_of(vec2 at) {
  vec2 uv = (2.0 * at - size) / min(size.x, size.y) + shift;
  return normalize(forward + tangent * (uv.x * right + uv.y * up));
}
`;

const wall = `
const float pi = 3.14159265;
const float rim = 0.36, course = 0.32;  // height of the rim; of a row of stones
uniform sampler2D pattern;
`;

// Stone and ground. Outputs: in cool light from above, and in the lantern's warm light; alpha of
// the first: 0 is water; of the second: how much of what lies behind is covered.
export const stone = `${head}${camera}${wall}
layout(location = 0) out vec4 cool;
layout(location = 1) out vec4 warm;
const vec3 lantern = vec3(-1.75, 1.25, 1.5);
float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
float bumps(vec3 p) {
  return textureLod(pattern, p.xy * 0.35 + p.z * 0.21, 0.0).r
       + 0.5 * textureLod(pattern, p.yz * 0.6 + p.x * 0.33, 0.0).g;
}
// Distance to a ring of rounded stones; row 0 is the rim, which stands out.
float ring(vec3 p, float row) {
  float n = row == 0.0 ? 17.0 : 21.0;
  float angle = atan(p.y, p.x) / (2.0 * pi) * n + (mod(row, 2.0) == 0.0 ? 0.0 : 0.5);
  float stone = floor(angle), r = length(p.xy);
  float vary = hash(vec2(mod(stone, n), row));
  float half_length = pi * r / n - 0.012;
  float thick = row == 0.0 ? 0.2 : 0.15, middle = row == 0.0 ? 1.185 : 1.14;
  float high = row == 0.0 ? rim - 0.115 + 0.022 * (vary - 0.5) : rim - 0.06 - (row + 0.0) * course;
  float tall = row == 0.0 ? 0.115 : 0.5 * course - 0.012;
  vec3 q = vec3((angle - stone - 0.5) * 2.0 * pi * r / n, r - middle - 0.012 * (vary - 0.5),
                p.z - high);
  vec3 d = abs(q) - vec3(half_length, thick, tall) + 0.045;
  return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0) - 0.045;
}
float shape(vec3 p) {
  float row = max(0.0, ceil((rim - 0.06 - 0.5 * course - p.z) / course));
  float d = min(ring(p, 0.0), min(ring(p, max(row, 1.0)), ring(p, max(row, 1.0) + 1.0)));
  // Mortar behind the joints.
  float r = length(p.xy);
  d = min(d, max(max(1.03 - r, r - 1.25), p.z - rim + 0.13));
  return min(d - 0.02 * (bumps(p) - 0.7), p.z + 0.34);
}
vec3 normal_at(vec3 p, float e) {
  vec2 h = vec2(e, -e);
  return normalize(h.xyy * shape(p + h.xyy) + h.yyx * shape(p + h.yyx) + h.yxy * shape(p + h.yxy)
                   + h.xxx * shape(p + h.xxx));
}
float shadow(vec3 p, vec3 to, float far) {
  float t = 0.03, lit = 1.0;
  for (int i = 0; i < 40 && t < far; i++) {
    float d = shape(p + to * t);
    lit = min(lit, 9.0 * d / t);
    if (lit < 0.01) return 0.0;
    t += clamp(d, 0.012, 0.2);
  }
  return smoothstep(0.0, 1.0, lit);
}
float open_sky(vec3 p, vec3 n) {
  float sum = 0.0, weight = 1.0;
  for (int i = 1; i <= 5; i++) {
    float d = 0.06 * float(i * i);
    sum += weight * max(d - shape(p + n * d), 0.0) / d;
    weight *= 0.62;
  }
  return clamp(1.0 - 0.52 * sum, 0.0, 1.0);
}
void main() {
  vec3 ray = ray_of(gl_FragCoord.xy);
  float water = ray.z < 0.0 ? -eye.z / ray.z : 1e9;
  vec3 surface = eye + water * ray;
  float far = dot(surface.xy, surface.xy) < 1.0 ? water : 14.0, t = 0.6;
  bool hit = false;
  for (int i = 0; i < 110 && t < far; i++) {
    float d = shape(eye + ray * t);
    if (d < 0.0007 * t) { hit = true; break; }
    t += 0.85 * d;
  }
  if (!hit) {
    cool = vec4(0.0);
    warm = vec4(0.0, 0.0, 0.0, far < 14.0 ? 1.0 : 0.0);
    return;
  }
  vec3 p = eye + ray * t, n = normal_at(p, 0.0016 * t);
  bool ground = p.z < -0.33;
  float r = length(p.xy), stain = textureLod(pattern, p.xy * 0.21 + p.z * 0.3, 0.0).r;
  float grain = textureLod(pattern, p.xy * 1.1 + p.z, 0.0).g;
  vec3 albedo = mix(vec3(0.22, 0.20, 0.175), vec3(0.40, 0.37, 0.325), smoothstep(0.2, 0.8, grain));
  albedo *= 0.45 + 0.75 * stain;
  if (ground) {
    vec2 at = p.xy * 0.22 + 0.03 * stain;
    float joint = smoothstep(0.02, 0.22, textureLod(pattern, at, 0.0).b);
    float e = 0.004;
    vec2 slope = vec2(smoothstep(0.02, 0.3, textureLod(pattern, at + vec2(e, 0), 0.0).b)
                    - smoothstep(0.02, 0.3, textureLod(pattern, at - vec2(e, 0), 0.0).b),
                      smoothstep(0.02, 0.3, textureLod(pattern, at + vec2(0, e), 0.0).b)
                    - smoothstep(0.02, 0.3, textureLod(pattern, at - vec2(0, e), 0.0).b));
    n = normalize(vec3(-1.6 * slope, 1.0));
    albedo = mix(vec3(0.07, 0.065, 0.05), vec3(0.25, 0.235, 0.21) * (0.7 + 0.6 * grain), joint);
  } else {
    // Damp and moss near the water, and in the shade of the joints.
    float damp = r < 1.08 ? smoothstep(0.32, 0.02, p.z) : 0.0;
    float moss = smoothstep(0.52, 0.72, stain + 0.25 * grain)
        * (0.25 + 0.75 * smoothstep(0.4, -0.3, p.z));
    albedo = mix(albedo, vec3(0.13, 0.17, 0.07) * (0.6 + grain), 0.75 * moss);
    albedo *= 1.0 - 0.55 * damp;
  }
  float sky = open_sky(p, n), up_facing = 0.5 + 0.5 * n.z;
  if (r < 1.02) sky *= 0.35 + 0.65 * smoothstep(-0.3, rim, p.z);
  vec3 moon = normalize(vec3(0.5, 0.35, 0.9));
  float direct = max(dot(n, moon), 0.0);
  if (direct > 0.0) direct *= shadow(p + 0.01 * n, moon, 3.0);
  vec3 to = lantern - p;
  float away = length(to), glow = max(dot(n, to / away), 0.0) / (0.25 + away * away);
  if (glow > 0.0) glow *= shadow(p + 0.01 * n, to / away, away);
  float edge = ground ? smoothstep(3.6, 1.5, r) : 1.0;
  cool = vec4(sqrt(albedo * (sky * up_facing * vec3(0.30, 0.36, 0.50)
      + direct * vec3(0.42, 0.47, 0.58))), 1.0);
  warm = vec4(sqrt(albedo * (5.0 * glow + 0.06 * sky) * vec3(1.0, 0.62, 0.28)), edge);
}`;

// The picture: stone from its two lights, and the water.
export const picture = `${head}${camera}${wall}
uniform sampler2D cool_stone, warm_stone, heights;
uniform float time, cool_light, warm_light, glimmer, stirred, book_height, book_open;
uniform vec4 drop;  // place and radius; 0: there is none
out vec4 color;
const vec3 lantern = vec3(-1.75, 1.25, 1.5);
// Height, slopes and curvature of the surface.
vec4 surface_at(vec2 p) { return texture(heights, 0.5 * p + 0.5); }
// How strongly the surface gathers light below p: its curvature, made deeper by fine ripples.
float caustic(vec2 p) {
  float bent = surface_at(p).w;
  vec2 q = 0.16 * p;
  float a = textureLod(pattern, q + vec2(0.011, 0.007) * time, 1.0).b;
  float b = textureLod(pattern, q * 1.31 - vec2(0.008, 0.012) * time, 1.0).b;
  float net = pow(1.0 - min(a + b, 1.0), 5.0) * stirred;
  return clamp(1.0 - 0.5 * bent + 2.2 * net, 0.25, 4.0);
}
vec3 sky(vec3 d) {
  float high = max(d.z, 0.0), around = atan(d.y, d.x) / (2.0 * pi);
  vec3 light = mix(vec3(0.95, 0.62, 0.44), vec3(0.34, 0.46, 0.78), smoothstep(0.0, 0.6, high));
  light = mix(light, vec3(0.13, 0.22, 0.47), smoothstep(0.5, 1.0, high));
  vec2 at = d.xy / (0.25 + high);
  float cloud = smoothstep(0.42, 0.66, textureLod(pattern, at * 0.28 + 0.002 * time, 0.0).r);
  light += cloud * mix(vec3(0.90, 0.66, 0.54), vec3(0.80, 0.86, 0.98),
      smoothstep(0.2, 0.8, high));
  vec2 grid = floor(at * 46.0);
  float star = fract(sin(dot(grid, vec2(127.1, 311.7))) * 43758.5453);
  vec2 in_cell = fract(at * 46.0) - 0.5;
  light += vec3(0.8, 0.86, 1.0) * smoothstep(0.985, 1.0, star) * (1.0 - cloud)
      * smoothstep(0.16, 0.0, dot(in_cell, in_cell)) * (0.7 + 0.3 * sin(time + 40.0 * star));
  // The castle's walls around the court, with lit windows.
  float merlon = step(0.5, fract(around * 46.0));
  float tower = smoothstep(0.018, 0.016, abs(fract(around * 3.0 + 0.3) - 0.5) / 3.0);
  float wall_top = 0.30 + 0.028 * merlon + 0.16 * tower;
  if (high < wall_top) {
    vec2 w = vec2(fract(around * 36.0), high * 11.0);
    float lit = step(0.62, fract(sin(floor(around * 36.0) * 12.9 + floor(w.y) * 4.1) * 951.1));
    float pane = step(0.42, w.x) * step(w.x, 0.58) * step(0.35, fract(w.y)) * step(fract(w.y), 0.7)
        * lit * step(0.12, high) * step(high, 0.27);
    light = vec3(0.028, 0.026, 0.03) + pane * warm_light * vec3(1.5, 0.8, 0.3);
  }
  return light * cool_light;
}
vec3 shaft(vec3 p) {
  float around = atan(p.y, p.x) / (2.0 * pi), row = floor((rim - 0.23 - p.z) / course);
  vec2 at = vec2(fract(around * 21.0 + 0.5 * mod(row, 2.0)), fract((rim - 0.23 - p.z) / course));
  float joint = smoothstep(0.0, 0.07, min(at.x, 1.0 - at.x) * 0.9)
      * smoothstep(0.0, 0.08, min(at.y, 1.0 - at.y));
  vec2 uv = vec2(around * 3.0, p.z * 0.5);
  float stain = textureLod(pattern, uv, 0.0).r, grain = textureLod(pattern, uv * 3.0, 0.0).g;
  vec3 albedo = mix(vec3(0.14, 0.15, 0.10), vec3(0.40, 0.40, 0.34), grain) * (0.5 + 0.9 * stain);
  return albedo * mix(0.25, 1.0, joint);
}
const vec3 thickness = vec3(0.31, 0.43, 0.065);
// The book in its own coordinates: turned, lying on its back.
void to_book(inout vec3 p, inout vec3 d, out mat3 turn) {
  float a = 0.22 + 0.05 * sin(0.31 * time), b = 0.07 * sin(0.43 * time);
  turn = mat3(cos(a), sin(a), 0.0, -sin(a), cos(a), 0.0, 0.0, 0.0, 1.0)
      * mat3(1.0, 0.0, 0.0, 0.0, cos(b), sin(b), 0.0, -sin(b), cos(b));
  p = (p - vec3(0.0, 0.16, book_height + 0.02 * sin(0.7 * time))) * turn;
  d = d * turn;
}
// Where a ray meets the book; color and glow are given back, negative: it does not.
float meet_book(vec3 p, vec3 d, out vec3 albedo, out vec3 normal, out float gold) {
  mat3 turn;
  to_book(p, d, turn);
  vec3 m = 1.0 / d, n = m * p, k = abs(m) * thickness;
  vec3 near = -n - k, far = -n + k;
  float t = max(max(near.x, near.y), near.z), leave = min(min(far.x, far.y), far.z);
  if (t > leave || leave < 0.0) return -1.0;
  vec3 face = -sign(d) * step(near.yzx, near.xyz) * step(near.zxy, near.xyz);
  vec3 q = p + t * d;
  gold = 0.0;
  if (abs(face.z) > 0.5) {
    vec2 u = q.xy / thickness.xy, border = thickness.xy - abs(q.xy);
    float grain = textureLod(pattern, q.xy * 1.2, 0.0).g;
    albedo = vec3(0.34, 0.085, 0.06) * (0.5 + grain);
    float inset = min(border.x, border.y);
    gold = smoothstep(0.006, 0.0, abs(inset - 0.045) - 0.006)
         + smoothstep(0.004, 0.0, abs(inset - 0.062) - 0.002);
    float r = length(q.xy - vec2(0.0, 0.02));
    gold += smoothstep(0.004, 0.0, abs(r - 0.155) - 0.006);
    // The sign of the well: a drop that stands on waves.
    vec2 s = q.xy - vec2(0.0, 0.02);
    float waist = 0.062 * sqrt(clamp((0.1 - s.y) / 0.14, 0.0, 1.0))
        * smoothstep(0.125, -0.03, s.y);
    gold += smoothstep(0.004, 0.0, abs(s.x) - waist) * step(-0.05, s.y) * step(s.y, 0.12);
    gold += smoothstep(0.004, 0.0, abs(s.y + 0.085 - 0.011 * sin(s.x * 75.0)) - 0.004)
        * step(abs(s.x), 0.1);
    vec2 corner = thickness.xy - abs(q.xy);
    gold += smoothstep(0.004, 0.0, corner.x + corner.y - 0.085) * 0.8;
    gold = clamp(gold, 0.0, 1.0);
    float spine = smoothstep(0.05, 0.0, abs(q.x + thickness.x - 0.035) - 0.004);
    albedo *= 1.0 - 0.35 * spine;
  } else if (face.x < -0.5) {
    albedo = vec3(0.3, 0.08, 0.055);
    gold = smoothstep(0.01, 0.0, abs(fract(q.y * 7.0) - 0.5) - 0.06) * 0.7;
  } else {
    albedo = vec3(0.72, 0.62, 0.42) * (0.75 + 0.3 * step(0.5, fract(q.z * 95.0)));
  }
  albedo = mix(albedo, vec3(0.95, 0.68, 0.24), gold);
  normal = turn * face;
  return t;
}
// What is seen under the water, from p on its surface in direction d.
vec3 below(vec3 p, vec3 d) {
  float b = dot(p.xy, d.xy), a = max(dot(d.xy, d.xy), 1e-5);
  float t = (-b + sqrt(max(b * b - a * (dot(p.xy, p.xy) - 1.0), 0.0))) / a;
  t = min(t, -2.6 / d.z);
  vec3 at = p + t * d, surface = shaft(at) * smoothstep(-2.5, -1.6, at.z);
  vec3 normal = vec3(-at.xy, 0.0);
  float gold = 0.0;
  bool book = false;
  if (glimmer > 0.001) {
    vec3 albedo, n;
    float g, hit = meet_book(p, d, albedo, n, g);
    if (hit > 0.0 && hit < t) {
      t = hit, at = p + t * d, surface = albedo, normal = n, gold = g, book = true;
    }
  }
  float down = -at.z, from_above = 0.35 + 0.65 * max(normal.z, 0.0);
  vec3 sun = vec3(0.55, 0.66, 0.72) * exp(-0.55 * down) * cool_light;
  float net = caustic(at.xy * (book ? 1.0 : 0.93));
  vec3 lit = surface * (sun * (0.45 + 0.8 * net * from_above)
      + warm_light * vec3(0.55, 0.32, 0.13) * exp(-1.1 * down) * net);
  // The book shines by itself, and on the walls around it.
  float breath = 0.75 + 0.25 * sin(1.7 * time);
  lit += glimmer * breath * (book ? vec3(0.85, 0.55, 0.16) * (1.1 * gold + 0.10)
      : surface * vec3(1.0, 0.66, 0.25) * 0.5 / (0.3 + dot(at - vec3(0, 0, book_height),
                                                          at - vec3(0, 0, book_height))));
  vec3 clear = exp(-t * vec3(1.15, 0.48, 0.42));
  vec3 haze = vec3(0.010, 0.050, 0.058) * cool_light * exp(-0.5 * down)
      + glimmer * breath * vec3(0.10, 0.075, 0.02) * exp(-2.2 * dot(at.xy, at.xy));
  return lit * clear + haze * (1.0 - clear);
}
vec3 water(vec3 p, vec3 ray) {
  vec2 q = p.xy * 0.33;
  vec2 fine = vec2(textureLod(pattern, q + vec2(0.013, 0.019) * time, 1.0).r
      - textureLod(pattern, q * 1.2 - vec2(0.017, 0.009) * time, 1.0).r,
      textureLod(pattern, q.yx + vec2(0.021, 0.011) * time, 1.0).r
      - textureLod(pattern, q.yx * 1.2 - vec2(0.011, 0.023) * time, 1.0).r);
  vec3 n = normalize(vec3(-surface_at(p.xy).yz - (0.015 + 0.05 * stirred) * fine, 1.0));
  float facing = max(dot(-ray, n), 0.0);
  // More than water's own, so that the sky is seen from above too.
  float fresnel = 0.20 + 0.80 * pow(1.0 - facing, 4.0);
  vec3 back = reflect(ray, n);
  back.z = max(back.z, 0.02);
  back = normalize(back);
  float b = dot(p.xy, back.xy), a = max(dot(back.xy, back.xy), 1e-5);
  float t = (-b + sqrt(max(b * b - a * (dot(p.xy, p.xy) - 1.0), 0.0))) / a;
  vec3 mirrored;
  if (t * back.z < rim) {
    vec3 at = p + t * back;
    float open = 0.3 + 0.7 * at.z / rim;
    vec3 to = lantern - at;
    mirrored = shaft(at) * (vec3(0.30, 0.35, 0.44) * cool_light * open
        + warm_light * vec3(1.7, 1.0, 0.42) * max(dot(vec3(-at.xy, 0.0), normalize(to)), 0.0)
          / (0.3 + dot(to, to)));
  } else mirrored = sky(back);
  float glint = dot(back, normalize(lantern - p));
  mirrored += warm_light * vec3(1.0, 0.62, 0.26)
      * (9.0 * pow(max(glint, 0.0), 1800.0) + 0.35 * pow(max(glint, 0.0), 60.0));
  float moon = dot(back, normalize(vec3(0.30, 0.42, 0.86)));
  mirrored += cool_light * vec3(0.9, 0.95, 1.0)
      * (smoothstep(0.9975, 0.9982, moon) * 5.0 + 0.25 * pow(max(moon, 0.0), 90.0));
  // Near the rim the stone shades the water.
  float shade = 0.45 + 0.55 * smoothstep(1.0, 0.86, length(p.xy));
  return mix(below(p, refract(ray, n, 0.752)), mirrored, fresnel) * shade;
}
vec3 tone(vec3 c) {
  c *= 1.15;
  return clamp((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
}
void main() {
  vec3 ray = ray_of(gl_FragCoord.xy);
  vec4 cool = texture(cool_stone, gl_FragCoord.xy / size);
  vec4 warm = texture(warm_stone, gl_FragCoord.xy / size);
  vec3 light = vec3(0.0);
  float cover = warm.a;
  bool seen_dry = cool.a > 0.5;
  if (seen_dry) light = cool.rgb * cool.rgb * cool_light + warm.rgb * warm.rgb * warm_light;
  else if (cover > 0.5) light = water(eye - ray * eye.z / ray.z, ray);
  if (glimmer > 0.001 && book_height > -0.08) {  // above the water
    vec3 albedo, n;
    float gold, t = meet_book(eye, ray, albedo, n, gold);
    vec3 at = eye + t * ray;
    if (t > 0.0 && at.z > 0.0) {
      vec3 to = lantern - at;
      light = albedo * (vec3(0.42, 0.48, 0.6) * (0.5 + 0.5 * n.z) * cool_light + warm_light * 2.4
          * vec3(1.0, 0.62, 0.28) * max(dot(n, normalize(to)), 0.15) / (0.25 + dot(to, to)));
      light += glimmer * gold * vec3(0.7, 0.45, 0.14);
      cover = 1.0;
    }
  }
  if (drop.w > 0.0) {
    vec3 from = eye - drop.xyz;
    float b = dot(from, ray), h = b * b - dot(from, from) + drop.w * drop.w;
    if (h > 0.0) {
      vec3 n = normalize(from + (-b - sqrt(h)) * ray);
      float fresnel = 0.03 + 0.97 * pow(1.0 - max(dot(-ray, n), 0.0), 5.0);
      vec3 through = refract(ray, n, 0.752);
      vec3 back = reflect(ray, n);
      vec3 shown = mix(sky(normalize(vec3(through.xy, abs(through.z)))) * 0.8,
                       sky(normalize(vec3(back.xy, abs(back.z)))) * 1.4, fresnel);
      float moon = max(dot(back, normalize(vec3(0.5, 0.35, 0.9))), 0.0);
      float lamp = max(dot(back, normalize(lantern - drop.xyz)), 0.0);
      shown += 3.0 * (cool_light * vec3(0.9, 0.95, 1.0) * pow(moon, 120.0)
                      + warm_light * vec3(1.0, 0.6, 0.25) * pow(lamp, 90.0));
      light = mix(light, shown, 0.85);
      cover = 1.0;
    }
  }
  light = mix(light, light * 0.25, book_open);
  vec3 shown = pow(tone(light), vec3(1.0 / 2.2));
  shown += (fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5) / 255.0;
  color = vec4(shown * cover, cover);
}`;
