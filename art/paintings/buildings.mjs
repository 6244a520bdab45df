// SPDX-License-Identifier: Apache-2.0
// Makes the symbols of buildings: a house is 1 wide and stands on (0, 0), its front to the viewer.
import { box, fill, oval, polygon, ridge, round, sow, stroke, use, words } from './pen.mjs';

// Makes a room that is seen through a window from (0, 0) to (1, 1): a table, a book, its words.
function make_room(sheet) {
  const page = (lines, x, align) => lines.map((text, i) =>
    words(text, x, 0.2 + 0.125 * i, i === 0 ? 0.088 : 0.052, i === 0 ? '#8e2a1c' : '#2b1a10',
      { font: i === 0 ? 'script' : 'serif', align }));
  sheet.symbol('book', [
    fill('M-0.03 0.05L0.5 0L1.03 0.05L1.03 1.02L0.5 0.97L-0.03 1.02Z', '#5a2a1a'),
    fill('M0 0.02R0.25 -0.05 0.5 0.03L0.5 0.95R0.25 0.87 0 0.96Z',
      sheet.linear(0, 0, 0.5, 0, 0, '#e8d9b4', 0.7, '#f6ebcc', 1, '#bfa878')),
    fill('M1 0.02R0.75 -0.05 0.5 0.03L0.5 0.95R0.75 0.87 1 0.96Z',
      sheet.linear(0.5, 0, 1, 0, 0, '#c2ab7b', 0.25, '#f4e8c8', 1, '#e3d2a8')),
    ...page([{ en: 'The well', de: 'Der Brunnen', sk: 'Studňa' },
      { en: 'Three summers', de: 'Drei Sommer', sk: 'Tri letá' },
      { en: 'Matej dug in dry', de: 'grub Matej im', sk: 'kopal Matej' },
      { en: 'stone. A falcon', de: 'trocknen Stein.', sk: 'v suchom kameni.' },
      { en: 'came, and he', de: 'Da kam ein Falke,', sk: 'Priletel sokol' },
      { en: 'shared his bread.', de: 'er teilte sein Brot.', sk: 'a dal mu chlieb.' }], 0.25, 0.5),
    ...page([{ en: 'Then the rock', de: 'Dann sang', sk: 'Vtedy skala' },
      { en: 'began to sing.', de: 'der Fels. Ein', sk: 'zaspievala.' },
      { en: 'One stroke of the', de: 'Hammerschlag,', sk: 'Jediný úder,' },
      { en: 'hammer, and the', de: 'und das Wasser', sk: 'a voda ho' },
      { en: 'water lifted him', de: 'hob ihn ans', sk: 'vyniesla hore' },
      { en: 'up into the light.', de: 'Licht empor.', sk: 'na svetlo.' }], 0.75, 0.5),
    stroke('M0.5 0.03L0.5 0.95', '#7d6233', 0.008)], 'detail');
  const glow = sheet.radial(0.36, 0.5, 0.95, 0, '#ffe9a8', 0.25, '#f0b860', 0.6, '#8a4e22', 1,
    '#33190c');
  sheet.symbol('room', [
    box(-0.1, -0.1, 1.1, 1.1, glow),
    ...[0.08, 0.3, 0.52, 0.74, 0.96].map((x) => box(x, -0.1, x + 0.05, 0.1, '#3a1f0f')),
    fill('M0.62 0.2L0.98 0.2L0.98 0.5L0.62 0.5Z', '#4a2814'),
    ...[0.66, 0.73, 0.8, 0.87].map((x, i) =>
      box(x, 0.26, x + 0.055, 0.48, ['#8b3a2a', '#4f6a48', '#b58a3c', '#3f4f73'][i])),
    box(0.6, 0.48, 1, 0.52, '#2e170a'),
    oval(0.8, 0.14, 0.05, 0.05, '#a8782f'), oval(0.8, 0.14, 0.036, 0.036, '#e8cf8a'),
    use('reader', 0.76, 1.16, 0.78),
    fill('M-0.1 0.86L0.66 0.82L0.78 0.94L-0.1 1.02Z', '#8a5527'),
    fill('M-0.1 1L0.78 0.93L0.78 1.1L-0.1 1.1Z', '#5a3314'),
    stroke('M-0.1 0.9L0.7 0.87M-0.1 0.94L0.74 0.91', '#6b3f1a', 0.006),
    box(0.335, 0.62, 0.365, 0.84, '#efe4c4'), oval(0.35, 0.85, 0.06, 0.018, '#b58a3c'),
    fill('M0.35 0.5R0.31 0.58 0.35 0.62 0.39 0.58Z', '#fff3c0'),
    fill('M0.35 0.54R0.335 0.585 0.35 0.61 0.365 0.585Z', '#f08a20'),
    oval(0.35, 0.57, 0.13, 0.14, sheet.radial(0.35, 0.57, 0.14, 0, '#fff0b0a0', 1, '#ffd87000')),
    { group: [use('book', 0, 0, [0.3, 0.22])], move: [0.42, 0.68], turn: 4 },
    fill('M0.1 0.86R0.08 0.78 0.12 0.74 0.2 0.74 0.24 0.78 0.22 0.86Z', '#7d8a86'),
    stroke('M0.24 0.78R0.3 0.79 0.28 0.85 0.22 0.84', '#7d8a86', 0.014),
    stroke('M0.12 0.8R0.11 0.78 0.13 0.76', '#d3ddd6', 0.01)], 'detail');
}

