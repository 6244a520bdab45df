// SPDX-License-Identifier: Apache-2.0
// Places on a map: which is the next in a direction, which lie in a circle, and how a new map is
// turned so that what it shares with the last one stays about where it was.

export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// Returns the index of the place that lies nearest in that direction, of those in its quarter; -1:
// there is none. takes(index): whether one may be chosen.
export function next_place(places, from, [dx, dy], takes = null) {
  let best = -1, least = Infinity;
  places.forEach(([x, y], i) => {
    if (i === from || (takes && !takes(i))) return;
    const along = (x - places[from][0]) * dx + (y - places[from][1]) * dy;
    const aside = Math.abs((x - places[from][0]) * dy - (y - places[from][1]) * dx);
    if (along <= 0 || aside > along) return;
    const cost = along + 2 * aside;
    if (cost < least) [best, least] = [i, cost];
  });
  return best;
}

// Returns the index of the place nearest to a point, within `reach`; -1: there is none.
export function nearest_place(places, at, reach = Infinity, takes = null) {
  let best = -1, least = reach;
  places.forEach((place, i) => {
    const away = distance(place, at);
    if (away <= least && (!takes || takes(i))) [best, least] = [i, away];
  });
  return best;
}

// Returns the indices of the places within a circle, the middle one among them.
export const in_circle = (places, middle, radius) => places.flatMap((place, i) =>
  (distance(place, middle) <= radius ? [i] : []));

// Returns the radius of the circle around one place that holds about that share of all, and at
// least some.
export function usual_radius(places, middle, share = 0.12, least = 5) {
  const away = places.map((place) => distance(place, middle)).sort((a, b) => a - b);
  const at = Math.min(away.length - 1, Math.max(least, Math.round(share * away.length)));
  return 1.02 * away[at];
}

// Turns and mirrors the new places, so that those that both maps have lie as near as may be to
// where they were (orthogonal Procrustes problem in the plane, Schoenemann 1966). pairs: [[old,
// new]]. Returns a function of places.
export function make_turn(pairs) {
  if (pairs.length < 2) return (place) => place;
  const mean = (k, axis) =>
    pairs.reduce((sum, pair) => sum + pair[k][axis], 0) / pairs.length;
  const [old_x, old_y, new_x, new_y] = [mean(0, 0), mean(0, 1), mean(1, 0), mean(1, 1)];
  let best = null;
  for (const mirror of [1, -1]) {
    let real = 0, imaginary = 0;
    for (const [[x, y], [u, v]] of pairs) {
      const a = x - old_x, b = y - old_y, c = u - new_x, d = mirror * (v - new_y);
      real += a * c + b * d;
      imaginary += b * c - a * d;
    }
    const length = Math.hypot(real, imaginary);
    if (!best || length > best.length) best = { mirror, real, imaginary, length };
  }
  if (!best.length) return (place) => place;
  const { mirror, length } = best, cos = best.real / length, sin = best.imaginary / length;
  return ([x, y]) => [cos * x - sin * mirror * y, sin * x + cos * mirror * y];
}
