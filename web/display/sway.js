// SPDX-License-Identifier: Apache-2.0
// Wind in keyframes: how far it has moved grass since they were drawn (server/lawn/wind.h). A push
// at (x, z) from a keyframe's eye is the sum of push * sin(dot(wave, (x, z)) + phase - rate * t);
// two sines of one wave differ by 2 sin(half of the difference) * cos(their mean).
import { axis_of, focal_of } from './view.js';

const agree_share = 0.1;   // of what the clocks are apart, is made up for with each picture
const most_apart = 0.5;    // seconds; more is made up for at once

// The wind's clock as this page has it: it goes on evenly, whenever pictures come.
export function make_wind_clock() {
  let ahead = NaN;  // seconds of the wind's clock before this page's
  return {
    // A picture of the wind at `time` came at `now`, milliseconds.
    note(time, now) {
      const apart = time - now / 1000 - ahead;
      if (!(Math.abs(apart) < most_apart)) ahead = time - now / 1000;
      else ahead += agree_share * apart;
    },
    at: (now) => now / 1000 + ahead,
  };
}

// Returns each wave's change since a keyframe, `seconds` ago: [push x, z, wave x, z] and the phase
// of a cosine, one behind the other.
export function eval_waves(waves, seconds) {
  const sums = [], phases = [];
  for (const { push, wave, rate, phase } of waves) {
    const half = -0.5 * rate * seconds, share = 2 * Math.sin(half);
    sums.push(share * push[0], share * push[1], ...wave);
    phases.push((phase + half) % (2 * Math.PI));
  }
  return { sums, phases };
}

// Returns a view's geometry for that. rays: one + x * across + y * down, divided by the pixel's
// disparity, is the way from the eye to its place (x and z). aside: by how much of a push along x
// and z a place moves to the right, down, and away. lens: the axis and the focal length in pixels.
export function make_ground_mapping(view) {
  const focal = focal_of(view), axis = axis_of(view), level = ([x, , z]) => [x, z];
  const right = level(view.right), up = level(view.up), forward = level(view.forward);
  const across = right.map((v) => v / focal), down = up.map((v) => -v / focal);
  const one = forward.map((v, i) => v - axis[0] * across[i] - axis[1] * down[i]);
  return { rays: [...one, ...across, ...down],
    aside: [...right, ...up.map((v) => -v), ...forward], lens: [...axis, focal] };
}
