// SPDX-License-Identifier: Apache-2.0
// Composes what lies below the painting: its X-ray, and what infrared shows of the drawing.
import { rider } from './people.mjs';
import { blob, box, curve, fill, ground, line, oval, polygon, ridge, round, shape, stroke, use,
  words } from './pen.mjs';
import { river_path } from './river.mjs';

const bottom = 0.625;  // the picture's height

// The earlier rider and the first place of the castle's tower, as X-rays show them: lead white is
// bright, so are the nails of the stretcher.
export function xray(sheet, random) {
  const items = [
    box(-0.1, -0.1, 1.1, 0.7, sheet.linear(0, 0, 0, bottom, 0, '#8f9499', 0.35, '#a7abad', 0.5,
      '#6a6f73', 1, '#33373a'),
      { brush: 'xray' })];
  for (let i = 0; i < 40; i++)
    items.push(oval(random(), 0.04 + 0.16 * random(), 0.03 + 0.07 * random(), 0.01 +
      0.02 * random(), '#e6eaec28'));
  items.push(fill(ground(ridge(random, -0.05, 1.05, 0.26, 0.05, 16), 0.7), '#6f7478c0'));
  items.push(fill(river_path(), '#b9bdbf', { brush: 'xray' }));
  items.push(fill(polygon([[0.6, 0.4], [0.65, 0.31], [0.69, 0.236], [0.84, 0.234], [0.9, 0.35],
    [1, 0.44], [0.6, 0.43]]),
    '#8b9094', { brush: 'xray' }));
  items.push({ group: [{ include: 'castle' }], move: [0.74, 0.238], scale: [0.23, 0.24] });
  items.push(box(0.6, 0, 0.9, 0.245, '#9a9fa380'));
  items.push(fill('M0.02 0.625R0.055 0.59 0.072 0.42L0.1 0.42R0.115 0.58 0.16 0.625Z', '#25282a'));
  items.push({ group: [...rider('#eef1f2', '#ffffff', 0.02),
    { include: 'horse' }], move: [0.63, 0.6], scale: 0.085 });
  items.push(fill('M0.55 0.45L0.72 0.45L0.72 0.61L0.55 0.61Z', '#80868a50'));
  items.push({ group: rider('#f2f5f6', '#ffffff', 0.02), move: [0.63, 0.6], scale: 0.085, brush:
    'fine' });
  // The stretcher behind the canvas, and its nails.
  for (const [x0, y0, x1, y1] of [[0, 0, 1, 0.03], [0, 0.595, 1, 0.625], [0, 0, 0.03, 0.625],
    [0.97, 0, 1, 0.625],
    [0.485, 0, 0.515, 0.625]])
    items.push(box(x0, y0, x1, y1, '#ffffff1c'));
  sheet.symbol('nail', [oval(0, 0, 1, 1, sheet.radial(0, 0, 1, 0, '#ffffff', 0.7, '#f4f6f7', 1,
    '#c8ccce00')),
    stroke('M0 0L1.6 2.2', '#f4f6f7', 0.5)]);
  for (let i = 0; i < 21; i++)
    items.push(use('nail', 0.02 + 0.048 * i, 0.006, 0.0016),
      use('nail', 0.02 + 0.048 * i, 0.617, 0.0016));
  for (let i = 1; i < 13; i++)
    items.push(use('nail', 0.006, 0.048 * i, 0.0016), use('nail', 0.992, 0.048 * i, 0.0016));
  return items;
}

