// SPDX-License-Identifier: Apache-2.0
// Makes the signs of maps: trees, houses and towers as draughtsmen of each age drew them. A sign
// stands on (0, 0) and is about 1 high.
import { box, fill, line, oval, polygon, stroke, words } from './pen.mjs';

const star = (count, inner) => polygon(Array.from({ length: 2 * count }, (_, i) => {
  const turn = Math.PI * i / count - Math.PI / 2, far = i % 2 ? inner : 1;
  return [far * Math.cos(turn), far * Math.sin(turn)];
}), 3);

// Each sign is drawn in ink, over washes of colour.
export function make_signs(sheet, { ink, wash, roof, tree, pen }) {
  const hand = pen > 0 ? { wobble: pen, wobble_period: 0.15 } : {};
  const drawn = (path, color, width) => ({ path, ...(color && { fill: color }), stroke: ink, width,
    ...hand });
  sheet.symbol('tree_sign', [
    oval(0.12, -0.02, 0.34, 0.06, `${ink}40`),
    drawn('M-0.05 0L-0.04 -0.35L0.04 -0.35L0.05 0Z', wash, 0.03),
    drawn('M-0.1 -0.3R-0.4 -0.36 -0.42 -0.6 -0.3 -0.78 -0.1 -0.98 0.14 -0.96 0.32 -0.78 0.42 ' +
      '-0.56 0.34 -0.36 ' +
      '0.1 -0.3Z', tree, 0.035),
    stroke('M0.1 -0.4L0.3 -0.42M0.08 -0.5L0.36 -0.52M0.12 -0.6L0.37 -0.62M0.14 -0.7L0.32 ' +
      '-0.72M0.12 -0.8L0.25 -0.82',
      ink, 0.022), stroke('M-0.25 -0.6R-0.2 -0.7 -0.12 -0.66M-0.15 -0.8R-0.08 -0.88 0 -0.82', ink,
        0.018)]);
  sheet.symbol('fir_sign', [
    oval(0.1, -0.02, 0.25, 0.05, `${ink}40`),
    drawn('M-0.03 0L-0.03 -0.2L0.03 -0.2L0.03 0Z', wash, 0.025),
    drawn('M-0.26 -0.18L-0.12 -0.46L-0.2 -0.46L-0.08 -0.72L-0.13 -0.72L0 -1.05L0.13 -0.72L0.08 ' +
      '-0.72L0.2 -0.46' +
      'L0.12 -0.46L0.26 -0.18Z', tree, 0.03),
    stroke('M0.04 -0.25L0.2 -0.27M0.04 -0.35L0.15 -0.37M0.03 -0.55L0.14 -0.57M0.02 -0.8L0.08 -0.82',
      ink, 0.022)]);
  sheet.symbol('house_sign', [
    drawn('M-0.5 0L-0.5 -0.4L0.15 -0.4L0.15 0Z', wash, 0.035),
      drawn('M0.15 0L0.15 -0.4L0.33 -0.78L0.5 -0.4L0.5 0Z', wash,
      0.035), drawn('M-0.5 -0.4L-0.32 -0.78L0.33 -0.78L0.15 -0.4Z', roof, 0.035),
    box(-0.28, -0.24, -0.14, 0, ink), box(-0.02, -0.28, 0.08, -0.16, ink),
      box(0.28, -0.3, 0.37, -0.16, ink),
    stroke('M-0.4 -0.5L0.18 -0.5M-0.36 -0.6L0.24 -0.6M-0.33 -0.69L0.28 -0.69', ink, 0.016)]);
  sheet.symbol('church_sign', [
    drawn('M-0.2 0L-0.2 -0.4L0.55 -0.4L0.55 0Z', wash, 0.03),
      drawn('M-0.2 -0.4L-0.1 -0.65L0.5 -0.65L0.6 -0.4Z', roof,
      0.03), drawn('M-0.5 0L-0.5 -0.8L-0.2 -0.8L-0.2 0Z', wash, 0.03),
    drawn('M-0.55 -0.8L-0.35 -1.5L-0.15 -0.8Z', roof, 0.03),
      stroke('M-0.35 -1.5L-0.35 -1.75M-0.43 -1.66L-0.27 -1.66',
      ink, 0.04), box(-0.4, -0.7, -0.3, -0.55, ink), box(0, -0.3, 0.08, -0.12, ink),
        box(0.25, -0.3, 0.33, -0.12, ink)]);
  sheet.symbol('tower_sign', [
    drawn('M-0.3 0L-0.26 -1L0.26 -1L0.3 0Z', wash, 0.04),
      drawn('M-0.34 -1L-0.34 -1.2L-0.2 -1.2L-0.2 -1.1L-0.07 -1.1' +
      'L-0.07 -1.2L0.07 -1.2L0.07 -1.1L0.2 -1.1L0.2 -1.2L0.34 -1.2L0.34 -1Z', wash, 0.04),
    box(-0.06, -0.75, 0.06, -0.5, ink), box(-0.1, -0.22, 0.1, 0, ink),
    stroke('M0.12 -0.9L0.24 -0.9M0.1 -0.78L0.25 -0.78M0.12 -0.66L0.25 -0.66M0.1 -0.54L0.26 ' +
      '-0.54M0.13 -0.42L0.27 -0.42' +
      'M0.14 -0.3L0.27 -0.3', ink, 0.02), stroke('M0 -1.2L0 -1.6', ink, 0.03),
    fill('M0 -1.6L0.3 -1.5L0 -1.4Z', '#8e2a1c')]);
  sheet.symbol('castle_sign', [
    { group: [{ include: 'tower_sign' }], move: [-0.75, 0], scale: [0.7, 0.8] },
    drawn('M-0.4 -0.1L-0.4 -0.8L0.45 -0.8L0.45 -0.1Z', wash, 0.03),
      drawn('M-0.45 -0.8L-0.3 -1.15L0.35 -1.15L0.5 -0.8Z',
      roof, 0.03), ...[-0.3, -0.1, 0.1, 0.3].map((x) => box(x, -0.66, x + 0.08, -0.5, ink)),
    { group: [{ include: 'tower_sign' }], move: [0.1, 0], scale: [0.9, 1.35] },
    { group: [{ include: 'tower_sign' }], move: [0.8, 0], scale: [0.7, 0.8] },
    drawn('M-0.9 0L-0.9 -0.35L-0.7 -0.35L-0.7 -0.28L-0.5 -0.28L-0.5 -0.35L-0.3 -0.35L-0.3 ' +
      '-0.28L-0.1 -0.28L-0.1 -0.35' +
      'L0.1 -0.35L0.1 -0.28L0.3 -0.28L0.3 -0.35L0.5 -0.35L0.5 -0.28L0.7 -0.28L0.7 -0.35L0.9 ' +
        '-0.35L0.9 0Z', wash, 0.03),
    fill('M-0.1 0L-0.1 -0.14R-0.05 -0.24 0 -0.25 0.05 -0.24 0.1 -0.14L0.1 0Z', ink)]);
  sheet.symbol('mill_sign', [
    drawn('M-0.25 0L-0.18 -0.7L0.18 -0.7L0.25 0Z', wash, 0.035),
      drawn('M-0.22 -0.7L0 -0.95L0.22 -0.7Z', roof, 0.035),
    stroke('M-0.45 -0.35L0.45 -1.15M-0.42 -1.15L0.42 -0.35', ink, 0.04),
      box(-0.07, -0.22, 0.07, 0, ink)]);
  sheet.symbol('hill_sign', [
    fill('M-1 0R-0.7 -0.5 -0.3 -0.9 0.05 -0.95 0.5 -0.55 1 0Z', `${wash}c0`),
    { ...stroke('M-1 0R-0.7 -0.5 -0.3 -0.9 0.05 -0.95 0.5 -0.55 1 0', ink, 0.03), ...hand },
    stroke('M0.05 -0.9L0.2 -0.35M0.16 -0.85L0.34 -0.3M0.26 -0.75L0.48 -0.2M0.38 -0.65L0.6 ' +
      '-0.12M0.5 -0.52L0.74 -0.08' +
      'M0.62 -0.4L0.84 -0.04', ink, 0.022)]);
  sheet.symbol('house_plan', [box(-0.5, -0.35, 0.5, 0.35, roof),
    stroke('M-0.5 -0.35L0.5 -0.35L0.5 0.35L-0.5 0.35Z', ink,
    0.06)]);
  sheet.symbol('church_plan',
    [fill('M-0.6 -0.2L-0.3 -0.2L-0.3 -0.4L0 -0.4L0 -0.2L0.6 -0.2L0.75 0L0.6 0.2L0 0.2L0 0.4' +
    'L-0.3 0.4L-0.3 0.2L-0.6 0.2Z', ink), stroke('M0.1 -0.75L0.1 -0.35M-0.05 -0.6L0.25 -0.6', ink,
      0.07)]);
  sheet.symbol('castle_plan', [fill('M-0.8 -0.5L0.2 -0.7L0.9 -0.3L0.8 0.5L-0.3 0.6L-0.9 0.2Z',
    `${roof}`),
    stroke('M-0.8 -0.5L0.2 -0.7L0.9 -0.3L0.8 0.5L-0.3 0.6L-0.9 0.2Z', ink, 0.1),
    ...[[-0.8, -0.5], [0.2, -0.7], [0.9, -0.3], [0.8, 0.5], [-0.3, 0.6],
      [-0.9, 0.2]].map(([x, y]) =>
      oval(x, y, 0.14, 0.14, ink)), box(-0.2, -0.2, 0.4, 0.15, ink),
        oval(-0.4, 0.15, 0.08, 0.08, '#3f6f93')]);
  sheet.symbol('compass', [
    oval(0, 0, 1, 1, `${wash}a0`), { ellipse: [0, 0, 1, 1], stroke: ink, width: 0.02 },
    { ellipse: [0, 0, 0.94, 0.94], stroke: ink, width: 0.008 },
      { path: star(16, 0.45), fill: `${ink}50` },
    { group: [{ path: star(8, 0.2), fill: wash, stroke: ink, width: 0.015 }], scale: 0.9 },
    ...[0, 90, 180, 270].flatMap((turn) => [{ group: [
      fill('M0 -1.2L0.14 -0.16L0 0Z', ink), fill('M0 -1.2L-0.14 -0.16L0 0Z', wash),
      stroke('M0 -1.2L-0.14 -0.16L0 0L0.14 -0.16Z', ink, 0.014)], turn }]),
    oval(0, 0, 0.08, 0.08, '#8e2a1c'), words({ en: 'N', de: 'N', sk: 'S' }, 0, -1.3, 0.4, ink,
      { align: 0.5, bold: true })]);
}

