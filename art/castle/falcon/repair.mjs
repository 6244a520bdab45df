// SPDX-License-Identifier: Apache-2.0
// The crack in the cartonnage head and what mended it: resin, and a pin of bell metal.
import { clamp, noise, smoothstep } from './field.mjs';
import { settle } from './outside.mjs';

export const RESIN = 130;
const zigzag = (t) => Math.abs(t - Math.floor(t) - 0.5) * 4 - 1;

// The crack runs from the crown down the left side of the head, and to the right of the crown.
// Returns how far a point lies in the gap and in the patch behind it, from 0 to 1.
export function crack(x, y, z) {
  if (y < 312 || x < -16) return { gap: 0, patch: 0, line: 0 };
  const way = x > 20 ? 417 - y : 40 - x;  // downwards on the side, else towards the right
  const across = z + 7 - 1.6 * zigzag(way / 15) - 0.7 * zigzag(way / 5.3) - 0.12 * (400 - y)
    + 0.5 * noise(x / 4, y / 4, 3);
  const ends = smoothstep(312, 330, y) * smoothstep(-16, 0, x);
  const half = 0.85 * ends * smoothstep(0, 0.4, ends);
  const gap = clamp((half - Math.abs(across)) / 0.9 + 0.5) * Math.min(1, 2 * ends);
  const patch = ends * smoothstep(7, 5.5, Math.abs(across) + 1.5 * noise(x / 7, y / 7, z / 7));
  return { gap, patch, line: ends * clamp(1.4 - Math.abs(across) / 0.5) };
}

export const PIN = {
  hounsfield: 3100, length_mm: 26,
  // It follows the wall through the crack, and both its ends are bent inwards.
  line() {
    const along = [];
    for (let i = 0; i <= 8; i++) {
      const t = i / 8 - 0.5;
      const end = i === 0 || i === 8 ? -8.5 : -3.3;
      along.push([...settle([39, 371 + 3 * t, -4 + 26 * t], end), 0.95]);
    }
    return along;
  },
};
