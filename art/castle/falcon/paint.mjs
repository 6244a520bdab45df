// SPDX-License-Identifier: Apache-2.0
// The colours of the outer face: dyed and plain linen, gilded studs, the painted head and collar.
import { clamp, mix, noise, smoothstep } from './field.mjs';
import { bib, EYE, lozenge, outside, STEPS } from './outside.mjs';
import { crack } from './repair.mjs';

const hex = (text) => [0, 2, 4].map((i) => parseInt(text.slice(i, i + 2), 16));
const PLAIN = hex('c3a878'), DYED = hex('5b3a26'), PALE = hex('d2bc90'), RUST = hex('8a4a2b');
const GOLD = hex('c99a3e'), BLUE = hex('24406b'), GREEN = hex('3f7a6c'), RED = hex('9c3526');
const CREAM = hex('ddc79a'), BLACK = hex('211a17'), HORN = hex('4b5358'), CERE = hex('c9962f');
const over = (a, b, t) => a.map((c, i) => mix(c, b[i], t));
const band = (x, low, high, soft = 0.3) =>
  smoothstep(low - soft, low + soft, x) * (1 - smoothstep(high - soft, high + soft, x));

function linen(x, y, z, angle) {
  const { rim, over: upper } = lozenge(x, y, z, angle);
  const tones = [GOLD, DYED, PALE, RUST, PLAIN, DYED];
  let tone = tones[0];
  const edges = [0.125, ...STEPS];
  for (const [i, edge] of edges.entries())
    tone = over(tone, tones[i + 1], smoothstep(edge - 0.01, edge + 0.01, rim));
  // A strip's fold is dark below its edge.
  let fold = 0;
  for (const edge of edges) fold = Math.max(fold, Math.exp(-(((rim - edge + 0.014) / 0.02) ** 2)));
  tone = over(tone, DYED.map((c) => 0.5 * c), 0.55 * fold);
  if (y < 37.5) {
    const wave = y + 0.8 * Math.sin(2 * angle);
    tone = over(PLAIN, DYED, band(wave, 20, 28.5));
    tone = over(tone, PALE, band(wave, 2, 12));
    for (const edge of [1.5, 12, 20, 29, 37])
      tone = over(tone, DYED.map((c) => 0.55 * c), 0.6 * Math.exp(-(((wave - edge) / 0.7) ** 2)));
  }
  const warp = Math.sin(2.6 * y + (upper ? 1 : -1) * 90 * angle);
  const weft = Math.sin(2.6 * y - (upper ? 1 : -1) * 90 * angle);
  const weave = 1 + 0.045 * warp * weft + 0.05 * noise(x / 0.9, y / 4, z / 0.9);
  return tone.map((c) => c * weave);
}

function collar(y, angle, edge) {
  const row = (y - edge) / 4.6, number = Math.floor(row), within = row - number;
  let tone = [GOLD, BLUE, RED, GREEN, GOLD, BLUE, GREEN, RED][clamp(number, 0, 7)];
  const bead = 46 * angle / (2 * Math.PI) + 0.5 * (number % 2);
  const local = bead - Math.floor(bead) - 0.5;
  if (number === 1 || number === 6)  // drops
    tone = over(CREAM, tone,
        smoothstep(0.05, -0.05, Math.hypot(local * 1.6, within - 0.45) - 0.42));
  else if (number % 2) tone = over(tone, CREAM, smoothstep(0.36, 0.42, Math.abs(local)));
  return over(tone, BLACK,
      0.7 * Math.max(smoothstep(0.07, 0.02, within), smoothstep(0.95, 0.99, within)));
}

