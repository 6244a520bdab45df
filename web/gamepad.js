// SPDX-License-Identifier: Apache-2.0
// A gamepad of the standard layout: the left stick walks, the right one looks; A goes on to the
// next place, B opens and closes the menu, in which the cross and A choose.
const dead = 0.16;  // share of a stick's way: it never rests quite in the middle
const buttons = { a: 0, b: 1, up: 12, down: 13 };

const bent = (v = 0) => (Math.abs(v) < dead ? 0
    : Math.sign(v) * ((Math.abs(v) - dead) / (1 - dead)) ** 1.5);

// orders: {next_place(), toggle_menu(), choose(), step(by)}; the last two where in_menu().
// Call what it gives once a frame: {right, forward, turn, tilt}, -1 to 1.
export function make_gamepad({ next_place, toggle_menu, in_menu, choose, step }) {
  const held = {};
  return () => {
    const pad = [...navigator.getGamepads?.() ?? []].find((one) => one?.connected);
    if (!pad) return { right: 0, forward: 0, turn: 0, tilt: 0 };
    const pressed = {};
    for (const [name, index] of Object.entries(buttons)) {
      const now = !!pad.buttons[index]?.pressed;
      pressed[name] = now && !held[name];
      held[name] = now;
    }
    if (pressed.b) toggle_menu();
    if (pressed.a) (in_menu() ? choose : next_place)();
    if (in_menu() && (pressed.up || pressed.down)) step(pressed.down ? 1 : -1);
    const [x, y, across, up] = pad.axes;
    return { right: bent(x), forward: -bent(y), turn: -bent(across), tilt: -bent(up) };
  };
}
