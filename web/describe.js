// SPDX-License-Identifier: Apache-2.0
// Describes the picture in words, for those who do not see it: the visitor's place, and objects in
// view on either side. The words are renewed when the visitor has come to rest.
import { by_id } from './element.js';
import { text_in, word } from './words.js';

const rest = 1200;        // milliseconds in which nothing moves
const here = 0.6;         // metres from a place that still are that place
const farthest = 15;      // metres to objects that are named
const most = 4;           // objects at a time, the nearest ones
const middle = 1 / 3;     // share of half the picture's width: straight ahead

const turn = (from, to) => Math.atan2(Math.sin(to - from), Math.cos(to - from));

// Returns objects in view: [{object, side: left, ahead or right}], nearest first. view: {position,
// yaw, fov}; fov: radians of the height, `aspect` times as wide.
export function in_view(objects, { position, yaw, fov }, aspect) {
  const half = Math.atan(Math.tan(fov / 2) * aspect);
  return objects.filter((object) => object.position)
      .map((object) => {
        const [x, , z] = object.position.map((v, i) => v - position[i]);
        return { object, away: Math.hypot(x, z), angle: turn(yaw, Math.atan2(-x, -z)) };
      })
      .filter(({ away, angle }) => away < farthest && Math.abs(angle) < half)
      .sort((a, b) => a.away - b.away).slice(0, most)
      .map(({ object, angle }) => ({ object,
        side: Math.abs(angle) < half * middle ? 'ahead' : angle > 0 ? 'left' : 'right' }));
}

// Returns the viewpoint that is nearest: {place, here: whether the visitor is there}; undefined:
// there is none.
export function nearest(viewpoints, position) {
  const away = (one) => Math.hypot(...one.position.map((v, i) => v - position[i]));
  const place = [...viewpoints].sort((a, b) => away(a) - away(b))[0];
  return place && { place, here: away(place) < here };
}

// element: what the words are written into.
export function make_description(element) {
  let lang = 'en', languages = [], objects = [], viewpoints = null, view = null, timer = 0,
      exhibit = '';

  // Titles and positions of the places, once they are needed.
  async function load() {
    viewpoints = [];
    const answer = await fetch(`api/v1/exhibits/${encodeURIComponent(exhibit)}`).catch(() => null);
    if (answer?.ok) ({ viewpoints, languages } = await answer.json());
  }

  async function say() {
    if (!viewpoints) await load();
    if (!view) return;  // a new welcome came meanwhile
    const parts = [], at = nearest(viewpoints, view.position);
    if (at)
      parts.push(word(lang, at.here ? 'scene_at' : 'scene_near')
          .replace('{place}', text_in(at.place.title, lang, languages)));
    const canvas = by_id('picture');
    const seen = in_view(objects, view, canvas.width / Math.max(1, canvas.height));
    const list = seen.map(({ object, side }) =>
      word(lang, `scene_${side}`).replace('{name}', object.title)).join('; ');
    if (list) parts.push(word(lang, 'scene_view').replace('{list}', list));
    const text = parts.join(' ');
    if (element.textContent !== text) element.textContent = text;
  }

  return {
    welcome(message) {
      if (message.exhibit !== exhibit) viewpoints = null;
      ({ lang, objects, exhibit } = message);
      view = null;
    },
    state({ position, yaw, fov }) {
      const now = [...position, yaw, fov], before = view && [...view.position, view.yaw, view.fov];
      if (before && now.every((v, i) => Math.abs(v - before[i]) < 0.01)) return;
      view = { position, yaw, fov };
      clearTimeout(timer);
      timer = setTimeout(say, rest);
    },
  };
}
