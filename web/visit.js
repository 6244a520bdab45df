// SPDX-License-Identifier: Apache-2.0
// The visitor's page: joins connection, picture, controls and menu.
import { make_connection } from './connection.js';
import { make_controls } from './controls.js';
import { make_menu } from './menu.js';
import { make_picture, wanted_size } from './picture.js';
import { make_player } from './player.js';
import { make_sound } from './sound.js';
import { make_subtitles } from './subtitles.js';
import { first_language, translate_page, word } from './words.js';

const by_id = (id) => document.getElementById(id);
const canvas = by_id('picture');
let lang = first_language(), seq = 0, state = null, walk_speed = 1.4, round_trip = 0, full = false;
let connection = null;
const asked = new Map();  // seq -> time it was sent, until a picture shows it
translate_page(lang);
by_id('veil-text').textContent = word(lang, 'opening');

const subtitles = make_subtitles(by_id('subtitle'));
const picture = make_picture(canvas, (shown) => {
  const decoded_ms = Math.round(shown.decoded_ms * 10) / 10;
  connection.send({ type: 'ack', frame: shown.frame, decoded_ms, shown: true });
  sound.shown(shown);
  by_id('veil').classList.add('lifted');
  const sent = asked.get(shown.seq);
  if (sent) round_trip += (performance.now() - sent - round_trip) * 0.2;
  for (const old of asked.keys()) if (old <= shown.seq) asked.delete(old);
  canvas.dataset.frame = shown.frame;
  canvas.dataset.seq = shown.seq;
});

const sound = make_sound(by_id('sound-button'), {
  on_wanted: (on) => connection?.send({ type: 'settings', sound: on }),
  label: (name) => word(lang, name),
});

function notice(text) {
  by_id('notice').textContent = text;
  by_id('notice').hidden = !text;
}

connection = make_connection({
  hello: () => ({ type: 'hello', exhibit: '', lang, role: 'visitor', ...wanted_size() }),
  open() {
    notice('');
    full = false;
    seq = 0;
    asked.clear();
    sound.joined();
    if (menu.attention() !== null)
      connection.send({ type: 'settings', attention: menu.attention() });
    // After a broken line: back to where the visitor stood.
    if (state?.viewpoint)
      connection.send({ type: 'viewpoint', seq: next(), name: state.viewpoint });
    else if (state)
      connection.send({ type: 'camera', seq: next(), position: state.position, yaw: state.yaw,
          pitch: state.pitch });
  },
  lost() { if (!full) notice(word(lang, 'lost')); },
  message(message) {
    switch (message.type) {
      case 'welcome':
        walk_speed = message.walk_speed;
        lang = message.lang;
        menu.welcome(message);
        player.welcome(message);
        sound.relabel();
        by_id('veil-title').textContent = message.title;
        break;
      case 'state':
        state = message;
        menu.state(message);
        player.state(message);
        sound.moved(message);
        menu.figures(
            `${picture.rate()} fps · ${Math.round(round_trip)} ms · `
            + `${canvas.width}×${canvas.height} · ${Math.round(message.converged * 100)} %`);
        break;
      case 'speech': sound.speech(message); break;
      case 'subtitle': subtitles.show(message); break;
      case 'agent':
        menu.agent(message);
        player.agent(message);
        document.body.dataset.mood = message.mood;
        break;
      case 'kiosk': document.body.dataset.kiosk = message.state; break;
      case 'error':
        if (message.code === 'full') { full = true; notice(word(lang, 'full')); }
        else if (message.code === 'storyteller_busy') {
          notice(word(lang, 'busy'));
          setTimeout(() => { if (!full) notice(''); }, 4000);
        } else console.warn(`${message.code}: ${message.message}`);
        break;
    }
  },
  binary: (buffer) => { if (!sound.receive(buffer)) picture.receive(buffer); },
});

function next() {
  asked.set(++seq, performance.now());
  return seq;
}

// What is broken off falls silent at once, not only when the server says so.
function tour_action(action, name) {
  if (action !== 'play') sound.stop();
  connection.send({ type: 'tour', action, ...(name && { name }) });
}

function story_action(action) {
  if (action !== 'play') sound.stop();
  connection.send({ type: 'storyteller', action });
}

const player = make_player({ tour: tour_action, story_action }, (rests) => subtitles.hold(rests));
const menu = make_menu({
  viewpoint: (name) => connection.send({ type: 'viewpoint', seq: next(), name }),
  tour: tour_action,
  story: (story) => connection.send({ type: 'storyteller', story }),
  storyteller: (fields) => connection.send({ type: 'storyteller', ...fields }),
  lamp: (name, on) => connection.send({ type: 'lamp', name, on }),
  lang(tag) {
    lang = tag;
    localStorage.setItem('wellspring.lang', tag);
    connection.send({ type: 'settings', lang: tag });
  },
  subtitles: (on) => subtitles.enable(on),
  attention(share) {
    localStorage.setItem('wellspring.attention', String(share));
    connection.send({ type: 'settings', attention: share });
  },
});

make_controls(canvas, by_id('stick'), by_id('stick-knob'), {
  // A pointer alone changes no picture: nothing to measure a round trip by.
  send: ({ moved, ...fields }) =>
      connection.send({ type: 'input', seq: moved ? next() : ++seq, ...fields }),
  fov: () => state?.fov ?? 1,
  speed: () => walk_speed,
  place(index) {
    const name = menu.place(index);
    if (name) connection.send({ type: 'viewpoint', seq: next(), name });
  },
});

let resize_timer = 0;
addEventListener('resize', () => {
  clearTimeout(resize_timer);
  resize_timer = setTimeout(() => connection.send({ type: 'settings', ...wanted_size() }), 200);
});
// A hidden page costs next to nothing.
document.addEventListener('visibilitychange',
    () => connection.send({ type: 'settings', fps: document.hidden ? 1 : 0 }));

// Controls fade while nobody touches them.
let quiet_timer = 0;
function wake() {
  document.body.classList.remove('quiet');
  clearTimeout(quiet_timer);
  quiet_timer = setTimeout(() => document.body.classList.add('quiet'), 6000);
}
for (const event of ['pointermove', 'pointerdown', 'keydown', 'touchstart'])
  addEventListener(event, wake, { passive: true });
wake();
canvas.focus();
