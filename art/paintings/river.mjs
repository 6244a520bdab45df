// SPDX-License-Identifier: Apache-2.0
// Says where the river runs.
import { curve, round } from './pen.mjs';

// The river, from the horizon to the foreground, as its two banks.
export const river = [[0.43, 0.283, 0.004], [0.5, 0.29, 0.006], [0.47, 0.302, 0.009],
  [0.37, 0.316, 0.012],
  [0.35, 0.334, 0.018], [0.44, 0.354, 0.024], [0.53, 0.378, 0.03], [0.5, 0.412, 0.042],
    [0.4, 0.45, 0.058],
  [0.36, 0.5, 0.08], [0.42, 0.56, 0.11], [0.46, 0.64, 0.15]];
export function river_path(grow = 1) {
  const left = river.map(([x, y, w]) => [x - grow * w / 2, y]);
  const right = river.map(([x, y, w]) => [x + grow * w / 2, y]).reverse();
  return `${curve(left)}L${right[0].map((n) => round(n)).join(' ')}R${right.slice(1)
    .map(([x, y]) => `${round(x)} ${round(y)}`).join(' ')}Z`;
}