function make_windows(sheet) {
  const frame = [
    stroke('M0 0L1 0L1 1.2L0 1.2Z', '#3a2717', 0.1),
      stroke('M0.5 0L0.5 1.2M0 0.55L1 0.55', '#3a2717', 0.045),
    box(-0.12, 1.2, 1.12, 1.3, '#6b5233')];
  sheet.symbol('lattice', [stroke('M0 0.15L0.85 1.2M0 0.4L0.65 1.2M0 0.65L0.45 1.2M0.15 0L1 1.05' +
    'M0.35 0L1 0.8M0.55 0L1 0.55M1 0.15L0.15 1.2M1 0.4L0.35 1.2M1 0.65L0.55 1.2M0.85 0L0 1.05' +
    'M0.65 0L0 0.8M0.45 0L0 0.55', '#2b2a26', 0.012)]);
  sheet.symbol('window', [
    box(0, 0, 1, 1.2, sheet.linear(0, 0, 1, 1.2, 0, '#6d8088', 0.4, '#2f3a3f', 1, '#1b1f20')),
    fill('M0 0R0.24 0.4 0.14 1.2L0 1.2Z', '#c9bfa8'),
      fill('M1 0R0.8 0.4 0.88 1.2L1 1.2Z', '#b3a88f'),
    use('lattice', 0, 0, 1), ...frame], 'detail');
  sheet.symbol('lit_window', [
    { group: [use('room', 0, 0, [1, 1.2])], clip: 'M0 0L1 0L1 1.2L0 1.2Z' },
    stroke('M0 0L1 0L1 1.2L0 1.2Z', '#3a2717', 0.09),
    fill('M-0.05 -0.05L-0.55 0.04L-0.55 1.27L-0.05 1.24Z', '#5b6b46'),
    stroke('M-0.45 0.12L-0.15 0.08M-0.45 0.6L-0.15 0.6M-0.45 1.15L-0.15 1.15', '#3d4a2e', 0.03),
    fill('M1.05 -0.05L1.5 0.04L1.5 1.27L1.05 1.24Z', '#6b7b54'),
    stroke('M1.15 0.08L1.42 0.12M1.15 0.6L1.42 0.6M1.15 1.15L1.42 1.15', '#3d4a2e', 0.03),
    box(-0.12, 1.2, 1.12, 1.3, '#7d6440'),
    ...[0.07, 0.17, 0.27, 0.93].map((x, i) => use(['poppy', 'daisy', 'cornflower', 'poppy'][i], x,
      1.22, 0.22))], 'detail');
  sheet.symbol('door', [
    fill('M0 0L0 -0.8R0.25 -1.02 0.5 -0.8L0.5 0Z', '#4b3019'),
    stroke('M0.12 0L0.12 -0.92M0.25 0L0.25 -0.98M0.38 0L0.38 -0.92', '#2e1c0d', 0.016),
    stroke('M0.02 -0.25L0.3 -0.25M0.02 -0.7L0.3 -0.7', '#26221e', 0.04),
      oval(0.42, -0.42, 0.035, 0.035, '#a88a4a'),
    stroke('M0 0L0 -0.8R0.25 -1.02 0.5 -0.8L0.5 0', '#6f5a3d', 0.06)], 'detail');
  sheet.symbol('tile', [
    fill('M-0.5 -0.5L0.5 -0.5L0.5 0.2R0 0.62 -0.5 0.2Z', '#8c4d38'),
    stroke('M-0.5 0.2R0 0.62 0.5 0.2', '#4f2216', 0.12)]);
  sheet.symbol('straw', [stroke('M0 -1R0.1 0 0.05 1M0.3 -0.9R0.32 0 0.4 1M-0.3 -1R-0.25 0 -0.3 0.9',
    '#6b5632', 0.11), stroke('M0.15 -1L0.2 0.9M-0.15 -0.9L-0.12 1', '#b59d66', 0.09)]);
  sheet.symbol('stone', [
    fill('M-0.48 -0.36R-0.1 -0.42 0.42 -0.4 0.48 0 0.44 0.36 0 0.4 -0.46 0.34Z', '#8d8474'),
    stroke('M-0.46 0.34R0 0.42 0.44 0.36 0.48 -0.3', '#4d473d', 0.09),
    stroke('M-0.46 0.2L-0.45 -0.34R-0.1 -0.4 0.36 -0.38', '#b8ae9a', 0.06)]);
}

