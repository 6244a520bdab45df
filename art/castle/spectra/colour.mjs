// SPDX-License-Identifier: Apache-2.0
// Colours of spectra: the standard observer, lamps, CIE Lab and CIEDE2000. Spectra are lists of
// values at NM.
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const tables = join(dirname(fileURLToPath(import.meta.url)), '../../../server/spectrum/tables');
export const NM = Array.from({ length: 81 }, (_, i) => 380 + 5 * i);
const rows = (name) => readFileSync(join(tables, name), 'utf8').trim().split('\n')
    .filter((line) => /^\d/.test(line)).map((line) => line.split(',').map(Number));

// Returns the value of a table of [nm, values ...] at a wavelength; beyond its ends it is the last.
export function between(table, nm, column = 1) {
  const next = table.findIndex(([at]) => at >= nm);
  if (next < 0) return table[table.length - 1][column];
  if (next === 0) return table[0][column];
  const [low, high] = [table[next - 1], table[next]];
  return low[column] + (high[column] - low[column]) * (nm - low[0]) / (high[0] - low[0]);
}
const sampled = (table, column) => NM.map((nm) => between(table, nm, column));
const observer = rows('cie_1931_2deg.csv'), basis = rows('daylight.csv');
const MATCHING = [1, 2, 3].map((column) => sampled(observer, column));
const S = [1, 2, 3].map((column) => sampled(basis, column));

// Planck's law.
export const blackbody = (kelvin) => {
  const power = (nm) => nm ** -5 / Math.expm1(1.438776877e7 / (nm * kelvin));
  return NM.map((nm) => power(nm) / power(560));
};
// Daylight by its components (CIE 15:2018, 4.1.2).
export function daylight(kelvin) {
  const t = 1000 / kelvin;
  const x = kelvin <= 7000 ? 0.244063 + 0.09911 * t + 2.9678 * t ** 2 - 4.607 * t ** 3
    : 0.23704 + 0.24748 * t + 1.9018 * t ** 2 - 2.0064 * t ** 3;
  const y = -3 * x ** 2 + 2.87 * x - 0.275, m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m, m2 = (0.03 - 31.4424 * x + 30.0717 * y) / m;
  return NM.map((_, i) => (S[0][i] + m1 * S[1][i] + m2 * S[2][i]) / 100);
}
export const LAMPS = { D65: daylight(6504), 'north-light': daylight(7500 * 1.4388 / 1.438),
  candle: blackbody(1930), 'bulb-1900': blackbody(2100), A: blackbody(2856) };

// X, Y, Z of a reflectance or transmittance; Y of white is 1.
export function xyz(spectrum, lamp) {
  const sum = (weights, values) =>
    weights.reduce((all, w, i) => all + w * lamp[i] * (values ? values[i] : 1), 0);
  const white = sum(MATCHING[1]);
  return MATCHING.map((weights) => sum(weights, spectrum) / white);
}
export function lab(spectrum, lamp) {
  const white = xyz(NM.map(() => 1), lamp);
  const [x, y, z] = xyz(spectrum, lamp).map((value, k) => value / white[k])
      .map((t) => t > 216 / 24389 ? Math.cbrt(t) : (24389 / 27 * t + 16) / 116);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
// Linear Rec. 709 of what is seen in daylight; negative where the colour is outside.
export function rgb(spectrum, lamp = LAMPS.D65) {
  const [x, y, z] = xyz(spectrum, lamp);
  return [3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
    -0.969266 * x + 1.8760108 * y + 0.041556 * z, 0.0556434 * x - 0.2040259 * y + 1.0572252 * z];
}

// CIEDE2000 (Sharma, Wu, Dalal 2005).
export function difference([L1, a1, b1], [L2, a2, b2]) {
  const degrees = 180 / Math.PI, mean = (Math.hypot(a1, b1) + Math.hypot(a2, b2)) / 2;
  const g = 0.5 * (1 - Math.sqrt(mean ** 7 / (mean ** 7 + 25 ** 7)));
  const [p1, p2] = [a1 * (1 + g), a2 * (1 + g)];
  const [c1, c2] = [Math.hypot(p1, b1), Math.hypot(p2, b2)];
  const hue = (a, b) => (a || b ? (Math.atan2(b, a) * degrees + 360) % 360 : 0);
  const [h1, h2] = [hue(p1, b1), hue(p2, b2)];
  let dh = h2 - h1;
  if (c1 * c2 === 0) dh = 0;
  else if (dh > 180) dh -= 360;
  else if (dh < -180) dh += 360;
  const dH = 2 * Math.sqrt(c1 * c2) * Math.sin(dh / 2 / degrees);
  const L = (L1 + L2) / 2, C = (c1 + c2) / 2;
  let H = h1 + h2;
  if (c1 * c2 !== 0) H = (Math.abs(h1 - h2) <= 180 ? H : H < 360 ? H + 360 : H - 360) / 2;
  const cos = (angle) => Math.cos(angle / degrees);
  const T = 1 - 0.17 * cos(H - 30) + 0.24 * cos(2 * H) + 0.32 * cos(3 * H + 6) -
      0.2 * cos(4 * H - 63);
  const sl = 1 + 0.015 * (L - 50) ** 2 / Math.sqrt(20 + (L - 50) ** 2);
  const sc = 1 + 0.045 * C, sh = 1 + 0.015 * C * T;
  const turn = -2 * Math.sqrt(C ** 7 / (C ** 7 + 25 ** 7)) *
      Math.sin(60 * Math.exp(-(((H - 275) / 25) ** 2)) / degrees);
  const [l, c, h] = [(L2 - L1) / sl, (c2 - c1) / sc, dH / sh];
  return Math.sqrt(l * l + c * c + h * h + turn * c * h);
}
