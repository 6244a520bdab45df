// SPDX-License-Identifier: Apache-2.0
// A round glass over the picture. What it shows comes from the server with a margin, so that the
// glass follows the hand at once; the next picture of it follows soon.
import { element } from './element.js';
import { read_picture } from './packet.js';

const sides = 3;  // of its radius: a picture of what it shows
const least = 0.05, most = 0.45, most_zoom = 64, key_step = 0.01;
const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

const within = (value, low, high) => Math.min(high, Math.max(low, value));

// canvas: that of the picture. send(message): to the server. label(name): words of the page.
export function make_glass(canvas, send, label) {
  const glass = element('canvas.glass', { tabIndex: 0, hidden: true, role: 'img' });
  const context = glass.getContext('2d', { alpha: false });
  const orders = new Map();  // seq -> {at, radius, zoom} of orders whose pictures may come yet
  const down = new Map();    // id -> {x, y} of pointers
  let held = null, seq = 0, asked = false, picture = null;

  // Pixels of the page: the picture's box, whose margins that do not fit are cut off.
  function box() {
    const at = canvas.getBoundingClientRect();
    const scale = Math.max(at.width / canvas.width, at.height / canvas.height);
    const width = canvas.width * scale, height = canvas.height * scale;
    return { left: at.left + (at.width - width) / 2, top: at.top + (at.height - height) / 2, width,
      height };
  }

  function draw() {
    if (!held) return;
    const { left, top, width, height } = box(), radius = held.radius * height;
    const ratio = Math.min(devicePixelRatio || 1, 2), side = Math.round(2 * radius * ratio);
    if (glass.width !== side) glass.width = glass.height = side;
    glass.style.width = glass.style.height = `${2 * radius}px`;
    glass.style.translate = `${left + held.at[0] * width - radius}px ${
      top + held.at[1] * height - radius}px`;
    if (!picture) return;
    // Things under the glass stay in their places; the larger they are, the faster they pass.
    const { at, zoom, bitmap } = picture, large = sides * picture.radius * height * ratio;
    const x = side / 2 + zoom * (at[0] - held.at[0]) * width * ratio,
        y = side / 2 + zoom * (at[1] - held.at[1]) * height * ratio;
    context.fillRect(0, 0, side, side);
    context.drawImage(bitmap, x - large / 2, y - large / 2, large, large);
  }

  // Asks for what it shows now, once a picture of the display.
  function ask() {
    draw();
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      if (!held) return;
      const { at, radius, ...rest } = held;
      orders.set(++seq, { at, radius });
      if (orders.size > 100) orders.delete(orders.keys().next().value);
      send({ type: 'lens', seq, at, radius, ...rest });
    });
  }
  function change(fields) {
    Object.assign(held, fields);
    held.at = held.at.map((one) => within(one, 0, 1));
    held.radius = within(held.radius, least, most);
    if (fields.zoom) held.zoom = within(fields.zoom, 1, most_zoom);
    ask();
  }
  const zoom = () => held.zoom || picture?.zoom || 1;

  glass.addEventListener('pointerdown', (event) => {
    glass.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    event.preventDefault();
    glass.focus({ preventScroll: true });
  });
  glass.addEventListener('pointermove', (event) => {
    const last = down.get(event.pointerId);
    if (!last || !held) return;
    const { width, height } = box(), other = [...down.values()].find((one) => one !== last);
    const now = { x: event.clientX, y: event.clientY };
    down.set(event.pointerId, now);
    const share = other ? 0.5 : 1;  // of two fingers each moves it by half
    const from = other ? Math.hypot(last.x - other.x, last.y - other.y) : 1;
    const to = other ? Math.hypot(now.x - other.x, now.y - other.y) : 1;
    change({
      at: [held.at[0] + share * (now.x - last.x) / width,
        held.at[1] + share * (now.y - last.y) / height],
      radius: held.radius * to / Math.max(from, 1),
    });
  });
  for (const end of ['pointerup', 'pointercancel'])
    glass.addEventListener(end, (event) => down.delete(event.pointerId));
  glass.addEventListener('wheel', (event) => {
    event.preventDefault();
    const factor = Math.exp(-within(event.deltaY, -100, 100) / 400);
    change(event.shiftKey ? { radius: held.radius * factor } : { zoom: zoom() * factor });
  }, { passive: false });
  glass.addEventListener('keydown', (event) => {
    const turn = turns[event.key], step = event.shiftKey ? 5 * key_step : key_step;
    if (turn) change({ at: [held.at[0] + turn[0] * step, held.at[1] + turn[1] * step] });
    else if (event.key === '+') change({ zoom: zoom() * 1.25 });
    else if (event.key === '-') change({ zoom: zoom() / 1.25 });
    else if (event.key === ']') change({ radius: held.radius * 1.1 });
    else if (event.key === '[') change({ radius: held.radius / 1.1 });
    else if (event.key === 'Escape') put_down();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  addEventListener('resize', draw);

  function put_down() {
    if (!held) return;
    held = picture = null;
    glass.remove();
    send({ type: 'lens', seq: ++seq });
    canvas.focus({ preventScroll: true });
  }

  async function show(packet) {
    const began = performance.now();
    let bitmap = null;
    try {
      bitmap = await createImageBitmap(new Blob([packet.payload], { type: 'image/jpeg' }));
    } catch (problem) {
      console.warn(`picture ${packet.frame}: ${problem}`);
    }
    send({ type: 'ack', frame: packet.frame, shown: bitmap !== null,
      decoded_ms: Math.round(10 * (performance.now() - began)) / 10 });
    const order = orders.get(packet.seq);
    if (!bitmap || !held || !order || packet.seq < (picture?.seq ?? 0)) return bitmap?.close();
    picture?.bitmap.close();
    picture = { ...order, bitmap, seq: packet.seq, zoom: packet.zoom };
    for (const old of orders.keys()) if (old < packet.seq) orders.delete(old);
    glass.hidden = false;
    glass.dataset.seq = String(packet.seq);
    draw();
  }

  return {
    // fields: zoom, name, layer, difference, depth, as the message has them. text: what it shows.
    hold(fields, text) {
      const { at, radius } = held ?? { at: [0.5, 0.5], radius: 0.18 };
      if (!held) {
        glass.hidden = true;
        canvas.parentElement.append(glass);
      }
      held = { at, radius, ...fields };
      glass.ariaLabel = `${label('glass')}: ${text}. ${label('glass_hint')}`;
      ask();
    },
    put_down,
    held: () => held,
    // As still.jpg asks for it.
    looks() {
      if (!held) return {};
      const { at, radius, zoom: large, name, layer, difference, depth } = held;
      return { lens: [...at, radius, large].join(','), ...(depth && { lens_depth: depth }),
        ...(name && { lens_layer: `${name}:${layer}${difference ? ':difference' : ''}` }) };
    },
    // Returns whether the message is what the glass shows.
    receive(buffer) {
      const packet = read_picture(buffer);
      if (!packet?.lens) return false;
      show(packet);
      return true;
    },
    // The server forgot it with the link.
    joined() { if (held) ask(); },
  };
}
