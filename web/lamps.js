// SPDX-License-Identifier: Apache-2.0
// A lamp of the exhibit: a switch, and where it can shine with more than one light, a dial of them.

// A check box that is read as what it is: on or off.
function make_switch({ name, title, on }, on_change) {
  const label = document.createElement('label'), input = document.createElement('input'),
      text = document.createElement('span');
  label.className = 'switch';
  input.type = 'checkbox';
  input.setAttribute('role', 'switch');
  input.checked = on;
  input.dataset.lamp = name;
  input.addEventListener('change', () => on_change(input.checked));
  text.textContent = title || name;
  label.append(input, text);
  return label;
}

// Radio buttons side by side; choosing one switches the lamp on.
function make_dial({ name, title, dial, light }, on_choose) {
  const group = document.createElement('div');
  group.className = 'dial';
  group.setAttribute('role', 'radiogroup');
  group.setAttribute('aria-label', title || name);
  for (const one of dial) {
    const label = document.createElement('label'), input = document.createElement('input'),
        text = document.createElement('span');
    input.type = 'radio';
    input.name = `dial-${name}`;
    input.value = one.light;
    input.checked = one.light === light;
    input.dataset.dial = name;
    input.addEventListener('change', () => on_choose(one.light));
    text.textContent = one.title || one.light;
    label.append(input, text);
    group.append(label);
  }
  return group;
}

// Shows the lamps of a welcome in `place`; `order(name, on, light)` tells the server. A lamp that
// is switched on again has the light that its dial shows.
export function show_lamps(place, lamps, order) {
  place.replaceChildren(...lamps.flatMap((lamp) => {
    const { name } = lamp;
    const shown = () => place.querySelector(`input[data-dial="${CSS.escape(name)}"]:checked`);
    /** @type {HTMLElement[]} */
    const parts = [make_switch(lamp, (on) => order(name, on, shown()?.value))];
    if (lamp.dial) parts.push(make_dial(lamp, (light) => order(name, true, light)));
    return parts;
  }));
}

// Follows what the server says of lamps and their lights.
export function follow_lamps(place, { lamps, lights }) {
  for (const input of place.querySelectorAll('input')) {
    const { lamp, dial } = input.dataset;
    if (lamp) input.checked = lamps?.[lamp] ?? input.checked;
    else if (lights?.[dial] !== undefined) input.checked = lights[dial] === input.value;
  }
}
