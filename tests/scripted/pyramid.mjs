// SPDX-License-Identifier: Apache-2.0
// A model for curators' tests.
import assert from 'node:assert/strict';
import { cpSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { run, source } from '../server.mjs';

const corners = [[0, 1, 0], [-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]];
const faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [1, 4, 3], [1, 3, 2]];
const positions = new Float32Array(faces.flatMap((face) => face.flatMap((i) => corners[i])));

// A pyramid whose file says whose it is, written into a folder: the path of its glTF file.
export function write_pyramid(folder) {
  const model = join(folder, 'pyramid.gltf');
  writeFileSync(join(folder, 'pyramid.bin'), Buffer.from(positions.buffer));
  writeFileSync(model, JSON.stringify({
    asset: { version: '2.0', copyright: '2024 A. Mason',
      extras: { title: 'Pyramid', author: 'A. Mason', license: 'CC0',
        source: 'https://example.org' } },
    scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: 'Pyramid' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 18, type: 'VEC3', min: [-1, 0, -1],
      max: [1, 1, 1] }],
    bufferViews: [{ buffer: 0, byteLength: positions.byteLength }],
    buffers: [{ byteLength: positions.byteLength, uri: 'pyramid.bin' }],
  }));
  return model;
}

// A folder of packages below that folder: the castle, and the pyramid as `giza`.
export async function make_two_exhibits(folder) {
  const content = join(folder, 'content');
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  cpSync(join(source, 'content', 'castle'), join(content, 'castle'), { recursive: true });
  return content;
}
