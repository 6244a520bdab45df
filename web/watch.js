// SPDX-License-Identifier: Apache-2.0
// For a curator who works at the exhibit (`./wellspring run --watch`): mistakes in its files over
// the picture, and in the menu the present place, as exhibit.json has it.
import { copy } from './copy.js';
import { by_id } from './element.js';
import { word } from './words.js';

const degrees = (radians) => Math.round(radians * 1800 / Math.PI) / 10;

// Writes a message `state` as one of exhibit.json's "viewpoints"; names that nobody has are given.
export function viewpoint_text({ position, yaw, pitch, roll, fov }, lang, names) {
  let number = 1;
  while (names.includes(`view-${number}`)) number++;
  return JSON.stringify({
    name: `view-${number}`, title: { [lang]: `View ${number}` },
    position: position.map((x) => Math.round(x * 1000) / 1000),
    yaw_deg: degrees(yaw), pitch_deg: degrees(pitch),
    ...(roll ? { roll_deg: degrees(roll) } : {}), fov_deg: degrees(fov),
  });
}

// state(): the newest message `state`. notice(text, seconds).
export function make_watch(state, notice) {
  let button = null, panel = null, lang = 'en', first = 'en', names = [];

  function add_button() {
    const section = document.createElement('section');
    button = document.createElement('button');
    button.type = 'button';
    button.id = 'copy-viewpoint';
    button.addEventListener('click', async () => {
      if (!state()) return;
      await copy(viewpoint_text(state(), first, names));
      notice(word(lang, 'viewpoint_copied'), 4);
    });
    section.append(button);
    by_id('menu').append(section);
  }

  function show(list) {
    panel?.remove();
    panel = null;
    if (list.length === 0) return;
    panel = document.createElement('section');
    panel.id = 'problems';
    panel.className = 'problems';
    panel.setAttribute('role', 'alert');
    const title = document.createElement('h2'), lines = document.createElement('ul');
    title.textContent = word(lang, 'problems');
    lines.append(...list.map(({ file, where, what }) => {
      const line = document.createElement('li'), place = document.createElement('b');
      place.textContent = [file, where].filter(Boolean).join(' ');
      line.append(place, place.textContent ? ': ' : '', what);
      return line;
    }));
    panel.append(title, lines);
    document.body.append(panel);
  }

  return {
    welcome(message) {
      lang = message.lang;
      first = message.languages[0];
      names = message.viewpoints.map(({ name }) => name);
      show([]);  // those that are left are told again
      if (message.watched && !button) add_button();
      if (button) button.textContent = word(lang, 'copy_viewpoint');
      if (button) button.parentElement.hidden = !message.watched;
    },
    problems: ({ list }) => show(list),
  };
}
