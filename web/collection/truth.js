// SPDX-License-Identifier: Apache-2.0
// How true a map is, and each place on it, by Kruskal's stress: 0 is true, 1 is anything.
const limits = [0.12, 0.28, 0.45];   // of faithful, mostly faithful and rough maps
const shares = [0.85, 1.15, 1.5];    // of a place's stress beside its map's
const faithful = limits[0];          // a place with less is true on every map
const palest = 0.38;

// Returns 0 to 3, the truest first.
export const map_truth = (stress) => limits.filter((limit) => stress > limit).length;
export const place_truth = (stress, of_map) => (stress <= faithful ? 0
  : shares.filter((share) => stress > share * of_map).length);

// Returns how opaque a place is drawn: 1 where it is true.
export function clearness(stress, of_map) {
  if (stress <= faithful) return 1;
  const above = stress / Math.max(of_map, faithful) - 0.8;
  return 1 - (1 - palest) * Math.min(1, Math.max(0, above / 1.2));
}

// Returns how full a meter of untruth is: half for a place as true as its map.
export const untruth = (stress, of_map) => Math.min(1, stress / Math.max(of_map, faithful) / 2);
