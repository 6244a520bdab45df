// SPDX-License-Identifier: Apache-2.0
// Binary messages from the server, little-endian. Pictures: magic "WSF1"; sound: "WSA1".
const magic_picture = 0x31465357;

// The parts of a picture that is not complete, [{x, y, width, height, payload}], or null.
function read_parts(buffer, view, header, width, height) {
  if (header < 30) return null;
  const count = view.getUint16(28, true), parts = [];
  if (header < 30 + 12 * count) return null;
  let at = header;
  for (let i = 0; i < count; i++) {
    const [x, y, w, h] = [0, 2, 4, 6].map((k) => view.getUint16(30 + 12 * i + k, true));
    const bytes = view.getUint32(38 + 12 * i, true);
    if (!w || !h || x + w > width || y + h > height || at + bytes > buffer.byteLength) return null;
    parts.push({ x, y, width: w, height: h, payload: new Uint8Array(buffer, at, bytes) });
    at += bytes;
  }
  return parts;
}

// Reads a keyframe's header: {color_bytes, cuts, unit, view: as display/view.js}, or null.
function read_keyframe(buffer, view, header) {
  if (header < 116) return null;
  const real = (at) => view.getFloat32(at, true);
  const triple = (at) => [0, 4, 8].map((more) => real(at + more));
  const color_bytes = view.getUint32(28, true), unit = real(112);
  const seen = {
    eye: [40, 48, 56].map((at) => view.getFloat64(at, true)),
    right: triple(64), up: triple(76), forward: triple(88),
    tan_half_fov: real(100), middle: [real(104), real(108)],
    width: view.getUint16(36, true), height: view.getUint16(38, true),
  };
  const numbers = [...seen.eye, ...seen.right, ...seen.up, ...seen.forward, ...seen.middle];
  const good = header + color_bytes <= buffer.byteLength && seen.width > 0 && seen.height > 0
    && seen.tan_half_fov > 0 && seen.tan_half_fov < Infinity && unit > 0 && unit < Infinity
    && numbers.every(Number.isFinite);
  return good ? { color_bytes, cuts: view.getUint32(32, true), unit, view: seen } : null;
}

const sway_bytes = 116;

// Reads how wind moves what a keyframe, or parts of one, show, from `at` on: {columns, rows, unit,
// time, waves: [{push, wave, rate, phase}], codes: bytes to be inflated}, or null. `before`: bytes
// of the payload that are something else.
function read_sway(buffer, view, at, header, before) {
  if (header < at + sway_bytes) return null;
  const real = (n) => view.getFloat32(n, true), pair = (n) => [real(n), real(n + 4)];
  const bytes = view.getUint32(at, true);
  const [columns, rows] = [at + 4, at + 6].map((n) => view.getUint16(n, true));
  const unit = real(at + 8), time = view.getFloat64(at + 12, true);
  const waves = [0, 1, 2, 3].map((i) => at + 20 + 24 * i).map((n) =>
    ({ push: pair(n), wave: pair(n + 8), rate: real(n + 16), phase: real(n + 20) }));
  const numbers = waves.flatMap(({ push, wave, rate, phase }) => [...push, ...wave, rate, phase]);
  if (!columns || !rows || !(unit > 0) || ![unit, time, ...numbers].every(Number.isFinite)
    || header + before + bytes > buffer.byteLength) return null;
  const codes = new Uint8Array(buffer, buffer.byteLength - bytes, bytes);
  return { columns, rows, unit, time, waves, codes };
}

// {frame, seq, time_us, width, height, quality, still, parts, keyframe, around, layer, sway, lens,
// zoom, payload: Blob-able bytes}, or null. parts: null of a complete picture; keyframe: null of
// one without depth; around: it is a wide one; layer: it is what moves, over what stands still;
// sway: how wind moves it, or null; lens: it is what a glass shows, where things are `zoom` times
// as large as beside it.
export function read_picture(buffer) {
  if (buffer.byteLength < 28) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== magic_picture) return null;
  const header = view.getUint16(26, true);
  if (header < 28 || header > buffer.byteLength) return null;
  const width = view.getUint16(20, true), height = view.getUint16(22, true);
  const flags = view.getUint8(25), complete = (flags & 2) !== 0;
  const parts = complete ? null : read_parts(buffer, view, header, width, height);
  if (!complete && !parts) return null;
  const lens = complete && (flags & 32) !== 0;
  if (lens && header < 32) return null;
  const deep = complete && (flags & 4) !== 0;
  const keyframe = deep ? read_keyframe(buffer, view, header) : null;
  if (deep && !keyframe) return null;
  const sways = (deep || !complete) && (flags & 64) !== 0;
  const sway = !sways ? null : deep ? read_sway(buffer, view, 116, header, keyframe.color_bytes)
    : read_sway(buffer, view, 30 + 12 * parts.length, header,
        parts.reduce((sum, { payload }) => sum + payload.length, 0));
  if (sways && !sway) return null;
  return {
    frame: view.getUint32(4, true),
    seq: view.getUint32(8, true),
    time_us: Number(view.getBigUint64(12, true)),
    width,
    height,
    quality: view.getUint8(24),
    still: (flags & 1) !== 0,
    parts,
    keyframe,
    around: deep && (flags & 8) !== 0,
    layer: deep && (flags & 16) !== 0,
    lens,
    zoom: lens ? view.getFloat32(28, true) : 1,
    sway,
    payload: new Uint8Array(buffer, header,
        buffer.byteLength - header - (sway?.codes.length ?? 0)),
  };
}

const magic_sound = 0x31415357;

// {utterance, start, time_us, total, rate, everywhere, mouth: [x, y, z], samples: Float32Array} of
// a sound ("WSA1"), or null. Only one channel is sent.
export function read_sound(buffer) {
  if (buffer.byteLength < 56) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== magic_sound || view.getUint8(24) !== 1) return null;
  const header = view.getUint16(26, true), bytes = buffer.byteLength - header;
  if (header < 56 || bytes < 2 || bytes % 2 !== 0) return null;
  const rate = view.getUint32(28, true);
  const mouth = [32, 40, 48].map((at) => view.getFloat64(at, true));
  if (rate < 3000 || rate > 192000 || !mouth.every(Number.isFinite)) return null;
  const samples = new Float32Array(bytes / 2);
  for (let i = 0; i < samples.length; i++) samples[i] = view.getInt16(header + 2 * i, true) / 32768;
  return {
    utterance: view.getUint32(4, true), start: view.getUint32(8, true),
    time_us: Number(view.getBigUint64(12, true)), total: view.getUint32(20, true), rate,
    everywhere: (view.getUint8(25) & 1) !== 0, mouth, samples,
  };
}
