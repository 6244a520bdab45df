// SPDX-License-Identifier: Apache-2.0
// The visitor's page: joins connection, picture, controls and menu.
import { asked_exhibit, asked_object, asked_place, asked_story, asked_viewpoint, asked_wall,
  read_place } from './address.js';
import { make_ambience } from './ambience.js';
import { announce } from './announce.js';
import { make_ask } from './ask.js';
import { make_card } from './card.js';
import { make_door } from './collection/door.js';
import { make_comfort } from './comfort.js';
import { make_connection } from './connection.js';
import { make_controls } from './controls.js';
import { make_description } from './describe.js';
import { make_screen } from './display/screen.js';
import { by_id } from './element.js';
import { make_gamepad } from './gamepad.js';
import { make_glass } from './glass.js';
import { make_group } from './group.js';
import { kept, of_tab } from './kept.js';
import { make_leap } from './leap.js';
import { make_map } from './map.js';
import { make_menu } from './menu.js';
import { make_pieces } from './pieces.js';
import { make_places } from './places.js';
import { make_player } from './player.js';
import { make_presence } from './presence.js';
import { make_ruler } from './ruler.js';
import { make_share } from './share.js';
import { make_sound } from './sound.js';
import { make_subtitles } from './subtitles.js';
import { make_watch } from './watch.js';
import { asked_language, first_language, knows, language_names, translate_page, word }
  from './words.js';

const covered_fps = 1;  // pictures a second while a map of the collection lies over them
const canvas = by_id('picture');
let lang = first_language(), seq = 0, state = null, walk_speed = 1.4, full = false;
let connection = null, place = null;  // place: the viewpoint where the visitor was last
let exhibit = asked_exhibit, unknown_exhibit = '';
// These hold what the address asks for, until the visitor has it; null: nothing. told: the story
// that a kiosk's guest took along; start_object: that a map of the collection led to.
let start = asked_viewpoint, start_place = asked_place(), told = asked_story,
    start_object = asked_object;
const visit_key = `visit.${exhibit}`;  // key of the sealed visit that goes on
translate_page(lang);
by_id('veil-text').textContent = word(lang, 'opening');

const subtitles = make_subtitles(by_id('subtitle'));
function note_shown(shown) {
  const decoded_ms = Math.round(shown.decoded_ms * 10) / 10;
  connection.send({ type: 'ack', frame: shown.frame, decoded_ms, shown: shown.shown });
  if (!shown.shown) return;
  sound.shown(shown);
  by_id('veil').classList.add('lifted');
  canvas.dataset.frame = shown.frame;
  canvas.dataset.seq = shown.seq;
  dark.shown(shown.seq);
}

const screen = make_screen(canvas, { on_shown: note_shown,
  send: (message) => connection?.send(message), calm: () => comfort.leaps() });

const sound = make_sound(by_id('sound-button'), {
  on_wanted: (on) => connection?.send({ type: 'settings', sound: on }),
  label: (name) => word(lang, name),
});

const ambience = make_ambience(sound);

// Shows a notice, for some seconds if it says how many.
let notice_timer = 0;
function notice(text, seconds) {
  clearTimeout(notice_timer);
  by_id('notice').textContent = text;
  by_id('notice').hidden = !text;
  if (seconds) notice_timer = setTimeout(() => { if (!full) notice(''); }, 1000 * seconds);
}

const dark = make_leap(canvas);
const leap = () => dark.begin(seq);

const hello = () => ({ type: 'hello', exhibit, lang, role: 'visitor', parts: true,
  ...comfort.size(), resume: of_tab.get(visit_key) ?? '', ...screen.hello(),
  ...(asked_wall && { wall: { name: asked_wall }, token: of_tab.get('kiosk-token') ?? '' }) });

// Says which wish of the address is unknown.
function say_what_is_unknown(message) {
  const tag = asked_language(), spoken = message.languages;
  if (unknown_exhibit) {
    notice(word(lang, 'unknown_exhibit')
        .replace('{asked}', unknown_exhibit).replace('{title}', message.title), 12);
    unknown_exhibit = '';
  } else if (tag && !knows(tag, spoken)) {
    lang = spoken[0];
    connection.send({ type: 'settings', lang });
    const names = spoken.map((one) => language_names[one] ?? one).join(', ');
    notice(word(lang, 'unknown_lang').replace('{asked}', tag).replace('{spoken}', names), 12);
  }
}

