// SPDX-License-Identifier: Apache-2.0
// A server with workers behind a real NATS server: their samples arrive with the same bits, who
// differs is refused by name, who answers nonsense is not asked, and whatever dies, pictures go on.
import assert from 'node:assert/strict';
import { cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync,
  writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, sleep, start_server, until } from '../server.mjs';
import { begin_to_walk, content, free_port, kill, read_numbers, skip, start_nats, start_worker,
  worker_state } from './crew.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const secret = 'what-only-these-tests-know';
const workers = new Map();
let port, nats, server, visitor;

// Speaks as much of NATS as a test needs.
class Nats {
  constructor() {
    this.rest = Buffer.alloc(0);
    this.heard = [];
    this.socket = net.connect(port, '127.0.0.1');
    this.socket.on('error', () => {});
    this.socket.on('data', (bytes) => this.read(bytes));
    this.socket.write('CONNECT {"verbose":false,"pedantic":false}\r\n');
  }
  read(bytes) {
    this.rest = Buffer.concat([this.rest, bytes]);
    for (let end; (end = this.rest.indexOf('\r\n')) >= 0;) {
      const words = this.rest.toString('latin1', 0, end).split(' ');
      let next = end + 2;
      if (words[0] === 'MSG') {
        const size = Number(words.at(-1));
        if (this.rest.length < next + size + 2) return;
        const message = Buffer.from(this.rest.subarray(next, next + size));
        next += size + 2;
        this.heard[Number(words[2])](message, words.length > 4 ? words[3] : '');
      } else if (words[0] === 'PING') this.socket.write('PONG\r\n');
      this.rest = this.rest.subarray(next);
    }
  }
  listen(subject, heard) {
    this.heard.push(heard);
    this.socket.write(`SUB ${subject} ${this.heard.length - 1}\r\n`);
  }
  send(subject, message) {
    this.socket.write(`PUB ${subject} ${message.length}\r\n`);
    this.socket.write(message);
    this.socket.write('\r\n');
  }
  close() { this.socket.destroy(); }
}

async function begin_worker(name, { embree = '', ...options } = {}) {
  const { child } = await start_worker(name, port, { cache: join(folder, 'worker'),
    environment: { WELLSPRING_EMBREE: embree }, ...options });
  workers.set(name, child);
}
const metric = async (name) => (await read_numbers(server))[name] ?? 0;
const state_of = (name) => worker_state(server, name);
const pictures_go_on = async () => {
  for (let k = 0; k < 3; k++) await visitor.picture();
};

let stop_walking;

before(async () => {
  if (skip) return;
  port = await free_port();
  nats = await start_nats(port);
  server = await start_server(['--exhibit', 'first-room', '--no-bake', '--verify-workers',
    '--workers', `nats://127.0.0.1:${port}`, '--cache', join(folder, 'server')]);
  await Promise.all([begin_worker('north'), begin_worker('south')]);
  visitor = new Visitor(server);
  await visitor.hello();
  stop_walking = begin_to_walk(visitor);
});
after(async () => {
  stop_walking?.();
  await Promise.all([...workers.values()].map((child) => kill(child)));
  if (server) assert.equal(await server.stop(), 0);
  if (nats) await kill(nats);
  rmSync(folder, { recursive: true, force: true });
});

test('samples come from all workers, with the same bits', { skip }, async () => {
  for (const name of ['north', 'south'])
    await until(async () => await metric(`worker_samples_total ${name}`) > 2000,
        `samples of ${name}`);
  assert.ok(await metric('workers_verified_total') > 4000);
  assert.equal(await metric('workers_differing_total'), 0);
  assert.equal(await metric('workers_spoiled_total'), 0);
  await until(async () => (await state_of('north')).problem === '', 'north is asked');
  const north = await state_of('north');
  assert.equal(north.cores, 1);
  assert.ok(north.samples_per_second > 0);
});