const beams = '#4a3422';
function make_house(sheet, name, wall, roof, thatched, height = 0.42, lit = false) {
  const ridge = -height - (thatched ? 0.52 : 0.42);
  const roof_path = `M-0.58 ${-height}L-0.38 ${ridge}L0.38 ${ridge}L0.58 ${-height}Z`;
  const window_name = lit ? 'lit_window' : 'window';
  sheet.symbol(name, [
    box(-0.5, -height, 0.5, 0.02, sheet.linear(-0.5, 0, 0.5, 0, 0, wall[0], 1, wall[1]),
      { brush: 'wall' }),
    stroke(`M-0.48 0L-0.48 ${-height}M-0.2 0L-0.2 ${-height}M0.2 0L0.2 ${-height}M0.48 0L0.48 ` +
      `${-height}M-0.5 ${-0.55 * height}L0.5 ${-0.55 * height}M-0.48 0L-0.2 ${-0.55 * height}` +
      `M0.48 0L0.2 ${-0.55 * height}`, beams, 0.026),
    box(-0.5, -0.05, 0.5, 0.03, '#6f675a'),
    use('door', -0.09, 0, height > 0.4 ? 0.3 : 0.26), use(window_name, -0.43, -0.9 * height, 0.15),
    use('window', 0.29, -0.9 * height, 0.13),
    box(0.16, ridge - 0.16, 0.28, ridge + 0.2, '#7b5a48'),
      box(0.14, ridge - 0.19, 0.3, ridge - 0.15, '#5d4234'),
    fill(`M-0.5 ${-height}L0.5 ${-height}L0.5 ${-height + 0.05}L-0.5 ${-height + 0.03}Z`,
      '#20140a90'),
    fill(roof_path, sheet.linear(0, ridge, 0, -height, 0, roof[0], 1, roof[1]), { brush: 'roof' }),
    thatched ? sow('straw', roof_path, 0.028, [0.018, 0.024], { turn: [-8, 8], shade: 0.25 })
      : sow('tile', roof_path, 0.03, [0.031, 0.034], { jitter: 0.15, shade: 0.22 }),
    stroke(`M-0.39 ${ridge}L0.39 ${ridge}`, thatched ? '#8b7848' : '#6b3020', 0.03)]);
}

