// SPDX-License-Identifier: Apache-2.0
// The well on the screen: its camera, its light as the stage wants it, water that is touched, the
// drop that falls up, the book that rises. WebGL2; where there is none, a still picture.
import { cells, make_water } from './water.js';
import { noise, picture, stone, triangle } from './well_shaders.js';

// Says how the well looks at each stage. light: from the sky; lantern: warm; glimmer: the book's;
// stirred: fine ripples; across: 0 looks down into the well, 1 across it to somebody behind it.
const looks = {
  sleep: { light: 0.13, lantern: 0.03, glimmer: 0, stirred: 0.1, across: 0, rate: 20 },
  awake: { light: 0.75, lantern: 0.55, glimmer: 0, stirred: 0.6, across: 0, rate: 60 },
  person: { light: 0.9, lantern: 0.9, glimmer: 0.8, stirred: 0.6, across: 1, rate: 60 },
  engaged: { light: 0.9, lantern: 0.9, glimmer: 0.9, stirred: 0.6, across: 1, rate: 60 },
  farewell: { light: 0.6, lantern: 0.6, glimmer: 0.25, stirred: 0.5, across: 1, rate: 60 },
};
const deep = -0.72, above = 0.62;  // heights of the book
const most_pixels = 2.2e6, least_pixels = 1.2e5;
const frame_budget = 17.5;         // milliseconds; beyond it pictures get fewer pixels

const mix = (a, b, t) => a + (b - a) * t;
const ease = (t) => t * t * (3 - 2 * t);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// The camera for a picture of that shape. across: 0..1.
export function well_camera(width, height, across) {
  const t = ease(across), tall = height > width;
  const eye = [0, mix(-1.35, -2.75, t), mix(3.5, 2.65, t)];
  const target = [0, mix(0.03, 0.25, t), mix(0, 0.1, t)];
  const forward = unit(target.map((x, i) => x - eye[i]));
  const right = unit(cross(forward, [0, 0, 1])), up = cross(right, forward);
  return { eye, forward, right, up, tangent: mix(0.40, tall ? 0.41 : 0.54, t),
    shift: [0, t * (tall ? 0.70 : 0.30)], width, height };
}
const ray_at = ({ right, up, forward, tangent, shift, width, height }, x, y) => {
  const side = Math.min(width, height);
  const u = tangent * ((2 * x - width) / side + shift[0]);
  const v = tangent * ((height - 2 * y) / side + shift[1]);
  return unit(forward.map((f, i) => f + u * right[i] + v * up[i]));
};
// Returns the place of the water that is seen at (x, y), pixels from the upper left: [x, y] in
// radii, or null.
export function water_at(camera, x, y) {
  const ray = ray_at(camera, x, y), t = -camera.eye[2] / ray[2];
  if (!(t > 0)) return null;
  const at = [camera.eye[0] + t * ray[0], camera.eye[1] + t * ray[1]];
  return Math.hypot(...at) < 1 ? at : null;
}
// Returns the pixels from the upper left at which a point is seen.
export function seen_at({ eye, right, up, forward, tangent, shift, width, height }, point) {
  const d = point.map((p, i) => p - eye[i]), depth = dot(d, forward);
  const side = Math.min(width, height);
  return [(dot(d, right) / depth / tangent - shift[0]) * side / 2 + width / 2,
    height / 2 - (dot(d, up) / depth / tangent - shift[1]) * side / 2];
}

function make_program(gl, fragment) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, triangle], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    const [one, other] = gl.getAttachedShaders(program);
    throw new Error(gl.getProgramInfoLog(program) || gl.getShaderInfoLog(other)
        || gl.getShaderInfoLog(one) || 'a shader was refused');
  }
  const places = new Map();
  return {
    use: () => gl.useProgram(program),
    set(values) {
      for (const [name, value] of Object.entries(values)) {
        if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
        const at = places.get(name);
        if (at === null) continue;
        if (typeof value === 'number') gl.uniform1f(at, value);
        else gl[`uniform${value.length}fv`](at, value);
      }
    },
    textures(named) {
      Object.entries(named).forEach(([name, texture], unit_number) => {
        gl.activeTexture(gl.TEXTURE0 + unit_number);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.uniform1i(gl.getUniformLocation(program, name), unit_number);
      });
    },
  };
}

function make_texture(gl, width, height, format, filter, wrap) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  const levels = filter === gl.LINEAR_MIPMAP_LINEAR ? 9 : 1;
  gl.texStorage2D(gl.TEXTURE_2D, levels, format, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER,
      filter === gl.NEAREST ? gl.NEAREST : gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
  return texture;
}