test('a finished picture over HTTP has samples of workers, the same bits', { skip }, async () => {
  stop_walking?.();
  await visitor.close();
  const total = () => metric('workers_samples_total');
  let before;  // what was on its way to the visitor has come
  do {
    before = await total();
    await sleep(500);
  } while (await total() !== before);
  const still = await fetch(`${server.url}/api/v1/exhibits/first-room/still.jpg?`
      + 'width=320&height=180&seconds=4&denoise=0');
  assert.equal(still.status, 200);
  assert.ok(Number(still.headers.get('still-samples')) >= 1);
  assert.ok(await total() > before);
  assert.equal(await metric('workers_differing_total'), 0);
  visitor = new Visitor(server);
  await visitor.hello();
  stop_walking = begin_to_walk(visitor);
});

// Reads where fields of an order lie (server/workers/message.cpp).
function places_of(order) {
  let at = 5 + 8;
  const places = { number: at };
  at += 8 + 4;
  for (const name of ['exhibit', 'version', 'instructions']) {
    places[name] = at + 4;
    at += 4 + order.readUInt32LE(at);
  }
  places.scene = at, places.light = at + 8, places.exact = at + 16;
  at += 17;
  places.technique = at + 4;
  at += 4 + order.readUInt32LE(at) + 10;
  places.state = at + 4;
  return places;
}
const words = ['none', 'version', 'instructions', 'exhibit', 'scene', 'light', 'state', 'technique',
  'late', 'busy'];

test('an order of another version, scene or light is refused by name', { skip }, async () => {
  const line = new Nats();
  const order = await new Promise((resolve) => line.listen('wellspring.orders.north', resolve));
  const answers = new Map();
  line.listen('wellspring.answers.*', (message) => {
    if (message[4] === 2)
      answers.set(message.readUInt32LE(13), words[message[21 + 4 + message.readUInt32LE(21)]]);
  });
  const places = places_of(order);
  let number = 1 << 30;
  for (const name of words.slice(1, 8)) {
    const other = Buffer.from(order);
    other.writeUInt32LE(++number, places.number);
    other[places[name]] ^= 1;
    other[places.exact] = 1;
    line.send('wellspring.orders.north', other);
    await until(() => answers.has(number), `an answer to another ${name}`);
    assert.equal(answers.get(number), name);
  }
  // What is no order at all is not answered, and does no harm.
  for (const size of [0, 5, 60, order.length - 1])
    line.send('wellspring.orders.north', order.subarray(0, size));
  const again = Buffer.from(order);
  again.writeUInt32LE(++number, places.number);
  line.send('wellspring.orders.north', again);
  await until(() => answers.has(number), 'an answer to the order itself');
  line.close();
});

test('a worker with other instructions finds the same light, if not the same bits', { skip },
    async () => {
      await begin_worker('old', { embree: 'isa=sse2' });
      await until(async () => await metric('workers_alike_total') > 10000, 'samples of old');
      assert.equal((await state_of('old')).same_bits, false);
      assert.ok(Math.abs(await metric('workers_alike_deviation')) < 5);
      assert.ok(Math.abs(await metric('workers_alike_difference')) < 0.01);
      assert.equal(await metric('workers_differing_total'), 0);
      await kill(workers.get('old'), 'SIGTERM');
    });

test('a worker without the illumination maps fetches them', { skip }, async () => {
  const exhibits = join(folder, 'content');
  cpSync(join(content, 'first-room'), join(exhibits, 'first-room'), { recursive: true });
  rmSync(join(exhibits, 'first-room', 'light.maps'));
  await begin_worker('dark', { exhibits });
  await until(async () => await metric('worker_samples_total dark') > 1000,
      'samples by fetched maps');
  assert.ok(await metric('workers_refused_total light') > 0);
  assert.equal(await metric('workers_differing_total'), 0);
  await kill(workers.get('dark'), 'SIGTERM');
});

test('a worker without the exhibit fetches it, whole, and goes on after a kill', { skip },
    async () => {
      const cache = join(folder, 'bare'), files = join(cache, 'packages', 'files');
      const bare = () => begin_worker('bare', { exhibits: join(folder, 'nothing'), cache });
      const halves = () => existsSync(files) && readdirSync(files).length > 0;
      await bare();
      await until(halves, 'the first file');
      await kill(workers.get('bare'));
      await bare();
      await until(async () => await metric('worker_samples_total bare') > 1000,
          'samples by a fetched exhibit');
      assert.equal(await metric('workers_differing_total'), 0);
      assert.ok(await metric('workers_refused_total exhibit') > 0);
      const [version] = readdirSync(join(cache, 'packages')).filter((name) => name.length === 16);
      const place = join(cache, 'packages', version, 'first-room', 'scene.glb');
      assert.deepEqual(readFileSync(place), readFileSync(join(content, 'first-room', 'scene.glb')));
      await kill(workers.get('bare'), 'SIGTERM');
    });