function make_church(sheet) {
  const wall = sheet.linear(-0.5, 0, 0.5, 0, 0, '#e2d6bb', 1, '#a3937a');
  const green = sheet.linear(-0.62, 0, -0.28, 0, 0, '#93b09a', 0.5, '#6a8d78', 1, '#3d5a4d');
  const arch = (x, y, s) => [
    fill(polygon([[x - s, y], [x - s, y - 2 * s], [x, y - 3.2 * s], [x + s, y - 2 * s], [x + s, y]],
      3),
      '#2b2f33'), stroke(`M${round(x, 3)} ${y}L${round(x, 3)} ${round(y - 3 * s, 3)}`, '#8d8474',
        0.008)];
  sheet.symbol('church', [
    box(-0.3, -0.42, 0.55, 0.02, wall, { brush: 'wall' }),
    fill('M-0.3 -0.42L-0.2 -0.78L0.5 -0.78L0.6 -0.42Z',
      sheet.linear(0, -0.8, 0, -0.4, 0, '#b0603f', 1,
      '#6f3524'), { brush: 'roof' }),
    sow('tile', 'M-0.3 -0.42L-0.2 -0.78L0.5 -0.78L0.6 -0.42Z', 0.026, [0.027, 0.03],
      { jitter: 0.15, shade: 0.2 }),
    ...arch(0, -0.1, 0.045), ...arch(0.18, -0.1, 0.045), ...arch(0.36, -0.1, 0.045),
    box(-0.6, -1.05, -0.3, 0.02, wall, { brush: 'wall' }), ...arch(-0.45, -0.78, 0.05),
    use('door', -0.52, 0, 0.28), oval(-0.45, -0.56, 0.065, 0.065, '#efe7d0'),
    stroke('M-0.45 -0.56L-0.45 -0.605M-0.45 -0.56L-0.415 -0.545', '#2a1c10', 0.01),
    oval(-0.45, -0.9, 0.035, 0.045, '#8a6a2c'),
    fill('M-0.64 -1.05R-0.58 -1.2 -0.5 -1.35 -0.45 -1.95 -0.4 -1.35 -0.32 -1.2 -0.26 -1.05Z',
      green),
    stroke('M-0.45 -1.95L-0.45 -2.12M-0.49 -2.06L-0.41 -2.06', '#c9a040', 0.014)]);
}

// Returns a round tower with a red hat, from (x, y) up.
function tower(sheet, x, y, w, h, hat) {
  const wall = sheet.linear(x - w, 0, x + w, 0, 0, '#e6d9bd', 0.35, '#cdbd9f', 1, '#7c6e5c');
  const red = sheet.linear(x - 1.2 * w, 0, x + 1.2 * w, 0, 0, '#b9735a', 0.4, '#94503c', 1,
    '#522a20');
  const slit = (a, b) => box(x + a * w, y - b * h, x + (a + 0.16) * w, y - b * h + 0.3 * w,
    '#2a221b');
  return [
    box(x - w, y - h, x + w, y, wall, { brush: 'wall' }),
    sow('stone',
      `M${round(x - w)} ${round(y - h)}L${round(x + w)} ${round(y - h)} ${round(x + w)} ` +
      `${round(y)} ${round(x - w)} ${round(y)}Z`, 0.02, [0.014, 0.019],
        { density: 0.3, shade: 0.15 }),
    slit(-0.5, 0.75), slit(0.15, 0.6), slit(-0.2, 0.35),
    box(x - 1.12 * w, y - h - 0.14 * w, x + 1.12 * w, y - h + 0.1 * w, '#9c8d76'),
    fill(polygon([[x - 1.25 * w, y - h - 0.1 * w], [x, y - h - hat],
      [x + 1.25 * w, y - h - 0.1 * w]], 4), red,
      { brush: 'roof' }),
    stroke(`M${round(x)} ${round(y - h - hat)}L${round(x)} ${round(y - h - hat - 0.05)}`, '#5b4a2c',
      0.006),
    fill(polygon([[x, y - h - hat - 0.05], [x + 0.06, y - h - hat - 0.038],
      [x, y - h - hat - 0.022]], 4),
      '#b8301f')];
}

