// SPDX-License-Identifier: Apache-2.0
// The kiosk's screen: a well; a book that rises from it; presentations; and the museum itself with
// its storyteller. The server says at which stage a visit is (sleep, awake, person, engaged,
// farewell); this page shows it and tells back what the guest does.
import { announce } from '../announce.js';
import { make_ambience } from '../ambience.js';
import { make_collection } from '../collection/collection.js';
import { make_connection } from '../connection.js';
import { make_controls } from '../controls.js';
import { make_screen } from '../display/screen.js';
import { by_id } from '../element.js';
import { wanted_size } from '../picture.js';
import { make_player } from '../player.js';
import { make_sound } from '../sound.js';
import { make_subtitles } from '../subtitles.js';
import { first_language, language_names, translate_page, word } from '../words.js';
import { make_book } from './book.js';
import { show_calibration } from './calibration.js';
import { show_holding } from './holding.js';
import { make_pointing } from './pointing.js';
import { make_slides } from './slides.js';
import { make_take_along } from './take_along.js';
import { kiosk_token } from './token.js';
import { make_well } from './well.js';
import { kiosk_word } from './words.js';

// Metres before the screen at which the picture is seen from where its camera is.
const viewing_distance = 0.6;
const double_touch = { seconds: 0.6, pixels: 160 };
const touch_interval = 500;   // milliseconds between two touches that the server hears of
const alone_after = 60;       // seconds without a touch; then the book sinks without a server
const idle_fps = 1;           // pictures a second while something else covers them
// The address has: kiosk: its name; wall: the name of a wall that shows what it shows; teller: the
// storyteller who shall be there; lang: the house's language; pixels: how many the well's pictures
// have, for measuring.
const asked = new URLSearchParams(location.search);
const house_lang = first_language();
const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
let lang = house_lang, stage = 'sleep', view = 'well', doing = '', house_volume = 1;
let about = null, state = null, seq = 0, walk_speed = 1.4, gesture_seen = null, opening = 0;
let connection = null, touched_at = -1e9, told = '', fps = null, server_decides = false;
let exhibit = '';

const send = (message) => connection?.send(message);
const subtitles = make_subtitles(by_id('subtitle'));
const sound = make_sound(by_id('sound-button'), {
  on_wanted: (on) => send({ type: 'settings', sound: on }),
  label: (name) => word(lang, name),
  eager: true,
});
const ambience = make_ambience(sound);
function note_shown(shown) {
  const decoded_ms = Math.round(shown.decoded_ms * 10) / 10;
  send({ type: 'ack', frame: shown.frame, decoded_ms, shown: shown.shown });
  if (!shown.shown) return;
  sound.shown(shown);
  by_id('picture').dataset.frame = shown.frame;
}
const screen = make_screen(by_id('picture'), { on_shown: note_shown, send,
  calm: () => calm });
const well = make_well(by_id('well'), {
  wave: (depth) => ambience.splash(depth * 14),
  fell_up: () => ambience.splash(0.15),
}, { calm, fixed: Number(asked.get('pixels')) || 0 });
const take_along = make_take_along(by_id('take-along'));
const point = make_pointing(() => tell(true));
/** @type {any} */ (window).well = well;  // for whoever measures it
const player = make_player({
  tour: (action) => send({ type: 'tour', action }),
  story_action(action) {
    if (action !== 'play') sound.stop();
    send({ type: 'storyteller', action });
  },
}, (rests) => subtitles.hold(rests));
const slides = make_slides(by_id('slides'), {
  ended() { show('book'); },
  changed: () => tell(),
});
const book = make_book(by_id('book'), {
  close: () => show('well'),
  turned: () => tell(),
  watch(presentation) { show('slides'); slides.open(presentation, lang); slides.loud(volume()); },
  story(id) { show('museum', 'story'); send({ type: 'storyteller', story: id }); },
  tour(id) { show('museum', 'tour'); send({ type: 'tour', action: 'play', name: id }); },
  walk() { show('museum', 'walk'); },
  map: () => show('collection'),
  call() { show('museum', 'call'); go_home(); },
  lang: speak,
  language_name: (tag) => language_names[tag] ?? tag,
});

// The map of the collection, while it is open.
let map = null;
function open_map() {
  const place = by_id('collection');
  place.hidden = false;
  map = make_collection({ exhibit, lang, place, outside: false, orders: {
    close: () => show('book'),
    there(object) { show('museum', 'walk'); send({ type: 'go', seq: ++seq, object }); },
    changed: () => tell(true),
  } });
  map.open();
}
function close_map() {
  map.close();
  map = null;
  by_id('collection').hidden = true;
}

