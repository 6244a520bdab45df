// SPDX-License-Identifier: Apache-2.0
// Long work in shards: whoever does it, however often it is broken off, the result has the same
// bits as one command's. By a real NATS with JetStream, by make, and by a script of Slurm arrays.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync,
  writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { run, source, until } from '../server.mjs';

const bin = process.env.WELLSPRING_BIN;
const has = (name, word) => !spawnSync(name, [word]).error;
const skip = has('nats-server', '--version') ? false : 'nats-server is not installed';
const no_vips = has('vips', '--version') ? false : 'vips is not installed';
const folder = mkdtempSync(join(tmpdir(), 'wellspring-jobs-'));
const secret = 'what-only-these-tests-know';
const passes = 100, bake_words = ['--passes', String(passes), '--nodes', '20000'];
const children = new Set();
let port, nats;

after(() => {
  for (const child of children) child.kill('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
});

// Makes a floor under a bulb, as a package below `inputs`.
function make_package(inputs, color = 0.5) {
  const floor = [-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2];
  const up = [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0];
  const bytes = Buffer.concat([Buffer.from(new Float32Array([...floor, ...up]).buffer),
    Buffer.from(new Uint16Array([0, 1, 2, 0, 2, 3]).buffer)]);
  const scene = {
    asset: { version: '2.0' }, extensionsUsed: ['KHR_lights_punctual'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'point', intensity: 5 }] } },
    buffers: [{ byteLength: bytes.length,
      uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 48 },
      { buffer: 0, byteOffset: 96, byteLength: 12 }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-2, 0, -2],
        max: [2, 0, 2] },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC3' },
      { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' }],
    materials: [{ pbrMetallicRoughness: { baseColorFactor: [color, color, color, 1],
      metallicFactor: 0 } }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2,
      material: 0 }] }],
    cameras: [{ type: 'perspective', perspective: { yfov: 1, znear: 0.1 } }],
    nodes: [{ name: 'Floor', mesh: 0 },
      { name: 'Bulb', translation: [0, 2, 0], extensions: { KHR_lights_punctual: { light: 0 } } },
      { name: 'Eye', translation: [0, 1.6, 1], camera: 0 }],
    scenes: [{ nodes: [0, 1, 2] }], scene: 0,
  };
  const made = join(inputs, 'content', 'hall');
  mkdirSync(made, { recursive: true });
  writeFileSync(join(made, 'scene.gltf'), JSON.stringify(scene));
  writeFileSync(join(made, 'exhibit.json'),
      JSON.stringify({ title: 'Floor', languages: ['en'], scene: 'scene.gltf' }));
  return inputs;
}

// Makes a PNG of any pattern, of one channel or of three.
function make_png(side, seed, channels = 3) {
  const table = Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n >>> 0;
  });
  const crc = (bytes) =>
    ~bytes.reduce((c, byte) => table[(c ^ byte) & 255] ^ (c >>> 8), -1) >>> 0;
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]), size = Buffer.alloc(4),
      end = Buffer.alloc(4);
    size.writeUInt32BE(data.length), end.writeUInt32BE(crc(body));
    return Buffer.concat([size, body, end]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(side, 0), head.writeUInt32BE(side, 4);
  head[8] = 8, head[9] = channels === 3 ? 2 : 0;
  const row = channels * side, rows = Buffer.alloc(side * (1 + row));
  for (let y = 0; y < side; y++)
    for (let x = 0; x < row; x++) rows[y * (1 + row) + 1 + x] = (x * seed + y * y) & 255;
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', head),
    chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

const inputs = make_package(join(folder, 'inputs'));
for (const name of ['one', 'two', 'three'])
  writeFileSync(join(inputs, `${name}.png`), make_png(300, name.length + 2));

function free_port() {
  return new Promise((resolve) => {
    const socket = net.createServer().listen(0, '127.0.0.1', () => {
      const { port: found } = socket.address();
      socket.close(() => resolve(found));
    });
  });
}

async function start_nats() {
  port ??= await free_port();
  nats = spawn('nats-server',
      ['-js', '-sd', join(folder, 'nats'), '-a', '127.0.0.1', '-p', String(port)],
      { stdio: 'ignore' });
  children.add(nats);
  const answers = () => new Promise((resolve) => {
    const socket = net.connect(port, '127.0.0.1');
    socket.on('data', () => { socket.destroy(); resolve(true); });
    socket.on('error', () => resolve(false));
  });
  await until(answers, 'nats-server answers');
}

const kill = (child, signal = 'SIGKILL') => new Promise((resolve) => {
  children.delete(child);
  if (child.exitCode !== null || child.signalCode !== null) return resolve();
  child.on('exit', () => resolve());
  child.kill(signal);
});

const places = (from = inputs) => ['--nats', `nats://127.0.0.1:${port}`, '--folder', from,
  '--cache', join(folder, 'cache'), '--scratch', join(folder, 'scratch')];
process.env.WELLSPRING_WORKERS_KEY = secret;
const jobs = (...args) => run('wellspring_jobs', [...places(), ...args]);
const state_of = async (job) => {
  const { status, stdout, stderr } = await jobs('--json');
  return status === 0 ? JSON.parse(stdout).find((one) => one.job === job) : assert.fail(stderr);
};

function start_worker(name, { from = inputs, env = {} } = {}) {
  const child = spawn(join(bin, 'wellspring_jobs'),
      [...places(from), 'work', '--name', name, '--cores', '1'],
      { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, ...env } });
  children.add(child);
  child.said = '';
  child.stderr.on('data', (bytes) => { child.said += bytes; });
  return child;
}
const submit = async (...words) => {
  const { status, stdout, stderr } = await jobs('submit', ...words);
  assert.equal(status, 0, stderr);
  return stdout.trim();
};