const send_settings = (fields) => connection?.send({ type: 'settings', ...fields });
const comfort = make_comfort(send_settings, () => places.load());
const glass = make_glass(canvas, (message) => connection?.send(message),
    (name) => word(lang, name));
const ruler = make_ruler(canvas, (message) => connection?.send(message), () => lang);
const pieces = make_pieces({
  piece: (fields) => connection.send({ type: 'piece', ...fields }),
}, glass, ruler);
const card = make_card({
  shown: (object) => pieces.show(object, state),
  story: (story) => connection.send({ type: 'storyteller', story }),
  play: (name, on) => connection.send({ type: 'play', name, on }),
  around: (object, around) => order({ type: 'go', object, around }),
});
const map = make_map((to) => go({ to }));
const collection = make_door({
  there(object) { go({ object }); canvas.focus(); },
  covered: (yes) => send_settings(yes ? { fps: covered_fps } : comfort.wishes()),
  here: () => connection.send({ type: 'presence', here: true }),
  leave_menu: () => { if (menu.is_open()) menu.toggle(); },
});
const watch = make_watch(() => state, notice);
const places = make_places((name) => go_to_viewpoint(name), () => !comfort.saves());

// The message takes the visitor elsewhere, who stands there.
function order(message) {
  connection.send({ ...message, seq: next() });
  screen.stands(seq);
}

// fields: at, to or object, as `go` has them.
function go(fields) {
  order({ type: 'go', ...fields });
  if (comfort.leaps()) leap();
}

function go_to_viewpoint(name) {
  order({ type: 'viewpoint', name });
  card.close();
  leap();
}

// place: as in an address.
function go_to_place(to) {
  order({ type: 'camera', ...to });
  leap();
}
addEventListener('hashchange', () => {
  const to = read_place(location.hash);
  if (to) go_to_place(to);
});

const group = make_group({
  group: (action, code) => connection.send({ type: 'group', action, ...(code && { code }) }),
  notice: (text) => notice(text, 6),
  close: () => { if (menu.is_open()) menu.toggle(); },
});
const share = make_share(() => state, () => [canvas.width, canvas.height],
    () => ({ ...pieces.looks(state), ...glass.looks() }));
const description = make_description(by_id('scene'));

const presence = make_presence({
  here: (here) => connection?.send({ type: 'presence', here }),
}, () => lang);

connection = make_connection({
  hello,
  open() {
    notice('');
    full = false;
    seq = 0;
    screen.joined();
    sound.joined();
    glass.joined();
    send_settings({ ...comfort.wishes(), ...(collection.is_open() && { fps: covered_fps }) });
    if (menu.attention() !== null)
      connection.send({ type: 'settings', attention: menu.attention() });
    if (start_place) go_to_place(start_place);
    else if (start) order({ type: 'viewpoint', name: start });
    else if (start_object) go({ object: start_object });
    start = start_place = start_object = null;
    if (told) connection.send({ type: 'storyteller', story: told });
    told = null;
  },
  lost() { if (!full) notice(word(lang, 'lost')); },
  silent(on) { if (!full) notice(on ? word(lang, 'silent') : ''); },
  message(message) {
    switch (message.type) {
      case 'welcome':
        walk_speed = message.walk_speed;
        screen.welcome(message);
        lang = message.lang;
        presence.welcome();
        menu.welcome(message);
        places.welcome(message);
        card.welcome(message);
        pieces.welcome(message);
        ask.welcome(message);
        map.welcome(message);
        collection.welcome(message);
        group.welcome(message);
        share.welcome(message);
        description.welcome(message);
        watch.welcome(message);
        say_what_is_unknown(message);
        player.welcome(message);
        sound.relabel();
        ambience.places(message.sounds);
        by_id('veil-title').textContent = message.title;
        break;
      case 'state':
        state = message;
        place = message.viewpoint ?? place;
        menu.state(message);
        places.state(message);
        card.state(message);
        pieces.state(message);
        map.state(message);
        player.state(message);
        sound.moved(message);
        ambience.moved(message);
        description.state(message);
        menu.figures(
            `${screen.rate()} fps · ${Math.round(screen.round_trip())} ms · `
            + `${canvas.width}×${canvas.height} · ${Math.round(message.converged * 100)} % · `
            + `${word(lang, `limit_${message.limit}`)} · ${word(lang, `drawn_${screen.way()}`)}`);
        break;
      case 'pose':
        screen.pose(message);
        break;
      case 'went':
        if (message.object) card.open(message.object); else card.close();
        break;
      case 'measured': ruler.measured(message); break;
      case 'reply': ask.reply(message); break;
      case 'waiting': presence.waiting(message); break;
      case 'idle': presence.idle(message); break;
      case 'keep': of_tab.set(visit_key, message.token); break;
      case 'speech': sound.speech(message); break;
      case 'subtitle': subtitles.show(message); break;
      case 'agent':
        menu.agent(message);
        player.agent(message);
        document.body.dataset.mood = message.mood;
        break;
      case 'group': group.message(message); break;
      case 'announce': announce(message, lang); break;
      case 'problems': watch.problems(message); break;
      case 'kiosk': document.body.dataset.kiosk = message.state; break;
      case 'error':
        if (message.code === 'full') { full = true; notice(word(lang, 'full')); }
        else if (message.code === 'storyteller_busy') notice(word(lang, 'busy'), 4);
        else if (message.code === 'no_way' || message.code === 'nothing_there') {
          notice(word(lang, 'no_way'), 2.5);
          dark.end();
        } else if (message.code === 'unknown_exhibit' && exhibit) {
          unknown_exhibit = exhibit;
          exhibit = '';
          connection.send(hello());
        } else if (!group.error(message)) console.warn(`${message.code}: ${message.message}`);
        break;
    }
  },
  rests: () => presence.rests(),
  binary(buffer) {
    if (!sound.receive(buffer) && !glass.receive(buffer)) screen.receive(buffer);
  },
});