const volume = () => Number(by_id('volume').value);
function set_volume(value) {
  by_id('volume').value = value;
  sound.volume(value);
  slides.loud(value);
}
by_id('volume').addEventListener('input', () => set_volume(volume()));

// Back to where the storyteller stands.
function go_home() {
  const name = about?.viewpoint_of_storyteller;
  if (name) send({ type: 'viewpoint', seq: ++seq, name });
}

function showing() {
  if (view === 'book')
    return { topic: 'topics', partn: 'partners', museu: 'museum' }[book.chapter().slice(0, 5)]
        ?? 'book';
  if (view === 'collection') return 'book';
  return view === 'museum' ? (doing === 'call' ? 'museum' : doing) : view;
}
// Tells the server what the guest does, when it is new, or when the screen was touched.
function tell(touched = false) {
  const message = { type: 'kiosk', touched, showing: showing(), playing: plays() };
  const text = JSON.stringify(message);
  if (!touched && text === told) return;
  told = text.replace('"touched":true', '"touched":false');
  if (server_decides) send(message);
}
// A story or tour that has ended leads back to the book.
let played = false;
function follow_player() {
  const now = view === 'museum' && !by_id('player').hidden;
  if (played && !now && view === 'museum' && ['story', 'tour'].includes(doing)) show('book');
  played = now;
  tell();
}
const plays = () => slides.playing()
    || (view === 'museum' && !by_id('player').hidden
      && by_id('player-pause').dataset.next === 'pause');

// The pictures of the museum are drawn at full rate only where they are seen.
function want_pictures() {
  const met = ['person', 'engaged', 'farewell'].includes(stage);
  const seen = !closed && (view === 'museum' || (view === 'well' && met));
  const wanted = seen ? 0 : idle_fps;
  if (wanted === fps) return;
  send({ type: 'settings', fps: fps = wanted });
}

const covers_book = (what) => ['museum', 'slides', 'collection'].includes(what);
// Shows a view. what: well, book, slides, collection or museum; activity: story, tour, walk or
// call.
function show(what, activity = '') {
  const before = view;
  clearTimeout(opening);
  if (before === 'museum' && what !== 'museum') leave_museum();
  if (before === 'slides' && what !== 'slides') slides.close();
  if (map) close_map();
  view = what;
  doing = activity;
  document.body.dataset.view = what;
  document.body.dataset.doing = activity;
  by_id('museum').hidden = what !== 'museum';
  by_id('stick').hidden = by_id('walk-hint').hidden = activity !== 'walk';
  by_id('places').hidden = activity !== 'walk';
  if (what === 'book') {
    well.raise_book(true);
    // The book opens when it has come up; from a presentation it lies open still.
    if (before === 'well' && !document.body.classList.contains('still-water'))
      opening = setTimeout(() => book.open(true), 1500);
    else if (by_id('book').hidden) book.open(true);
  } else if (what === 'well') {
    well.raise_book(false);
    book.open(false);
  }
  if (what === 'collection') open_map();
  const covered = covers_book(what);
  by_id('book').classList.toggle('covered', covered);
  well.hide(closed || covered);
  want_pictures();
  tell();
}
function leave_museum() {
  send({ type: 'input', seq: ++seq, move: [0, 0, 0], look: [0, 0] });
  if (doing === 'tour') send({ type: 'tour', action: 'stop' });
  if (!by_id('player').hidden) { sound.stop(); send({ type: 'storyteller', action: 'stop' }); }
  go_home();
}

