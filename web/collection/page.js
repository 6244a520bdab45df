// SPDX-License-Identifier: Apache-2.0
// The map of a collection as a page of its own: collection.html?exhibit=ID#TRAIL. Going back in the
// browser goes back on the trail.
import { asked_exhibit } from '../address.js';
import { by_id, element } from '../element.js';
import { first_language, knows, text_in } from '../words.js';
import { make_collection } from './collection.js';
import { map_word } from './words.js';

const api = 'api/v1/exhibits', retry_after = 5000;  // milliseconds
const trail_of = (hash) => decodeURIComponent(hash.slice(1));

async function get(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer.json();
}

// The exhibit that was asked for, else the first that has a collection.
async function find_exhibit() {
  const { exhibits } = await get(api);
  const wanted = asked_exhibit ? exhibits.filter(({ id }) => id === asked_exhibit) : exhibits;
  for (const { id } of wanted) {
    const about = await get(`${api}/${encodeURIComponent(id)}`);
    if (about.collection) return { ...about, id };
  }
  return null;
}

async function show() {
  const exhibit = await find_exhibit();
  let lang = first_language();
  if (!exhibit) {
    document.documentElement.lang = lang;
    by_id('problem').textContent = map_word(lang, 'no_collection');
    by_id('problem').hidden = false;
    return;
  }
  const { id, languages } = exhibit;
  if (!knows(lang, languages)) [lang] = languages;
  document.documentElement.lang = lang;
  document.title = text_in(exhibit.collection, lang, languages);
  const door = (object = '') => `e/${encodeURIComponent(id)}?${new URLSearchParams({ lang,
    ...(object && { object }) })}`;
  const map = make_collection({ exhibit: id, lang, place: by_id('collection'), orders: {
    there(object) { location.href = door(object); },
    changed(trail) {
      if (trail !== trail_of(location.hash))
        history.pushState(null, '', trail ? `#${trail}` : location.pathname + location.search);
    },
  } });
  map.root.querySelector('header').append(element('a.to-exhibit', { href: door(),
    textContent: map_word(lang, 'to_exhibit') }));
  map.open(trail_of(location.hash));
  addEventListener('popstate', () => map.show(trail_of(location.hash)));
}

document.body.classList.add('runs');
try {
  await show();
} catch {
  by_id('problem').textContent = map_word(first_language(), 'failed');
  by_id('problem').hidden = false;
  setTimeout(() => location.reload(), retry_after);
}