test('a worker that has another scene is not asked, and told', { skip }, async () => {
  const exhibits = join(folder, 'content');
  cpSync(join(content, 'first-room'), join(exhibits, 'first-room'), { recursive: true });
  const file = join(exhibits, 'first-room', 'scene.glb'), scene = readFileSync(file);
  const place = scene.indexOf('"roughnessFactor":0.');
  assert.ok(place > 0);
  scene[place + '"roughnessFactor":0.'.length] ^= 1;
  writeFileSync(file, scene);
  await begin_worker('other', { exhibits, words: ['--fetch-most', '0'] });
  await until(async () => (await state_of('other'))?.problem.includes('scene'),
      'refuses: scene');
  assert.ok(await metric('workers_refused_total scene') > 0);
  await pictures_go_on();
  await kill(workers.get('other'), 'SIGTERM');
});

function write_text(text) {
  const size = Buffer.alloc(4);
  size.writeUInt32LE(text.length);
  return Buffer.concat([size, Buffer.from(text)]);
}

test('a worker that answers nonsense is not asked, and spoils nothing', { skip }, async () => {
  const line = new Nats();
  let orders = 0;
  line.listen('wellspring.call', (call, reply) => {
    const cores = Buffer.from([1, 0, 0, 0]);
    line.send(reply, Buffer.concat([Buffer.from('WSW1\x04'), call.subarray(5),
      write_text('liar'), write_text('0.1.0'), write_text('x'), cores]));
  });
  line.listen('wellspring.orders.liar', (order, reply) => {
    orders++;
    const one = Buffer.alloc(2 + 12 + 12 + 4 + 12);  // a hit on an object that is not there
    one[0] = 1, one.writeUInt32LE(0xffff0000, 26);
    const head = Buffer.concat([Buffer.from('WSW1\x02'), order.subarray(5, 21),
      write_text('liar'), Buffer.from([0]), Buffer.alloc(8), Buffer.from([1, 0, 0, 0])]);
    line.send(reply, Buffer.concat([head, one]));
  });
  await until(async () => (await state_of('liar'))?.problem.includes('cannot be'), 'is judged');
  assert.ok(orders >= 1);
  assert.ok(await metric('workers_spoiled_total') > 0);
  assert.equal(await metric('workers_differing_total'), 0);
  await pictures_go_on();
  line.close();
});

test('pictures go on when a worker dies, or NATS, and when it is back', { skip }, async () => {
  await kill(workers.get('south'));
  await until(async () => (await state_of('south'))?.problem, 'the dead worker is noticed');
  await pictures_go_on();
  await kill(nats);
  await until(async () => await metric('workers_connected') === 0, 'the loss is noticed');
  await pictures_go_on();
  const before_it = await metric('workers_samples_total');
  nats = await start_nats(port);
  await until(async () => await metric('workers_samples_total') > before_it + 1000,
      'samples come again');
});

test('with a secret, who does not know it is neither heard nor obeyed', { skip }, async () => {
  const key = join(folder, 'key');
  writeFileSync(key, `${secret}\n`, { mode: 0o600 });
  await kill(workers.get('north'), 'SIGTERM');
  await begin_worker('sealed', { key: secret });
  await begin_worker('open');
  stop_walking?.();
  await visitor.close();
  assert.equal(await server.stop(), 0);
  server = await start_server(['--exhibit', 'first-room', '--no-bake', '--verify-workers',
    '--workers', `nats://127.0.0.1:${port}`, '--workers-key', key,
    '--cache', join(folder, 'server')]);
  visitor = new Visitor(server);
  await visitor.hello();
  stop_walking = begin_to_walk(visitor);
  await until(async () => await metric('worker_samples_total sealed') > 1000,
      'samples of who knows it');
  await sleep(1500);  // more than a call
  assert.equal(await state_of('open'), undefined);
  assert.equal(await metric('workers_differing_total'), 0);
});
