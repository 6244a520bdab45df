// SPDX-License-Identifier: Apache-2.0
// Giving away what one sees: a link that opens in exactly this view, and a postcard of it.
import { place_address } from './address.js';
import { copy } from './copy.js';
import { by_id } from './element.js';
import { word } from './words.js';

const least = 320, most = 1920;  // pixels of a postcard's longer side

// looks() -> fields of the address that say which layers are seen, and through which glass.
// view() -> {position, yaw, pitch, roll, fov}, or null: none yet; size() -> [width, height] of the
// picture.
export function make_share(view, size, looks) {
  const field = by_id('share-link'), postcard = by_id('share-postcard');
  let lang = 'en', exhibit = '', title = '';
  const say = (name) => { by_id('share-answer').textContent = name ? word(lang, name) : ''; };

  function link() {
    field.hidden = false;
    field.value = place_address(view());
  }
  by_id('share-copy').addEventListener('click', async () => {
    if (!view()) return;
    link();
    say(await copy(field.value) ? 'copied' : '');
  });
  by_id('share-send').hidden = !navigator.share;
  by_id('share-send').addEventListener('click', () => {
    if (view()) navigator.share({ title, url: place_address(view()) }).catch(() => {});
  });
  field.addEventListener('focus', () => field.select());

  postcard.addEventListener('click', async () => {
    const seen = view();
    if (!seen || postcard.getAttribute('aria-disabled') === 'true') return;
    postcard.setAttribute('aria-disabled', 'true');
    say('postcard_wait');
    const [width, height] = size(), longer = Math.max(width, height);
    const scale = Math.min(Math.max(longer, least), most) / longer;
    const query = new URLSearchParams(/** @type {any} */ ({
      position: seen.position.join(','), yaw: seen.yaw, pitch: seen.pitch, roll: seen.roll,
      fov: seen.fov,
      width: Math.round(width * scale), height: Math.round(height * scale), denoise: 1,
      ...looks(),
    }));
    try {
      const answer = await fetch(
          `api/v1/exhibits/${encodeURIComponent(exhibit)}/still.jpg?${query}`);
      if (!answer.ok) throw new Error(`${answer.status}`);
      const address = URL.createObjectURL(await answer.blob());
      const file = document.createElement('a');
      file.href = address;
      file.download = `${exhibit}.jpg`;
      file.click();
      setTimeout(() => URL.revokeObjectURL(address), 60000);
      say('postcard_done');
    } catch {
      say('postcard_failed');
    }
    postcard.removeAttribute('aria-disabled');
  });

  return {
    welcome(message) {
      ({ lang, exhibit, title } = message);
      say('');
    },
  };
}