// Returns the bits of a bake of one command.
let whole;
async function bake_whole() {
  if (whole) return whole;
  const package_folder = join(make_package(join(folder, 'alone')), 'content', 'hall');
  const said = await run('wellspring_bake',
      [package_folder, '--cache', join(folder, 'alone', 'cache'), ...bake_words]);
  assert.equal(said.status, 0, said.stderr);
  assert.match(said.stdout, new RegExp(`: ${passes} passes, error`));
  whole = readFileSync(join(package_folder, 'light.maps'));
  return whole;
}
function take_maps() {
  const file = join(inputs, 'content', 'hall', 'light.maps');
  const bytes = readFileSync(file);
  rmSync(file);
  return bytes;
}
const is_same = (a, b, what) => assert.ok(a.equals(b), `${what}: other bits`);

test('a bake by passes has the same bits however often it is broken off', async () => {
  const wanted = await bake_whole();
  const again = make_package(join(folder, 'again'));
  const package_folder = join(again, 'content', 'hall');
  const args = [package_folder, '--cache', join(again, 'cache'), ...bake_words, '--resume'];
  for (let i = 0; i < 2; i++) {
    const child = spawn(join(bin, 'wellspring_bake'), args, { stdio: 'ignore' });
    await new Promise((resolve) => { setTimeout(resolve, 1000); });
    child.kill('SIGTERM');
    await new Promise((resolve) => { child.on('exit', resolve); });
  }
  assert.equal((await run('wellspring_bake', args)).status, 0);
  is_same(readFileSync(join(package_folder, 'light.maps')), wanted, 'light.maps');
  const fewer = await run('wellspring_bake',
      [...args.map((word) => (word === String(passes) ? '3' : word))]);
  assert.equal(fewer.status, 1);
  assert.match(fewer.stderr, /more than 3 passes/);
});

test('a bake of 8 shards, two workers killed and NATS, too, has the same bits', { skip },
    async () => {
  await start_nats();
  const job = await submit('--shards', '8', '--', 'bake', 'content/hall', ...bake_words);
  assert.match(job, /^bake-hall-[0-9a-f]{6}$/);
  assert.match((await jobs()).stdout, /0 of 8 shards done, 8 wait/);
  const works = (name) => async () =>
    (await state_of(job)).shards.some((shard) => shard.state === 'works' && shard.worker === name);
  for (const name of ['first', 'second']) {
    const child = start_worker(name);
    await until(works(name), `${name} works`);
    await kill(child);
  }
  const third = start_worker('third');
  await until(works('third'), 'third works');
  await kill(nats);
  await start_nats();
  const { status, stdout, stderr } = await jobs('wait', job);
  assert.equal(status, 0, `${stdout}${stderr}\n${third.said}`);
  const { shards, share } = await state_of(job);
  assert.equal(share, 1);
  assert.ok(shards.every((shard) => shard.worker === 'third' || shard.worker === 'second' ||
    shard.worker === 'first'));
  const fetched = await jobs('fetch', job);
  assert.equal(fetched.status, 0, fetched.stderr);
  is_same(take_maps(), await bake_whole(), 'light.maps');
  assert.equal((await jobs('remove', job)).status, 0);
  assert.match((await jobs()).stdout, /^no jobs$/m);
  await kill(third, 'SIGTERM');
});

