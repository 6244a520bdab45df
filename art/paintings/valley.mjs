// SPDX-License-Identifier: Apache-2.0
// Composes the painting "The valley under the castle in the year of the well".
import { make_buildings } from './buildings.mjs';
import { foreground } from './foreground.mjs';
import { infrared, xray } from './hidden.mjs';
import { make_nature } from './nature.mjs';
import { make_people } from './people.mjs';
import { box, curve, fill, ground, line, oval, polygon, random_source, ridge, round, Sheet, shape,
  sow, stroke, use } from './pen.mjs';
import { river, river_path } from './river.mjs';

function make_brushes(sheet) {
  sheet.brush('sky', 2.6, 26, { angle: -6, turn: 30, tone: 0.022, warmth: 0.018, impasto: 0.05,
    smear_mm: 1.5, octaves: 3 });
  sheet.brush('cloud', 2.2, 11, { angle: -12, turn: 100, tone: 0.03, warmth: 0.016, impasto: 0.09,
    smear_mm: 1.5, octaves: 3 });
  sheet.brush('far', 1, 7, { angle: 3, turn: 40, tone: 0.035, warmth: 0.02, impasto: 0.06,
    smear_mm: 0.6, octaves: 3 });
  sheet.brush('hill', 1.1, 6, { angle: 8, turn: 70, tone: 0.07, warmth: 0.05, impasto: 0.09,
    smear_mm: 0.7, octaves: 3 });
  sheet.brush('meadow', 0.8, 4.5, { angle: 4, turn: 50, tone: 0.07, warmth: 0.05, impasto: 0.09,
    smear_mm: 0.5, octaves: 3 });
  sheet.brush('rock', 1, 4, { angle: 68, turn: 120, tone: 0.075, warmth: 0.04, impasto: 0.14,
    smear_mm: 0.6, octaves: 3 });
  sheet.brush('water', 0.7, 9, { angle: 0, turn: 10, tone: 0.05, warmth: 0.02, impasto: 0.05,
    smear_mm: 0.7, octaves: 3 });
  sheet.brush('foliage', 0.5, 1.4, { angle: -40, turn: 200, tone: 0.12, warmth: 0.06, impasto: 0.14,
    smear_mm: 0.3, octaves: 2 });
  sheet.brush('earth', 1.4, 6, { angle: 10, turn: 60, tone: 0.1, warmth: 0.05, impasto: 0.12,
    smear_mm: 0.7, octaves: 3 });
  sheet.brush('wall', 0.5, 2, { angle: 80, turn: 60, tone: 0.04, warmth: 0.02, impasto: 0.1,
    smear_mm: 0.1, octaves: 2 });
  sheet.brush('roof', 0.5, 2, { angle: 62, turn: 30, tone: 0.06, warmth: 0.04, impasto: 0.1,
    smear_mm: 0.1, octaves: 2 });
  sheet.brush('horse', 0.5, 2.4, { angle: 40, turn: 120, tone: 0.04, warmth: 0.03, impasto: 0.1,
    smear_mm: 0.2, octaves: 2 });
  sheet.brush('fine', 0.2, 1.1, { angle: -50, turn: 120, tone: 0.035, warmth: 0.02, impasto: 0.07,
    smear_mm: 0.05, octaves: 2 });
  sheet.brush('detail', 0.09, 0.6, { angle: 20, turn: 90, tone: 0.02, warmth: 0.012, impasto:
    0.05 });
}

