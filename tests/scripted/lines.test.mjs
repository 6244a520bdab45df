// SPDX-License-Identifier: Apache-2.0
// Workers behind bad lines: far away, stalled, slow, asleep, dead, of another time, without room on
// their disk; messages that come twice and in another order. Whatever happens to one of them,
// pictures go on, the others go on, and each request is counted once: it became a sample, was lost,
// refused, or is on the way.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync }
  from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, start_server, until } from '../server.mjs';
import { begin_to_walk, content, free_port, kill, read_numbers, skip, start_nats, start_worker,
  worker_state } from './crew.mjs';
import { ShapingProxy } from './shaping_proxy.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const cache = join(folder, 'worker');
const workers = new Map();
const walks = [];
let port, far_port, nats, proxy, server, visitor;

async function begin_worker(name, options = {}) {
  workers.set(name, await start_worker(name, port, { cache, ...options }));
  return workers.get(name);
}
const end_worker = (name, signal) => kill(workers.get(name).child, signal);
const begin_server = (words = [], options = {}) => start_server(['--exhibit', 'first-room',
  '--no-bake', '--verify-workers', '--workers', `nats://127.0.0.1:${port}`, ...words], options);
async function begin_visit(at) {
  const one = new Visitor(at);
  await one.hello();
  walks.push(begin_to_walk(one));
  return one;
}

const samples_of = async (name, at = server) =>
    (await read_numbers(at))[`worker_samples_total ${name}`] ?? 0;
async function samples_come(name, count = 1000, at = server) {
  const before_it = await samples_of(name, at);
  await until(async () => await samples_of(name, at) >= before_it + count, `samples of ${name}`);
}
const problem_of = async (name, at = server) => (await worker_state(at, name))?.problem;

// Checks that no request is counted twice or forgotten.
async function is_balanced(at = server) {
  const numbers = await read_numbers(at);
  let known = numbers.workers_samples_total + numbers.workers_lost_total;
  for (const [name, value] of Object.entries(numbers))
    if (/^workers_refused_total |^worker_requests_in_flight /.test(name)) known += value;
  assert.equal(known, numbers.workers_requests_total);
  assert.equal(numbers.workers_differing_total, 0);
  assert.ok(numbers.workers_verified_total > 0);
}

// Checks what holds whatever happens to others: pictures and the worker `near` go on.
async function all_goes_on(at = server, guest = visitor) {
  for (let k = 0; k < 5; k++) await guest.picture();
  await samples_come('near', 1000, at);
  assert.equal(await problem_of('near', at), '');
  await is_balanced(at);
}

before(async () => {
  if (skip) return;
  port = await free_port();
  nats = await start_nats(port);
  proxy = new ShapingProxy(port);
  far_port = await proxy.opened;
  server = await begin_server(['--cache', join(folder, 'server')]);
  await begin_worker('near');
  workers.set('far', await start_worker('far', far_port, { cache }));
  visitor = await begin_visit(server);
  await Promise.all([samples_come('near'), samples_come('far')]);
});
after(async () => {
  for (const stop of walks) stop();
  for (const { child } of workers.values()) child.kill('SIGCONT');
  await Promise.all([...workers.values()].map(({ child }) => kill(child)));
  if (server) assert.equal(await server.stop(), 0);
  proxy?.close();
  if (nats) await kill(nats);
  rmSync(folder, { recursive: true, force: true });
});

test('a worker 200 ms away is still of use', { skip }, async () => {
  proxy.delay = 200;
  await until(async () => (await read_numbers(server))['worker_line_milliseconds far'] > 300,
      'the line is measured');
  await samples_come('far');
  await all_goes_on();
  proxy.delay = 0;
});

test('a stalled line loses what is on it, and nothing else', { skip }, async () => {
  proxy.stalled = true;
  await until(() => problem_of('far'), 'far is noticed');
  await until(async () => (await read_numbers(server))['worker_requests_in_flight far'] === 0,
      'its orders are forgotten');
  const stalled_at = await samples_of('far');
  await all_goes_on();
  assert.equal(await samples_of('far'), stalled_at);
  proxy.stalled = false;
  await samples_come('far');
  assert.equal(await problem_of('far'), '');
  await is_balanced();
});

test('a line that lets little through holds up nobody', { skip }, async () => {
  proxy.rate = 20e3;
  const { 'worker_lost_total far': lost } = await read_numbers(server);
  await until(async () => (await read_numbers(server))['worker_lost_total far'] > lost,
      'some are lost');
  await all_goes_on();
  proxy.rate = Infinity;
  proxy.cut();  // what waits there would take minutes
  await samples_come('far');
  await is_balanced();
});

test('a line that is cut comes back by itself', { skip }, async () => {
  proxy.refuses = true;
  proxy.cut();
  await until(() => problem_of('far'), 'far is noticed');
  await all_goes_on();
  proxy.refuses = false;
  await samples_come('far');
  await is_balanced();
});

test('messages that come twice, and the newest first, count once', { skip }, async () => {
  const before_it = await read_numbers(server);
  const { messages, overtaking } = proxy;
  proxy.copies = 2, proxy.shuffled = true;
  await samples_come('far', 5000);
  await until(() => proxy.overtaking > overtaking + 5 && proxy.messages > messages + 40,
      'messages overtake others');
  await until(async () =>
      (await read_numbers(server)).workers_late_total > before_it.workers_late_total,
  'second answers are dropped');
  await all_goes_on();
  proxy.copies = 1, proxy.shuffled = false;
  const now = await read_numbers(server);
  assert.equal(now.workers_spoiled_total, before_it.workers_spoiled_total);
  await samples_come('far');
  await is_balanced();
});

