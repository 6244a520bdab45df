// SPDX-License-Identifier: Apache-2.0
// The painter's palette: rows of mixtures from dark to light, or from the zenith to the horizon,
// each mixed of old pigments. The last row was mixed by a later hand, of cobalt blue and viridian
// where the first took indigo: it matches the sky by day and by no other light.
import { LAMPS, NM, difference, lab, xyz } from '../spectra/colour.mjs';
import { mix_pigments } from '../spectra/pigments.mjs';

export const BANDS = Array.from({ length: 31 }, (_, i) => 400 + 10 * i);
const STEPS = 20;

const rows = {
  sky: [
    { 'indigo': 1.8, 'lead white': 0.9, 'ultramarine': 0.25 },
    { 'indigo': 1.3, 'lead white': 1.5, 'ultramarine': 0.2 },
    { 'indigo': 0.9, 'lead white': 2, 'madder lake': 0.06 },
    { 'indigo': 0.5, 'lead white': 2.4, 'madder lake': 0.05 },
    { 'azurite': 0.35, 'lead white': 3, 'lead-tin yellow I': 0.25 },
    { 'lead white': 3, 'lead-tin yellow I': 1, 'vermilion': 0.05 },
    { 'lead white': 2, 'lead-tin yellow II': 1.6, 'vermilion': 0.22 },
    { 'lead white': 1, 'lead-tin yellow II': 1.2, 'red lead': 0.6, 'vermilion': 0.3 },
  ],
  cloud: [
    { 'azurite': 0.9, 'ultramarine': 0.5, 'madder lake': 1.6, 'lead white': 0.35 },
    { 'azurite': 0.4, 'madder lake': 2, 'lead white': 0.9, 'vermilion': 0.1 },
    { 'madder lake': 1, 'lead white': 1.2, 'vermilion': 0.5, 'red lead': 0.3 },
    { 'lead white': 2, 'lead-tin yellow II': 1, 'vermilion': 0.25 },
    { 'lead white': 3, 'lead-tin yellow I': 0.6 },
  ],
  far: [
    { 'indigo': 1.2, 'lead white': 0.8, 'madder lake': 0.5, 'azurite': 0.3 },
    { 'indigo': 0.7, 'lead white': 1.2, 'madder lake': 0.7, 'azurite': 0.3 },
    { 'indigo': 0.25, 'madder lake': 1, 'lead white': 1.6, 'vermilion': 0.12 },
  ],
  hill: [
    { 'azurite': 0.7, 'green earth': 1, 'bone black': 0.4, 'madder lake': 0.3 },
    { 'azurite': 0.6, 'green earth': 1.2, 'lead white': 0.18, 'madder lake': 0.2 },
    { 'green earth': 1, 'malachite': 0.6, 'yellow ochre': 0.35, 'lead white': 0.2 },
    { 'yellow ochre': 0.9, 'malachite': 0.4, 'lead-tin yellow II': 0.3, 'red ochre': 0.15 },
  ],
  wood: [
    { 'bone black': 1, 'burnt umber': 1, 'verdigris': 0.5, 'indigo': 0.5 },
    { 'burnt umber': 1, 'green earth': 1, 'verdigris': 0.6, 'azurite': 0.3 },
    { 'green earth': 1, 'malachite': 0.6, 'raw sienna': 0.6 },
    { 'malachite': 0.6, 'yellow ochre': 0.8, 'lead-tin yellow II': 0.4, 'red ochre': 0.1 },
  ],
  meadow: [
    { 'bone black': 0.7, 'burnt umber': 1, 'green earth': 1, 'verdigris': 0.3 },
    { 'raw umber': 0.7, 'green earth': 1.2, 'malachite': 0.4 },
    { 'green earth': 1, 'malachite': 0.9, 'raw sienna': 0.4 },
    { 'malachite': 1, 'yellow ochre': 0.6, 'lead-tin yellow I': 0.3 },
    { 'yellow ochre': 0.8, 'lead-tin yellow II': 0.7, 'malachite': 0.4 },
  ],
  stone: [
    { 'bone black': 1, 'burnt umber': 0.8, 'ultramarine': 0.4 },
    { 'bone black': 0.5, 'raw umber': 1, 'azurite': 0.6, 'lead white': 0.15 },
    { 'raw umber': 0.7, 'lead white': 0.6, 'azurite': 0.35, 'red ochre': 0.1 },
    { 'lead white': 1.4, 'yellow ochre': 0.5, 'red ochre': 0.25, 'raw umber': 0.2 },
    { 'lead white': 2, 'lead-tin yellow II': 0.7, 'red lead': 0.25 },
  ],
  water: [
    { 'indigo': 1.4, 'bone black': 0.5, 'verdigris': 0.3, 'burnt umber': 0.3 },
    { 'indigo': 1.3, 'lead white': 0.5, 'azurite': 0.4 },
    { 'indigo': 0.7, 'lead white': 1.5, 'azurite': 0.3 },
    { 'indigo': 0.15, 'lead white': 2, 'madder lake': 0.4, 'vermilion': 0.06 },
    { 'lead white': 2, 'lead-tin yellow II': 0.9, 'vermilion': 0.25 },
    { 'lead white': 3, 'lead-tin yellow I': 0.5 },
  ],
  falcon: [
    { 'bone black': 1, 'burnt umber': 1.2, 'indigo': 0.2 },
    { 'burnt umber': 1.2, 'burnt sienna': 0.8, 'bone black': 0.2 },
    { 'burnt sienna': 1, 'raw sienna': 0.7, 'red ochre': 0.3 },
    { 'raw sienna': 1, 'lead white': 0.45, 'red ochre': 0.15 },
    { 'lead white': 1.6, 'yellow ochre': 0.5, 'red lead': 0.12 },
    { 'lead white': 3, 'lead-tin yellow I': 0.3 },
  ],
};