function enter(next) {
  if (next === stage) return;
  const before = stage;
  stage = next;
  document.body.dataset.stage = stage;
  well.stage(stage);
  if (stage === 'farewell' && view !== 'well') show('well');
  if (stage === 'sleep' || (stage === 'awake' && before === 'farewell')) house_again();
  notice();
  want_pictures();
}
// Nothing of a guest stays: language, volume and view are the house's.
function house_again() {
  if (view !== 'well') show('well');
  take_along.hide();
  subtitles.show({});
  sound.reset();
  set_volume(house_volume);
  if (lang !== house_lang) speak(house_lang);
}
function speak(tag) {
  lang = tag;
  translate_page(lang);
  slides.lang(lang);
  send({ type: 'settings', lang });
  label();
}
function label() {
  by_id('open-book').textContent = kiosk_word(lang, 'touch_twice');
  by_id('to-book').textContent = kiosk_word(lang, 'to_book');
  by_id('walk-hint').textContent = kiosk_word(lang, 'walk_hint');
  by_id('gestures').textContent = kiosk_word(lang, 'gesture_hint');
  by_id('volume').ariaLabel = kiosk_word(lang, 'louder');
  by_id('take-along').lastElementChild.textContent = kiosk_word(lang, 'take_along');
  sound.relabel();
  if (about) book.fill(about, lang);
}
let lost = false, elsewhere = false, untrusted = false;
function notice() {
  const text = untrusted ? kiosk_word(lang, 'not_trusted') : lost ? word(lang, 'lost')
    : stage === 'farewell' ? kiosk_word(lang, 'goodbye')
      : elsewhere && view === 'museum' ? kiosk_word(lang, 'elsewhere')
        : quiet && stage === 'person' ? kiosk_word(lang, 'headphones') : '';
  document.body.classList.toggle('untrusted', untrusted);
  by_id('notice').textContent = text;
  by_id('notice').hidden = !text;
}

// A gesture in the air does what a touch does.
function gesture(name) {
  const digit = /^digit_(\d)$/.exec(name)?.[1] ?? /^(\d)$/.exec(name)?.[1];
  if (view === 'slides') {
    if (name === 'swipe_left') slides.step(1);
    else if (name === 'swipe_right') slides.step(-1);
    else if (name === 'swipe_down' || name === 'stop') show('book');
  } else if (view === 'collection') {
    if (name === 'swipe_left') map.next(1);
    else if (name === 'swipe_right') map.next(-1);
    else if (name === 'swipe_up') map.dive();
    else if (name === 'swipe_down' && !map.back()) show('book');
    else if (name === 'stop') show('book');
    else if (digit) map.alone(Number(digit) - 1);
  } else if (view === 'book') {
    if (name === 'swipe_left') book.turn(1);
    else if (name === 'swipe_right') book.turn(-1);
    else if (name === 'swipe_down') show('well');
    else if (digit) book.choose(Number(digit));
    else if (name === 'stop') book.choose(5);  // five fingers, where nothing is to be stopped
  } else if (view === 'well' && name === 'swipe_up') show('book');
}

function hear_kiosk(message) {
  show_calibration(message.calibration, lang);
  show_holding(message.holding, lang);
  point(message.points_at);
  server_decides = 'stage' in message;
  const cameras = message.cameras ?? 0;
  sound.stands_behind(Math.max(0, (message.distance ?? viewing_distance) - viewing_distance));
  well.guest(message.distance ? [message.aside ?? 0, 0, message.distance] : null);
  house_volume = message.volume ?? 1;
  if (['sleep', 'awake'].includes(stage)) set_volume(house_volume);
  elsewhere = message.storyteller === 'elsewhere';
  book.heard(message.heard ?? []);
  by_id('gestures').hidden = cameras === 0;
  const at = message.stage ?? { absent: 'sleep', motion: 'awake', person: 'person' }[message.state];
  // Without a camera the well is always awake: nobody else could wake it for a passer-by.
  enter(at === 'sleep' && cameras === 0 ? 'awake' : at);
  if (message.gesture && message.gesture.number !== gesture_seen) {
    if (gesture_seen !== null || message.gesture.number === 1) gesture(message.gesture.name);
    gesture_seen = message.gesture.number;
  }
  notice();
}

// The house's day: closed, the screen is dark and draws nothing; quiet, headphones are offered; in
// the night the page begins anew.
let quiet = false, closed = false;
function hear_house(message) {
  take_along.house(message);
  if (message.reload && ['sleep', 'awake'].includes(stage) && view === 'well') {
    location.reload();
    return;
  }
  closed = !message.open;
  quiet = !!message.headphones;
  document.body.classList.toggle('closed', closed);
  if (closed) house_again();
  well.hide(closed || covers_book(view));
  notice();
  want_pictures();
}

async function read_exhibit(message) {
  try {
    about = await (await fetch(`api/v1/exhibits/${encodeURIComponent(message.exhibit)}`)).json();
  } catch {
    return;  // the line broke: the next welcome asks again
  }
  about.viewpoint_of_storyteller =
      message.storyteller?.viewpoint ?? message.viewpoints[0]?.name ?? '';
  book.fill(about, lang);
}

