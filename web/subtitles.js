// SPDX-License-Identifier: Apache-2.0
// One line of speech at a time, gone when its time is over.
export function make_subtitles(element) {
  let timer = 0, on = true;
  const hide = () => { element.hidden = true; };
  return {
    show({ text, speaker, seconds, lang }) {
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
      element.lang = lang ?? '';
      element.hidden = false;
      timer = setTimeout(hide, (seconds + 1) * 1000);
    },
    enable(value) { on = value; if (!on) hide(); },
  };
}
