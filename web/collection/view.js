// SPDX-License-Identifier: Apache-2.0
// The window on a map: how places of the map become pixels of the page, and back. The map's y
// points up.
const most_zoom = 40, least_zoom = 0.6;  // times the size at which all of the map is seen

const within = (value, low, high) => Math.min(high, Math.max(low, value));

export function make_view() {
  let width = 1, height = 1, scale = 1, whole = 1, middle = [0, 0];
  const margin = () => Math.max(22, Math.min(64, 0.07 * Math.min(width, height)));

  const view = {
    width: () => width,
    height: () => height,
    scale: () => scale,  // pixels of a unit of the map
    zoom: () => scale / whole,
    middle: () => middle,
    /** @returns {[number, number]} */
    to_screen: ([x, y]) =>
      [width / 2 + (x - middle[0]) * scale, height / 2 - (y - middle[1]) * scale],
    /** @returns {[number, number]} */
    to_map: ([x, y]) =>
      [middle[0] + (x - width / 2) / scale, middle[1] - (y - height / 2) / scale],
    resize(to_width, to_height) {
      width = Math.max(1, to_width);
      height = Math.max(1, to_height);
    },
    // Shows all of the places. below: pixels at the lower edge that something covers.
    fit(places, below = 0) {
      const [xs, ys] = [0, 1].map((k) => places.map((place) => place[k]));
      const [left, right] = [Math.min(...xs), Math.max(...xs)];
      const [low, high] = [Math.min(...ys), Math.max(...ys)];
      const free = Math.max(60, height - below), edge = margin();
      const fits = Math.min((width - 2 * edge) / (right - left), (free - 2 * edge) / (high - low));
      // Places that are all the same have a size of nothing.
      whole = Number.isFinite(fits) && fits > 0 ? fits : Math.min(width, free) / 2;
      scale = whole;
      middle = [(left + right) / 2, (low + high) / 2 - below / 2 / scale];
    },
    // Enlarges; what is at that pixel stays there.
    zoom_at(factor, [x, y]) {
      const before = view.to_map([x, y]);
      scale = within(scale * factor, least_zoom * whole, most_zoom * whole);
      const after = view.to_map([x, y]);
      middle = [middle[0] + before[0] - after[0], middle[1] + before[1] - after[1]];
    },
    pan(dx, dy) { middle = [middle[0] - dx / scale, middle[1] + dy / scale]; },
    // Moves as little as brings the place into the window. Returns whether it moved.
    reveal(place, below = 0) {
      const [x, y] = view.to_screen(place), edge = margin();
      const dx = within(x, edge, width - edge) - x;
      const dy = within(y, edge, Math.max(edge, height - below - edge)) - y;
      if (dx || dy) view.pan(dx, dy);
      return Boolean(dx || dy);
    },
    has([x, y]) { return x >= 0 && y >= 0 && x <= width && y <= height; },
  };
  return view;
}
