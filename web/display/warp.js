// SPDX-License-Identifier: Apache-2.0
// Draws keyframes as they are seen from another view, by WebGL2: the newest one, what it does not
// show from the one before, then from a wide one, and what none shows as it goes on behind; over
// all that a layer of what moves.
import { fragment, vertex } from './shaders.js';
import { block, carry_bounds, is_same, make_mapping } from './view.js';

const fade_ms = 50;      // from one keyframe to the next
const seam_across = 64;  // as in server/picture/warp_picture.cpp

function make_program(gl) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  const places = {};
  for (const name of ['color', 'units', 'bounds', 'to', 'back', 'size', 'unit', 'height', 'share',
    'whole', 'seam', 'coarse', 'masked', 'as_it_is'])
    places[name] = gl.getUniformLocation(program, name);
  return { program, places };
}

function make_texture(gl, filter) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return texture;
}

// Returns null where there is no WebGL2. A keyframe, {view, unit, cuts, blocks, units, bitmap}, is
// kept as it is, so that a lost context can be made anew from it.
export function make_warp(canvas, on_lost) {
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false,
    desynchronized: true, powerPreference: 'high-performance', preserveDrawingBuffer: false });
  if (!gl) return null;
  let program = null, bounds_texture = null, bounds = new Float32Array(0);
  let newest = null, before = null, around = null, layer = null, came = 0;

  function set_up() {
    program = make_program(gl);
    bounds_texture = make_texture(gl, gl.NEAREST);
    gl.bindVertexArray(gl.createVertexArray());
    for (const one of [newest, before, around, layer]) if (one) upload(one);
  }
  function upload_color(one) {
    gl.bindTexture(gl.TEXTURE_2D, one.color);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, one.bitmap);
    one.color_size = [one.bitmap.width, one.bitmap.height];
  }
  function upload(one) {
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    one.color = make_texture(gl, gl.LINEAR);
    upload_color(one);
    one.depth = make_texture(gl, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R16UI, one.view.width, one.view.height, 0, gl.RED_INTEGER,
        gl.UNSIGNED_SHORT, one.units);
  }
  function forget(one) {
    if (!one) return;
    gl.deleteTexture(one.color);
    gl.deleteTexture(one.depth);
    one.bitmap.close();
  }
  function replace(old, one) {
    forget(old);
    if (one && !one.color && !gl.isContextLost()) upload(one);
    return one;
  }
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    on_lost(true);
  });
  canvas.addEventListener('webglcontextrestored', () => { set_up(); on_lost(false); });
  set_up();

  // whole: what it does not show is guessed, else left as it is.
  function draw(one, view, share, whole) {
    const columns = Math.ceil(view.width / block), rows = Math.ceil(view.height / block);
    if (bounds.length !== 2 * columns * rows) bounds = new Float32Array(2 * columns * rows);
    const to = make_mapping(view, one.view), back = make_mapping(one.view, view);
    carry_bounds(one, view, back, bounds);
    const { places } = program;
    const flat = (m) => [...m.one, ...m.across, ...m.down, ...m.baseline];
    gl.useProgram(program.program);
    [[one.color, places.color], [one.depth, places.units], [bounds_texture, places.bounds]]
        .forEach(([texture, place], i) => {
          gl.activeTexture(gl.TEXTURE0 + i);
          gl.bindTexture(gl.TEXTURE_2D, texture);
          gl.uniform1i(place, i);
        });
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32F, columns, rows, 0, gl.RG, gl.FLOAT, bounds);
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform3fv(places.to, flat(to));
    gl.uniform3fv(places.back, flat(back));
    gl.uniform2f(places.size, one.view.width, one.view.height);
    gl.uniform1f(places.unit, one.unit);
    gl.uniform1f(places.height, view.height);
    gl.uniform1f(places.share, share);
    gl.uniform1i(places.whole, whole ? 1 : 0);
    gl.uniform1f(places.seam, whole || one === layer ? 0 : one.view.width / seam_across);
    gl.uniform1i(places.coarse, one === around ? 1 : 0);
    gl.uniform1i(places.masked, one === layer ? 1 : 0);
    gl.uniform1i(places.as_it_is, is_same(one.view, view) ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  return {
    // still: the layer lies over it, too; else what moves is in it.
    add(keyframe, now, still) {
      if (around && around.cuts !== keyframe.cuts) around = replace(around, null);
      if (layer && (!still || layer.cuts !== keyframe.cuts)) layer = replace(layer, null);
      const goes_on = newest && newest.cuts === keyframe.cuts;
      before = replace(before, goes_on ? newest : null);
      newest = replace(goes_on ? null : newest, keyframe);
      came = now;
    },
    // What lies around the others, in fewer pixels.
    set_around(keyframe) { around = replace(around, keyframe); },
    set_layer(keyframe) { layer = replace(layer, keyframe); },
    // Pieces, {bitmap, x, y} in a picture of that size, replace colours of the newest keyframe.
    async change(pieces, width, height) {
      if (!newest) return;
      const one = newest, [wide, high] = one.color_size;
      if (wide !== width || high !== height) {
        const scaled = await createImageBitmap(one.bitmap,
            { resizeWidth: width, resizeHeight: height });
        one.bitmap.close();
        one.bitmap = scaled;
        if (one === newest) upload_color(one);
      }
      if (one !== newest || gl.isContextLost()) return;
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, one.color);
      for (const { bitmap, x, y } of pieces)
        gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    },
    show(view, now) {
      if (!newest || gl.isContextLost()) return false;
      if (canvas.width !== view.width) canvas.width = view.width;
      if (canvas.height !== view.height) canvas.height = view.height;
      gl.viewport(0, 0, view.width, view.height);
      gl.disable(gl.BLEND);
      const share = before ? Math.min(1, (now - came) / fade_ms) : 1;
      const behind = share === 1 && is_same(newest.view, view) ? []
        : [around, before].filter((one) => one !== null);
      // The first of them shows what none of them does as it goes on behind.
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      [...behind, newest].forEach((one, i) => {
        if (i === 1) gl.enable(gl.BLEND);
        draw(one, view, one === newest ? share : 1, i === 0);
      });
      gl.disable(gl.BLEND);
      if (layer) draw(layer, view, 1, false);
      return true;
    },
    fades: (now) => before !== null && now - came < fade_ms,
  };
}
