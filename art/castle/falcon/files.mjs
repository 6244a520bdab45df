// SPDX-License-Identifier: Apache-2.0
// Writes GLB, PNG and NRRD files.
import { deflateSync, gzipSync } from 'node:zlib';

const CRC = Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});
const crc32 = (bytes) => {
  let c = 0xffffffff;
  for (const byte of bytes) c = CRC[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
};

// `pixels` holds rows from above of `channels` bytes each: 1 grey, 3 red, green and blue.
export function png(width, height, pixels, channels = 3) {
  const chunk = (kind, data) => {
    const out = Buffer.alloc(data.length + 12);
    out.writeUInt32BE(data.length, 0);
    out.write(kind, 4, 'latin1');
    data.copy(out, 8);
    out.writeUInt32BE(crc32(out.subarray(4, 8 + data.length)), 8 + data.length);
    return out;
  };
  const head = Buffer.alloc(13), row = width * channels;
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, channels === 3 ? 2 : 0, 0, 0, 0], 8);
  const rows = Buffer.alloc(height * (row + 1));
  for (let y = 0; y < height; y++) {
    const at = y * (row + 1);
    rows[at] = y === 0 ? 0 : 2;  // each byte minus the one above
    for (let i = 0; i < row; i++)
      rows[at + 1 + i] = pixels[y * row + i] - (y === 0 ? 0 : pixels[(y - 1) * row + i]);
  }
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', head),
    chunk('IDAT', deflateSync(rows, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}

// `parts` are {name, material, points, normals, colors, uv, triangles}, colours linear; `pictures`
// are PNG files, of which materials speak by their place. `wrap` says whether they repeat upwards.
export function glb({ generator, parts, materials, pictures = [], nodes = [], extras = {},
  wrap = 33071 }) {
  const views = [], accessors = [], chunks = [];
  let size = 0;
  const view = (content, target) => {
    views.push({ buffer: 0, byteOffset: size, byteLength: content.length,
      ...(target ? { target } : {}) });
    const padded = Buffer.alloc((content.length + 3) & ~3);
    content.copy(padded);
    chunks.push(padded);
    size += padded.length;
    return views.length - 1;
  };
  const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  const floats = (rows, type, bounds) => {
    const flat = Float32Array.from(rows.flat());
    const width = rows[0].length;
    const found = { bufferView: view(bytes(flat), 34962), componentType: 5126, count: rows.length,
      type };
    if (bounds) {
      found.min = rows[0].map((_, k) => Infinity);
      found.max = rows[0].map((_, k) => -Infinity);
      for (let i = 0; i < flat.length; i++) {
        found.min[i % width] = Math.min(found.min[i % width], flat[i]);
        found.max[i % width] = Math.max(found.max[i % width], flat[i]);
      }
    }
    return accessors.push(found) - 1;
  };
  const meshes = parts.map((part) => {
    const attributes = { POSITION: floats(part.points, 'VEC3', true) };
    if (part.normals) attributes.NORMAL = floats(part.normals, 'VEC3');
    if (part.uv?.length) attributes.TEXCOORD_0 = floats(part.uv, 'VEC2');
    if (part.colors) {
      const codes = part.colors.map((c) => [...c, 1]).flat()
          .map((c) => Math.round(255 * Math.min(Math.max(c, 0), 1)));
      attributes.COLOR_0 = accessors.push({ bufferView: view(Buffer.from(codes), 34962),
        componentType: 5121, normalized: true, count: part.colors.length, type: 'VEC4' }) - 1;
    }
    const small = part.points.length < 65536;
    const flat = (small ? Uint16Array : Uint32Array).from(part.triangles.flat());
    const indices = accessors.push({ bufferView: view(bytes(flat), 34963),
      componentType: small ? 5123 : 5125, count: flat.length, type: 'SCALAR' }) - 1;
    return { name: part.name, primitives: [{ attributes, indices,
      material: materials.findIndex(({ name }) => name === part.material) }] };
  });
  const images = pictures.map((picture) => ({ mimeType: 'image/png', bufferView: view(picture) }));
  const all = [...parts.map(({ name }, mesh) => ({ name, mesh })), ...nodes];
  const used = new Set(materials.flatMap(({ extensions = {} }) => Object.keys(extensions)));
  if (extras.extensions) Object.keys(extras.extensions).forEach((name) => used.add(name));
  const document = {
    asset: { version: '2.0', generator, copyright: 'The Wellspring authors, Apache License 2.0' },
    ...(used.size ? { extensionsUsed: [...used].sort() } : {}), ...extras,
    scene: 0, scenes: [{ nodes: all.map((_, i) => i) }], nodes: all, meshes, materials,
    ...(images.length ? { textures: images.map((_, source) => ({ source, sampler: 0 })), images,
      samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 10497, wrapT: wrap }] } : {}),
    accessors, bufferViews: views, buffers: [{ byteLength: size }] };
  let text = Buffer.from(JSON.stringify(document));
  text = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, ' ')]);
  const head = Buffer.alloc(20), between = Buffer.alloc(8);
  head.write('glTF', 0, 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + text.length + size, 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16, 'latin1');
  between.writeUInt32LE(size, 0);
  between.write('BIN\0', 4, 'latin1');
  return Buffer.concat([head, text, between, ...chunks]);
}

// Signed 16-bit samples of a scan, x fastest. `axes` and `origin` are in millimetres, in the frame
// left, posterior, superior (NRRD format, teem.sourceforge.net/nrrd/format.html).
export function nrrd({ size, samples, axes, origin, notes }) {
  const vector = (v) => `(${v.join(',')})`;
  const header = ['NRRD0005', ...notes.map((note) => `# ${note}`), 'type: short', 'dimension: 3',
    'space: left-posterior-superior', `sizes: ${size.join(' ')}`,
    `space directions: ${axes.map(vector).join(' ')}`, 'kinds: domain domain domain',
    'space units: "mm" "mm" "mm"', 'endian: little', 'encoding: gzip',
    `space origin: ${vector(origin)}`, '', ''].join('\n');
  const body = Buffer.from(samples.buffer, samples.byteOffset, samples.byteLength);
  return Buffer.concat([Buffer.from(header), gzipSync(body, { level: 9, memLevel: 9 })]);
}
