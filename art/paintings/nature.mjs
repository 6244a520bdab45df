// SPDX-License-Identifier: Apache-2.0
// Makes the symbols of plants and beasts. Plants stand on (0, 0) and are 1 high.
import { blob, fill, oval, polygon, random_source, round, sow, stroke, use } from './pen.mjs';

// Makes leaves and a clump of them; colours from the shade to the light.
function make_clump(sheet, name, [dark, middle, light, bright], seed) {
  const random = random_source(seed);
  const leaf = (suffix, color, rib) => sheet.symbol(`${name}_leaf_${suffix}`, [
    fill('M-0.5 0R-0.2 -0.24 0.2 -0.2 0.52 0 0.2 0.2 -0.2 0.22Z', color),
    stroke('M-0.5 0L0.45 0', rib, 0.05)]);
  const low = leaf('low', dark, middle), mid = leaf('mid', middle, dark),
    high = leaf('high', light, middle), sun = leaf('sun', bright, light);
  sheet.symbol(name, [
    fill(blob(random, 0, 0.05, 1, 0.85, 11, 0.3, 2), dark, { brush: 'foliage' }),
    sow(low, blob(random, 0, 0.1, 1.1, 0.95, 9, 0.2, 2), 0.17, [0.2, 0.34], { turn: [-180, 180],
      shade: 0.2 }),
    sow(mid, blob(random, -0.05, -0.08, 0.95, 0.75, 9, 0.25, 2), 0.15, [0.17, 0.3],
      { turn: [-180, 180], shade: 0.2, density: 0.85 }),
    sow(high, blob(random, -0.15, -0.25, 0.75, 0.5, 8, 0.3, 2), 0.14, [0.15, 0.26],
      { turn: [-180, 180], shade: 0.15, density: 0.75 }),
    sow(sun, blob(random, -0.3, -0.4, 0.45, 0.28, 7, 0.3, 2), 0.14, [0.12, 0.22],
      { turn: [-180, 180], shade: 0.1, density: 0.6 })]);
}

// Makes a round tree of clumps.
function make_tree(sheet, name, clump, bark, seed, width = 0.34) {
  const random = random_source(seed);
  const items = [
    fill('M-0.045 0R-0.03 -0.2 -0.035 -0.4L0.03 -0.4R0.03 -0.2 0.055 0Z', bark, { brush: 'fine' }),
    stroke('M0 -0.3R-0.06 -0.45 -0.16 -0.55', bark, 0.022),
    stroke('M0 -0.32R0.07 -0.48 0.15 -0.6', bark, 0.02)];
  const rows = [[0.62, 5, 0.13], [0.5, 4, 0.12], [0.74, 4, 0.12], [0.86, 3, 0.11], [0.4, 3, 0.09]];
  for (const [up, count, size] of rows)
    for (let i = 0; i < count; i++) {
      const x = width * (count === 1 ? 0 : (2 * i / (count - 1) - 1)) *
        (1 - 0.6 * Math.abs(up - 0.58) / 0.42) + 0.05 * (random() - 0.5);
      items.push(use(clump, x, -up + 0.05 * (random() - 0.5),
        [size * (0.9 + 0.4 * random()), size * (0.8 + 0.3 * random())]));
    }
  sheet.symbol(name, items);
}

// Makes a tree of the distance: a few blots that tell light from shade.
function make_far_tree(sheet, name, dark, light, seed) {
  const random = random_source(seed);
  sheet.symbol(name, [
    fill(blob(random, 0, -0.5, 0.42, 0.5, 9, 0.25, 2), dark),
    fill(blob(random, -0.1, -0.62, 0.26, 0.28, 7, 0.3, 2), light)]);
}

