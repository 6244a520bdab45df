// SPDX-License-Identifier: Apache-2.0
// The kiosk's screen: the storyteller's view, dim until somebody comes; no controls to get lost in.
import { make_connection } from './connection.js';
import { make_picture, wanted_size } from './picture.js';
import { make_sound } from './sound.js';
import { make_subtitles } from './subtitles.js';
import { first_language, word } from './words.js';

const by_id = (id) => document.getElementById(id);
const lang = first_language();
const asked = new URLSearchParams(location.search);  // kiosk: its name; teller: who shall be there
const subtitles = make_subtitles(by_id('subtitle'));
by_id('invite').textContent = word(lang, 'invite');

let connection = null;
const sound = make_sound(by_id('sound-button'), {
  on_wanted: (on) => connection?.send({ type: 'settings', sound: on }),
  label: (name) => word(lang, name),
  eager: true,
});
const picture = make_picture(by_id('picture'), (shown) => {
  const decoded_ms = Math.round(shown.decoded_ms * 10) / 10;
  connection.send({ type: 'ack', frame: shown.frame, decoded_ms, shown: true });
  sound.shown(shown);
  by_id('picture').dataset.frame = shown.frame;
});

connection = make_connection({
  hello: () => ({ type: 'hello', exhibit: '', lang, role: 'kiosk', kiosk: asked.get('kiosk') ?? '',
      ...wanted_size() }),
  open() {
    by_id('notice').hidden = true;
    sound.joined();
    if (asked.get('teller')) connection.send({ type: 'storyteller', teller: asked.get('teller') });
  },
  lost() {
    by_id('notice').textContent = word(lang, 'lost');
    by_id('notice').hidden = false;
  },
  message(message) {
    if (message.type === 'welcome') {
      by_id('title').textContent = message.title;
      document.title = message.title;
    }
    if (message.type === 'speech') sound.speech(message);
    if (message.type === 'state') sound.moved(message);
    if (message.type === 'subtitle') subtitles.show(message);
    if (message.type === 'kiosk') {
      document.body.classList.remove('absent', 'motion', 'person');
      // Without a camera the screen is simply bright.
      document.body.classList.add(message.cameras === 0 ? 'person' : message.state);
    }
    if (message.type === 'agent') {
      document.body.dataset.mood = message.mood;
      document.body.dataset.teller = message.teller;
    }
    if (message.type === 'error') console.warn(`${message.code}: ${message.message}`);
  },
  binary: (buffer) => { if (!sound.receive(buffer)) picture.receive(buffer); },
});
addEventListener('resize', () => connection.send({ type: 'settings', ...wanted_size() }));