export function infrared(sheet, random) {
  const coal = '#26221fd0', pale = '#3a353080', items = [];
  const pen = { wobble: 0.0012, wobble_period: 0.006 };
  for (let i = 1; i < 16; i++)
    items.push(stroke(`M${i / 16} 0L${i / 16} ${bottom}`, '#4a444048', 0.0005, { wobble: 0.0004 }));
  for (let i = 1; i < 10; i++)
    items.push(stroke(`M0 ${i / 16}L1 ${i / 16}`, '#4a444048', 0.0005, { wobble: 0.0004 }));
  for (const [y, height] of [[0.235, 0.06], [0.262, 0.04], [0.289, 0.012]])
    items.push(stroke(curve(ridge(random, -0.02, 1.02, y, height, 32)), pale, 0.0009, pen));
  items.push({ path: river_path(), stroke: coal, width: 0.0011, ...pen });
  const rock = polygon([[0.6, 0.4], [0.632, 0.345], [0.668, 0.28], [0.69, 0.236], [0.84, 0.234],
    [0.87, 0.285],
    [0.905, 0.35], [1, 0.44], [0.6, 0.43]]);
  items.push({ path: rock, stroke: coal, width: 0.0013, ...pen });
  items.push({ hatch: polygon([[0.78, 0.24], [0.86, 0.25], [0.9, 0.35], [0.99, 0.43],
    [0.74, 0.42]]), spacing: 0.003,
    angle: 62, stroke: '#2a262280', width: 0.0008, jitter: 0.6, density: 0.85 });
  const tower_lines = [[-0.26, 0.065, 0.58, 0.26], [0.16, 0.05, 0.42, 0.2],
    [0.43, 0.042, 0.3, 0.15],
    [-0.47, 0.045, 0.26, 0.14]];
  for (const [x, w, h, hat] of tower_lines)
    for (const shift of [0, 0.014])
      items.push(stroke(line([[x - w, 0], [x - w, -h], [x, -h - hat], [x + w, -h], [x + w, 0]]
        .map(([a, b]) => [0.768 + shift + 0.2 * a, 0.236 + 0.2 * b])), shift ? pale : coal, 0.0009,
          pen));
  items.push(stroke(line([[0.668, 0.236], [0.668, 0.204], [0.86, 0.204], [0.86, 0.236]]), coal,
    0.0009, pen));
  for (const [x, y, s] of [[0.885, 0.562, 0.15], [0.1, 0.37, 0.03], [0.15, 0.37, 0.03],
    [0.25, 0.365, 0.04],
    [0.19, 0.345, 0.03]]) {
    items.push(stroke(line([[x - s / 2, y], [x - s / 2, y - 0.42 * s], [x - 0.38 * s, y - 0.94 * s],
      [x + 0.38 * s, y - 0.94 * s], [x + s / 2, y - 0.42 * s], [x + s / 2, y], [x - s / 2, y]]),
        coal, 0.0009, pen));
    items.push({ hatch: polygon([[x - 0.55 * s, y - 0.42 * s], [x - 0.38 * s, y - 0.94 * s],
      [x + 0.38 * s, y - 0.94 * s],
      [x + 0.55 * s, y - 0.42 * s]]), spacing: round(s / 26), angle: 70, stroke: '#2a262270', width:
        round(s / 130, 6),
    jitter: 0.5 });
  }
  items.push({ path: shape([[0.53, 0.452], [0.62, 0.412], [0.74, 0.404], [0.86, 0.418],
    [0.94, 0.44], [0.88, 0.475],
    [0.74, 0.494], [0.6, 0.49]]), stroke: pale, width: 0.001, ...pen });
  for (const edge of [[[-0.05, 0.5], [0.05, 0.51], [0.16, 0.535], [0.27, 0.575], [0.36, 0.605],
    [0.44, 0.64]],
    [[0.5, 0.64], [0.56, 0.585], [0.66, 0.55], [0.78, 0.532], [0.9, 0.528], [1.05, 0.522]]]) {
    items.push(stroke(curve(edge), coal, 0.0016, pen));
    items.push({ hatch: ground(edge, 0.7), spacing: 0.0042, angle: -52, stroke: '#2a262268', width:
      0.0011, jitter: 0.7,
      density: 0.8 });
    items.push({ hatch: ground(edge.map(([x, y]) => [x, y + 0.03]), 0.7), spacing: 0.005, angle: 28,
      stroke: '#2a262258',
      width: 0.0011, jitter: 0.7, density: 0.7 });
  }
  items.push({ path: blob(random, 0.12, 0.3, 0.14, 0.13, 14, 0.25), stroke: coal, width: 0.0013,
    ...pen });
  items.push({ hatch: blob(random, 0.13, 0.31, 0.12, 0.11, 12, 0.3), spacing: 0.0035, angle: -40,
    stroke: '#2a262270',
    width: 0.0009, jitter: 0.9, density: 0.7 });
  items.push(stroke('M0.072 0.43R0.07 0.5 0.05 0.59 0.02 0.62M0.1 0.43R0.104 0.52 0.115 0.58 ' +
    '0.16 0.62', coal, 0.0014, pen));
  items.push({ group: [...rider('#00000000', '#26221f', 0.016),
    stroke('M-0.46 -0.86R-0.2 -0.92 0.36 -0.92 0.74 -0.76 ' +
    '0.72 -0.5 0.4 -0.44 -0.2 -0.42 -0.52 -0.66ZM-0.26 -0.86R-0.6 -1.26 -0.9 -1.24 -1.04 -1.02 ' +
      '-0.8 -1.06 -0.52 -0.62' +
    'M-0.58 -0.1L-0.42 -0.5M0.6 0L0.66 -0.5M-0.38 0L-0.26 -0.46', '#26221f', 0.014,
      { wobble: 0.02, wobble_period: 0.2 })],
  move: [0.63, 0.6], scale: 0.085 });
  items.push(words('weiß', 0.3, 0.09, 0.014, '#26221f90', { font: 'script', turn: -8 }),
    words('blau', 0.55, 0.045, 0.014, '#26221f90', { font: 'script', turn: -4 }),
    words('Korn', 0.72, 0.45, 0.012, '#26221f90', { font: 'script', turn: 5 }));
  return items;
}

