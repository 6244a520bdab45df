// SPDX-License-Identifier: Apache-2.0
// The front door: the exhibits of a museum that has more than one.
import { first_language, text_in, translate_page, word } from './words.js';

const lang = first_language();
const list = document.getElementById('exhibits');

function tile(exhibit) {
  const item = document.createElement('li'), link = document.createElement('a');
  const poster = document.createElement('img'), words = document.createElement('span');
  const title = document.createElement('strong'), about = document.createElement('span');
  link.href = `e/${encodeURIComponent(exhibit.id)}`;
  poster.src = exhibit.poster.slice(1);  // under the page's own address
  poster.alt = '';
  poster.width = 640;
  poster.height = 360;
  poster.addEventListener('error', () => { poster.hidden = true; });
  title.textContent = text_in(exhibit.title, lang, exhibit.languages);
  about.textContent = text_in(exhibit.description, lang, exhibit.languages);
  words.append(title, about);
  link.append(poster, words);
  item.append(link);
  return item;
}

translate_page(lang);
document.body.classList.add('runs');
document.title = 'Wellspring';
try {
  const answer = await fetch('api/v1/exhibits');
  list.replaceChildren(...(await answer.json()).exhibits.map(tile));
} catch {
  const problem = document.getElementById('front-problem');
  problem.textContent = word(lang, 'lost');
  problem.hidden = false;
  setTimeout(() => location.reload(), 5000);
}
