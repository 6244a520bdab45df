// SPDX-License-Identifier: Apache-2.0
// Two disc galaxies that pass one another: stars without mass of their own around two masses on a
// bound orbit (Toomre and Toomre 1972, "Galactic bridges and tails"). Kiloparsecs, thousand million
// years, and masses of 10^11 suns.
import { add, cross, dot, random, subtract, unit } from '../castle/falcon/field.mjs';

const GRAVITY = 4.498e5;  // of such a mass, kpc^3 / Gyr^2
const SOFT = 1.4;  // kpc: a galaxy's mass is spread so far (Plummer's sphere)
const NEAREST = 20, ECCENTRICITY = 0.6;  // kpc, of the two masses' orbit
const STEP = 0.001;

const pull = (r) => GRAVITY / (dot(r, r) + SOFT * SOFT) ** 1.5;
const turn_speed = (r) => r * Math.sqrt(GRAVITY / (r * r + SOFT * SOFT) ** 1.5);

// The way from the first mass to the second one, and its change, `time` after they are nearest.
function orbit(time) {
  const a = NEAREST / (1 - ECCENTRICITY), all = 2 * GRAVITY;
  const mean = Math.sqrt(all / a ** 3) * time;
  let e = mean;  // the eccentric anomaly, by Newton's method
  for (let i = 0; i < 50; i++)
    e -= (e - ECCENTRICITY * Math.sin(e) - mean) / (1 - ECCENTRICITY * Math.cos(e));
  const flat = Math.sqrt(1 - ECCENTRICITY ** 2), turn = Math.sqrt(all / a) /
    (1 - ECCENTRICITY * Math.cos(e));
  return { way: [a * (Math.cos(e) - ECCENTRICITY), 0, a * flat * Math.sin(e)],
    speed: [-turn * Math.sin(e), 0, turn * flat * Math.cos(e)] };
}

// Masses that lie apart by a softened pull do not quite follow Kepler, so they are moved as stars
// are; their orbit begins as his.
function begin(time) {
  const { way, speed } = orbit(time);
  return [-0.5, 0.5].map((share) => ({ at: way.map((c) => share * c),
    speed: speed.map((c) => share * c) }));
}

// Stars of a disc that turns around `axis`, and of the bulge in its middle.
function galaxy(host, axis, stars, bulge, seed) {
  const draw = random(seed), right = unit(cross(axis, [0.3, 0.5, 0.8])), up = cross(axis, right);
  const found = [];
  for (let i = 0; i < stars + bulge; i++) {
    const in_disc = i < stars, r = in_disc ? 1.5 + 12.5 * draw() : 1.7 * draw() ** 0.6;
    let normal = axis;
    if (!in_disc) {
      do normal = [0, 1, 2].map(() => 2 * draw() - 1); while (dot(normal, normal) > 1);
      normal = unit(normal);
    }
    const [u, v] = in_disc ? [right, up] : (() => {
      const one = unit(cross(normal, axis));
      return [one, cross(normal, one)];
    })();
    const angle = 2 * Math.PI * draw(), [c, s] = [Math.cos(angle), Math.sin(angle)];
    const out = add(u.map((one) => c * one), v, s), along = add(v.map((one) => c * one), u, -s);
    const high = in_disc ? 0.5 * (draw() + draw() - 1) : 0;
    found.push({ r, bulge: !in_disc, tone: draw(), at: add(add(host.at, out, r), axis, high),
      speed: add(host.speed, along, turn_speed(r)) });
  }
  return found;
}

// Both discs turn as the masses pass one another, so that stars are drawn along.
// Calls show(time, stars of each galaxy) at each of the times, which grow.
export function encounter(times, stars, bulge, show) {
  const masses = begin(times[0]);
  const galaxies = [galaxy(masses[0], unit([0.2, -1, 0.15]), stars, bulge, 3),
    galaxy(masses[1], unit([-0.62, -0.75, 0.25]), stars, bulge, 4)];
  const push = (body, others, share) => {
    for (const other of others) {
      const r = subtract(other.at, body.at);
      body.speed = add(body.speed, r, share * STEP * pull(r));
    }
  };
  const all = [...masses, ...galaxies.flat()];
  const kick = (share) => {
    push(masses[0], [masses[1]], share);
    push(masses[1], [masses[0]], share);
    for (const star of galaxies.flat()) push(star, masses, share);
  };
  let step = 0;
  for (const time of times) {
    for (const end = Math.round((time - times[0]) / STEP); step < end; step++) {
      kick(0.5);  // leapfrog
      for (const body of all) body.at = add(body.at, body.speed, STEP);
      kick(0.5);
    }
    show(time, galaxies);
  }
}