// Returns a frame with a scale of alternating fields, a title and a measure.
export function make_frame({ ink, paper, title, subtitle, font, left, top, right, bottom, metres,
  measure }) {
  const items = [], edge = 0.008;
  const out = [[left - edge, top - edge], [right + edge, top - edge], [right + edge, bottom + edge],
    [left - edge, bottom + edge]];
  const margin = 0.06;
  items.push(fill(`M-0.02 -0.02L1.02 -0.02L1.02 0.7L-0.02 0.7ZM${left} ${top}L${left} ` +
    `${bottom}L${right} ${bottom}` +
    `L${right} ${top}Z`, paper));
  items.push(stroke(polygon(out), ink, 0.0016), stroke(polygon([[left, top], [right, top],
    [right, bottom],
    [left, bottom]]), ink, 0.0008), stroke(polygon([[left - margin / 4, top - margin / 4],
      [right + margin / 4,
    top - margin / 4], [right + margin / 4, bottom + margin / 4],
      [left - margin / 4, bottom + margin / 4]]), ink, 0.0006));
  for (let i = 0; i < 20; i += 2) {
    const x = left + (right - left) * i / 20, step = (right - left) / 20;
    items.push(box(x, top - edge, x + step, top, ink),
      box(x + step, bottom, x + 2 * step, bottom + edge, ink));
  }
  for (let i = 0; i < 12; i += 2) {
    const y = top + (bottom - top) * i / 12, step = (bottom - top) / 12;
    items.push(box(left - edge, y, left, y + step, ink),
      box(right, y + step, right + edge, y + 2 * step, ink));
  }
  // The title, on a sheet of its own.
  const x = left + 0.018, y = top + 0.018, w = 0.29, h = 0.072;
  items.push(fill(polygon([[x + 0.003, y + 0.004], [x + w + 0.003, y + 0.004],
    [x + w + 0.003, y + h + 0.004],
    [x + 0.003, y + h + 0.004]]), `${ink}50`));
  items.push({ box: [x, y, x + w, y + h].map((n) => Number(n.toFixed(4))), fill: paper, stroke: ink,
    width: 0.001 });
  items.push(stroke(polygon([[x + 0.004, y + 0.004], [x + w - 0.004, y + 0.004],
    [x + w - 0.004, y + h - 0.004],
    [x + 0.004, y + h - 0.004]]), ink, 0.0004));
  items.push(words(title, x + w / 2, y + 0.034, 0.026, ink, { font, align: 0.5 }),
    words(subtitle, x + w / 2, y + 0.056, 0.0125, '#7a2a1e',
      { font, align: 0.5, slanted: font === 'serif' }));
  // The measure.
  const per_metre = (right - left) / metres, mx = right - 0.03 - 500 * per_metre, my =
    bottom - 0.02;
  for (let i = 0; i < 5; i++)
    items.push({ box: [mx + 100 * i * per_metre, my, mx + 100 * (i + 1) * per_metre, my + 0.003]
      .map((n) => Number(n.toFixed(5))), fill: i % 2 ? paper : ink, stroke: ink, width: 0.0003 });
  items.push(words(measure, mx + 250 * per_metre, my - 0.004, 0.009, ink, { font, align: 0.5 }));
  items.push(stroke(line([[mx, my + 0.003], [mx + 500 * per_metre, my + 0.003]]), ink, 0.0003));
  items.push({ include: 'compass', move: [right - 0.06, top + 0.075], scale: 0.036 });
  return items;
}
