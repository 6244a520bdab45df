// SPDX-License-Identifier: Apache-2.0
// Draws a map of a collection: a dot for each object, in the colour of its group, with the object's
// own colours where dots are large; pale where the map is not true; pictures where there is room.
import { clearness } from './truth.js';

export const group_colors = ['#d9b36a', '#8fb9c9', '#c98f7a', '#98bd8c', '#b59acb', '#d8cdb8'];
export const color_of = (group) => group_colors[group % group_colors.length];

// Pixels where words have their usual size; larger words have larger dots.
const least_dot = 3.5, most_dot = 21;     // of a radius
const pie_from = 7.5;                     // radius from which an object's own colours are seen
const usual_side = 54;                    // of a picture
const narrow = 520;                       // of a window with smaller words
const gold = '#ffd98a', ink = '#f3ecdf', ground = '#16130f';
const serif = 'Georgia, "Palatino Linotype", "Times New Roman", serif';

// Returns how large dots are on a map with so many, in a window of that size. unit: how many times
// larger than usual words are.
export function dot_radius(view, count, unit) {
  const spacing = Math.sqrt(view.width() * view.height() / Math.max(1, count));
  return Math.min(most_dot * unit,
      Math.max(least_dot * unit, 0.13 * spacing * view.zoom() ** 0.45));
}

function ring(context, [x, y], radius, width, color) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.lineWidth = width;
  context.strokeStyle = color;
  context.stroke();
}

function disc(context, [x, y], radius, color) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
}

// Draws the object's own colours, by their order, in a dot of its group's colour.
function pie(context, [x, y], radius, colors, edge) {
  const part = 2 * Math.PI / colors.length;
  disc(context, [x, y], radius, edge);
  colors.forEach((color, i) => {
    context.beginPath();
    context.moveTo(x, y);
    context.arc(x, y, radius - Math.max(2, 0.22 * radius), i * part - Math.PI / 2,
        (i + 1) * part - Math.PI / 2);
    context.closePath();
    context.fillStyle = color;
    context.fill();
  });
}

function picture(context, [x, y], image, color, picture_side) {
  const { width, height } = image, side = Math.min(width, height), half = picture_side / 2;
  context.save();
  context.beginPath();
  context.roundRect(x - half, y - half, picture_side, picture_side, 8);
  context.fillStyle = color;
  context.fill();
  context.beginPath();
  context.roundRect(x - half + 3, y - half + 3, picture_side - 6, picture_side - 6, 6);
  context.clip();
  context.drawImage(image, (width - side) / 2, (height - side) / 2, side, side, x - half, y - half,
      picture_side, picture_side);
  context.restore();
}

const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

// Words that do not lie over others; those that come first are kept. avoid: boxes [left, top,
// right, bottom] that they do not lie over, either.
function make_words(context, width, height) {
  const taken = [];
  return function write(text, [x, y],
      { size, color, below = 0, italic = false, most = 180, avoid = [] }) {
    context.font = `${italic ? 'italic ' : ''}400 ${size}px ${serif}`;
    let shown = text;
    while (context.measureText(shown).width > most && shown.length > 4)
      shown = `${shown.slice(0, -2).trimEnd().replace(/…$/, '')}…`;
    const half = context.measureText(shown).width / 2;
    const at = Math.min(width - half - 4, Math.max(half + 4, x)), line = y + below;
    const box = [at - half - 3, line - 0.9 * size, at + half + 3, line + 0.35 * size];
    if (box[1] < 0 || box[3] > height) return false;
    if ([...taken, ...avoid].some((one) => overlap(box, one))) return false;
    taken.push(box);
    context.textAlign = 'center';
    context.lineJoin = 'round';
    context.lineWidth = 5;
    context.strokeStyle = 'rgba(16, 13, 10, .9)';
    context.strokeText(shown, at, line);
    context.fillStyle = color;
    context.fillText(shown, at, line);
    return true;
  };
}

function draw_circle(context, [x, y], radius) {
  const glow = context.createRadialGradient(x, y, 0.6 * radius, x, y, Math.max(1, radius));
  glow.addColorStop(0, 'rgba(217, 179, 106, .05)');
  glow.addColorStop(1, 'rgba(217, 179, 106, .17)');
  disc(context, [x, y], radius, glow);
  ring(context, [x, y], radius, 2, 'rgba(255, 217, 138, .85)');
}
// Draws the knob by which the circle's rim is held.
function draw_grip(context, [x, y], radius, bent, unit) {
  /** @type {[number, number]} */
  const grip = [x + radius * Math.cos(bent), y - radius * Math.sin(bent)];
  disc(context, grip, 7 * unit, gold);
  ring(context, grip, 7 * unit, 2, ground);
}

