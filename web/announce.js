// SPDX-License-Identifier: Apache-2.0
// What the house says on all of its screens: a line that stays for its time, or, where it is
// urgent, big words over everything.
let panel = null, timer = 0;

// message: {text: {language: text}, seconds, urgent}; an empty text takes it back.
export function announce({ text, seconds, urgent }, lang) {
  const words = typeof text === 'string' ? text
    : text?.[lang] ?? text?.[lang?.split('-')[0]] ?? Object.values(text ?? {})[0] ?? '';
  clearTimeout(timer);
  if (!panel) {
    panel = document.createElement('p');
    panel.id = 'announcement';
    document.body.append(panel);
  }
  panel.hidden = !words;
  panel.className = urgent ? 'announcement urgent' : 'announcement';
  panel.setAttribute('role', urgent ? 'alert' : 'status');
  panel.textContent = words;
  if (words) timer = setTimeout(() => { panel.hidden = true; }, 1000 * seconds);
}
