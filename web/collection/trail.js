// SPDX-License-Identifier: Apache-2.0
// The trail from the map of everything to the one that is seen: steps, as the server reads them,
// each with the words of its crumb.
export const most_steps = 24;

// A radius is written with so many digits that reading it gives the same circle.
export const circle_step = (index, radius) => `${index}@${Number(radius.toPrecision(6))}`;
export const groups_step = (numbers) => `c${[...numbers].sort((a, b) => a - b).join(',')}`;

// Returns the steps of a text; an empty list for a text that is no trail.
export function read_steps(text) {
  const steps = text ? text.split(';') : [];
  const known = /^(\d+@\d+(\.\d+)?(e-?\d+)?|c\d+(,\d+)*)$/;
  return steps.length <= most_steps && steps.every((step) => known.test(step)) ? steps : [];
}

export function make_trail(steps = []) {
  // Words of a step that came with an address are not known until its map is there.
  let all = steps.map((step) => ({ step, name: '' }));
  return {
    text: () => all.map(({ step }) => step).join(';'),
    depth: () => all.length,
    names: () => all.map(({ name }) => name),
    is_full: () => all.length >= most_steps,
    add(step, name) { all = [...all, { step, name }]; },
    // Goes back to so many steps.
    cut(depth) { all = all.slice(0, depth); },
    set(text) { all = read_steps(text).map((step, i) => (all[i]?.step === step ? all[i]
      : { step, name: '' })); },
  };
}