connection = make_connection({
  hello: () => ({ type: 'hello', exhibit: '', lang, role: 'kiosk', parts: true,
    kiosk: asked.get('kiosk') ?? '', token: kiosk_token(), ...wanted_size(), ...screen.hello(),
    ...(asked.has('wall') && { wall: { name: asked.get('wall') } }) }),
  open() {
    lost = untrusted = false;
    fps = null;
    told = '';
    gesture_seen = null;
    notice();
    sound.joined();
    screen.joined();
    if (asked.get('teller')) send({ type: 'storyteller', teller: asked.get('teller') });
    want_pictures();
    tell();
  },
  lost() { lost = true; server_decides = false; notice(); },
  message(message) {
    switch (message.type) {
      case 'welcome':
        exhibit = message.exhibit;
        screen.welcome(message);
        by_id('title').textContent = document.title = message.title;
        walk_speed = message.walk_speed;
        ambience.places(message.sounds);
        player.welcome(message);
        by_id('places').replaceChildren(...message.viewpoints.map(({ name, title }) => {
          const button = document.createElement('button');
          button.type = 'button';
          button.textContent = title;
          button.dataset.viewpoint = name;
          button.addEventListener('click', () => send({ type: 'viewpoint', seq: ++seq, name }));
          return button;
        }));
        read_exhibit(message);
        break;
      case 'state':
        state = message;
        sound.moved(message);
        ambience.moved(message);
        player.state(message);
        for (const button of by_id('places').children)
          button.setAttribute('aria-current',
              String(button.dataset.viewpoint === message.viewpoint));
        follow_player();
        break;
      case 'pose': screen.pose(message); break;
      case 'speech': sound.speech(message); break;
      case 'subtitle': subtitles.show(message); break;
      case 'kiosk': hear_kiosk(message); break;
      case 'announce': announce(message, lang); break;
      case 'house': hear_house(message); break;
      case 'agent':
        document.body.dataset.mood = message.mood;
        document.body.dataset.teller = message.teller;
        player.agent(message);
        take_along.follow(exhibit, message.story, lang);
        follow_player();
        break;
      case 'error':
        console.warn(`${message.code}: ${message.message}`);
        if (message.code === 'not_trusted') { untrusted = true; notice(); }
        break;
    }
  },
  binary: (buffer) => { if (!sound.receive(buffer)) screen.receive(buffer); },
});
label();

// Touches: of the water, twice for the book; and any of them tells that somebody is there.
let last_touch = { at: -1e9, x: 0, y: 0 };
by_id('well').addEventListener('pointerdown', (event) => {
  if (view !== 'well') return;
  well.touch(event.clientX, event.clientY);
  const now = performance.now() / 1000, { at, x, y } = last_touch;
  const again = now - at < double_touch.seconds
      && Math.hypot(event.clientX - x, event.clientY - y) < double_touch.pixels;
  last_touch = again ? { at: -1e9, x: 0, y: 0 } : { at: now, x: event.clientX, y: event.clientY };
  if (again) { well.drop_at(event.clientX, event.clientY); show('book'); }
});
by_id('well').addEventListener('pointermove', (event) => {
  if (view === 'well' && event.buttons) well.touch(event.clientX, event.clientY, 0.012);
});
by_id('open-book').addEventListener('click', () => show('book'));
by_id('to-book').addEventListener('click', () => show('book'));
for (const kind of ['pointerdown', 'keydown'])
  addEventListener(kind, () => {
    const now = performance.now();
    if (now - touched_at < touch_interval) return;
    touched_at = now;
    tell(true);
    if (!server_decides && stage !== 'engaged') enter('person');
  }, { capture: true, passive: true });
addEventListener('contextmenu', (event) => event.preventDefault());
// Without a server's word the house comes back by itself.
setInterval(() => {
  if (!server_decides && view !== 'well' && !plays()
      && performance.now() - touched_at > 1000 * alone_after) house_again();
}, 1000);

make_controls(by_id('picture'), by_id('stick'), by_id('stick-knob'), {
  send({ moved, ...fields }) {
    if (view !== 'museum' || doing !== 'walk') return;
    send({ type: 'input', seq: ++seq, ...fields });
    screen.input(seq, fields, moved);
  },
  fov: () => state?.fov ?? 1,
  speed: () => walk_speed,
  place() {},
});
addEventListener('resize', () => send({ type: 'settings', ...wanted_size() }));
setInterval(() => tell(), 500);
