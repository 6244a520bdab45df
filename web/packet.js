// SPDX-License-Identifier: Apache-2.0
// Binary messages from the server, little-endian. Pictures: magic "WSF1".
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
