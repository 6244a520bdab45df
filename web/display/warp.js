// SPDX-License-Identifier: Apache-2.0
// Draws keyframes as they are seen from another view, by WebGL2: the newest one, what it does not
// show from the one before, then from a wide one, and what none shows as it goes on behind; over
// all that what moves.
import { fragment, most_layers, vertex } from './shaders.js';
import { eval_waves, make_ground_mapping } from './sway.js';
import { block, carry_bounds, is_coarse, is_same, make_mapping } from './view.js';

const fade_ms = 50;      // from one keyframe to the next
const seam_across = 64;  // in this part of its width a keyframe passes into the next

// Returns where uniforms are: {height, as_it_is, masked, layers: fields and textures of each, and
// its sway's}.
function find_places(gl, program) {
  const at = (name) => gl.getUniformLocation(program, name);
  const layers = Array.from({ length: most_layers }, (_, i) => {
    const places = Object.fromEntries(['color', 'units', 'bounds', 'codes'].map((name) =>
      [name, at(`${name}[${i}]`)]));
    places.sway = Object.fromEntries(
        ['is_there', 'waves', 'phases', 'rays', 'aside', 'lens', 'unit'].map((name) =>
          [name, at(`sways[${i}].${name}`)]));
    for (const name of ['is_there', 'to', 'back', 'size', 'unit', 'seam', 'opacity', 'is_coarse'])
      places[name] = at(`layers[${i}].${name}`);
    return places;
  });
  return { height: at('height'), as_it_is: at('as_it_is'), masked: at('masked'), layers };
}

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
  return { program, places: find_places(gl, program) };
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

