// SPDX-License-Identifier: Apache-2.0
// A collection as a map: joins the server's maps, what is drawn of them, and what the visitor does.
import { make_details } from './details.js';
import { make_fingers } from './fingers.js';
import { make_frame } from './frame.js';
import { make_groups, name_of } from './groups.js';
import { listen_to_keys } from './keys.js';
import { fetch_level, group_places, place_items } from './levels.js';
import { make_list } from './list.js';
import { make_pictures } from './pictures.js';
import { in_circle, nearest_place, next_place, usual_radius } from './places.js';
import { dot_radius, draw_plane } from './plane.js';
import { circle_step, groups_step, make_trail, read_steps } from './trail.js';
import { map_truth, place_truth } from './truth.js';
import { make_view } from './view.js';
import { map_word } from './words.js';

const move_time = 900;          // milliseconds from map to map
const list_pause = 150;         // milliseconds that the view rests before the list follows
const bar_height = 76;          // pixels that the circle's slider covers at the lower edge
const usual_font = 16;          // pixels

// exhibit: its id. place: the element that the map is put in. orders: {there(object): takes the
// visitor to it, close() or null, changed(trail): another map is seen, touched(): somebody does
// something}. outside: whether links may leave the page.
export function make_collection({ exhibit, lang, place, orders, outside = true }) {
  const word = (name, values) => map_word(lang, name, values);
  const calm = matchMedia('(prefers-reduced-motion: reduce)');
  const view = make_view(), pictures = make_pictures(() => draw());
  let trail = make_trail(), level = null, items = [], group_at = [];
  let selected = -1, hovered = -1, radius = 0, bent = 0.6, opened = false, began = 0;
  let asked = 0, drawing = false, list_timer = 0, last = -1, unit = 1;

  const details = make_details(word, { there: orders.there, close: () => choose(-1) }, outside);
  const groups = make_groups(word, { changed: () => { draw(); follow_list(); },
    alone: (numbers) => go_on(groups_step(numbers),
        word('only', { groups: numbers.map((i) => group_name(i)).join('; ') })) });
  const list = make_list(lang, { choose: (index) => choose(index_of(index), { from_list: true }),
    open: (index) => choose(index_of(index), { open: true }) });
  const frame = make_frame({
    back, close: orders.close, zoom: zoom_middle, whole: show_all, radius: slide, dive,
    again: () => load(), crumb: (depth) => { trail.cut(depth); load(); },
  }, { details: details.element, groups: groups.element, list: list.element });
  const { canvas } = frame;
  place.replaceChildren(frame.root);

  const group_name = (number) => name_of(level.clusters[number]) || word('mixed');
  const index_of = (index) => items.findIndex((item) => item.index === index);
  const places = () => items.map(({ to }) => to);
  const lit = () => (groups.pressed().size ? groups.pressed() : null);
  const may_choose = (i) => !lit() || lit().has(items[i].group);
  const longest = () => Math.max(1e-9, ...places().map((one) => Math.hypot(...one)));
  const covered = () => (selected >= 0 ? bar_height : frame.hint.offsetHeight);

  // The slider's value and the circle's radius: fine steps for small circles.
  const share_of = (value) => Math.sqrt(Math.min(1, value / (2 * longest())));
  const circle_now = () => (selected < 0 ? null : { at: items[selected].at, radius, bent,
    inside: new Set(in_circle(places(), items[selected].to, radius)) });

  function draw() {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(() => {
      drawing = false;
      if (!frame.root.isConnected || !level) return;
      const passed = calm.matches ? 1 : Math.min(1, (performance.now() - began) / move_time);
      const t = passed * passed * (3 - 2 * passed);
      for (const item of items) {
        item.at = [0, 1].map((k) => item.from[k] + (item.to[k] - item.from[k]) * t);
        item.seen = item.from_seen + (1 - item.from_seen) * t;
      }
      draw_plane(canvas.getContext('2d'), { view, items, selected, hovered,
        stress: level.stress, circle: circle_now(), lit: lit(), unit,
        ratio: canvas.width / view.width(),
        groups: group_at.map((at, i) => ({ at, terms: level.clusters[i].terms })),
        image: (item) => pictures.of(item.picture) });
      canvas.dataset.settled = String(passed >= 1);
      if (selected >= 0)
        canvas.dataset.at = view.to_screen(items[selected].at).map(Math.round).join(',');
      if (passed < 1) draw();
    });
  }

  function resize() {
    const { width, height } = canvas.getBoundingClientRect();
    if (!width || !height) return;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    unit = parseFloat(getComputedStyle(frame.root).fontSize) / usual_font;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const first = view.width() <= 1, zoomed = view.zoom() > 1.01;
    view.resize(width, height);
    if (level && (first || !zoomed)) view.fit(places(), covered());
    draw();
    follow_list();
  }
  const observer = new ResizeObserver(resize);
  observer.observe(canvas);

  // The list follows when the view has come to rest.
  function follow_list() {
    clearTimeout(list_timer);
    list_timer = setTimeout(() => {
      if (!level) return;
      const seen = items.filter((item, i) => may_choose(i) && view.has(view.to_screen(item.to)));
      frame.list_title.textContent = word('list_count', { n: seen.length });
      list.fill(seen.map(({ index, title, maker, date, group }) => ({ index, title, group,
        text: [maker, date].filter(Boolean).join(' · ') })), word('list'));
      list.choose(selected < 0 ? -1 : items[selected].index);
    }, list_pause);
  }

  const say = (...parts) => { frame.live.textContent = parts.filter(Boolean).join(' '); };
  function tell_item(i) {
    const { title, maker, date, group, stress, object } = items[i];
    say(`${[title, maker, date].filter(Boolean).join(', ')}.`,
        word('of_group', { group: group_name(group) }),
        word(`truth_${place_truth(stress, level.stress)}`), object && word('in_exhibit'));
  }
  function show_circle() {
    frame.circle.hidden = selected < 0;
    frame.hint.hidden = selected >= 0;
    if (selected < 0) return;
    const inside = circle_now().inside.size, text = word('inside', { n: inside });
    frame.inside.textContent = text;
    frame.slider.value = String(share_of(radius));
    frame.slider.setAttribute('aria-valuetext', text);
    frame.dive.disabled = inside < 2 || trail.is_full() || inside === level.region;
  }

  function show_details(open) {
    opened = open;
    if (!open) return details.hide();
    const item = items[selected];
    details.show(item, { name: group_name(item.group), number: item.group }, level.stress);
  }
  // Chooses an object; -1: none. from_list: the list has the focus and keeps its place.
  function choose(i, { open = false, from_list = false } = {}) {
    const had_focus = details.element.contains(document.activeElement);
    if (i >= 0 && i !== selected) radius = usual_radius(places(), items[i].to);
    selected = i;
    if (i >= 0) {
      last = i;
      if (view.reveal(items[i].to, covered()) && !from_list) follow_list();
      if (!from_list || open) tell_item(i);
    }
    if (i < 0 || open || opened) show_details(i >= 0);
    if (i < 0 && had_focus) canvas.focus({ preventScroll: true });
    list.choose(i < 0 ? -1 : items[i].index);
    canvas.dataset.item = i < 0 ? '' : items[i].id;
    show_circle();
    draw();
    orders.touched?.();
  }
  function set_radius(value) {
    if (selected < 0) return;
    radius = Math.min(2 * longest(), Math.max(longest() / 500, value));
    show_circle();
    draw();
  }
  function slide(share) { set_radius(share * share * 2 * longest()); }

  function zoom(factor, at) {
    view.zoom_at(factor, at);
    draw();
    follow_list();
  }
  function zoom_middle(factor) {
    zoom(factor, selected < 0 ? [view.width() / 2, view.height() / 2]
      : view.to_screen(items[selected].to));
  }
  function pan(dx, dy) {
    view.pan(dx, dy);
    draw();
    follow_list();
  }
  function show_all() {
    if (!level) return;
    view.fit(places(), covered());
    draw();
    follow_list();
  }

  function tell_about() {
    const { objects, region, stress, too_near, items: { length } } = level;
    const texts = [region === objects ? word('region', { n: region })
      : word('region_part', { n: region, all: objects }),
    ...(length < region ? [word('shown', { n: length })] : []), word(`stress_${map_truth(stress)}`),
    ...(too_near ? [word('too_near', { n: too_near })] : [])];
    frame.about.replaceChildren(...texts.map((text) => {
      const line = document.createElement('p');
      line.textContent = text;
      return line;
    }));
    frame.about.dataset.stress = String(stress);
    return texts;
  }
  function show_trail() {
    const names = trail.names(), text = trail.text().split(';');
    frame.trail(names.map((name, i) => name || text[i]), word('everything'));
  }

  // Shows the map of the trail. is_new: the visitor came there, not the page's history.
  async function load({ is_new = true } = {}) {
    const mine = ++asked;
    frame.say_state(word('loading'));
    show_trail();
    const { status, level: answer } =
        await fetch_level(exhibit, trail.text(), () => mine === asked);
    if (mine !== asked) return;
    if (status === 404 && trail.depth()) {
      say(word('gone'));
      trail.cut(0);
      return load();
    }
    if (!answer) {
      frame.say_state(word(status === 404 ? 'no_collection' : 'failed'), status !== 404);
      return;
    }
    frame.say_state('');
    const pivot = items[selected]?.index ?? -1;
    level = answer;
    level.items.forEach((item) => { item.group = item.cluster; });
    place_items(level.items, items);
    ({ items } = level);
    group_at = group_places(items, level.clusters);
    selected = hovered = -1;
    last = index_of(pivot);
    began = performance.now();
    pictures.forget();
    show_details(false);
    frame.title.textContent = level.title[lang] ?? level.title[lang.split('-')[0]]
      ?? Object.values(level.title)[0] ?? '';
    groups.fill(level.clusters);
    list.clear();
    show_circle();
    show_trail();
    view.fit(places(), covered());
    say(...tell_about());
    canvas.dataset.item = '';
    canvas.dataset.trail = trail.text();
    canvas.dataset.items = String(items.length);
    if (is_new) orders.changed?.(trail.text());
    draw();
    follow_list();
  }
  function go_on(step, name) {
    if (trail.is_full()) return;
    trail.add(step, name);
    load();
    canvas.focus({ preventScroll: true });
  }
  function dive() {
    if (selected < 0 || frame.dive.disabled) return;
    const { index, title } = items[selected];
    go_on(circle_step(index, radius), word('around', { title }));
  }
  function back() {
    if (trail.depth() === 0) return false;
    trail.cut(trail.depth() - 1);
    load();
    return true;
  }
  function leave() {
    if (selected >= 0) choose(-1);
    else if (!back()) orders.close?.();
  }
  function step([dx, dy]) {
    if (!level) return;
    const from = selected >= 0 ? selected : last;
    const middle = view.middle();
    const to = from < 0 || !may_choose(from) ? nearest_place(places(), middle, Infinity, may_choose)
      : selected < 0 ? from : next_place(places(), from, [dx, dy], may_choose);
    if (to >= 0) choose(to);
  }

  make_fingers(canvas, {
    find: (at, reach) => nearest_place(items.map((item) => view.to_screen(item.at)), at,
        Math.max(reach, dot_radius(view, items.length, unit) + 4), may_choose),
    circle: () => (selected < 0 ? null : { at: view.to_screen(items[selected].at),
      radius: radius * view.scale(), index: selected }),
    orders: {
      choose: (i, again) => { choose(i, { open: true }); if (again) dive(); },
      size(i, pixels, at) {
        if (i !== selected) choose(i);
        const [x, y] = view.to_screen(items[i].to);
        bent = Math.atan2(y - at[1], at[0] - x);
        set_radius((pixels ?? Math.hypot(at[0] - x, at[1] - y)) / view.scale());
      },
      pan, zoom, grow: (factor) => set_radius(radius * factor),
      hover(i) { if (i !== hovered) { hovered = i; draw(); } },
      nothing(again, at) { if (again) zoom(2, at); else choose(-1); },
    },
  });
  listen_to_keys(frame.root, canvas, { step, back, leave, pan, whole: show_all, zoom: zoom_middle,
    grow: (factor) => set_radius(radius * factor), group: groups.toggle,
    enter() {
      if (selected < 0) step([0, 0]);
      else if (opened) dive();
      else show_details(true);
    } });
  frame.label(word);
  document.fonts?.ready.then(() => draw());

  return {
    root: frame.root,
    // text: a trail, as an address has it.
    open(text = '', is_new = true) {
      trail = make_trail(read_steps(text));
      load({ is_new });
      canvas.focus({ preventScroll: true });
    },
    // Another trail, of the page's history.
    show(text) { trail.set(text); load({ is_new: false }); },
    // Swipes and numbers in the air.
    next: (by) => step([by, 0]),
    dive() { if (selected >= 0 && !opened) show_details(true); else dive(); },
    back: () => { if (selected >= 0) { choose(-1); return true; } return back(); },
    // Looks at one of the groups alone.
    alone(number) {
      if (level?.clusters[number])
        go_on(groups_step([number]), word('only', { groups: group_name(number) }));
    },
    focus: () => canvas.focus({ preventScroll: true }),
    close() {
      asked++;
      observer.disconnect();
      clearTimeout(list_timer);
      pictures.forget();
      place.replaceChildren();
    },
  };
}