function sky(sheet, random) {
  const items = [box(-0.1, -0.1, 1.1, 0.4, sheet.linear(0, 0, 0, 0.3, 0, '#476788', 0.3, '#7795a8',
    0.6,
    '#b9c8c6', 0.82, '#e9dcb8', 1, '#f3dfb0'), { brush: 'sky' })];
  sheet.symbol('glow', [oval(0, 0, 1, 1, sheet.radial(0, 0, 1, 0, '#fff0c8e0', 0.4, '#fbe3b070', 1,
    '#fbe3b000'))]);
  items.push(use('glow', 0.22, 0.25, [0.42, 0.2]));
  const puff = sheet.radial(0, 0, 1, 0, '#fff9ecd0', 0.45, '#f6ead4a0', 0.8, '#e8dcc830', 1,
    '#e8dcc800');
  const shade = sheet.radial(0, 0, 1, 0, '#8793a3c0', 0.5, '#98a2ad80', 1, '#98a2ad00');
  sheet.symbol('puff', [oval(0, 0, 1, 1, puff)]);
  sheet.symbol('cloud_shade', [oval(0, 0, 1, 1, shade)]);
  const bank = (x, y, w, h, count) => {
    const group = [];
    for (let i = 0; i < count; i++) {
      const t = random() * 2 - 1, up = Math.sqrt(Math.max(0, 1 - t * t)) * random();
      group.push([up, use('cloud_shade', x + w * t, y - h * (up * 0.6 - 0.25),
        [0.2 * w * (0.6 + random()),
        0.3 * h * (0.6 + random())])]);
      group.push([up + 0.25, use('puff', x + w * t - 0.02 * w, y - h * up,
        [0.22 * w * (0.5 + random()),
        0.36 * h * (0.5 + random())])]);
    }
    group.sort((a, b) => a[0] - b[0]);
    items.push({ group: group.map(([, item]) => item) });
  };
  bank(0.34, 0.1, 0.2, 0.055, 30), bank(0.06, 0.15, 0.13, 0.04, 18),
    bank(0.62, 0.06, 0.16, 0.04, 22);
  bank(0.9, 0.12, 0.15, 0.05, 24), bank(0.47, 0.185, 0.16, 0.018, 14),
    bank(0.16, 0.03, 0.16, 0.025, 12);
  for (let i = 0; i < 16; i++)
    items.push(oval(random(), 0.2 + 0.07 * random(), 0.05 + 0.1 * random(), 0.002 +
      0.003 * random(),
      i % 2 ? '#fff2d060' : '#8f9cae38'));
  for (let i = 0; i < 9; i++)
    items.push(use('bird', 0.52 + 0.12 * random(), 0.1 + 0.06 * random(), 0.003 +
      0.002 * random()));
  items.push(use('falcon', 0.565, 0.085, 0.013));
  return items;
}

// Returns a far rock: a few steep points, lit from the left.
function crag(sheet, random, x, y, w, h, light, dark) {
  const top = [], count = 7;
  for (let i = 0; i <= count; i++) {
    const t = i / count, rise = Math.sin(Math.PI * t) ** 0.7;
    top.push([x + w * (t - 0.5), y - h * rise * (0.65 + 0.45 * random())]);
  }
  const items = [fill(polygon([[x - 0.7 * w, y], ...top, [x + 0.75 * w, y]]),
    sheet.linear(x - w / 2, 0, x + w / 2, 0, 0, light, 1, dark), { brush: 'far' })];
  for (let i = 1; i < count; i++) {
    const [a, b] = top[i];
    items.push(fill(polygon([[a, b], [a + 0.1 * w * (0.5 + random()), b +
      h * (0.2 + 0.5 * random())],
      [a + 0.02 * w, b + h * (0.3 + 0.5 * random())]]), `${dark}90`));
  }
  return { group: items };
}