// Returns null where there is no WebGL2. A keyframe, {view, unit, cuts, blocks, units, bitmap,
// sway}, is kept as it is, so that a lost context can be made anew from it.
export function make_warp(canvas, on_lost) {
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false,
    desynchronized: true, powerPreference: 'high-performance', preserveDrawingBuffer: false });
  if (!gl) return null;
  let program = null, bounds_textures = [], bounds = new Float32Array(0);
  let newest = null, before = null, around = null, moving = null, came = 0;

  function set_up() {
    program = make_program(gl);
    bounds_textures = Array.from({ length: most_layers }, () => make_texture(gl, gl.NEAREST));
    gl.bindVertexArray(gl.createVertexArray());
    for (const one of [newest, before, around, moving]) if (one) upload(one);
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
    upload_sway(one);
  }
  // Textures of less than a word a pixel, and one for what does not sway.
  function upload_sway(one) {
    if (one.swaying) gl.deleteTexture(one.swaying);
    one.swaying = make_texture(gl, gl.LINEAR);
    const { columns, rows, codes } = one.sway ?? { columns: 1, rows: 1, codes: new Uint8Array(1) };
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, columns, rows, 0, gl.RED, gl.UNSIGNED_BYTE, codes);
  }
  function forget(one) {
    if (!one) return;
    gl.deleteTexture(one.color);
    gl.deleteTexture(one.depth);
    gl.deleteTexture(one.swaying);
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

  // Carries the bounds of a keyframe to the view. Returns null where its parts would move too far,
  // else what the shader reads of it.
  function make_layer(one, view, texture) {
    const columns = Math.ceil(view.width / block), rows = Math.ceil(view.height / block);
    if (bounds.length !== 2 * columns * rows) bounds = new Float32Array(2 * columns * rows);
    const to = make_mapping(view, one.view), back = make_mapping(one.view, view);
    if (!carry_bounds(one, view, back, bounds)) return null;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32F, columns, rows, 0, gl.RG, gl.FLOAT, bounds);
    return { one, to, back, texture };
  }
  // now: seconds of the wind's clock; NaN: nothing sways.
  function set_sway(places, { sway, view }, now) {
    const since = sway ? now - sway.time : NaN;
    gl.uniform1i(places.is_there, since ? 1 : 0);
    if (!since) return;
    const { sums, phases } = eval_waves(sway.waves, since);
    const { rays, aside, lens } = make_ground_mapping(view);
    gl.uniform4fv(places.waves, sums);
    gl.uniform1fv(places.phases, phases);
    gl.uniform2fv(places.rays, rays);
    gl.uniform2fv(places.aside, aside);
    gl.uniform3fv(places.lens, lens);
    gl.uniform1f(places.unit, sway.unit);
  }
  function set_layer(layer, i, { is_last, opacity, view, wind }) {
    const places = program.places.layers[i], { one, to, back, texture } = layer;
    const flat = (m) => [...m.one, ...m.across, ...m.down, ...m.baseline];
    gl.uniform1i(places.is_there, 1);
    gl.uniform3fv(places.to, flat(to));
    gl.uniform3fv(places.back, flat(back));
    gl.uniform2f(places.size, one.view.width, one.view.height);
    gl.uniform1f(places.unit, one.unit);
    gl.uniform1f(places.seam, is_last ? 0 : Math.max(Math.floor(one.view.width / seam_across), 1));
    gl.uniform1f(places.opacity, opacity);
    gl.uniform1i(places.is_coarse, is_coarse(one.view, view) ? 1 : 0);
    set_sway(places.sway, one, wind);
    bind(i, [one.color, one.depth, texture, one.swaying]);
  }
  function bind(i, textures) {
    const places = program.places.layers[i];
    [places.color, places.units, places.bounds, places.codes].forEach((place, n) => {
      gl.activeTexture(gl.TEXTURE0 + 4 * i + n);
      gl.bindTexture(gl.TEXTURE_2D, textures[n]);
      gl.uniform1i(place, 4 * i + n);
    });
  }
  // Draws keyframes in the order in which they are asked. False: none can be seen from there.
  function draw(keyframes, view, opacity, wind) {
    const layers = keyframes.map((one, i) => one && make_layer(one, view, bounds_textures[i]))
        .filter((layer) => layer);
    if (layers.length === 0) return false;
    gl.useProgram(program.program);
    layers.forEach((layer, i) => set_layer(layer, i,
        { is_last: i === layers.length - 1, opacity: layer.one === newest ? opacity : 1, view,
          wind }));
    for (let i = layers.length; i < most_layers; i++) {
      gl.uniform1i(program.places.layers[i].is_there, 0);
      const { one, texture } = layers[0];
      bind(i, [one.color, one.depth, texture, one.swaying]);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1f(program.places.height, view.height);
    gl.uniform1i(program.places.masked, keyframes[0] === moving ? 1 : 0);
    gl.uniform1i(program.places.as_it_is,
        opacity === 1 && is_same(layers[0].one.view, view) ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    return true;
  }

  return {
    // still: what moves lies over it, too; else it is in it.
    add(keyframe, now, still) {
      if (around && around.cuts !== keyframe.cuts) around = replace(around, null);
      if (moving && (!still || moving.cuts !== keyframe.cuts)) moving = replace(moving, null);
      const goes_on = newest && newest.cuts === keyframe.cuts;
      before = replace(before, goes_on ? newest : null);
      newest = replace(goes_on ? null : newest, keyframe);
      came = now;
    },
    // Sets the surroundings, which lie around the others in fewer pixels.
    set_around(keyframe) { around = replace(around, keyframe); },
    // Sets the layer that moves over still keyframes, where its disparity is not 0.
    set_layer(keyframe) { moving = replace(moving, keyframe); },
    // Pieces, {bitmap, x, y} in a picture of that size, replace colours of the newest keyframe, and
    // the sway that of them, unless it is null.
    async change(pieces, width, height, sway) {
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
      if (sway) {
        one.sway = sway;
        upload_sway(one);
        gl.bindTexture(gl.TEXTURE_2D, one.color);
      }
      for (const { bitmap, x, y } of pieces)
        gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    },
    // wind: seconds of its clock; NaN: nothing sways between keyframes.
    show(view, now, wind = NaN) {
      if (!newest || gl.isContextLost()) return false;
      if (canvas.width !== view.width) canvas.width = view.width;
      if (canvas.height !== view.height) canvas.height = view.height;
      gl.viewport(0, 0, view.width, view.height);
      const opacity = before ? Math.min(1, (now - came) / fade_ms) : 1;
      const wide = around?.cuts === newest.cuts ? around : null;
      const drawn = draw([newest, before, wide], view, opacity, wind);
      if (moving) draw([moving], view, 1, NaN);
      return drawn;
    },
    sways: () => Boolean(newest?.sway),
    fades: (now) => before !== null && now - came < fade_ms,
  };
}