test('a worker that is stopped is missed, and welcome again', { skip }, async () => {
  workers.get('far').child.kill('SIGSTOP');
  await until(() => problem_of('far'), 'far is noticed');
  await all_goes_on();
  workers.get('far').child.kill('SIGCONT');
  await samples_come('far');
  assert.equal(await problem_of('far'), '');
  await is_balanced();
});

test('a worker that dies is replaced by one of its name', { skip }, async () => {
  await end_worker('far', 'SIGKILL');
  await until(() => problem_of('far'), 'far is noticed');
  await all_goes_on();
  workers.set('far', await start_worker('far', far_port, { cache }));
  await samples_come('far');
  await is_balanced();
});

test('clocks may differ by an hour', { skip }, async (t) => {
  const library = ['x86_64', 'aarch64'].map((kind) =>
      `/usr/lib/${kind}-linux-gnu/faketime/libfaketimeMT.so.1`).find((file) => existsSync(file));
  if (!library) return t.skip('libfaketime is not installed');
  // The library shifts the clock of the day, and a name space the one that counts from the start of
  // the machine, by which programs wait; root may make such a space.
  const shift = ['unshare', '-T', '--monotonic', '3600', '--boottime', '3600'];
  const may = spawnSync(shift[0], [...shift.slice(1), 'true']).status === 0;
  await begin_worker('ahead', { prefix: may ? shift : [],
    environment: { LD_PRELOAD: library, FAKETIME: '+3600', DONT_FAKE_MONOTONIC: '1' } });
  await samples_come('ahead');
  await all_goes_on();
  assert.equal(await problem_of('ahead'), '');
  assert.equal(await end_worker('ahead', 'SIGTERM'), 0);
  const { log } = workers.get('ahead');
  const said = new Date(/(\S+) \S* *\S+ \d+ samples traced/.exec(log())[1]);
  const ahead = (said - Date.now()) / 1000;
  assert.ok(ahead > 3000, `its clock is ${ahead} s ahead`);
});

test('a worker whose disk is full says so, and is missed', { skip }, async (t) => {
  const exhibits = join(folder, 'dark'), full = join(folder, 'full');
  cpSync(join(content, 'first-room'), join(exhibits, 'first-room'), { recursive: true });
  rmSync(join(exhibits, 'first-room', 'light.maps'));
  mkdirSync(full);
  const own = process.getuid() === 0 ? ['unshare', '-m'] : ['unshare', '-rm'];
  const mounts = [...own, 'sh', '-c', `mount -t tmpfs -o size=16k none ${full} && exec "$@"`, 'sh'];
  if (spawnSync(mounts[0], [...mounts.slice(1), 'true']).status !== 0)
    return t.skip('no file system may be mounted here');
  const { log } = await begin_worker('full', { exhibits, cache: full, prefix: mounts });
  await until(async () => (await problem_of('full'))?.includes('disk'), 'refuses: disk');
  assert.match(log(), /first-room[^\n]* do not fit on the disk/);
  await all_goes_on();
  assert.equal(await samples_of('full'), 0);
  await end_worker('full', 'SIGTERM');
});

test('two servers share workers, which fetch a new package and hold both', { skip }, async () => {
  const exhibits = join(folder, 'content'), scene = join(exhibits, 'first-room', 'scene.glb');
  cpSync(join(content, 'first-room'), join(exhibits, 'first-room'), { recursive: true });
  const other = (words = []) => begin_server(['--cache', join(folder, 'second'), ...words],
      { content: exhibits });
  let second = await other(), guest = await begin_visit(second);
  await begin_worker('keeper', { exhibits });
  const all = [[server, 'near'], [server, 'far'], [second, 'near'], [second, 'far'],
    [second, 'keeper']];
  await Promise.all(all.map(([at, name]) => samples_come(name, 1000, at)));
  for (const at of [server, second]) {
    const numbers = await read_numbers(at);
    // No worker has more of one server than it can trace in the time that samples are worth.
    for (const name of ['near', 'far', 'keeper']) {
      const rate = Math.max(numbers[`worker_samples_per_second ${name}`], 1000);
      assert.ok(numbers[`worker_requests_in_flight ${name}`] < 4 * rate + 4096);
    }
  }
  await all_goes_on(server, visitor);
  await all_goes_on(second, guest);
  await guest.close();
  assert.equal(await second.stop(), 0);

  const bytes = readFileSync(scene), place = bytes.indexOf('"roughnessFactor":0.');
  assert.ok(place > 0);
  bytes[place + '"roughnessFactor":0.'.length] ^= 1;
  writeFileSync(scene, bytes);
  second = await other(), guest = await begin_visit(second);
  await Promise.all(['near', 'far', 'keeper'].map((name) => samples_come(name, 1000, second)));
  assert.ok((await read_numbers(second))['workers_refused_total scene'] > 0);
  await Promise.all(['near', 'far'].map((name) => samples_come(name)));  // they hold both
  await is_balanced(second);
  await all_goes_on(server, visitor);
  await guest.close();
  assert.equal(await second.stop(), 0);
});
