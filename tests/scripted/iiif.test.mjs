// SPDX-License-Identifier: Apache-2.0
// Large pictures for viewers of other museums: the IIIF Image API 3.0 and the manifest of an
// exhibit, over HTTP.
import assert from 'node:assert/strict';
import { copyFileSync, cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync }
  from 'node:fs';
import http from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { little_light, source, start_server } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-iiif-'));
const room = join(folder, 'content', 'room');
const poster = readFileSync(join(source, 'content', 'first-room', 'poster.jpg'));
let server;

// Returns the size of a JPEG as its frame tells.
function size_of(jpeg) {
  for (let at = 2; ; at += 2 + jpeg.readUInt16BE(at + 2)) {
    const marker = jpeg[at + 1];
    if (marker >= 0xc0 && marker <= 0xc2)
      return { width: jpeg.readUInt16BE(at + 7), height: jpeg.readUInt16BE(at + 5) };
  }
}
const { width, height } = size_of(poster);

before(async () => {
  cpSync(join(source, 'content', 'first-room'), room, { recursive: true });
  // A pyramid of Zoomify whose one tile is the poster: it goes out as it is stored.
  mkdirSync(join(room, 'zoomify', 'TileGroup0'), { recursive: true });
  copyFileSync(join(room, 'poster.jpg'), join(room, 'zoomify', 'TileGroup0', '0-0-0.jpg'));
  writeFileSync(join(room, 'zoomify', 'ImageProperties.xml'),
      `<IMAGE_PROPERTIES WIDTH="${width}" HEIGHT="${height}" TILESIZE="2048"/>`);
  const exhibit = JSON.parse(readFileSync(join(room, 'exhibit.json'), 'utf8'));
  exhibit.id = 'room';
  const place = { position: [0, 1.5, -2.4], yaw_deg: 180 };
  exhibit.pieces = [
    { id: 'poster', kind: 'picture', source: 'poster.jpg', width_m: 1.28, place,
      label: { en: 'A poster', de: 'Ein Plakat' }, text: { en: 'It shows the room.' },
      provenance: { creator: 'A. Painter', date: { en: 'today', de: 'heute' } } },
    { id: 'tiles', kind: 'picture', source: 'zoomify/ImageProperties.xml', width_m: 0.5,
      place: { position: [0, 1.5, -2.3], yaw_deg: 180 } },
  ];
  writeFileSync(join(room, 'exhibit.json'), JSON.stringify(exhibit));
  server = await start_server(['--exhibit', 'room', ...little_light],
      { content: join(folder, 'content') });
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});

const get = (path, options) => fetch(`${server.url}/iiif/${path}`, options);
const bytes_of = async (reply) => Buffer.from(await reply.arrayBuffer());

test('a picture is described, and its address leads there', async () => {
  const { status, headers } = await get('room~poster', { redirect: 'manual' });
  assert.equal(status, 303);
  assert.equal(headers.get('location'), `${server.url}/iiif/room~poster/info.json`);
  const reply = await get('room%7Eposter/info.json');
  assert.equal(reply.status, 200);
  assert.match(reply.headers.get('content-type'), /^application\/json/);
  const info = await reply.json();
  assert.equal(info['@context'], 'http://iiif.io/api/image/3/context.json');
  assert.equal(info.id, `${server.url}/iiif/room~poster`);
  assert.equal(info.type, 'ImageService3');
  assert.equal(info.protocol, 'http://iiif.io/api/image');
  assert.equal(info.profile, 'level2');
  assert.deepEqual([info.width, info.height], [width, height]);
  assert.equal(info.maxWidth, 4096);
  assert.deepEqual(info.tiles, [{ width: 256, height: 256, scaleFactors: [1, 2, 4, 8] }]);
  assert.deepEqual(info.sizes,
      [8, 4, 2, 1].map((scale) => ({ width: width / scale, height: height / scale })));
  const linked = await get('room~poster/info.json', { headers: { accept: 'application/ld+json' } });
  assert.equal(linked.headers.get('content-type'),
      'application/ld+json;profile="http://iiif.io/api/image/3/context.json"');
  assert.match(linked.headers.get('vary'), /Accept/);
});

test('every tile that is described is there in its size', async () => {
  const info = await (await get('room~poster/info.json')).json();
  for (const { width: side, scaleFactors } of info.tiles)
    for (const scale of scaleFactors)
      for (let y = 0; y < height; y += side * scale)
        for (let x = 0; x < width; x += side * scale) {
          const region = [x, y, Math.min(side * scale, width - x),
            Math.min(side * scale, height - y)];
          const [wide, high] = region.slice(2).map((length) => Math.ceil(length / scale));
          const tile = await get(`room~poster/${region}/${wide},${high}/0/default.jpg`);
          assert.equal(tile.status, 200, `${region}`);
          assert.equal(tile.headers.get('content-type'), 'image/jpeg');
          assert.deepEqual(size_of(await bytes_of(tile)), { width: wide, height: high });
        }
});

test('parts, sizes, turns and formats', async () => {
  for (const [request, wide, high] of [['full/max/0/default.jpg', width, height],
    ['square/100,/90/gray.jpg', 100, 100], ['0,0,300,200/!90,90/90/color.jpg', 60, 90],
    ['pct:0,0,50,50/^pct:200/!180/bitonal.jpg', width, height]]) {
    const reply = await get(`room~poster/${request}`);
    assert.equal(reply.status, 200, request);
    assert.deepEqual(size_of(await bytes_of(reply)), { width: wide, height: high }, request);
  }
  const png = await bytes_of(await get('room~poster/full/64,/0/default.png'));
  assert.equal(png.toString('latin1', 1, 4), 'PNG');
  assert.equal(png.readUInt32BE(16), 64);
  const links = (await get('room~poster/0,0,9999,9999/640,/360/color.jpg')).headers.get('link');
  assert.ok(links.includes(
      `<${server.url}/iiif/room~poster/full/640,${height / 2}/0/default.jpg>;rel="canonical"`));
  assert.ok(links.includes('<http://iiif.io/api/image/3/level2.json>;rel="profile"'));
});