test('a machine with other files refuses by name; one with the same does it', { skip },
    async () => {
  const other = make_package(join(folder, 'other'), 0.6);
  const job = await submit('--', 'bake', 'content/hall', ...bake_words);
  const stranger = start_worker('stranger', { from: other });
  await until(async () => /scene: the exhibit's files differ/.test((await jobs()).stdout),
      'the stranger refuses');
  await kill(stranger);
  const worker = start_worker('same');
  assert.equal((await jobs('wait', job)).status, 0);
  const fetched = await jobs('fetch', job);
  assert.equal(fetched.status, 0, fetched.stderr);
  is_same(take_maps(), await bake_whole(), 'light.maps');
  await jobs('remove', job);
  await kill(worker);
});

test('what always fails is a dead letter with its reason, and may be tried again',
    { skip: skip || no_vips }, async () => {
  // This machine has no vips.
  const path = join(folder, 'path');
  mkdirSync(path);
  for (const name of ['setpriv', 'nice'])
    symlinkSync(spawnSync('which', [name], { encoding: 'utf8' }).stdout.trim(), join(path, name));
  const job = await submit('--shards', '2', '--', 'import', 'picture', 'one.png', 'two.png');
  const poor = start_worker('poor', { env: { PATH: path } });
  const waited = await jobs('wait', job);
  assert.equal(waited.status, 1);
  assert.match(waited.stdout, /dead at poor: vips cannot be started/);
  assert.match(waited.stdout, new RegExp(`jobs retry ${job}`));
  await until(async () => (await state_of(job)).shards.every(({ state }) => state === 'dead'),
      'both are dead');
  await kill(poor);
  assert.match((await jobs('retry', job)).stdout, /2 shards wait again/);
  const rich = start_worker('rich');
  assert.equal((await jobs('wait', job)).status, 0);
  await kill(rich);
  const out = join(folder, 'imported'), alone = join(folder, 'imported-alone');
  const fetched = await jobs('fetch', job, '--out', out);
  const said = await run('wellspring_import', ['picture', join(inputs, 'one.png'),
    join(inputs, 'two.png'), '--out', alone]);
  assert.equal(fetched.stdout, said.stdout);
  for (const name of ['one.tif', 'two.tif'])
    is_same(readFileSync(join(out, name)), readFileSync(join(alone, name)), name);
  await jobs('remove', job);
});

test('nothing else runs, and no path leads out', { skip }, async () => {
  symlinkSync('/etc', join(inputs, 'out'));
  for (const [words, what] of [[['rm', '-rf', 'x'], /'rm' is no command of jobs/],
      [['bake', '../x', '--passes', '1'], /'\.\.\/x' is no path below/],
      [['bake', '/etc', '--passes', '1'], /'\/etc' is no path below/],
      [['bake', 'content/hall'], /wants --passes/],
      [['bake', 'content/hall', '--passes', '1', '--out', 'x'], /'--out' is no option of jobs/],
      [['import', 'picture', 'out/passwd'], /out\/passwd is not below/]]) {
    const said = await jobs('submit', '--', ...words);
    assert.equal(said.status, 1, words.join(' '));
    assert.match(said.stderr, what);
  }
  rmSync(join(inputs, 'out'));
  for (const args of [['submit'], ['fetch'], ['work', '--hours', 'night'], ['dance']])
    assert.equal((await jobs(...args)).status, 2, args.join(' '));
  assert.match((await jobs('fetch', 'none')).stderr, /there is no job 'none'/);
  const full = await run('wellspring_jobs', ['--nats', 'nats://127.0.0.1:1']);
  assert.equal(full.status, 1);
  assert.match(full.stderr, /no NATS server answers/);
  await kill(nats);
});

