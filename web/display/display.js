// SPDX-License-Identifier: Apache-2.0
// The picture as this page draws it: keyframes with depth from the server, seen by a camera that
// moves here.
import { read_picture } from '../packet.js';
import { inflate } from './disparity.js';
import { decode_jpeg } from './jpeg.js';
import { make_wind_clock } from './sway.js';
import { view_of } from './view.js';
import { make_ground, make_walker } from './walker.js';
import { make_warp } from './warp.js';

const least_rate = 24;       // pictures a second in motion: fewer are too slow
const judged_ms = 2000;      // motion, after which the rate is looked at
const lost_ms = 3000;        // without a context: it does not come back
const most_broken = 3;       // keyframes one after the other that could not be decoded

// Tells in how many pictures a second motion was shown, whenever enough of it was.
function make_judge(on_rate) {
  let milliseconds = 0, pictures = 0;
  return (gap) => {
    milliseconds += gap;
    pictures++;
    if (milliseconds < judged_ms) return;
    on_rate(1000 * pictures / milliseconds);
    milliseconds = pictures = 0;
  };
}

// `canvas`: that of finished pictures, over which one of its own is laid. on_shown: as of
// make_picture(). on_weak(reason): the device cannot do it, as it is too `slow` or its context is
// `lost`. round_trip(): milliseconds. calm(): grass does not sway between keyframes. null: the
// browser cannot do it.
export function make_display(canvas, { on_shown, on_weak, round_trip, calm = () => false }) {
  if (!('createImageBitmap' in window && 'Worker' in window)) return null;
  let fresh = false;  // there is something new to be drawn
  const own = document.createElement('canvas');
  own.className = 'local';
  own.hidden = true;
  let lost_timer = 0, broken = 0, slow = 0, ended = false, drew = false;
  const warp = make_warp(own, (lost) => {
    own.hidden = true;
    fresh = !lost;
    clearTimeout(lost_timer);
    if (lost) lost_timer = setTimeout(() => on_weak('lost'), lost_ms);
  });
  if (!warp) return null;
  canvas.after(own);
  const walker = make_walker();
  const worker = new Worker(new URL('./decoder.js', import.meta.url), { type: 'module' });
  const decoding = new Map();  // frame -> what takes the worker's answer
  let size = [canvas.width, canvas.height], deep = false;
  let last = performance.now(), drawn = 0, work = Promise.resolve();
  const wind = make_wind_clock();
  let sways = true, slow_sways = 0;  // false: the device is too slow for that
  const times = [];  // times of the last second's pictures

  worker.onmessage = ({ data }) => {
    decoding.get(data.id)(data);
    decoding.delete(data.id);
  };
  worker.onerror = () => on_weak('unable');
  // A slow moment may be another program's.
  const judge = make_judge((rate) => {
    slow = rate < least_rate ? slow + 1 : 0;
    if (slow > 1) on_weak('slow');
  });
  const judge_sway = make_judge((rate) => {
    slow_sways = rate < least_rate ? slow_sways + 1 : 0;
    if (slow_sways > 1) sways = false;
  });
  const decode_keyframe = ({ frame, keyframe: { color_bytes, view }, payload, layer, sway }) =>
    new Promise((resolve) => {
      decoding.set(frame, resolve);
      const { width, height } = view;
      const color = payload.slice(0, color_bytes), depth = payload.slice(color_bytes);
      worker.postMessage({ id: frame, color, depth, width, height, layer, sway },
          [color.buffer, depth.buffer]);
    });

  async function show_keyframe(picture) {
    const { view, unit, cuts } = picture.keyframe;
    const { bitmap, units, blocks, codes, problem } = await decode_keyframe(picture);
    if (problem) throw new Error(problem);
    const sway = codes && { ...picture.sway, codes };
    const keyframe = { view, unit, cuts, bitmap, units, blocks, sway };
    if (picture.layer) warp.set_layer(keyframe);
    else if (picture.around) warp.set_around(keyframe);
    else warp.add(keyframe, performance.now(), picture.still);
  }
  async function change(picture) {
    const pieces = await Promise.all(picture.parts.map(async (part) =>
      ({ bitmap: await decode_jpeg(part.payload), x: part.x, y: part.y })));
    const { sway } = picture;
    const codes = sway && await inflate(sway.codes, sway.columns * sway.rows);
    await warp.change(pieces, picture.width, picture.height, sway && { ...sway, codes });
    for (const { bitmap } of pieces) bitmap.close();
  }
  async function take(picture) {
    if (ended) return;
    const began = performance.now();
    let good = true;
    try {
      await (picture.parts ? change(picture) : show_keyframe(picture));
      if (picture.sway) wind.note(picture.sway.time, began);
      fresh = true;
      broken = 0;
    } catch (problem) {
      console.warn(`picture ${picture.frame}: ${problem}`);
      good = false;
      if (++broken >= most_broken) on_weak('unable');
    }
    on_shown({ ...picture, payload: null, parts: null, keyframe: null, shown: good,
      bytes: picture.payload.byteLength, decoded_ms: performance.now() - began });
  }

  function frame(now) {
    if (ended) return;
    requestAnimationFrame(frame);
    const gap = now - last, dt = Math.min(0.1, Math.max(0, gap) / 1000), drew_before = drew;
    last = now;
    const moved = walker.advance(dt, now), pose = walker.pose();
    drew = false;
    const swaying = sways && !calm() && warp.sways(), needed = moved || fresh || warp.fades(now);
    if (!pose || !deep || !(needed || swaying)) return;
    fresh = false;
    if (!warp.show(view_of(pose, ...size), now, swaying ? wind.at(now) : NaN)) return;
    own.hidden = false;
    own.dataset.sways = String(swaying);
    drew = true;
    if (drew_before && gap < 1000) (swaying ? judge_sway : judge)(gap);
    drawn++;
    canvas.dataset.drawn = String(drawn);
    times.push(now);
    while (times.length && now - times[0] > 1000) times.shift();
  }
  requestAnimationFrame(frame);

  return {
    walker,
    // Returns whether the picture is one for this display.
    receive(buffer) {
      const picture = read_picture(buffer);
      if (!picture) return true;
      if (!picture.parts) deep = picture.keyframe !== null;
      if (deep) work = work.then(() => take(picture));
      else own.hidden = true;
      return deep;
    },
    welcome(message) {
      size = [message.width, message.height];
      [canvas.width, canvas.height] = size;
      if (message.map)
        fetch(`api/v1/exhibits/${message.exhibit}/map`).then((answer) => answer.json())
            .then((map) => walker.set_ground(make_ground(map)), () => {});
    },
    told(message) {
      const { width, height } = message;
      if (width !== size[0] || height !== size[1]) {
        size = [width, height];
        [canvas.width, canvas.height] = size;
      }
      walker.told(message, performance.now(), round_trip());
    },
    rate: () => Math.max(0, times.length - 1),
    end() {
      ended = true;
      clearTimeout(lost_timer);
      worker.terminate();
      own.remove();
    },
  };
}