function face(x, y, z, angle) {
  const side = Math.abs(x);
  // The wig: blue with golden stripes behind and over the head, two lappets in front.
  const stripe = Math.abs(((z > 0 && y < 345 ? side * 0.9 : y + 0.25 * z) / 7.5) % 1);
  let tone = over(BLUE, GOLD, band(Math.abs(stripe - 0.5), -1, 0.16, 0.03));
  if (z > 0 && y < 330) {
    const edge = Math.abs(Math.abs(side - 27.5) - 10.8);
    tone = over(tone, GOLD, smoothstep(1.3, 0.8, edge));
    const barred = over(CREAM, RUST, 0.4 * smoothstep(0.2, 0.6, Math.sin(1.3 * y + 0.6 * side)));
    tone = over(barred, tone, smoothstep(16, 16.4, side));
  }
  const front = z - 0.0125 * (y - 352) ** 2 * (y > 352 ? 0.45 : 0.1) - 9;
  const mask = smoothstep(-0.5, 0.5, front) * smoothstep(318, 320, y) * smoothstep(404, 401, y);
  if (mask > 0) {
    let skin = over(CREAM, GOLD, 0.35 + 0.2 * noise(x / 9, y / 9, z / 9));
    const barred = Math.sin(y * 1.3 + 1.2 * Math.sin(side * 0.5));
    skin = over(skin, RUST, 0.35 * smoothstep(0.2, 0.6, barred) * smoothstep(340, 330, y));
    const dx = (Math.atan2(side, z) - Math.atan2(EYE[0], EYE[2])) * 42, dy = y - EYE[1];
    const eye = Math.hypot(dx, dy * 1.12);
    // The falcon's dark moustache, and the line behind its eye.
    const drop = Math.abs(dx + 1.5 + 0.12 * dy) - 4.5 - 0.05 * dy;
    skin = over(skin, BLACK, smoothstep(0.6, -0.4, drop) * band(dy, -34, 0, 1));
    skin = over(skin, BLACK, smoothstep(0.5, -0.4, Math.abs(dy + 0.12 * dx) - 2 + 0.05 * dx)
        * band(dx, 0, 24));
    skin = over(skin, BLACK, smoothstep(0.4, -0.4, Math.abs(dy - 13 + 0.18 * Math.abs(dx)) - 1.6)
        * band(dx, -13, 20));
    skin = over(skin, BLACK, smoothstep(0.4, -0.4, eye - 9.6));
    skin = over(skin, hex('efe6cf'), smoothstep(0.4, -0.4, Math.hypot(dx, dy * 1.5) - 8));
    skin = over(skin, hex('5a2d16'), smoothstep(0.4, -0.4, eye - 5.8));
    skin = over(skin, BLACK, smoothstep(0.4, -0.4, eye - 3.3));
    const rim = Math.exp(-((front / 0.9) ** 2));
    tone = over(over(tone, skin, mask), GOLD, 0.9 * rim);
    const bill = smoothstep(43.5, 44.5, z + 0.10 * side) * smoothstep(13.5, 12.5, side)
      * band(y, 322, 369);
    let horn = over(CERE, HORN, smoothstep(49, 50, z - 0.4 * (y - 356)));
    horn = over(horn, BLACK, smoothstep(345, 330, y) * smoothstep(52, 56, z));
    horn = over(horn, BLACK, smoothstep(0.4, -0.3, Math.hypot(side - 7, y - 361, (z - 48)) - 1.7));
    tone = over(tone, horn, bill);
    const gape = y - 345 + 0.012 * x * x;
    tone = over(tone, BLACK, 0.85 * Math.exp(-((gape / 0.8) ** 2)) * band(z, 31, 58, 2));
  }
  return tone;
}

// The colour at a place on the outer face, 0 to 255.
export function paint(x, y, z) {
  const angle = Math.atan2(x, z), edge = bib(angle);
  if (y < 0.6) return PLAIN.map((c) => 0.8 * c);
  let tone;
  if (y < edge - 0.6) tone = linen(x, y, z, angle);
  else {
    const lappet = band(Math.abs(x), 17, 38, 0.4) * (z > 0 ? 1 : 0);
    tone = y < edge + 36.8 && !(lappet > 0.5 && y > edge + 14) ? collar(y, angle, edge)
      : face(x, y, z, angle);
    const { line } = crack(x, y, z);
    tone = over(tone, hex('3a2a1c'), 0.85 * line);
    const worn = smoothstep(0.42, 0.62, noise(x / 5, y / 5, z / 5) + 0.35 * noise(x, y, z));
    tone = over(tone, CREAM, 0.75 * worn);
    tone = tone.map((c) => c * (1 + 0.05 * noise(x / 1.2, y / 1.2, z / 1.2)));
  }
  const dirt = 0.9 + 0.13 * noise(x / 24, y / 30, z / 24) - 0.12 * smoothstep(60, 0, y);
  return tone.map((c) => clamp(c * dirt, 0, 255));
}

// The picture's lower part winds about the upright axis, its upper part is the crown of the head.
const CAP = 372, BREAK = 0.845;
export function place_uv([x, y, z]) {
  const u = Math.atan2(x, z) / (2 * Math.PI) + 0.5;
  const v = y < CAP ? BREAK * Math.max(0, y) / CAP
    : BREAK + (1 - BREAK) * Math.atan2(y - CAP, Math.hypot(x, z)) / (Math.PI / 2);
  return [u, 1 - v];
}

// The outermost place of the face on the ray that belongs to a place of the picture.
function trace(u, v) {
  const angle = (u - 0.5) * 2 * Math.PI, height = 1 - v;
  const rise = height < BREAK ? 0 : (height - BREAK) / (1 - BREAK) * Math.PI / 2;
  const low = height < BREAK ? height / BREAK * CAP : CAP;
  const at = (r) => [r * Math.cos(rise) * Math.sin(angle), low + r * Math.sin(rise),
    r * Math.cos(rise) * Math.cos(angle)];
  let far = Math.abs(angle) < 0.45 && height > 0.7 ? 80 : 70, near = far;
  while (near > 2) {
    const d = outside(...at(near));
    if (d < 0) break;
    far = near;
    near -= Math.max(0.4, 0.6 * d);
  }
  for (let i = 0; i < 9; i++) {
    const middle = (near + far) / 2;
    if (outside(...at(middle)) < 0) near = middle;
    else far = middle;
  }
  return at(near);
}

export function make_picture(width, height) {
  const pixels = Buffer.alloc(width * height * 3);
  for (let j = 0; j < height; j++)
    for (let i = 0; i < width; i++) {
      const place = trace((i + 0.5) / width, (j + 0.5) / height);
      const tone = paint(...place);
      for (let k = 0; k < 3; k++) pixels[3 * (j * width + i) + k] = Math.round(tone[k] / 4) * 4;
    }
  return pixels;
}