// What make and Slurm do has the same bits as one command's.
const figure = join(source, 'content', 'castle', 'figures', 'storyteller.x3d');
const story = join(source, 'content', 'first-room', 'stories', 'cup.en.story');
const clip_words = ['--seconds', '1', '--fps', '3', '--size', '48x64', '--spp', '1'];

// Makes a picture of six bands, as a folder of PNGs, that `lamps` compares.
function make_bands() {
  const made = join(folder, 'bands');
  mkdirSync(made, { recursive: true });
  for (const nm of [420, 470, 520, 570, 620, 670])
    writeFileSync(join(made, `band_${nm}nm.png`), make_png(24, nm % 13 + 1, 1));
  return made;
}

test('by make -j and by Slurm arrays it is the same bits', { skip: no_vips }, async () => {
  const makefile = join(source, 'deploy', 'jobs', 'Makefile'),
    slurm = join(source, 'deploy', 'jobs', 'slurm.sh');
  const make = (...args) => {
    const said = spawnSync('make', ['-j', '2', '-f', makefile, `BIN=${bin}`,
      `CACHE=${join(folder, 'cache')}`, 'SHARDS=2', ...args], { encoding: 'utf8' });
    assert.equal(said.status, 0, said.stdout + said.stderr);
    return said.stdout;
  };
  const array = (out, ...words) => {
    const env = { ...process.env, BIN: bin, OUT: out };
    for (const i of [1, 2]) {
      const said = spawnSync('sh', [slurm, ...words], { encoding: 'utf8',
        env: { ...env, SLURM_ARRAY_TASK_ID: String(i), SLURM_ARRAY_TASK_COUNT: '2' } });
      assert.equal(said.status, 0, said.stdout + said.stderr);
    }
    const said = spawnSync('sh', [slurm, ...words], { encoding: 'utf8', env });
    assert.equal(said.status, 0, said.stdout + said.stderr);
    return said.stdout;
  };
  const hall = join(inputs, 'content', 'hall');
  make('bake', `PACKAGE=${hall}`, `PASSES=${passes}`, 'OPTIONS=--nodes 20000',
      `OUT=${join(folder, 'make-bake')}`);
  is_same(take_maps(), await bake_whole(), 'bake by make');
  array(join(folder, 'slurm-bake'), 'bake', hall, ...bake_words);
  is_same(take_maps(), await bake_whole(), 'bake by Slurm');

  const files = ['one', 'two', 'three'].map((name) => join(inputs, `${name}.png`));
  const imported = join(folder, 'import'), by_make = join(folder, 'make-import');
  const printed = (await run('wellspring_import', ['picture', ...files, '--out', imported])).stdout;
  assert.ok(make('-s', 'import', `FILES=${files.join(' ')}`, `OUT=${by_make}`).endsWith(printed));
  for (const name of readdirSync(imported))
    is_same(readFileSync(join(by_make, name)), readFileSync(join(imported, name)), name);

  const clip = join(folder, 'clip'), made_clip = join(folder, 'make-clip');
  const said = await run('wellspring_clip', [figure, story, ...clip_words, '--out', clip]);
  assert.equal(said.status, 0, said.stderr);
  make('clip', `FIGURE=${figure}`, `STORY=${story}`, `OPTIONS=${clip_words.join(' ')}`,
      `OUT=${made_clip}`);
  const clips = readdirSync(clip).filter((name) => !name.endsWith('.mp4'));
  assert.ok(clips.includes('0002.png') && clips.includes('sheet.png') &&
    clips.includes('sound.wav'));
  for (const name of clips)
    is_same(readFileSync(join(made_clip, name)), readFileSync(join(clip, name)), name);

  const bands = make_bands();
  const table = await run('wellspring_lamps', ['--picture', bands]);
  assert.equal(table.status, 0, table.stderr);
  assert.ok(make('-s', 'lamps', `PICTURE=${bands}`, `OUT=${join(folder, 'make-lamps')}`)
      .endsWith(table.stdout));
  assert.ok(array(join(folder, 'slurm-lamps'), 'lamps', '--picture', bands).endsWith(table.stdout));
  const missing = await run('wellspring_lamps',
      ['--picture', bands, '--merge', join(folder, 'make-lamps', '1.places')]);
  assert.equal(missing.status, 1);
  assert.match(missing.stderr, /1\.places: is no shard of 1/);
});
