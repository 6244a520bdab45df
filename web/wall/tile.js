// SPDX-License-Identifier: Apache-2.0
// One screen of a wall.
import { make_connection } from '../connection.js';
import { make_controls } from '../controls.js';
import { element } from '../element.js';
import { kiosk_token } from '../kiosk/token.js';
import { wanted_size } from '../picture.js';
import { make_moments } from './moments.js';

const most_pixels = 1920 * 1200;
const quiet_after = 3000;  // milliseconds, after which the pointer is hidden

// layout: as of read_layout().
export function open_tile(main, { wall, exhibit }) {
  const canvas = element('canvas', { id: 'picture', tabIndex: 0 });
  canvas.setAttribute('aria-label', `Screen ${wall.column + 1}, ${wall.row + 1} of ${wall.name}`);
  const notice = element('p.notice', { id: 'notice', hidden: true });
  main.append(canvas, notice);
  let connection = null, seq = 0, walk_speed = 1.4, fov = 1, refused = '';

  function say(text) {
    notice.textContent = text;
    notice.hidden = !text;
  }

  const shown = [];  // for whoever measures: [{frame, at: milliseconds of the day}], the last ones
  /** @type {any} */ (window).wall_shown = shown;
  const moments = make_moments(canvas, {
    on_decoded: ({ decoded_ms, ...rest }) => connection.send({
      type: 'ack', decoded_ms: Math.round(decoded_ms * 10) / 10, ...rest }),
    on_shown(frame) {
      canvas.dataset.frame = frame;
      shown.push({ frame, at: performance.timeOrigin + performance.now() });
      if (shown.length > 1000) shown.shift();
    },
  });

  connection = make_connection({
    hello: () => ({ type: 'hello', exhibit, lang: 'en', role: 'visitor', token: kiosk_token(), wall,
      ...wanted_size(most_pixels) }),
    open() {
      say('');
      refused = '';
      seq = 0;
      moments.joined();
    },
    lost: () => say(refused || 'The server does not answer. This screen comes back by itself.'),
    message(message) {
      if (message.type === 'show') moments.release(message.frame);
      else if (message.type === 'welcome') walk_speed = message.walk_speed;
      else if (message.type === 'state') fov = message.fov;
      else if (message.type === 'error') say(refused = message.message);
    },
    binary: (buffer) => moments.receive(buffer),
  });

  // Whoever is at any screen may move the wall, while no other page leads it.
  const none = element('div');
  make_controls(canvas, none, none, {
    send({ move, look, moved }) {
      if (moved) connection.send({ type: 'input', seq: ++seq, move, look });
    },
    fov: () => fov / wall.rows,
    speed: () => walk_speed,
    place() {},
  });

  let timer = 0, resize_timer = 0;
  addEventListener('pointermove', () => {
    document.body.classList.remove('quiet');
    clearTimeout(timer);
    timer = setTimeout(() => document.body.classList.add('quiet'), quiet_after);
  });
  addEventListener('resize', () => {
    clearTimeout(resize_timer);
    resize_timer = setTimeout(() => connection.send({ type: 'settings',
      ...wanted_size(most_pixels) }), 200);
  });
  canvas.addEventListener('dblclick', () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen?.().catch(() => {});
  });
}
