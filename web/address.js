// SPDX-License-Identifier: Apache-2.0
// What the page's address asks for, and addresses to give away.
const asks = new URLSearchParams(location.search);
// A wish counts where the address has just been opened, not when the page is loaded again.
const [opening] = /** @type {any[]} */ (performance.getEntriesByType('navigation'));
const fresh = opening?.type !== 'reload';

export const asked_exhibit = decodeURIComponent(/\/e\/([^/]+)$/.exec(location.pathname)?.[1] ?? '')
    || (asks.get('exhibit') ?? '');
export const asked_viewpoint = fresh ? asks.get('viewpoint') : null;
export const asked_object = fresh ? asks.get('object') : null;
export const asked_story = fresh ? asks.get('story') : null;
export const asked_group = fresh ? asks.get('group') : null;

// Name of the wall of screens that this visit leads; null: none.
export const asked_wall = asks.get('wall');

// "local": this page draws the picture; "server": it comes finished; null: nothing is asked.
export const asked_display = asks.get('display');

// #place=x,y,z,yaw,pitch or with roll behind it, in metres and radians: {position, yaw, pitch,
// roll}; null: none, or a wrong one.
export function read_place(hash) {
  const text = /^#place=(.*)$/.exec(decodeURIComponent(hash))?.[1];
  const numbers = text?.split(',').map((word) => (word.trim() ? Number(word) : NaN));
  const complete = numbers?.length === 5 || numbers?.length === 6;
  if (!complete || !numbers.every(Number.isFinite)) return null;
  const [yaw, pitch, roll = 0] = numbers.slice(3);
  return { position: numbers.slice(0, 3), yaw, pitch, roll };
}
export const asked_place = () => (fresh ? read_place(location.hash) : null);

// Leaves only this page and its exhibit in the address.
function clean_address() {
  const url = new URL(location.href);
  const exhibit = url.searchParams.get('exhibit');
  url.search = exhibit ? new URLSearchParams({ exhibit }).toString() : '';
  url.hash = '';
  return url;
}
export function group_address(code) {
  const url = clean_address();
  url.searchParams.set('group', code);
  return url.href;
}
// Returns the address of a place, to a centimetre and a twentieth of a degree.
export function place_address({ position, yaw, pitch, roll }) {
  const url = clean_address();
  const numbers = [...position.map((v) => v.toFixed(2)), yaw.toFixed(3), pitch.toFixed(3),
    ...(roll ? [roll.toFixed(3)] : [])];
  url.hash = `place=${numbers.map(Number).join(',')}`;
  return url.href;
}
// The page of all texts, in a language; story: the one to begin with.
export const read_address = (exhibit, lang, story = '') =>
  `read?${new URLSearchParams({ exhibit, lang })}${story && `#story-${story}`}`;
