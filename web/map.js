// SPDX-License-Identifier: Apache-2.0
// The map: where one can walk, the places, where the visitor is and which way he looks.
import { by_id } from './element.js';

const colours = { o: [217, 196, 158, 255], x: [104, 88, 66, 255], '.': [0, 0, 0, 0] };
const margin = 1;  // cells around the ground

// go(position): when a place of the ground was chosen.
export function make_map(go) {
  const panel = by_id('map'), canvas = by_id('map-picture'), button = by_id('map-button');
  let map = null, ground = null, state = null, exhibit = '';

  // Cells as pixels, which drawing makes larger.
  function draw_ground() {
    ground = document.createElement('canvas');
    ground.width = map.rows[0].length;
    ground.height = map.rows.length;
    const context = ground.getContext('2d');
    const image = context.createImageData(ground.width, ground.height);
    map.rows.forEach((row, z) => [...row].forEach((cell, x) =>
      image.data.set(colours[cell], 4 * (z * ground.width + x))));
    context.putImageData(image, 0, 0);
  }

  const cell_of = ([x, , z]) =>
    /** @type {[number, number]} */ (
      [(x - map.corner[0]) / map.cell + 0.5, (z - map.corner[1]) / map.cell + 0.5]);
  const scale = () => Math.min(canvas.width / (ground.width + 2 * margin),
      canvas.height / (ground.height + 2 * margin));
  // Canvas pixels of a cell, and back.
  /** @returns {[number, number]} */
  function to_canvas([x, z]) {
    const s = scale();
    return [canvas.width / 2 + (x - ground.width / 2) * s,
      canvas.height / 2 + (z - ground.height / 2) * s];
  }

  function dot(context, at, radius, colour) {
    context.beginPath();
    context.arc(...at, radius, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.fill();
  }

  function draw() {
    if (panel.hidden || !map) return;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.round(canvas.clientWidth * ratio),
        height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    const context = canvas.getContext('2d'), s = scale();
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = true;
    context.drawImage(ground, ...to_canvas([0, 0]), ground.width * s, ground.height * s);
    for (const { position } of map.objects)
      dot(context, to_canvas(cell_of(position)), 2.5 * ratio, 'rgba(33, 25, 13, .7)');
    for (const { position, name } of map.viewpoints)
      dot(context, to_canvas(cell_of(position)), 4 * ratio,
          name === state?.viewpoint ? '#21190d' : '#8a5a12');
    if (!state) return;
    const [x, y] = to_canvas(cell_of(state.position)), reach = 26 * ratio;
    const across = Math.atan(Math.tan(state.fov / 2) * innerWidth / innerHeight);
    const ahead = -state.yaw - Math.PI / 2;  // yaw 0 looks up on the map, and grows to the left
    context.beginPath();
    context.moveTo(x, y);
    context.arc(x, y, reach, ahead - across, ahead + across);
    context.closePath();
    context.fillStyle = 'rgba(178, 58, 26, .45)';
    context.fill();
    dot(context, [x, y], 5.5 * ratio, '#fff');
    dot(context, [x, y], 4 * ratio, '#b23a1a');
    canvas.dataset.at = [x / ratio, y / ratio].map(Math.round).join(',');
  }

  async function load() {
    const answer = await fetch(`api/v1/exhibits/${encodeURIComponent(exhibit)}/map`);
    if (!answer.ok) return;
    map = await answer.json();
    if (map.rows.length === 0) { map = null; return; }
    draw_ground();
    canvas.style.aspectRatio = `${ground.width + 2 * margin} / ${ground.height + 2 * margin}`;
    draw();
  }

  function open(yes) {
    panel.hidden = !yes;
    button.setAttribute('aria-expanded', String(yes));
    if (yes && !map) load();
    else draw();
  }
  button.addEventListener('click', () => open(panel.hidden));
  by_id('map-close').addEventListener('click', () => { open(false); button.focus(); });
  addEventListener('keydown', (event) => {
    const types = event.target instanceof Element && event.target.closest('input, select');
    if (event.code === 'KeyM' && !button.hidden && !types && !event.repeat && !event.ctrlKey
        && !event.altKey && !event.metaKey) open(panel.hidden);
  });
  canvas.addEventListener('click', (event) => {
    if (!map || !state) return;
    const box = canvas.getBoundingClientRect(), s = scale();
    const x = (event.clientX - box.left) * canvas.width / box.width,
        y = (event.clientY - box.top) * canvas.height / box.height;
    const column = (x - canvas.width / 2) / s + ground.width / 2 - 0.5,
        row = (y - canvas.height / 2) / s + ground.height / 2 - 0.5;
    const round = (v) => Math.round(v * 1000) / 1000;
    go([round(map.corner[0] + column * map.cell), round(state.position[1] - map.eye_height),
      round(map.corner[1] + row * map.cell)]);
  });
  addEventListener('resize', draw);

  return {
    welcome(message) {
      ({ exhibit } = message);
      button.hidden = !message.map;
      if (!message.map) open(false);
    },
    state(message) { state = message; draw(); },
  };
}
