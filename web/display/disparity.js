// SPDX-License-Identifier: Apache-2.0
// Reads disparities of a picture in whole units, as server/frame/disparity_code.h writes them.
const header_bytes = 16, slope_units = 256, most_units = 65535, long_length = 255;
const above = 0, after = 1, earlier = 2, begins = 3, values = 4;

// Unpacks a zlib stream, which must hold that many bytes.
export async function inflate(bytes, count) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const out = new Uint8Array(count), reader = stream.getReader();
  let at = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (at + value.length > count) {
      await reader.cancel();
      throw new Error('packed: too many bytes');
    }
    out.set(value, at);
    at += value.length;
  }
  if (at < count) throw new Error('packed: too few bytes');
  return out;
}

// Returns the arrays of the format, and throws where no picture of so many pixels has such.
async function unpack(bytes, pixels) {
  if (bytes.length < header_bytes) throw new Error('depth: no header');
  const head = new DataView(bytes.buffer, bytes.byteOffset);
  const [runs, planes, singles, longs] = [0, 4, 8, 12].map((at) => head.getUint32(at, true));
  if (Math.max(runs, planes, singles, longs) > pixels) throw new Error('depth: too many runs');
  const all = await inflate(bytes.subarray(header_bytes),
      2 * (runs + longs + 3 * planes + singles));
  let at = 0;
  const take = (count) => all.subarray(at, at += count);
  const words = (count) => {
    const low = take(count), high = take(count), out = new Uint16Array(count);
    for (let i = 0; i < count; i++) out[i] = low[i] | high[i] << 8;
    return out;
  };
  const signed = (count) => new Int16Array(words(count).buffer);
  return { kind: take(runs), length: take(runs), long: words(longs), value: words(planes),
    across: signed(planes), down: signed(planes), single: words(singles) };
}

// A row says of each of its runs where it ends and which plane it lies on, -1: none.
const make_row = (width) =>
  ({ end: new Int32Array(width), plane: new Int32Array(width), count: 0 });

// Writes what a plane has along a row into `out`, from `at` on.
function fill_plane(out, at, count, units, slope) {
  for (let i = 0, sum = units + slope_units / 2; i < count; i++, sum += slope) {
    const unit = sum >> 8;
    out[at + i] = unit < 0 ? 0 : unit > most_units ? most_units : unit;
  }
}

/** @param {Uint8Array} bytes @returns {Promise<Uint16Array>} */
export async function decode_disparity(bytes, width, height) {
  const parts = await unpack(bytes, width * height);
  const out = new Uint16Array(width * height), planes = parts.value.length;
  const plane_x = new Int32Array(planes), plane_y = new Int32Array(planes);
  let before = make_row(width), row = make_row(width);
  let run = 0, long = 0, single = 0, begun = 0;
  const wrong = () => { throw new Error('depth: no such run'); };
  const plane_of = (kind, over, x, y) => {
    const n = over + (kind === after ? 1 : 0);
    let plane = -1;
    if (kind === above || kind === after) plane = n < before.count ? before.plane[n] : -1;
    else if (kind === earlier) plane = row.count >= 2 ? row.plane[row.count - 2] : -1;
    else if (kind === begins && begun < planes) {
      plane = begun++;
      plane_x[plane] = x;
      plane_y[plane] = y;
    }
    if (plane < 0 && kind !== values) wrong();
    return plane;
  };
  const end_of = (kind, over, x) => {
    let length = parts.length[run];
    if (length === long_length) length = long < parts.long.length ? parts.long[long++] : wrong();
    if (kind !== above && kind !== after) return x + length + 1;
    const farther = length % 2 ? -(length + 1) / 2 : length / 2;
    return before.end[over + (kind === after ? 1 : 0)] + farther;
  };
  for (let y = 0; y < height; y++) {
    row.count = 0;
    for (let x = 0, over = 0; x < width; run++) {
      while (over < before.count && before.end[over] <= x) over++;
      if (run >= parts.kind.length || parts.kind[run] > values) wrong();
      const kind = parts.kind[run], plane = plane_of(kind, over, x, y), end = end_of(kind, over, x);
      if (end <= x || end > width) wrong();
      const at = y * width + x, count = end - x;
      if (plane >= 0) {
        const across = parts.across[plane], down = parts.down[plane];
        fill_plane(out, at, count, parts.value[plane] * slope_units
            + across * (x - plane_x[plane]) + down * (y - plane_y[plane]), across);
      } else {
        if (single + count > parts.single.length) wrong();
        out.set(parts.single.subarray(single, single += count), at);
      }
      row.end[row.count] = x = end;
      row.plane[row.count++] = plane;
    }
    [before, row] = [row, before];
  }
  if (run !== parts.kind.length) wrong();
  return out;
}