// All that the graphics card holds; made anew when it was lost.
function make_drawing(gl) {
  const programs = { stone: make_program(gl, stone), picture: make_program(gl, picture) };
  const pattern = make_texture(gl, 512, 512, gl.RGBA8, gl.LINEAR_MIPMAP_LINEAR, gl.REPEAT);
  const heights = make_texture(gl, cells, cells, gl.RGBA16F, gl.LINEAR, gl.CLAMP_TO_EDGE);
  const target = gl.createFramebuffer();
  let stones = null, drawn_for = '';
  gl.bindVertexArray(gl.createVertexArray());
  gl.disable(gl.DEPTH_TEST);

  const once = make_program(gl, noise);
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, pattern, 0);
  gl.viewport(0, 0, 512, 512);
  once.use();
  once.set({ size: 512 });
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.bindTexture(gl.TEXTURE_2D, pattern);
  gl.generateMipmap(gl.TEXTURE_2D);

  function draw_stone(view) {
    const { width, height } = view;
    if (stones?.width !== width || stones.height !== height) {
      if (stones) gl.deleteTexture(stones.cool), gl.deleteTexture(stones.warm);
      const one = () =>
          make_texture(gl, width, height, gl.RGBA8, gl.NEAREST, gl.CLAMP_TO_EDGE);
      stones = { width, height, cool: one(), warm: one() };
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, stones.cool, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, stones.warm, 0);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    gl.viewport(0, 0, width, height);
    programs.stone.use();
    programs.stone.set(uniforms(view));
    programs.stone.textures({ pattern });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
  const uniforms = ({ eye, right, up, forward, tangent, shift, width, height }) =>
      ({ eye, right, up, forward, tangent, shift, size: [width, height] });

  return (view, values, surface) => {
    const key = JSON.stringify(uniforms(view));
    if (key !== drawn_for) draw_stone(view), drawn_for = key;
    gl.bindTexture(gl.TEXTURE_2D, heights);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, cells, cells, gl.RGBA, gl.FLOAT, surface);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, view.width, view.height);
    programs.picture.use();
    programs.picture.set({ ...uniforms(view), ...values });
    programs.picture.textures(
        { cool_stone: stones.cool, warm_stone: stones.warm, heights, pattern });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };
}