function next() {
  screen.asked(++seq);
  return seq;
}

// A tour that is broken off falls silent at once, not only when the server says so.
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
  viewpoint: go_to_viewpoint,
  object: (object) => go({ object }),
  tour: tour_action,
  story: (story) => connection.send({ type: 'storyteller', story }),
  storyteller: (fields) => connection.send({ type: 'storyteller', ...fields }),
  lamp: (name, on, light) => connection.send({ type: 'lamp', name, on, light }),
  hour: (value) => connection.send({ type: 'hour', value }),
  lang(tag) {
    lang = tag;
    kept.set('lang', tag);
    connection.send({ type: 'settings', lang: tag });
  },
  subtitles: (on) => subtitles.enable(on),
  attention(share) {
    kept.set('attention', share);
    connection.send({ type: 'settings', attention: share });
  },
});

const ask = make_ask({
  ask: (text) => connection.send({ type: 'ask', text }),
  close: () => { if (menu.is_open()) menu.toggle(); },
});

let ring_timer = 0;
make_controls(canvas, by_id('stick'), by_id('stick-knob'), {
  // A pointer alone changes no picture: nothing to measure a round trip by.
  send({ moved, ...fields }) {
    connection.send({ type: 'input', seq: ++seq, ...fields });
    screen.input(seq, fields, moved);
  },
  fov: () => state?.fov ?? 1,
  speed: () => walk_speed,
  place(index) {
    const name = places.name(index);
    if (name) go_to_viewpoint(name);
  },
  tap(at, event) {
    const ring = by_id('tapped');
    ring.style.translate = `${event.clientX}px ${event.clientY}px`;
    ring.hidden = true;
    void ring.offsetWidth;  // its movement begins anew
    ring.hidden = false;
    clearTimeout(ring_timer);
    ring_timer = setTimeout(() => { ring.hidden = true; }, 700);
    go({ at });
  },
  pad: make_gamepad({
    next_place() {
      const name = places.after(place);
      if (name) go_to_viewpoint(name);
    },
    toggle_menu: menu.toggle,
    in_menu: menu.is_open,
    step: menu.step,
    choose: () => /** @type {HTMLElement} */ (document.activeElement)?.click(),
  }),
});

// Controls fade while nobody touches them.
let quiet_timer = 0;
function wake() {
  document.body.classList.remove('quiet');
  clearTimeout(quiet_timer);
  quiet_timer = setTimeout(() => document.body.classList.add('quiet'), 6000);
}
for (const event of ['pointermove', 'pointerdown', 'keydown', 'touchstart'])
  addEventListener(event, wake, { passive: true });
// A visitor who goes on by keys sees the focus, on the picture too.
addEventListener('keydown',
    (event) => { if (event.key === 'Tab') document.body.classList.add('keys'); });
addEventListener('pointerdown', () => document.body.classList.remove('keys'));
wake();
canvas.focus();
document.body.classList.add('runs');