// Returns far hills, from blue to green, and what grows on them.
function distance(sheet, random) {
  const items = [];
  const rows = [[0.245, 0.05, '#a9bac2', '#c3cbc6'], [0.258, 0.036, '#8fa6ac', '#aebdb6'],
    [0.268, 0.03, '#7b959a', '#9fb0a4'], [0.28, 0.024, '#6f8b83', '#94a890']];
  const places = [[0.3, 0.46, 0.6, 0.97], [0.36, 0.53, 0.93], [0.32, 0.57], []];
  const lit = ['#b6c3c8', '#a3b4b6', '#93a8a6'], shaded = ['#93a7b3', '#7d959f', '#6c878a'];
  rows.forEach(([y, height, high, low], i) => {
    for (const x of places[i])
      items.push(crag(sheet, random, x + 0.03 * random(), y + 0.008, 0.05 + 0.05 * random(),
        0.05 + 0.035 * random(), lit[i], shaded[i]));
    const edge = [];
    for (let x = -0.05; x < 1.06; x += 0.035)
      edge.push([x, y - height * (0.25 + 0.3 * Math.sin(7 * x + 3 * i) ** 2 + 0.3 * random())]);
    items.push(fill(ground(edge, 0.4), sheet.linear(0, y - height, 0, y + 0.03, 0, high, 1, low),
      { brush: 'far' }));
    if (i >= 1)
      items.push(sow('blue_tree', ground(edge.map(([x, top]) => [x, top + 0.006]), y + 0.04),
        0.0034,
        [0.002 + 0.0006 * i, 0.0036 + 0.0008 * i], { density: 0.2 + 0.12 * i, shade: 0.08 }));
  });
  return items;
}

function plain(sheet, random) {
  const items = [
    fill(ground(ridge(random, -0.05, 1.05, 0.289, 0.012, 16), 0.7),
      sheet.linear(0, 0.28, 0, 0.5, 0, '#a3b39c',
      0.3, '#a0a67c', 0.7, '#888a52', 1, '#6f6d35'), { brush: 'hill' })];
  // Fields in the distance are patches between hedges.
  const colors = ['#b9b878', '#8fa468', '#c8b870', '#7f9460', '#a8ac6a', '#d0bd78', '#87966a'];
  for (let i = 0; i < 46; i++) {
    const far = random(), y = 0.292 + 0.11 * far * far, size = 0.012 + 0.05 * far;
    const x = random(), tilt = 0.3 * (random() - 0.5) * size, flat = 0.2 + 0.12 * random();
    const corners = [[x, y], [x + size, y + tilt], [x + size * 1.1, y + tilt + size * flat],
      [x - 0.1 * size, y + size * flat]];
    items.push(fill(polygon(corners), `${colors[i % 7]}b0`));
    items.push({ hatch: polygon(corners), spacing: round(size / 14), angle:
      round(12 * (random() - 0.5), 1),
      stroke: '#5f6b3a70', width: round(size / 60, 6), jitter: 0.3 });
    items.push(sow('far_tree', polygon([corners[0], corners[1],
      [corners[1][0], corners[1][1] + 0.002],
      [corners[0][0], corners[0][1] + 0.002]]), 0.0018 + 0.004 * far, [0.003 + 0.007 * far,
      0.004 + 0.01 * far], { shade: 0.12 }));
  }
  const water = sheet.linear(0, 0.28, 0, 0.625, 0, '#dfe3d2', 0.2, '#b9cbcb', 0.5, '#86a5ae', 1,
    '#4f6f7c');
  items.push(fill(river_path(1.12), '#6f7340'), fill(river_path(), water, { brush: 'water' }));
  for (let i = 0; i < 70; i++) {
    const k = 1 + Math.floor(random() * (river.length - 2)), t = random();
    const [a, b] = [river[k], river[k + 1]], w = (a[2] + (b[2] - a[2]) * t) * 0.35;
    const x = a[0] + (b[0] - a[0]) * t + (random() - 0.5) * w, y = a[1] + (b[1] - a[1]) * t;
    items.push(stroke(curve([[x - w * 0.4, y], [x, y + 0.0006], [x + w * 0.4, y]]), i % 3 ?
      '#f3eed890'
      : '#33505c70', 0.0003 + 0.0012 * (y - 0.28)));
  }
  return items;
}