// scene: {view, items: [{at, group, stress, colors, object, picture, seen: 0..1, title}], stress:
// of the map, selected, hovered: indices or -1, circle: {at, radius, inside: Set, bent} or null,
// lit: Set of groups that are not dimmed, or null, groups: [{at: or null, terms}], image(item) or
// null, ratio: pixels of the canvas for one of the page, unit: as of dot_radius()}.
export function draw_plane(context, scene) {
  const { view, items, circle, lit, selected, hovered, unit } = scene;
  const picture_side = usual_side * unit;
  context.setTransform(scene.ratio, 0, 0, scene.ratio, 0, 0);
  context.clearRect(0, 0, view.width(), view.height());
  const places = items.map(({ at }) => view.to_screen(at));
  const seen = places.map((at) => at[0] > -40 && at[1] > -40 && at[0] < view.width() + 40
      && at[1] < view.height() + 40);
  const radius = dot_radius(view, items.length, unit);
  const visible = seen.filter(Boolean).length;
  const spread = Math.sqrt(view.width() * view.height() / Math.max(1, visible));
  const has_room = spread > 1.15 * picture_side;
  const rim = circle && circle.radius * view.scale(), middle = circle && view.to_screen(circle.at);
  if (circle) draw_circle(context, middle, rim);
  const is_dim = (item, i) => (lit && !lit.has(item.group)) || (circle && !circle.inside.has(i));
  // Those that are dimmed lie below, the chosen one above all.
  const order = items.map((item, i) => i).filter((i) => seen[i]).sort((a, b) =>
    Number(a === selected) - Number(b === selected)
    || Number(is_dim(items[b], b)) - Number(is_dim(items[a], a)));
  for (const i of order) {
    const item = items[i], color = color_of(item.group), at = places[i];
    const away = lit && !lit.has(item.group);
    context.globalAlpha = item.seen * clearness(item.stress, scene.stress)
        * (i === selected ? 1 : away ? 0.12 : is_dim(item, i) ? 0.42 : 1);
    const image = has_room && !away ? scene.image?.(item) : null;
    const grown = radius * (i === selected ? 1.35 : i === hovered ? 1.15 : 1);
    if (image) picture(context, at, image, color, picture_side);
    else if (grown >= pie_from * unit && item.colors?.length)
      pie(context, at, grown, item.colors, color);
    else disc(context, at, grown, color);
    const edge = image ? picture_side / 2 * 1.35 : grown;
    if (item.object) ring(context, at, edge + 2.5, 1.5, gold);
    context.globalAlpha = item.seen;
    if (i === selected) {
      ring(context, at, edge + 4, 4, 'rgba(16, 13, 10, .9)');
      ring(context, at, edge + 4, 2, ink);
    } else if (i === hovered) ring(context, at, edge + 3, 1.5, ink);
  }
  context.globalAlpha = 1;
  if (circle) draw_grip(context, middle, rim, circle.bent, unit);
  const write = make_words(context, view.width(), view.height());
  const below = radius + 18 * unit;
  for (const i of [selected, hovered])
    if (i >= 0 && seen[i]) write(items[i].title, places[i],
        { size: 15 * unit, color: ink, below: below + (has_room ? 16 : 4), most: 260 * unit });
  if (view.zoom() < 2.2)
    scene.groups.forEach(({ at, terms }, i) => {
      if (!at || (lit && !lit.has(i))) return;
      const is_narrow = view.width() < narrow, size = (is_narrow ? 14 : 17) * unit;
      const name = terms.slice(0, is_narrow ? 1 : 2).join(', ');
      [0, 1.6, -1.6].some((lines) => write(name, view.to_screen(at), { size, below: lines * size,
        color: color_of(i), italic: true, most: 13 * size }));
    });
  if (spread < 90 * unit) return;
  const half = (i) => (has_room && scene.image?.(items[i]) ? picture_side / 2 : radius);
  const avoid = order.map((i) => [places[i][0] - half(i), places[i][1] - half(i),
    places[i][0] + half(i), places[i][1] + half(i)]);
  for (const i of order)
    if (i !== selected && !is_dim(items[i], i))
      [half(i) + 17 * unit, -half(i) - 8].some((lines) => write(items[i].title, places[i],
          { size: 13 * unit, color: '#d5cab6', below: lines, avoid,
            most: Math.min(220 * unit, 1.3 * spread) }));
}