function make_beasts(sheet) {
  sheet.symbol('sheep', [
    stroke('M-0.3 -0.3L-0.32 0M-0.2 -0.3L-0.18 0M0.2 -0.3L0.2 0M0.3 -0.3L0.32 0', '#3a3128', 0.06),
    fill('M-0.5 -0.45R-0.4 -0.75 -0.1 -0.82 0.25 -0.78 0.45 -0.55 0.35 -0.25 0 -0.18 -0.4 -0.25Z',
      '#cdc4ae'),
    fill('M-0.42 -0.5R-0.3 -0.74 0 -0.78 0.2 -0.7 0.1 -0.5 -0.2 -0.45Z', '#e9e2cf'),
    fill('M-0.45 -0.62R-0.66 -0.72 -0.74 -0.55 -0.66 -0.42 -0.5 -0.42Z', '#4a3f35'),
    oval(-0.64, -0.6, 0.018, 0.018, '#f0e8d8')], 'fine');
  sheet.symbol('cow', [
    stroke('M-0.45 -0.35L-0.47 0M-0.33 -0.35L-0.3 0M0.35 -0.35L0.36 0M0.48 -0.4L0.5 0', '#5b3a24',
      0.075),
    fill('M-0.62 -0.72R-0.3 -0.85 0.2 -0.82 0.58 -0.76 0.62 -0.45 0.4 -0.3 0 -0.26 -0.4 -0.3 ' +
      '-0.6 -0.5Z', '#8a5632'),
    fill('M-0.3 -0.8R0 -0.84 0.2 -0.7 0.05 -0.5 -0.2 -0.55Z', '#e6dcc6'),
    fill('M-0.55 -0.78R-0.82 -0.92 -1 -0.75 -0.98 -0.58 -0.8 -0.55 -0.6 -0.52Z', '#74452a'),
    stroke('M-0.8 -0.88R-0.86 -1 -0.78 -1.06M-0.74 -0.86R-0.7 -0.98 -0.62 -1', '#e9dfc4', 0.035),
    oval(-0.86, -0.76, 0.02, 0.02, '#1d120b'),
    stroke('M0.6 -0.72R0.72 -0.5 0.68 -0.2', '#6b4028', 0.03)], 'fine');
  sheet.symbol('bird', [
    stroke('M-1 -0.1R-0.5 -0.35 0 0 0.5 -0.35 1 -0.1', '#2b2a2c', 0.12)]);
  sheet.symbol('falcon', [
    fill('M-1 -0.35R-0.6 -0.42 -0.2 -0.12 0.05 -0.1 0.3 -0.3 0.8 -0.55 1.05 -0.5 0.6 -0.2 ' +
      '0.25 0.08 0.12 0.2 0.32 0.52 0 0.44 -0.06 0.22 -0.3 0.05 -0.65 -0.2Z', '#4a3b31'),
    fill('M-0.2 -0.12R-0.28 -0.2 -0.16 -0.26 -0.04 -0.16Z', '#39302b'),
    oval(-0.2, -0.2, 0.018, 0.018, '#f0c040'),
    fill('M-0.08 0R0.02 0.2 0.1 0.12 0.06 -0.02Z', '#d8c8a8'),
    stroke('M-0.06 0.04L0.06 0.08M-0.04 0.1L0.08 0.13', '#6b4f3a', 0.012)], 'fine');
  sheet.symbol('duck', [
    fill('M-0.5 0R-0.4 -0.3 0 -0.25 0.4 -0.35 0.55 -0.45 0.45 -0.1 0 0.05Z', '#6d5a45'),
    oval(-0.5, -0.42, 0.14, 0.12, '#1f4a3a'), fill('M-0.62 -0.42L-0.82 -0.36L-0.62 -0.34Z',
      '#c9902a'),
    stroke('M-0.9 0.08L0.8 0.08', '#cfdde0', 0.04)], 'fine');
}

function make_grass(sheet) {
  const blades = (name, colors, seed) => {
    const random = random_source(seed);
    sheet.symbol(name, colors.map((color) => {
      const paths = [];
      for (let i = 0; i < 3; i++) {
        const x = random() - 0.5, lean = 0.8 * (random() - 0.4), high = 0.5 + 0.5 * random();
        paths.push(polygon([[x - 0.035, 0], [x + 0.3 * lean - 0.025, -high * 0.55],
          [x + lean, -high],
          [x + 0.3 * lean + 0.025, -high * 0.55], [x + 0.035, 0]], 2));
      }
      return fill(paths.join(''), color);
    }), 'fine');
  };
  blades('grass', ['#454c22', '#666b33', '#2f351a', '#86834a'], 3);
  blades('dry_grass', ['#8f7a3c', '#b59a52', '#6d5a2b', '#cbb46e'], 4);
  sheet.symbol('wheat', [
    fill('M-0.02 0L0.01 -0.75L0.04 -0.75L0.02 0ZM0 -0.2L0.12 -0.37L0.22 -0.3L0.12 -0.32Z',
      '#a98a3a'),
    fill('M-0.03 -0.72R-0.09 -0.85 0.04 -1 0.12 -0.86 0.07 -0.72Z', '#cdae62'),
    stroke('M0.03 -0.75L0.04 -1.12M-0.02 -0.8L-0.08 -1.08M0.08 -0.8L0.16 -1.08', '#e6cb7c', 0.012)],
      'fine');
  const flower = (name, petal, heart) => sheet.symbol(name, [
    stroke('M0 0R0.06 -0.4 0 -0.8', '#4d5a24', 0.05),
    fill('M0 -0.3R0.22 -0.42 0.3 -0.55 0.1 -0.5Z', '#5d6a2c'),
    ...[0, 72, 144, 216, 288].map((turn) => {
      const a = turn * Math.PI / 180;
      return oval(0.13 * Math.cos(a), -0.85 + 0.13 * Math.sin(a), 0.13, 0.08, petal,
        { turn });
    }), oval(0, -0.85, 0.07, 0.07, heart)], 'fine');
  flower('daisy', '#efeadb', '#d8a628');
  flower('poppy', '#9c3524', '#2a1512');
  flower('cornflower', '#4a63a8', '#26305e');
}

