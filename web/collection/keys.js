// SPDX-License-Identifier: Apache-2.0
// The keyboard on the map. Keys that mean something here are not heard by the museum behind it.
const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const zoom_step = 1.25, radius_step = 1.15, pan_step = 60;

// element: that of the whole map; canvas: where directions are meant. orders: {step(direction),
// enter(), back(), leave(), zoom(factor), grow(factor), pan(dx, dy), whole(), group(number)}.
export function listen_to_keys(element, canvas, orders) {
  function of_canvas(event) {
    const direction = directions[event.key];
    if (direction && event.shiftKey) orders.pan(-pan_step * direction[0], pan_step * direction[1]);
    else if (direction) orders.step(direction);
    else if (event.key === 'Enter') orders.enter();
    else if (event.key === '+' || event.key === '=') orders.zoom(zoom_step);
    else if (event.key === '-') orders.zoom(1 / zoom_step);
    else if (event.key === '0' || event.key === 'Home') orders.whole();
    else if (event.key === ']') orders.grow(radius_step);
    else if (event.key === '[') orders.grow(1 / radius_step);
    else if (/^[1-9]$/.test(event.key)) orders.group(Number(event.key) - 1);
    else return false;
    return true;
  }
  element.addEventListener('keydown', (event) => {
    event.stopPropagation();
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === 'Escape') orders.leave();
    else if (event.key === 'Backspace') orders.back();
    else if (event.target !== canvas || !of_canvas(event)) return;
    event.preventDefault();
  });
}