function castle_rock(sheet, random) {
  const edge = [[0.6, 0.4], [0.615, 0.37], [0.632, 0.345], [0.65, 0.31], [0.668, 0.28],
    [0.672, 0.25],
    [0.69, 0.236], [0.72, 0.232], [0.78, 0.23], [0.84, 0.234], [0.862, 0.25], [0.87, 0.285],
      [0.888, 0.31],
    [0.905, 0.35], [0.94, 0.38], [0.98, 0.41], [1, 0.44]];
  const rough = edge.flatMap(([x, y], i) => i === 0 ? [[x, y]] : [
    [(x + edge[i - 1][0]) / 2 + 0.006 * (random() - 0.5), (y + edge[i - 1][1]) / 2 +
      0.006 * (random() - 0.5)],
    [x, y]]);
  const outline = polygon([...rough, [1, 0.46], [0.6, 0.43]]);
  const items = [fill(outline, sheet.linear(0.6, 0.24, 0.95, 0.42, 0, '#c3b795', 0.35, '#9c917a',
    0.7,
    '#716957', 1, '#5d5c40'), { brush: 'rock' })];
  const clefts = [];
  for (let i = 0; i < 80; i++) {
    const x = 0.64 + 0.26 * random(), y = 0.245 + 0.13 * random(), size = 0.006 + 0.016 * random();
    if (y < 0.24 + 0.9 * Math.max(0, Math.abs(x - 0.77) - 0.08)) continue;
    clefts.push(fill(polygon([[x, y], [x + size * 0.4, y + size * 0.5],
      [x + size * 0.25, y + size * 1.6],
      [x - size * 0.15, y + size * 0.9]]), i % 2 ? '#4a443880' : '#e2d8b880'));
    clefts.push(stroke(line([[x, y], [x + size * 0.5, y + size * 0.4],
      [x + 0.4 * size, y + 1.3 * size],
      [x + 0.6 * size, y + 1.9 * size]]), '#3d382d90', 0.0005));
  }
  items.push({ group: clefts });
  items.push(sow('tree_mid', polygon([[0.6, 0.39], [0.65, 0.345], [0.68, 0.33], [0.76, 0.352],
    [0.86, 0.342],
    [0.92, 0.36], [1, 0.42], [1, 0.45], [0.62, 0.43]]), 0.011, [0.014, 0.026],
      { shade: 0.18, density: 0.8 }));
  items.push(sow('bush', outline, 0.012, [0.005, 0.009], { density: 0.25, shade: 0.2 }));
  // The way up, the castle, and the well with the mason before its gate.
  items.push(stroke(curve([[0.66, 0.41], [0.7, 0.385], [0.83, 0.372], [0.865, 0.345], [0.78, 0.315],
    [0.7, 0.296], [0.72, 0.268], [0.76, 0.246], [0.776, 0.236]]), '#dccb9e', 0.003));
  items.push(use('castle', 0.768, 0.236, 0.2));
  items.push(use('well', 0.815, 0.2445, 0.008), use('mason', 0.822, 0.2448, 0.0075),
    use('falcon', 0.8105, 0.2345, 0.0016), use('walker', 0.744, 0.2555, 0.006),
    use('carrier', 0.716, 0.294, 0.0065), use('cow', 0.84, 0.3655, 0.0045));
  return items;
}

