// SPDX-License-Identifier: Apache-2.0
// Binary messages from the server, little-endian. Pictures: magic "WSF1"; sound: "WSA1".
const magic_picture = 0x31465357;

// {frame, seq, time_us, width, height, quality, still, payload: Blob-able bytes} or null.
export function read_picture(buffer) {
  if (buffer.byteLength < 28) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== magic_picture) return null;
  const header = view.getUint16(26, true);
  if (header < 28 || header > buffer.byteLength) return null;
  return {
    frame: view.getUint32(4, true),
    seq: view.getUint32(8, true),
    time_us: Number(view.getBigUint64(12, true)),
    width: view.getUint16(20, true),
    height: view.getUint16(22, true),
    quality: view.getUint8(24),
    still: (view.getUint8(25) & 1) !== 0,
    payload: new Uint8Array(buffer, header),
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