// Makes the horse without a rider; it looks to the left and is 1 high at the withers.
function make_horse(sheet) {
  const coat = sheet.linear(0, -1, 0, -0.2, 0, '#d9cdb8', 0.5, '#b7a68d', 1, '#7d6c58');
  const far = '#6e5f4e';
  sheet.symbol('horse', [
    fill('M-0.34 -0.5R-0.38 -0.3 -0.44 -0.16 -0.42 0L-0.34 0R-0.34 -0.14 -0.28 -0.3 -0.22 -0.46Z',
      far),
    fill('M0.5 -0.55R0.56 -0.32 0.5 -0.2 0.54 0L0.62 0R0.6 -0.16 0.66 -0.34 0.62 -0.55Z', far),
    stroke('M0.7 -0.84R0.84 -0.74 0.84 -0.5 0.78 -0.3 0.84 -0.2', '#4b3f35', 0.075),
    stroke('M0.72 -0.82R0.88 -0.66 0.82 -0.4 0.86 -0.24', '#857660', 0.03),
    fill('M-0.46 -0.86R-0.2 -0.92 0.1 -0.9 0.36 -0.92 0.6 -0.9 0.74 -0.76 0.72 -0.56 0.6 -0.46 ' +
      '0.4 -0.44 0.1 -0.4 -0.2 -0.42 -0.42 -0.5 -0.52 -0.66Z', coat),
    fill('M0.44 -0.7R0.42 -0.5 0.52 -0.36 0.62 -0.28 0.56 -0.14 0.58 0L0.68 0R0.67 -0.14 ' +
      '0.74 -0.3 0.72 -0.5 0.74 -0.7Z', coat),
    fill('M-0.46 -0.66R-0.5 -0.44 -0.54 -0.3 -0.68 -0.24 -0.66 -0.1L-0.58 -0.08R-0.57 -0.2 ' +
      '-0.42 -0.26 -0.34 -0.4 -0.28 -0.6Z', coat),
    fill('M-0.26 -0.86R-0.42 -1.06 -0.6 -1.26 -0.74 -1.34 -0.9 -1.24 -1.04 -1.06 -1.02 -0.98 ' +
      '-0.92 -0.98 -0.8 -1.06 -0.68 -1.06 -0.62 -0.9 -0.52 -0.62 -0.3 -0.6Z', coat),
    fill('M-0.72 -1.33R-0.76 -1.46 -0.68 -1.44 -0.64 -1.3Z', '#a8977f'),
    fill('M-0.66 -1.36R-0.5 -1.26 -0.34 -1.08 -0.2 -0.88 -0.26 -0.78 -0.36 -0.92 -0.46 -1.02 ' +
      '-0.56 -1.12 -0.68 -1.24Z', '#4f4338'),
    stroke('M-0.6 -1.28R-0.5 -1.12 -0.46 -0.98M-0.5 -1.2R-0.4 -1.04 -0.37 -0.9', '#7a6a58', 0.012),
    oval(-0.82, -1.2, 0.024, 0.018, '#1a130e'), oval(-0.826, -1.206, 0.006, 0.005, '#f5efe2'),
    oval(-0.99, -1.04, 0.014, 0.02, '#4b3d33'),
    stroke('M-1.02 -1R-0.97 -1.01 -0.93 -1.03', '#4b3d33', 0.008),
    fill('M0.1 -0.42R0.24 -0.5 0.42 -0.46 0.3 -0.38Z', '#6b5b49b0'),
    fill('M-0.3 -0.88R0 -0.92 0.4 -0.92 0.6 -0.86 0.2 -0.82Z', '#f0e8d880'),
    ...[[-0.43, -0.34], [0.53, 0.63], [0.57, 0.69]].map(([a, b]) =>
      fill(polygon([[a, -0.05], [b, -0.05], [b + 0.015, 0], [a - 0.015, 0]], 3), '#2d251f')),
    fill('M-0.67 -0.12L-0.58 -0.09L-0.59 -0.04L-0.69 -0.08Z', '#2d251f')], 'horse');
}

export function make_nature(sheet) {
  make_clump(sheet, 'clump', ['#22300f', '#3c4d1b', '#66742f', '#98994c'], 11);
  make_clump(sheet, 'clump_warm', ['#33290f', '#5a4a1c', '#86702d', '#b59a4b'], 12);
  make_clump(sheet, 'clump_mid', ['#35462c', '#4d6038', '#72804b', '#979b64'], 13);
  make_tree(sheet, 'tree', 'clump', '#3a2c1c', 21);
  make_tree(sheet, 'tree_warm', 'clump_warm', '#3d2d1b', 22, 0.3);
  make_tree(sheet, 'tree_mid', 'clump_mid', '#453a2b', 23, 0.28);
  make_far_tree(sheet, 'far_tree', '#5d7468', '#7e9384', 31);
  make_far_tree(sheet, 'blue_tree', '#7f96a0', '#93a8ae', 32);
  make_far_tree(sheet, 'bush', '#3d4c26', '#6b7a3e', 33);
  make_beasts(sheet);
  make_grass(sheet);
  make_horse(sheet);
}