function town(sheet, random) {
  const items = [], names = ['house', 'cottage', 'white_house', 'tall_house'];
  const rows = [[0.06, 0.33, 0.332, 16, 0.011], [0.05, 0.34, 0.342, 16, 0.014],
    [0.04, 0.33, 0.356, 14, 0.018],
    [0.05, 0.3, 0.373, 10, 0.023]];
  items.push(fill(shape([[-0.02, 0.335], [0.1, 0.322], [0.25, 0.32], [0.34, 0.332], [0.37, 0.36],
    [0.33, 0.4],
    [0.2, 0.412], [0.05, 0.41], [-0.02, 0.4]]), '#8b9352', { brush: 'meadow' }));
  items.push(stroke(curve([[0.44, 0.375], [0.38, 0.383], [0.3, 0.386], [0.16, 0.385],
    [-0.02, 0.392]]), '#c9b888', 0.006),
    stroke(curve([[0.605, 0.374], [0.63, 0.388], [0.66, 0.41]]), '#c9b888', 0.006));
  rows.forEach(([x0, x1, y, count, size], r) => {
    for (let i = 0; i < count; i++) {
      const x = x0 + (x1 - x0) * (i + 0.6 * random()) / count, s = size * (0.85 + 0.35 * random());
      const name = names[Math.floor(random() * (r < 3 ? 4 : 3))], back = y + 0.004 * random();
      items.push(fill(polygon([[x + 0.4 * s, back], [x + 0.9 * s, back + 0.02 * s],
        [x + 0.7 * s, back + 0.12 * s],
        [x - 0.4 * s, back + 0.08 * s]]), '#3f4226a0'));
      items.push(use(name, x, back, [s * (random() < 0.5 ? 1 : -1), s]));
      if (random() < 0.4) items.push(use('tree', x + 0.75 * s, back + 0.1 * s, 0.9 * s));
    }
    if (r === 0) items.push(use('church', 0.205, 0.34, 0.034), use('church', 0.09, 0.338, 0.026));
    if (r === 2) items.push(use('church', 0.27, 0.362, 0.042));
  });
  for (let i = 0; i < 7; i++) {
    const x = 0.08 + 0.22 * random(), y = 0.325 + 0.03 * random();
    items.push(stroke(curve([[x, y], [x + 0.004, y - 0.012], [x - 0.001, y - 0.022],
      [x + 0.008, y - 0.036]]),
      '#e4e0d42c', 0.0035),
      stroke(curve([[x, y], [x + 0.003, y - 0.014], [x + 0.001, y - 0.03]]), '#e4e0d430', 0.0018));
  }
  for (let i = 0; i < 14; i++)
    items.push(use(['walker', 'carrier', 'raker', 'child'][i % 4], 0.04 + 0.28 * random(),
      0.381 + 0.009 * random(), i % 4 === 3 ? 0.0048 : 0.008));
  items.push(use('mill', 0.315, 0.3225, 0.022), use('mill', 0.02, 0.318, 0.016));
  // A bridge of five arches, a boat on each side.
  const deck = [[0.44, 0.3705], [0.48, 0.364], [0.525, 0.362], [0.57, 0.365], [0.605, 0.3725]];
  items.push(fill(`${curve(deck)}L0.605 0.3835 0.44 0.3815Z`, '#b7a785', { brush: 'wall' }));
  for (let i = 0; i < 5; i++) {
    const x = 0.462 + 0.027 * i;
    items.push(fill(`M${round(x)} 0.387R${round(x + 0.002)} 0.374 ${round(x + 0.009)} 0.3705 ` +
      `${round(x + 0.016)
    } 0.374 ${round(x +
      0.018)} 0.387Z`, sheet.linear(0, 0.37, 0, 0.387, 0, '#3a4138', 1, '#7f9aa0')));
  }
  items.push(sow('stone', `${curve(deck)}L0.605 0.375 0.44 0.374Z`, 0.0032, [0.0026, 0.0031],
    { density: 0.5,
    jitter: 0.3, shade: 0.15 }));
  items.push(stroke(curve(deck), '#e0d4b4', 0.0016), use('walker', 0.5, 0.3635, 0.009),
    use('cow', 0.52, 0.3632, 0.006),
    use('carrier', 0.548, 0.3632, 0.009));
  items.push(use('boat', 0.475, 0.427, 0.024), use('boat', 0.4, 0.322, 0.009),
    use('boat', 0.44, 0.296, 0.004));
  for (let i = 0; i < 6; i++) items.push(use('duck', 0.36 + 0.05 * random(), 0.47 + 0.03 * random(),
    0.0035));
  return items;
}