// canvas: is laid over the storyteller's picture, transparent above the rim. events: {wave(depth),
// fell_up()}: for sounds. calm: a still picture. fixed: pixels of each picture, however long it
// takes, even where the processor draws; 0: as many as keep it smooth, and none without a graphics
// card.
export function make_well(canvas, events = {}, { calm = false, fixed = 0 } = {}) {
  const water = make_water();
  const gl = calm ? null : canvas.getContext('webgl2',
      { alpha: true, antialias: false, powerPreference: 'high-performance',
        failIfMajorPerformanceCaveat: !fixed });
  const now = { ...looks.sleep }, began = performance.now();
  let draw = null, stage = 'sleep', rise = 0, wanted_rise = 0, dim = 0;
  let last = 0, pixels = fixed || 1.2e6, slow = 0, quick = 0;
  let drop = null, next_drip = 3, next_drop = 6;  // seconds at which these come
  let guest = null, hidden = false;
  const times = [];

  const still = () => document.body.classList.add('still-water');
  function prepare() {
    try { draw = make_drawing(gl); } catch (error) { console.warn(`the well: ${error}`); still(); }
  }
  if (gl) prepare(); else still();
  canvas.addEventListener('webglcontextlost', (event) => { event.preventDefault(); draw = null; });
  canvas.addEventListener('webglcontextrestored', prepare);

  function view() {
    const box = canvas.getBoundingClientRect();
    const scale = Math.min(fixed ? 1e9 : devicePixelRatio || 1,
        Math.sqrt(pixels / (box.width * box.height)));
    const width = Math.max(16, Math.round(box.width * scale));
    const height = Math.max(16, Math.round(box.height * scale));
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    return well_camera(width, height, now.across);
  }
  // The camera in the page's own pixels.
  const page_camera = () => {
    const box = canvas.getBoundingClientRect();
    return { ...well_camera(box.width, box.height, now.across), left: box.left, top: box.top };
  };

  // Pictures get as many pixels as keep 60 a second; slowly up, quickly down.
  function pace(milliseconds) {
    if (fixed || looks[stage].rate < 60) return;
    if (milliseconds > frame_budget) { slow++; quick = 0; } else { quick++; slow = 0; }
    if (slow > 4) {
      pixels = Math.max(least_pixels, pixels * Math.max(0.3, frame_budget / milliseconds));
      slow = 0;
    }
    if (quick > 240) { pixels = Math.min(most_pixels, pixels * 1.15); quick = 0; }
  }

  function live(seconds) {
    const look = looks[stage], share = 1 - Math.exp(-seconds / 0.9);
    for (const name of ['light', 'lantern', 'glimmer', 'stirred'])
      now[name] = mix(now[name], look[name], share);
    // Stone is drawn anew while the camera moves; where that takes too long, it jumps.
    const way = seconds > 0.1 ? 1 : seconds / 2.4;
    now.across += Math.max(-way, Math.min(way, look.across - now.across));
    rise += Math.max(-seconds / 1.6, Math.min(seconds / 1.6, wanted_rise - rise));
    dim = mix(dim, wanted_rise > 0 && rise > 0.8 ? 1 : 0, share);
    const time = (performance.now() - began) / 1000;
    if (stage !== 'sleep' && time > next_drip) {  // water is never quite still
      next_drip = time + 0.4 + 2.2 * Math.random();
      const a = 2 * Math.PI * Math.random(), r = Math.sqrt(Math.random()) * 0.85;
      water.press(r * Math.cos(a), r * Math.sin(a), 0.004 + 0.005 * Math.random(), 0.1);
    }
    if (stage === 'person' && time > next_drop && !drop) fall_up(0, -0.1);
    if (drop) {
      drop.age += seconds;
      const t = drop.age;
      if (!drop.left && t > 0.9) {
        drop.left = true;
        water.press(drop.x, drop.y, 0.03, 0.08);
        events.fell_up?.();
      }
      if (t > 3.2) drop = null, next_drop = time + 9 + 8 * Math.random();
    }
    water.advance(seconds);
  }
  // A drop gathers on the water, frees itself and falls up, faster and faster.
  function fall_up(x, y) { drop = { x, y, age: 0, left: false }; }
  function drop_now() {
    if (!drop) return [0, 0, 0, 0];
    const t = drop.age, radius = 0.055 * ease(Math.min(1, t / 0.9));
    const high = t < 0.9 ? mix(-0.05, 0.05, t / 0.9) : 0.05 + 0.42 * (t - 0.9) ** 2;
    return [drop.x, drop.y, high, radius];
  }

  function frame(at) {
    requestAnimationFrame(frame);
    const gap = at - last;
    if (hidden || document.hidden || gap < 1000 / looks[stage].rate - 2) return;
    last = at;
    live(Math.min(gap / 1000, 0.25));
    pace(gap);
    times.push(gap);
    if (times.length > 240) times.shift();
    if (!draw) return;
    const flicker = 1 + 0.05 * Math.sin(at / 83) + 0.04 * Math.sin(at / 137 + 1);
    draw(view(), { time: (at - began) / 1000, cool_light: now.light,
      warm_light: now.lantern * flicker, glimmer: now.glimmer, stirred: now.stirred,
      book_height: mix(deep, above, ease(rise)), book_open: dim, drop: drop_now() },
    water.surface());
    canvas.dataset.pictures = Number(canvas.dataset.pictures ?? 0) + 1;
  }
  requestAnimationFrame(frame);

  return {
    stage(name) { if (looks[name]) stage = name; },
    // Page pixels. True: the water was touched there.
    touch(x, y, depth = 0.045) {
      const camera = page_camera(), at = water_at(camera, x - camera.left, y - camera.top);
      if (at) { water.press(...at, depth); events.wave?.(depth); }
      return !!at;
    },
    drop_at(x, y) {
      const camera = page_camera(), at = water_at(camera, x - camera.left, y - camera.top);
      if (at && !drop) fall_up(...at);
    },
    // The nearest guest, metres from the screen's centre; who moves stirs the water.
    guest(position) {
      const moved =
          guest && position ? Math.hypot(position[0] - guest[0], position[2] - guest[2]) : 0;
      if (position && !(moved > 0 && moved <= 0.03)) guest = position;
      if (!position) guest = null;
      if (moved > 0.03)
        water.press(Math.max(-0.7, Math.min(0.7, position[0])), -0.6, Math.min(0.02, 0.1 * moved),
            0.2);
    },
    raise_book(up) { wanted_rise = up ? 1 : 0; if (up && !draw) rise = 1; },
    book_is_up: () => rise >= 1,
    // Nothing is drawn while nobody sees it.
    hide(yes) { hidden = yes; canvas.style.visibility = yes ? 'hidden' : ''; },
    // Returns figures of the last pictures: milliseconds between them, and their size.
    figures: () => ({ milliseconds: [...times], pixels: canvas.width * canvas.height }),
    water,
  };
}
