// SPDX-License-Identifier: Apache-2.0
// Pictures of objects, loaded when they are looked at, a few at a time, and kept while the map is.
const most_at_once = 4, most_kept = 400;

// loaded(): another picture is there.
export function make_pictures(loaded) {
  const all = new Map();  // address -> its picture; null: it comes, or there is none
  let waiting = [], coming = 0;

  function load_next() {
    if (coming >= most_at_once || waiting.length === 0) return;
    const address = waiting.pop(), image = new Image();
    coming++;
    const done = (is_there) => {
      coming--;
      if (is_there) { all.set(address, image); loaded(); }
      load_next();
    };
    image.onload = () => done(true);
    image.onerror = () => done(false);
    image.src = address;
  }

  return {
    // Returns the picture at an address if it is there; else it is asked for.
    of(address) {
      if (!address) return null;
      if (!all.has(address) && all.size < most_kept) {
        all.set(address, null);
        waiting.push(address);
        load_next();
      }
      return all.get(address) ?? null;
    },
    // Those that have not come are no longer wanted.
    forget() {
      for (const address of waiting) all.delete(address);
      waiting = [];
    },
  };
}