function fields(sheet, random) {
  const wheat = shape([[0.53, 0.452], [0.62, 0.412], [0.74, 0.404], [0.86, 0.418], [0.94, 0.44],
    [0.88, 0.475],
    [0.74, 0.494], [0.6, 0.49]]);
  const items = [
    fill(shape([[0.46, 0.47], [0.56, 0.42], [0.7, 0.398], [0.9, 0.404], [1.05, 0.43], [1.05, 0.66],
      [0.5, 0.66],
      [0.45, 0.54]]), sheet.linear(0, 0.4, 0, 0.6, 0, '#8b8f55', 0.5, '#686b3a', 1, '#433f20'),
    { brush: 'meadow' }),
    fill(shape([[-0.05, 0.42], [0.1, 0.405], [0.25, 0.41], [0.35, 0.44], [0.31, 0.5], [0.34, 0.58],
      [0.4, 0.66],
      [-0.05, 0.66]]), sheet.linear(0, 0.4, 0, 0.6, 0, '#848850', 0.5, '#605f33', 1, '#38351b'),
    { brush: 'meadow' }),
    fill(wheat, sheet.linear(0.55, 0.41, 0.9, 0.49, 0, '#d9c283', 0.5, '#c2a35c', 1, '#94773e'),
      { brush: 'meadow' })];
  const mown = shape([[0.6, 0.462], [0.7, 0.436], [0.83, 0.45], [0.84, 0.47], [0.72, 0.488],
    [0.62, 0.486]]);
  items.push(fill(mown, '#d3b878', { brush: 'meadow' }),
    { hatch: mown, spacing: 0.0016, angle: 8, stroke: '#a8853f90',
    width: 0.0006, jitter: 0.6, density: 0.8 });
  // Wheat stands around what is mown.
  items.push(sow('wheat', `${wheat}${mown}`, 0.0028, [0.007, 0.01],
    { density: 0.9, shade: 0.14, turn: [-14, 14],
    grow: 1.4 }));
  sheet.symbol('sheaf', [
    fill('M-0.3 0R-0.16 -0.4 -0.3 -0.85 -0.1 -0.95 0.1 -0.95 0.32 -0.85 0.16 -0.4 0.32 0Z',
      '#c79f4a'),
    stroke('M-0.2 -0.02L-0.05 -0.45L-0.2 -0.9M0 0L0 -0.95M0.2 -0.02L0.06 -0.45L0.2 -0.9', '#8d6a28',
      0.03),
    stroke('M-0.12 -0.02L-0.03 -0.45L-0.1 -0.95M0.12 0L0.04 -0.45L0.1 -0.95', '#efd58a', 0.03),
    stroke('M-0.17 -0.45R0 -0.4 0.17 -0.45', '#6d4f1d', 0.06)], 'fine');
  const actors = [];
  for (let i = 0; i < 16; i++) actors.push(['sheaf', 0.615 + 0.2 * random(), 0.452 +
    0.03 * random(), 0.013]);
  const people = [['mower', 0.66, 0.462, 0.028], ['mower', 0.7, 0.47, 0.03],
    ['mower', 0.745, 0.477, 0.031],
    ['raker', 0.79, 0.47, 0.028], ['raker', 0.68, 0.483, 0.03], ['carrier', 0.83, 0.458, 0.027],
    ['raker', 0.63, 0.478, 0.029], ['child', 0.81, 0.483, 0.018], ['carrier', 0.86, 0.484, 0.031],
    ['walker', 0.9, 0.478, 0.029]];
  actors.push(...people);
  actors.sort((a, b) => a[2] - b[2]);
  for (const [name, x, y, size] of actors) {
    items.push(oval(x + 0.35 * size, y, 0.45 * size, 0.06 * size, '#5d4a2060'));
    items.push(use(name, x, y, [random() < 0.25 ? -size : size, size]));
  }
  items.push(sow('sheep', shape([[0.06, 0.43], [0.16, 0.42], [0.27, 0.428], [0.26, 0.45],
    [0.14, 0.458],
    [0.07, 0.45]]), 0.013, [0.0075, 0.0095], { density: 0.6, shade: 0.08, grow: 1.25 }));
  items.push(use('walker', 0.285, 0.452, 0.024), use('cow', 0.2, 0.487, 0.02),
    use('cow', 0.265, 0.475, 0.018));
  items.push(sow('tree', shape([[0.48, 0.44], [0.53, 0.42], [0.555, 0.425], [0.52, 0.46],
    [0.47, 0.49]]), 0.02,
    [0.022, 0.034], { shade: 0.15, density: 0.8 }));
  items.push(sow('tree_warm', shape([[0.9, 0.42], [1.02, 0.43], [1.02, 0.458], [0.94, 0.448]]),
    0.024, [0.04, 0.06],
    { shade: 0.15 }));
  items.push(sow('tree_mid', shape([[-0.02, 0.405], [0.12, 0.396], [0.3, 0.402], [0.34, 0.415],
    [0.2, 0.418],
    [-0.02, 0.42]]), 0.012, [0.012, 0.022], { shade: 0.15, density: 0.75 }));
  return items;
}

