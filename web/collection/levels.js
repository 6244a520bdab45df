// SPDX-License-Identifier: Apache-2.0
// Asks the server for maps of a collection, and makes them fit for drawing.
import { distance, make_turn } from './places.js';

const most_shown = 600;
const most_tries = 4, least_wait = 1500;  // where the server has much to do; milliseconds

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Returns {status, level}: 200 with a map, else why there is none; 0: the line is broken.
// is_wanted(): whether somebody still waits for it.
export async function fetch_level(exhibit, trail, is_wanted) {
  const query = new URLSearchParams({ shown: String(most_shown), ...(trail && { trail }) });
  const address = `api/v1/exhibits/${encodeURIComponent(exhibit)}/collection?${query}`;
  for (let tries = 1; ; tries++) {
    const answer = await fetch(address).catch(() => null);
    if (answer?.ok) {
      const level = await answer.json().catch(() => null);
      return level ? { status: 200, level } : { status: 0 };
    }
    const status = answer?.status ?? 0;
    if (status !== 503 || tries >= most_tries || !is_wanted()) return { status };
    await sleep(Math.max(least_wait, 1000 * Number(answer.headers.get('Retry-After'))));
  }
}

// Says where the objects of a new map come from, and where they go. before: the items that are seen
// now; sets at, from and to of each item.
export function place_items(items, before) {
  const old = new Map(before.map((item) => [item.index, item]));
  const pairs = items.filter(({ index }) => old.has(index))
      .map(({ index, x, y }) => [old.get(index).at, [x, y]]);
  const turn = make_turn(pairs);
  for (const item of items) {
    item.to = turn([item.x, item.y]);
    const was = old.get(item.index);
    item.from = was ? was.at : item.to;
    item.from_seen = was ? was.seen : 0;
    item.at = item.from;
    item.seen = item.from_seen;
  }
}

// Says where the words of each group stand: at the object that lies nearest to their middle; null:
// the map shows none of them.
export function group_places(items, groups) {
  return groups.map((_, number) => {
    const places = items.filter(({ group }) => group === number).map(({ to }) => to);
    if (places.length === 0) return null;
    const middle = [0, 1].map((k) =>
      places.reduce((sum, place) => sum + place[k], 0) / places.length);
    return places.reduce((best, place) =>
      (distance(place, middle) < distance(best, middle) ? place : best));
  });
}
