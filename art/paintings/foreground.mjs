// SPDX-License-Identifier: Apache-2.0
// Composes the foreground: the great tree, the cottage, the horse without a rider.
import { curve, fill, ground, line, oval, shape, sow, stroke, use, words } from './pen.mjs';

// Returns the great tree at the left: boughs by halving, then clumps of leaves around their ends.
function great_tree(sheet, random) {
  const boughs = [], ends = [];
  const grow = (x, y, angle, length, width, depth) => {
    const bend = angle + 0.35 * (random() - 0.5);
    const to = [x + length * Math.cos(bend), y + length * Math.sin(bend)];
    boughs.push([curve([[x, y], [x + 0.5 * length * Math.cos(angle), y +
      0.5 * length * Math.sin(angle)], to]),
      width]);
    if (depth <= 2) ends.push(to);
    if (depth === 0) return;
    for (const side of depth > 3 ? [-0.5, 0.1, 0.55] : [-0.5, 0.5])
      grow(...to, bend + side * (0.8 + 0.5 * random()), length * (0.68 + 0.16 * random()),
        width * 0.62, depth - 1);
  };
  grow(0.085, 0.42, -1.5, 0.075, 0.014, 4), grow(0.085, 0.4, -2.2, 0.06, 0.008, 3);
  const bark = sheet.linear(0.06, 0, 0.12, 0, 0, '#8a6f4e', 0.4, '#55402a', 1, '#22180f');
  const items =
    [fill('M0.02 0.625R0.055 0.59 0.068 0.52 0.072 0.42L0.1 0.42R0.103 0.52 0.115 0.58 0.16 0.625Z',
      bark,
    { brush: 'rock' })];
  for (let i = 0; i < 26; i++) {
    const x = 0.07 + 0.035 * random(), y = 0.43 + 0.15 * random();
    items.push(stroke(curve([[x, y], [x + 0.002, y + 0.01], [x - 0.002, y + 0.024]]), i % 2 ?
      '#1d140c90'
      : '#a88a6080', 0.0012));
  }
  for (const [path, width] of boughs) items.push(stroke(path, '#3f2f1f', width, width > 0.004 ?
    { brush: 'rock' } : {}));
  ends.sort((a, b) => b[1] - a[1]);
  for (const tone of [0, 1])
    for (const [x, y] of ends) {
      const size = (tone ? 0.017 : 0.023) * (0.8 + 0.5 * random());
      items.push(use(tone && random() < 0.35 ? 'clump_warm' : 'clump', x +
        0.03 * (random() - 0.5) - 0.006 * tone,
        y + 0.024 * (random() - 0.5) - 0.006 * tone, [size, size * 0.85]));
    }
  return items;
}

export function foreground(sheet, random) {
  const left = ground([[-0.05, 0.5], [0.05, 0.51], [0.16, 0.535], [0.27, 0.575], [0.36, 0.605],
    [0.44, 0.64]], 0.7);
  const right = ground([[0.5, 0.64], [0.56, 0.585], [0.66, 0.55], [0.78, 0.532], [0.9, 0.528],
    [1.05, 0.522]], 0.7);
  const dark = sheet.linear(0, 0.5, 0, 0.625, 0, '#6d6232', 0.4, '#4b3f20', 1, '#241b0e');
  const items = [];
  // A cottage on the right bank; there is light in its window.
  items.push(fill(right, dark, { brush: 'earth' }));
  items.push(use('tree_warm', 0.985, 0.535, 0.17), use('tree', 0.93, 0.53, 0.14));
  items.push(fill('M0.78 0.56L1.02 0.545L1.02 0.57L0.82 0.585Z', '#2a2412a0'));
  items.push(use('cottage', 0.885, 0.562, 0.15));
  items.push(stroke(curve([[0.913, 0.416], [0.92, 0.39], [0.908, 0.365], [0.926, 0.33]]),
    '#dcd8cc24', 0.009),
    stroke(curve([[0.913, 0.416], [0.919, 0.38], [0.912, 0.345]]), '#dcd8cc30', 0.005));
  items.push(fill(shape([[0.868, 0.562], [0.89, 0.562], [0.87, 0.585], [0.8, 0.6], [0.72, 0.63],
    [0.6, 0.66],
    [0.57, 0.64], [0.7, 0.6], [0.83, 0.578]]), '#b59a64', { brush: 'earth' }));
  items.push(use('raker', 0.795, 0.588, 0.05), use('child', 0.768, 0.592, 0.031),
    use('duck', 0.855, 0.594, 0.009),
    use('duck', 0.87, 0.597, 0.008), use('duck', 0.842, 0.6, 0.0085));
  const meadow = ground([[0.5, 0.66], [0.575, 0.606], [0.66, 0.592], [0.74, 0.596], [0.8, 0.606],
    [0.88, 0.6],
    [0.95, 0.59], [1.05, 0.585]], 0.7);
  items.push(sow('grass', ground([[0.55, 0.594], [0.66, 0.556], [0.78, 0.542], [0.81, 0.545]], 0.6),
    0.0055,
    [0.004, 0.007], { density: 0.5, shade: 0.3, turn: [-12, 12] }));
  // A fence, then the horse without a rider.
  for (let i = 0; i < 9; i++) {
    const x = 0.965 + 0.012 * i;
    items.push(stroke(line([[x, 0.598 - 0.001 * i], [x + 0.001, 0.573 - 0.001 * i]]), '#5b4730',
      0.003));
  }
  items.push(stroke('M0.96 0.582L1.05 0.573M0.96 0.591L1.05 0.582', '#6b5538', 0.002));
  items.push(oval(0.64, 0.597, 0.075, 0.008, '#150f08a0'), use('horse', 0.63, 0.598, 0.092));
  items.push(sow('grass', meadow, 0.0055, [0.006, 0.011],
    { density: 0.75, shade: 0.3, turn: [-12, 12], grow: 1.5 }));
  for (const flower of ['daisy', 'poppy', 'cornflower'])
    items.push(sow(flower, meadow, 0.017, [0.005, 0.007],
      { density: 0.22, shade: 0.1, turn: [-20, 20], grow: 1.3 }));
  items.push(fill(left, dark, { brush: 'earth' }));
  items.push(sow('bush', ground([[-0.05, 0.515], [0.05, 0.52], [0.16, 0.548], [0.25, 0.58]], 0.62),
    0.02, [0.015, 0.03],
    { density: 0.5, shade: 0.25 }));
  items.push(...great_tree(sheet, random));
  items.push(sow('grass', left, 0.006, [0.007, 0.013],
    { density: 0.75, shade: 0.35, turn: [-14, 14], grow: 1.5 }));
  items.push(sow('dry_grass', left, 0.009, [0.007, 0.014],
    { density: 0.5, shade: 0.3, turn: [-16, 16] }));
  for (const flower of ['daisy', 'poppy', 'cornflower'])
    items.push(sow(flower, left, 0.018, [0.005, 0.008],
      { density: 0.2, shade: 0.1, turn: [-20, 20], grow: 1.3 }));
  items.push(use('walker', 0.215, 0.582, 0.06), words('M. F. 1437', 0.035, 0.616, 0.006, '#a8905a',
    { font: 'script' }));
  return items;
}