const blend = (one, two, t) => Object.fromEntries([...Object.keys(one), ...Object.keys(two)]
    .map((name) => [name, (one[name] ?? 0) * (1 - t) + (two[name] ?? 0) * t]));
export const row_names = [...Object.keys(rows), 'retouch'];
// Where the mixture of a row at `tone`, 0 to 1, stands in `mixtures`.
export const index_of = (row, tone) => row * STEPS +
    Math.round(Math.min(Math.max(tone, 0), 1) * (STEPS - 1));

const first_hand = Object.values(rows).flatMap((keys) =>
  Array.from({ length: STEPS }, (_, i) => {
    const at = (i / (STEPS - 1)) * (keys.length - 1), k = Math.min(Math.floor(at), keys.length - 2);
    return blend(keys[k], keys[k + 1], at - k);
  }));

// Finds amounts of pigments beside `base` that look like `target` by day (Newton's method over the
// logarithms of three amounts); nothing if there are none.
function match(target, base, names) {
  const wanted = xyz(target, LAMPS.D65).map(Math.log), amounts = names.map(() => Math.log(0.2));
  const miss = (logs) => {
    const parts = { ...base };
    names.forEach((name, i) => { parts[name] = (parts[name] ?? 0) + Math.exp(logs[i]); });
    const made = mix_pigments(parts);
    return { parts, made, away: xyz(made, LAMPS.D65).map((v, k) => Math.log(v) - wanted[k]) };
  };
  for (let round = 0; round < 60; round++) {
    const { parts, made, away } = miss(amounts);
    if (Math.hypot(...away) < 1e-6) return { parts, made };
    const step = 1e-4, columns = amounts.map((_, i) =>
      miss(amounts.map((a, k) => a + (k === i ? step : 0))).away
          .map((v, k) => (v - away[k]) / step));
    const det = (a, b, c) => a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1]);
    const all = det(...columns);
    if (!(Math.abs(all) > 1e-12)) return undefined;
    for (let i = 0; i < 3; i++) {
      const change = det(...columns.map((column, k) => (k === i ? away : column))) / all;
      amounts[i] -= Math.min(Math.max(change, -0.7), 0.7);
      if (!(Math.abs(amounts[i]) < 12)) return undefined;
    }
  }
  return undefined;
}

const shelf = ['cobalt blue', 'viridian', 'cobalt green', 'madder lake', 'lac dye', 'cobalt violet',
  'bone black'];
const choices = shelf.flatMap((a, i) => shelf.slice(i + 1).flatMap((b, k) =>
  shelf.slice(i + k + 2).map((c) => [a, b, c])));
// Returns the later hand's mixture for one of the sky: of those that match it by day the one that
// is farthest from it by candle. Where none matches the first hand's stays.
function retouch(parts) {
  const target = mix_pigments(parts, NM), by_candle = lab(target, LAMPS.candle);
  const found = choices.map((names) => match(target, { 'zinc white': 0.3 }, names))
      .filter(Boolean).map(({ parts: other, made }) =>
        ({ parts: other, candle: difference(by_candle, lab(made, LAMPS.candle)) }));
  return found.sort((a, b) => b.candle - a.candle)[0]?.parts ?? parts;
}

// Both hands' rows lie one after another.
export const mixtures = [...first_hand, ...first_hand.slice(0, STEPS).map(retouch)];
