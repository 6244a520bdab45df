// SPDX-License-Identifier: Apache-2.0
// One line of speech at a time, gone when its time is over.
export function make_subtitles(element) {
  let timer = 0, on = true, left = 0, since = 0, held = false;
  const hide = () => { element.hidden = true; };
  const start = () => { since = performance.now(); timer = setTimeout(hide, left); };
  return {
    show({ text = '', speaker = '', seconds = 0, lang = '' }) {
      clearTimeout(timer);
      if (!text || !on) return hide();
      element.replaceChildren();
      if (speaker) {
        const who = document.createElement('span');
        who.className = 'speaker';
        who.textContent = speaker;
        element.append(who);
      }
      element.append(text);
      element.lang = lang;
      element.hidden = false;
      left = (seconds + 1) * 1000;
      if (!held) start();
    },
    // Speech rests, or goes on: the line stays as long.
    hold(value) {
      if (held === value) return;
      held = value;
      clearTimeout(timer);
      if (held) left = Math.max(left - (performance.now() - since), 1000);
      else if (!element.hidden) start();
    },
    enable(value) { on = value; if (!on) hide(); },
  };
}