test('a tile goes out as it is stored', async () => {
  const reply = await get('room~tiles/full/max/0/default.jpg');
  assert.ok(poster.equals(await bytes_of(reply)));
  assert.ok(!poster.equals(await bytes_of(await get('room~tiles/full/max/0/gray.jpg'))));
});

test('what is wrong is told', async () => {
  const image = 'room~poster/';
  for (const [path, status, code] of [['room~nothing/info.json', 404, 'unknown_picture'],
    ['nowhere~poster/info.json', 404, 'unknown_picture'], ['room', 404, 'unknown_picture'],
    ['nowhere/manifest.json', 404, 'unknown_picture'], [`${image}full`, 400, 'bad_request'],
    [`${image}9999,0,1,1/max/0/default.jpg`, 400, 'bad_request'],
    [`${image}full/9999,/0/default.jpg`, 400, 'bad_request'],
    [`${image}full/^5000,/0/default.jpg`, 400, 'bad_request'],
    [`${image}full/max/45/default.jpg`, 501, 'bad_request'],
    [`${image}full/max/0/default.webp`, 400, 'bad_request']]) {
    const reply = await get(path);
    assert.equal(reply.status, status, path);
    assert.equal((await reply.json()).error.code, code, path);
    assert.equal(reply.headers.get('access-control-allow-origin'), '*', path);
  }
});

test('pages of other sites may read it, and keep it', async () => {
  for (const path of ['room~poster/info.json', 'room~poster/full/90,/0/default.jpg',
    'room/manifest.json']) {
    const reply = await get(path, { headers: { origin: 'https://viewer.example' } });
    assert.equal(reply.headers.get('access-control-allow-origin'), '*', path);
    assert.equal(reply.headers.get('cross-origin-resource-policy'), 'cross-origin', path);
    assert.equal(reply.headers.get('cache-control'), 'public, max-age=86400', path);
    const headers = { 'if-none-match': reply.headers.get('etag') };
    await reply.arrayBuffer();
    const again = await get(path, { headers });
    assert.equal(again.status, 304, path);
    const head = await get(path, { method: 'HEAD' });
    assert.equal(head.status, 200, path);
  }
  const allowed = await get('room~poster/info.json', { method: 'OPTIONS' });
  assert.equal(allowed.status, 204);
  assert.match(allowed.headers.get('access-control-allow-methods'), /GET/);
  assert.equal((await get('room~poster/info.json', { method: 'PUT' })).status, 405);
  assert.equal((await fetch(`${server.url}/`, { method: 'OPTIONS' })).status, 405);
});

test('the burst of a viewer is answered', async () => {
  const replies = await Promise.all(Array.from({ length: 50 }, (_, i) =>
      get(`room~poster/${i},${i},256,256/max/0/default.jpg`)));
  for (const reply of replies) {
    assert.equal(reply.status, 200);
    await reply.arrayBuffer();
  }
});

test('an exhibit has a manifest', async () => {
  const reply = await get('room/manifest.json');
  const manifest = await reply.json();
  assert.equal(manifest['@context'], 'http://iiif.io/api/presentation/3/context.json');
  assert.equal(manifest.type, 'Manifest');
  assert.equal(manifest.id, `${server.url}/iiif/room/manifest.json`);
  assert.deepEqual(Object.keys(manifest.label).sort(), ['de', 'en', 'sk']);
  assert.equal(manifest.items.length, 2);
  const [canvas, other] = manifest.items;
  assert.deepEqual([canvas.type, canvas.width, canvas.height], ['Canvas', width, height]);
  assert.deepEqual(canvas.label, { en: ['A poster'], de: ['Ein Plakat'] });
  assert.deepEqual(canvas.summary, { en: ['It shows the room.'] });
  assert.deepEqual(canvas.metadata, [
    { label: { en: ['Creator'] }, value: { en: ['A. Painter'] } },
    { label: { en: ['Date'] }, value: { en: ['today'], de: ['heute'] } }]);
  assert.equal(canvas.service[0].physicalUnits, 'cm');
  assert.ok(Math.abs(canvas.service[0].physicalScale * width - 128) < 1e-3);
  const [annotation] = canvas.items[0].items;
  assert.equal(annotation.motivation, 'painting');
  assert.equal(annotation.target, canvas.id);
  assert.deepEqual(annotation.body.service, [
    { id: `${server.url}/iiif/room~poster`, type: 'ImageService3', profile: 'level2' }]);
  assert.equal((await fetch(annotation.body.id)).status, 200);
  assert.deepEqual(other.label, { none: ['tiles'] });
});

test('addresses are those by which the server is asked', async () => {
  const info = await new Promise((resolve, reject) => {
    const headers = { host: `localhost:${server.port}` };
    http.get(`${server.url}/iiif/room~poster/info.json`, { headers }, (reply) => {
      let text = '';
      reply.on('data', (part) => { text += part; });
      reply.on('end', () => resolve(JSON.parse(text)));
    }).on('error', reject);
  });
  assert.equal(info.id, `http://localhost:${server.port}/iiif/room~poster`);
});