function make_castle(sheet) {
  const wall = (x0, y0, x1, y1) => {
    const merlons = [];
    for (let x = x0; x < x1 - 0.005; x += 0.028)
      merlons.push([x, y0 - 0.02], [x + 0.016, y0 - 0.02], [x + 0.016, y0], [x + 0.028, y0]);
    return [fill(polygon([[x0, y1], ...merlons, [x1, y0], [x1, y1]], 3),
      sheet.linear(x0, 0, x1, 0, 0, '#d8c9aa', 1, '#9a8a72'), { brush: 'wall' }),
    sow('stone', polygon([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], 3), 0.02, [0.014, 0.019],
      { density: 0.3, shade: 0.15 })];
  };
  const windows = (list, s) => list.map(([x, y]) => use('window', x, y, s));
  sheet.symbol('castle', [
    ...tower(sheet, 0.16, -0.1, 0.05, 0.42, 0.2),
    fill('M-0.2 -0.1L-0.2 -0.44L0.12 -0.44L0.12 -0.1Z',
      sheet.linear(-0.2, 0, 0.12, 0, 0, '#e4d5b6', 1,
      '#a5947a'), { brush: 'wall' }),
    fill('M-0.23 -0.44L-0.16 -0.6L0.08 -0.6L0.15 -0.44Z',
      sheet.linear(0, -0.6, 0, -0.44, 0, '#bb6442', 1,
      '#7d3625'), { brush: 'roof' }),
    sow('tile', 'M-0.23 -0.44L-0.16 -0.6L0.08 -0.6L0.15 -0.44Z', 0.016, [0.0165, 0.018],
      { jitter: 0.15, shade: 0.2 }),
    ...windows([[-0.16, -0.4], [-0.09, -0.4], [-0.02, -0.4], [0.05, -0.4], [-0.16, -0.26],
      [-0.02, -0.26], [0.05, -0.26]], 0.026), use('lit_window', -0.09, -0.265, 0.03),
    ...tower(sheet, -0.06, -0.56, 0.022, 0.12, 0.1),
    ...tower(sheet, -0.26, -0.06, 0.065, 0.58, 0.26),
    fill('M0.18 -0.08L0.18 -0.3L0.38 -0.3L0.38 -0.08Z', '#b8a88a', { brush: 'wall' }),
    fill('M0.16 -0.3L0.21 -0.41L0.36 -0.41L0.41 -0.3Z',
      sheet.linear(0, -0.41, 0, -0.3, 0, '#b25b3c', 1,
      '#763222'), { brush: 'roof' }), ...windows([[0.21, -0.25], [0.27, -0.25], [0.33, -0.25]],
        0.024),
    ...tower(sheet, 0.43, -0.02, 0.042, 0.3, 0.15),
    ...wall(-0.5, -0.16, 0.44, 0.02), ...tower(sheet, -0.47, 0, 0.045, 0.26, 0.14),
    fill('M0 0.02L0 -0.09R0.04 -0.13 0.08 -0.09L0.08 0.02Z', '#2b211a'),
    stroke('M0.02 0.02L0.02 -0.1M0.04 0.02L0.04 -0.11M0.06 0.02L0.06 -0.1M0 -0.04L0.08 -0.04',
      '#6b5a44',
      0.004), ...tower(sheet, 0.14, 0.02, 0.03, 0.2, 0.1),
        ...tower(sheet, -0.06, 0.02, 0.03, 0.2, 0.1)]);
  sheet.symbol('well', [
    fill('M-0.4 -0.3L-0.36 0L0.36 0L0.4 -0.3Z', '#9a8f7d'), oval(0, -0.3, 0.4, 0.09, '#b7ab96'),
    oval(0, -0.3, 0.3, 0.06, '#1d1a17'), stroke('M-0.36 -0.3L-0.34 -1M0.36 -0.3L0.34 -1', '#5d4327',
      0.06),
    stroke('M-0.4 -0.75L0.5 -0.75', '#6f5230', 0.07),
      stroke('M0.5 -0.75L0.5 -0.6L0.58 -0.6', '#3b3b3b', 0.03),
    stroke('M0 -0.75L0 -0.36', '#c9b890', 0.016),
      fill('M-0.07 -0.4L0.07 -0.4L0.05 -0.26L-0.05 -0.26Z', '#6b4c2b'),
    fill('M-0.5 -0.95L0 -1.3L0.5 -0.95L0.42 -0.92L0 -1.2L-0.42 -0.92Z', '#7d4a30')], 'fine');
}

