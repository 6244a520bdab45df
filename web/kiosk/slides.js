// SPDX-License-Identifier: Apache-2.0
// A presentation: slides of pictures, video and text; played, stopped, forward, back, with its
// progress.
import { element } from '../element.js';
import { kiosk_word, local } from './words.js';

const icons = {
  back: 'M18 6v12l-9-6zM6 6v12', play: 'M8 5.5v13l11-6.5z', pause: 'M9 6v12M15 6v12',
  forward: 'M6 6v12l9-6zM18 6v12', stop: 'M7 7h10v10H7z',
};
function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(svg.namespaceURI, 'path');
  path.setAttribute('d', icons[name]);
  svg.append(path);
  return svg;
}

// events: {ended(), changed()}.
export function make_slides(place, events) {
  let shown = null, lang = 'en', at = 0, playing = false, volume = 1;
  let left = 0, since = 0, timer = 0;  // milliseconds that a picture still stays
  const stage = element('div.stage'), text = element('div.caption');
  const progress = element('div.progress', { role: 'group' });
  const buttons = Object.fromEntries(['back', 'play', 'forward', 'stop'].map((name) =>
    [name, element('button.round', { type: 'button', dataset: { action: name } }, icon(name))]));
  place.replaceChildren(stage, text, progress,
      element('div.controls', { role: 'group' }, ...Object.values(buttons)));
  buttons.back.addEventListener('click', () => step(-1));
  buttons.forward.addEventListener('click', () => step(1));
  buttons.play.addEventListener('click', () => (playing ? pause() : play()));
  buttons.stop.addEventListener('click', () => events.ended());

  const video = () => stage.querySelector('video:not(.leaving)');
  const slide = () => shown.slides[at];
  function label() {
    const word = (name) => kiosk_word(lang, name);
    for (const [name, button] of Object.entries(buttons))
      button.ariaLabel = word(name === 'play' && playing ? 'pause' : name);
    buttons.play.replaceChildren(icon(playing ? 'pause' : 'play'));
    buttons.play.ariaPressed = String(playing);
    buttons.back.disabled = at === 0;
    place.dataset.slide = at;
    place.dataset.playing = playing;
    progress.ariaLabel = kiosk_word(lang, 'picture_of', { n: at + 1, all: shown.slides.length });
    [...progress.children].forEach((one, i) => {
      one.dataset.state = i < at ? 'past' : i > at ? 'ahead' : playing ? 'runs' : 'now';
      one.style.setProperty('--seconds', `${Math.max(0, left) / 1000}s`);
    });
    events.changed();
  }
  function words_of() {
    const { title, text: words } = slide();
    text.replaceChildren(...(title ? [element('h2', { textContent: local(title, lang) })] : []),
        ...(words ? [element('p', { textContent: local(words, lang) })] : []));
    text.hidden = !title && !words;
  }
  function enter() {
    clearTimeout(timer);
    for (const old of stage.children) {
      old.classList.add('leaving');
      old.pause?.();
      setTimeout(() => old.remove(), 900);
    }
    const one = slide(), alt = local(one.alt, lang);
    if (one.video) {
      const film = element('video', { src: one.video, ariaLabel: alt, playsInline: true, volume });
      film.addEventListener('ended', () => { if (playing) step(1); });
      film.addEventListener('error', () => { if (playing) wait(); });
      stage.append(film);
    } else if (one.image) {
      stage.append(element('img', { src: one.image, alt, draggable: false }));
    }
    place.classList.toggle('words-only', !one.image && !one.video);
    words_of();
    left = 1000 * (one.seconds ?? 10);
    if (playing) go_on();
    label();
  }
  function wait() {
    since = performance.now();
    clearTimeout(timer);
    timer = setTimeout(() => step(1), left);
  }
  function go_on() {
    const film = video();
    if (!film) return wait();
    // A browser that allows no sound yet plays it silently.
    film.play().catch(() => {
      film.muted = true;
      film.play().catch(() => { if (playing) wait(); });
    });
  }
  function play() { playing = true; go_on(); label(); }
  function pause() {
    if (playing && !video()) left = Math.max(500, left - (performance.now() - since));
    playing = false;
    clearTimeout(timer);
    video()?.pause();
    label();
  }
  function step(by) {
    if (at + by >= shown.slides.length) { events.ended(); return false; }
    if (at + by < 0) return false;
    at += by;
    enter();
    return true;
  }
  return {
    open(presentation, tag) {
      shown = presentation;
      lang = tag;
      at = 0;
      playing = true;
      progress.replaceChildren(...shown.slides.map(() => element('span')));
      place.hidden = false;
      enter();
    },
    close() {
      clearTimeout(timer);
      playing = false;
      shown = null;
      stage.replaceChildren();
      place.hidden = true;
    },
    lang(tag) { lang = tag; if (shown) { words_of(); label(); } },
    loud(value) { volume = value; const film = video(); if (film) film.volume = value; },
    step, play, pause,
    playing: () => playing && shown !== null,
    is_open: () => shown !== null,
  };
}
