// SPDX-License-Identifier: Apache-2.0
// The book in front of the water: two pages side by side where the screen is wide, one where it is
// tall. A page turns under the finger, by its corner, or by a swipe in the air.
import { element } from '../element.js';
import { make_pages } from './pages.js';
import { kiosk_word } from './words.js';

const turn_seconds = 0.7;
const least_text = 0.62;  // share of the usual size; smaller text is scrolled instead

// place: the element that it lives in. orders: as of pages.js, and close(), turned(), lang(tag).
export function make_book(place, orders) {
  let about = null, lang = 'en', pages = [], starts = new Map(), at = 0, wide = true;
  let turning = null, heard = [];
  const calm = matchMedia('(prefers-reduced-motion: reduce)');
  const left = element('div.page.left'), right = element('div.page.right');
  const sheets = element('div.sheets', {}, left, right);
  const corner = (name, onclick) => element(`button.corner.${name}`, { type: 'button', onclick },
      element('span', { ariaHidden: 'true', textContent: name === 'next' ? '›' : '‹' }));
  const forth = corner('next', () => turn(1)), back = corner('back', () => turn(-1));
  const tabs = element('nav.tabs'), sink = element('button.sink', { type: 'button' });
  const languages = element('div.languages', { role: 'group' });
  sink.addEventListener('click', () => orders.close());
  place.replaceChildren(element('div.cover', {}, sheets, back, forth, tabs),
      element('div.foot', {}, languages, sink));

  const step = () => (wide ? 2 : 1);
  // Content of page `index`, in its frame; too much text is set smaller, then scrolled.
  function fill(page, index) {
    page.replaceChildren(element('div.text', {}, ...(pages[index]?.make() ?? [])),
        element('p.number', { ariaHidden: 'true', textContent: pages[index] ? index + 1 : '' }));
    const body = page.firstChild;
    body.querySelectorAll('.entry').forEach((one, i) => {
      if (i < 9) one.dataset.number = i + 1;
    });
    let size = 1;
    const fit = () => {
      while (body.scrollHeight > body.clientHeight + 1 && size > least_text)
        body.style.fontSize = `${size -= 0.06}em`;
      page.classList.toggle('long', body.scrollHeight > body.clientHeight + 1);
    };
    fit();
    for (const image of body.querySelectorAll('img')) image.addEventListener('load', fit);
  }
  function show() {
    fill(left, wide ? at : -1);
    fill(right, wide ? at + 1 : at);
    left.hidden = !wide;
    back.disabled = at <= 0;
    forth.disabled = at + step() >= pages.length;
    const chapters = pages.slice(at, at + step()).map((page) => page.chapter);
    for (const tab of tabs.children)
      tab.setAttribute('aria-current',
          String(chapters.some((one) => one.startsWith(tab.dataset.chapter))));
    place.dataset.page = at;
    place.dataset.chapter = chapters.at(-1) ?? '';
  }

  // The leaf that is turned: its two faces, and what lies under it.
  function begin_turn(direction) {
    const to = at + direction * step();
    if (turning || to < 0 || to >= pages.length) return null;
    const front = element('div.page.face.right'), reverse = element('div.page.face.reverse.left');
    const leaf = element('div.leaf', {}, front, reverse);
    sheets.append(leaf);
    fill(front, wide ? (direction > 0 ? at + 1 : to + 1) : Math.min(at, to));
    if (wide) fill(reverse, direction > 0 ? to : at);
    else reverse.classList.add('empty');
    if (direction > 0) fill(right, wide ? to + 1 : to);
    else if (wide) fill(left, to);
    turning = { direction, to, leaf, angle: direction > 0 ? 0 : 180 };
    lay(turning.angle);
    return turning;
  }
  function lay(angle) {
    turning.angle = angle;
    turning.leaf.style.transform = `rotateY(${-angle}deg)`;
    turning.leaf.style.setProperty('--bent', Math.sin(angle * Math.PI / 180).toFixed(3));
  }
  function end_turn(done) {
    const mine = turning, goal = (mine.direction > 0) === done ? 180 : 0, from = mine.angle;
    const length = calm.matches ? 0 : turn_seconds * 1000 * Math.abs(goal - from) / 180;
    const began = performance.now();
    mine.ends = true;
    const frame = () => {
      if (turning !== mine) return;
      const t = length ? Math.min(1, (performance.now() - began) / length) : 1;
      lay(from + (goal - from) * (t * t * (3 - 2 * t)));
      if (t < 1) return requestAnimationFrame(frame);
      settle(done);
    };
    frame();
  }
  function settle(done) {
    if (!turning) return;
    const { to, leaf } = turning;
    turning = null;
    if (done) at = to;
    leaf.remove();
    show();
    if (done) orders.turned();
  }
  function turn(direction) {
    if (turning) settle(turning.ends !== undefined);
    if (!begin_turn(direction)) return false;
    end_turn(true);
    return true;
  }

  // Under the finger: a page is taken anywhere and follows.
  let held = null;
  sheets.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || held) return;
    held = { id: event.pointerId, x: event.clientX, y: event.clientY };
  });
  addEventListener('pointermove', (event) => {
    if (held?.id !== event.pointerId) return;
    const x = event.clientX - held.x, width = right.clientWidth || 1;
    if (!held.leaf) {
      if (Math.abs(x) < 14 || Math.abs(x) < Math.abs(event.clientY - held.y)) return;
      if (turning) settle(turning.ends !== undefined);
      held.leaf = begin_turn(x < 0 ? 1 : -1);
      if (!held.leaf) { held = null; return; }
      place.classList.add('held');
    }
    const share = Math.max(0, Math.min(1, -x * held.leaf.direction / (width * (wide ? 1.6 : 0.9))));
    lay(held.leaf.direction > 0 ? 180 * share : 180 - 180 * share);
    held.share = share;
  });
  for (const kind of ['pointerup', 'pointercancel'])
    addEventListener(kind, (/** @type {PointerEvent} */ event) => {
      if (held?.id !== event.pointerId) return;
      if (held.leaf && turning === held.leaf) end_turn(kind === 'pointerup' && held.share > 0.22);
      held = null;
      setTimeout(() => place.classList.remove('held'));
    });
  // A finger that turned a page did not press what lay under it.
  sheets.addEventListener('click', (event) => {
    if (!place.classList.contains('held')) return;
    event.preventDefault();
    event.stopPropagation();
  }, true);

  function rebuild(chapter) {
    if (!about) return;
    wide = innerWidth > innerHeight;
    place.classList.toggle('wide', wide);
    ({ pages, starts } = make_pages({ about, lang, wide, heard, orders: { ...orders, go } }));
    tabs.replaceChildren(...['contents', 'topic', 'presentations', 'museum', 'partners']
        .filter((name) => [...starts.keys()].some((key) => key.startsWith(name)))
        .map((name) => element('button', { type: 'button', dataset: { chapter: name },
          textContent: kiosk_word(lang, name === 'topic' ? 'topics' : name),
          onclick: () => go(name) })));
    languages.replaceChildren(...about.languages.map((tag) => element('button', { type: 'button',
      lang: tag, textContent: orders.language_name(tag), onclick: () => orders.lang(tag),
      ariaPressed: String(tag === lang || tag === lang.split('-')[0]) })));
    languages.hidden = about.languages.length < 2;
    sink.textContent = kiosk_word(lang, 'close_book');
    forth.ariaLabel = kiosk_word(lang, 'page_next');
    back.ariaLabel = kiosk_word(lang, 'page_back');
    if (turning) { turning.leaf.remove(); turning = null; }
    at = 0;
    if (chapter) jump(chapter);
    show();
  }
  function jump(chapter) {
    const key = [...starts.keys()].find((one) => one === chapter)
        ?? [...starts.keys()].find((one) => one.startsWith(chapter));
    const page = starts.get(key) ?? 0;
    at = wide ? page - page % 2 : page;
  }
  function go(chapter) {
    if (turning) settle(turning.ends !== undefined);
    jump(chapter);
    show();
    orders.turned();
  }
  let shape = innerWidth > innerHeight;
  addEventListener('resize', () => {
    const is = innerWidth > innerHeight;
    if (is !== shape) rebuild(place.dataset.chapter);
    else if (about) show();
    shape = is;
  });

  return {
    // Fills the book with the exhibit, in that language; the chapter stays open.
    fill(what, tag) {
      about = what;
      lang = tag;
      rebuild(place.dataset.chapter);
    },
    open(yes) {
      place.hidden = !yes;
      if (yes) { jump('contents'); show(); }
    },
    turn,
    // Takes the stories that this guest has heard.
    heard(ids) {
      if (ids.join() === heard.join()) return;
      heard = ids;
      rebuild(place.dataset.chapter);
    },
    // Entry n (1 to 9) of the pages that lie open. True: there is one.
    choose(n) {
      const entries = [...sheets.querySelectorAll('.entry')].filter((one) => !one.closest('.leaf'));
      entries[n - 1]?.click();
      return !!entries[n - 1];
    },
    chapter: () => place.dataset.chapter ?? '',
  };
}