function make_mill(sheet) {
  sheet.symbol('sail', [stroke('M0 0L0 -1', '#5a4128', 0.03),
    fill('M0.02 -0.25L0.22 -0.25L0.22 -0.98L0.02 -0.98Z',
    '#e3d8bd'),
      stroke('M0.02 -0.4L0.22 -0.4M0.02 -0.55L0.22 -0.55M0.02 -0.7L0.22 -0.7M0.02 -0.85L0.22 ' +
        '-0.85' +
    'M0.12 -0.25L0.12 -0.98', '#8b7a5a', 0.012)]);
  sheet.symbol('mill', [
    fill('M-0.32 0L-0.2 -0.9L0.2 -0.9L0.32 0Z', sheet.linear(-0.3, 0, 0.3, 0, 0, '#a8865c', 1,
      '#5d452b'),
      { brush: 'wall' }),
    fill('M-0.26 -0.88R-0.2 -1.1 0 -1.2 0.2 -1.1 0.26 -0.88Z', '#6b4530'),
      use('door', -0.08, 0, 0.3),
    use('window', -0.06, -0.65, 0.12),
    ...[20, 110, 200, 290].map((turn) => use('sail', 0, -0.95, 0.85, { turn }))], 'fine');
  sheet.symbol('boat', [
    fill('M-0.5 -0.1R-0.3 0.06 0.3 0.06 0.55 -0.16L0.48 -0.16R0 -0.04 -0.5 -0.1Z', '#5a3d25'),
    stroke('M0 -0.05L0 -0.95', '#6b4f30', 0.025), fill('M0.03 -0.92R0.3 -0.7 0.42 -0.25L0.03 -0.2Z',
      '#e0d4b8'),
    fill('M-0.03 -0.85R-0.2 -0.6 -0.3 -0.25L-0.03 -0.2Z', '#b8a888'),
    stroke('M-0.6 0.1L0.65 0.1', '#e8eef0', 0.016), use('walker', -0.3, 0.02, 0.34)], 'fine');
}

export function make_buildings(sheet) {
  make_room(sheet);
  make_windows(sheet);
  make_house(sheet, 'cottage', ['#e2d3b2', '#a8926e'], ['#a08a58', '#6d5a35'], true, 0.42, true);
  make_house(sheet, 'house', ['#ddcfb0', '#9d8a69'], ['#b3603f', '#793724'], false, 0.46, true);
  make_house(sheet, 'white_house', ['#eee6d2', '#b3a68b'], ['#8f7a4d', '#5e4c2d'], true, 0.4);
  make_house(sheet, 'tall_house', ['#d8b98a', '#94744c'], ['#a5553a', '#6b3021'], false, 0.66,
    true);
  make_church(sheet);
  make_castle(sheet);
  make_mill(sheet);
}