// Returns the shadows of clouds over the land.
function cloud_shadows(sheet) {
  sheet.symbol('shadow', [oval(0, 0, 1, 1, sheet.radial(0, 0, 1, 0, '#1c241678', 0.6, '#1c241650',
    1, '#1c241600'))]);
  return [[0.12, 0.43, 0.3, 0.03], [0.5, 0.325, 0.22, 0.014], [0.93, 0.335, 0.16, 0.02],
    [0.56, 0.545, 0.2, 0.05],
    [0.15, 0.5, 0.3, 0.04], [0.98, 0.5, 0.2, 0.06]].map(([x, y, w, h]) =>
      use('shadow', x, y, [w, h]));
}

// Returns old varnish: warm, and darker towards the edges.
function varnish(sheet) {
  const edge = (x0, y0, x1, y1) =>
    sheet.linear(x0, y0, x1, y1, 0, '#120a0270', 0.45, '#1a100430', 1, '#1a100400');
  return [box(-0.01, -0.01, 1.01, 0.64, '#b88a3818'),
    box(-0.01, -0.01, 0.22, 0.64, edge(-0.01, 0, 0.22, 0)),
    box(0.78, -0.01, 1.01, 0.64, edge(1.01, 0, 0.78, 0)),
      box(-0.01, -0.01, 1.01, 0.12, edge(0, -0.02, 0, 0.12)),
    box(-0.01, 0.48, 1.01, 0.64, edge(0, 0.64, 0, 0.48))];
}

export function make_valley() {
  const sheet = new Sheet({ width: 65536, height: 40960, metres: 2, seed: 1437 });
  make_brushes(sheet);
  sheet.brush('xray', 1.6, 9, { angle: 20, turn: 160, tone: 0.07, octaves: 3, smear_mm: 0.6 });
  make_nature(sheet), make_people(sheet), make_buildings(sheet);
  const random = random_source(1437);
  sheet.layer('paint', '#8c9a72', { cracks: { cell: 0.0034, width: 0.00005, depth: 0.42 },
    weave: { period: 0.0007, depth: 0.018 } },
  [...sky(sheet, random), ...distance(sheet, random), ...plain(sheet, random),
    ...castle_rock(sheet, random),
    ...town(sheet, random), ...fields(sheet, random), ...cloud_shadows(sheet),
      ...foreground(sheet, random),
    ...varnish(sheet)]);
  sheet.layer('xray', '#5a5f63', { weave: { period: 0.0007, depth: 0.1 }, grain:
    { period: 0.0006, depth: 0.05, octaves: 6 } },
    xray(sheet, random_source(7)), { gray: true });
  sheet.layer('infrared', '#cdc6ba', { grain: { period: 0.0004, depth: 0.035, octaves: 8 },
    weave: { period: 0.0007, depth: 0.03 }, cracks: { cell: 0.0034, width: 0.00005, depth: 0.12 } },
  infrared(sheet, random_source(8)));
  return sheet.file;
}
