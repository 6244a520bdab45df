// SPDX-License-Identifier: Apache-2.0
// A leap to another place goes through a moment of dark.
const longest = 1500;  // milliseconds

// Returns {begin(seq), shown(seq), end()}: dark until the picture of that input is there.
export function make_leap(canvas) {
  let waits_for = 0, timer = 0;
  function end() {
    waits_for = 0;
    clearTimeout(timer);
    canvas.classList.remove('leaping');
  }
  return {
    begin(seq) {
      waits_for = seq;
      canvas.classList.add('leaping');
      clearTimeout(timer);
      timer = setTimeout(end, longest);
    },
    shown(seq) { if (waits_for && seq >= waits_for) end(); },
    end,
  };
}
