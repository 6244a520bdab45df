// SPDX-License-Identifier: Apache-2.0
// A museum that outgrew one machine (docs/deploy.md): three servers behind HAProxy, NATS and two
// workers, each on a machine of its own, started by the units and configurations of deploy/. Visits
// outlive a server that is killed and an upgrade of all of them, pictures outlive NATS.
// WELLSPRING_NODES_VISITORS: how many there are (6). WELLSPRING_NODES_EXHIBIT: what they visit, in
// all of its light (a pyramid in little).
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { appendFileSync, cpSync, existsSync, mkdirSync, readFileSync, rmSync, symlinkSync,
  writeFileSync } from 'node:fs';
import net from 'node:net';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { load_module, run, source, until } from '../server.mjs';
import { Machine, add_address, enter_own_namespaces, here, make_net, network, read_unit }
  from './machines.mjs';
import { start_name_server } from './name_server.mjs';
import { write_pyramid } from './pyramid.mjs';
import { ReturningPage, all_come_back } from './returning_page.mjs';

const { folder, skip: no_namespaces } = await enter_own_namespaces(
    fileURLToPath(import.meta.url));
const absent = ['haproxy', 'nats-server'].find((name) => spawnSync(name, ['-v'],
    { env: { PATH: `${process.env.PATH}:/usr/sbin` } }).error);
const skip = no_namespaces ?? (absent ? `${absent} is not installed` : false);

const count = Number(process.env.WELLSPRING_NODES_VISITORS ?? 6);
const exhibit = process.env.WELLSPRING_NODES_EXHIBIT ?? '';
const deploy = (name) => join(source, 'deploy', name);
const names = ['node1', 'node2', 'node3'], workers = ['worker1', 'worker2'];
const front = { url: `http://${network(9)}/`, ws: `ws://${network(9)}` };
const machines = new Map();
const pages = [];
let walker, walks, admin, name_server, centre;

// A unit of Debian's, where it is installed, with ours over it.
function unit(name) {
  if (name.startsWith('wellspring')) return read_unit(deploy(`systemd/${name}.service.in`));
  const own = ['/usr/lib', '/lib'].map((place) => `${place}/systemd/system/${name}.service`)
      .filter(existsSync).slice(0, 1);
  return read_unit(...own, deploy(`systemd/${name}.service.d/wellspring.conf`));
}
const start_server = (name) => machines.get(name).start('server', unit('wellspring-server'));
const start_nats = () => machines.get('nats').start('nats', unit('nats-server'));

const healthy = (name) => fetch(`http://${machines.get(name).address}:8080/healthz`)
    .then(({ status }) => status === 200, () => false);

// All that a socket says until it ends.
function read_socket(place, words = '') {
  return new Promise((resolve, reject) => {
    const socket = net.connect(place, () => socket.write(words));
    let said = '';
    socket.on('data', (chunk) => { said += chunk; });
    socket.on('end', () => resolve(said));
    socket.on('error', reject);
  });
}

// What HAProxy thinks of its servers: {name: {column: text}}.
async function thoughts(asked = 'haproxy.sock') {
  const [head, ...rows] = (await read_socket({ path: join(folder, asked) }, 'show stat\n'))
      .split('\n').map((row) => row.split(','));
  return Object.fromEntries(rows.filter((row) => row[0] === 'nodes').map((row) =>
    [row[1], Object.fromEntries(head.map((column, i) => [column, row[i]]))]));
}
const thought = async (name, column) => (await thoughts())[name][column];
const served = (name) => until(async () => await healthy(name)
    && (await thought(name, 'status')).startsWith('UP'), () => machines.get(name).said('server'));

// /metrics of a server, as Prometheus reads it: {series: value}.
async function metrics(name) {
  const answer = await fetch(`http://${machines.get(name).address}:8080/metrics`,
      { headers: { authorization: `Bearer ${admin}` } });
  assert.equal(answer.status, 200);
  return new Map((await answer.text()).split('\n').filter((line) => /^\w/.test(line))
      .map((line) => [line.slice(0, line.lastIndexOf(' ')), Number(line.split(' ').at(-1))]));
}

function make_machines() {
  const last = { nats: 5, proxy: 9, node1: 1, node2: 2, node3: 3, worker1: 11, worker2: 12 };
  make_net(folder,
      Object.fromEntries(Object.entries(last).map(([name, at]) => [name, network(at)])));
  for (const [name, at] of Object.entries(last)) machines.set(name, new Machine(folder, name, at));
  const made = spawnSync('sh', [deploy('secrets.sh'), join(folder, 'secrets')],
      { encoding: 'utf8' });
  assert.equal(made.status, 0, made.stderr);
  // This test judges no picture: the cores are for as many visitors as it asks for.
  const little_light = exhibit ? [] : ['technique = direct', 'still-technique = direct'];
  const house = [...little_light, 'bake = false', 'fps = 10', 'least-fps = 0.01',
    `max-visitors = ${count + 5}`];
  for (const [name, machine] of machines) {
    const etc = join(machine.root, 'etc/wellspring');
    for (const file of ['secrets.env', 'seal.key'])
      cpSync(join(folder, 'secrets', file), join(etc, file));
    symlinkSync(join(folder, 'content'), join(machine.root, 'var/lib/wellspring/exhibits'));
    if (names.includes(name)) machine.configure('server.conf', deploy('server.conf'), house);
    if (workers.includes(name))
      machine.configure('worker.conf', deploy('worker.conf'), ['cores = 1', ...little_light]);
  }
  admin = /ADMIN_TOKEN=(\w+)/.exec(readFileSync(join(folder, 'secrets/secrets.env'), 'utf8'))[1];
  const nats = machines.get('nats');
  nats.configure('nats.conf', deploy('nats.conf'));
  appendFileSync(join(nats.root, 'etc/wellspring/secrets.env'),
      `NATS_LISTEN=${nats.address}:4222\nNATS_STORE=${join(nats.root, 'var/lib/nats')}\n`);
}

// HAProxy with the words of haproxy.env; `asked`: where this test asks it what it thinks.
function start_proxy(words, asked) {
  const machine = machines.get('proxy');
  rmSync(join(folder, asked), { force: true });
  machine.configure('haproxy-nodes.cfg', deploy('haproxy-nodes.cfg'),
      ['global', `  stats socket ${join(folder, asked)} level operator`]);
  writeFileSync(join(machine.root, 'etc/wellspring/haproxy.env'),
      Object.entries(words).map(([key, value]) => `${key}=${value}\n`).join(''));
  machine.start(asked, unit('haproxy'));
  return until(() => existsSync(join(folder, asked)), () => machine.said(asked));
}

before(async () => {
  if (skip) return;
  const content = join(folder, 'content'), shown = join(content, exhibit || 'giza');
  mkdirSync(content);
  if (exhibit) symlinkSync(join(source, 'content', exhibit), shown);
  else await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  centre = JSON.parse(readFileSync(join(shown, 'exhibit.json'), 'utf8')).viewpoints[0].position;
  make_machines();
  start_nats();
  names.forEach(start_server);
  for (const name of workers) machines.get(name).start('worker', unit('wellspring-worker'));
  await start_proxy({ MUSEUM: ':80', ...Object.fromEntries(names.map((name) =>
    [name.toUpperCase(), `${machines.get(name).address}:8080`])) }, 'haproxy.sock');
  for (const name of names) await served(name);
});
after(async () => {
  clearInterval(walks);
  name_server?.close();
  await Promise.all([walker, ...pages].map((page) => page?.leave()));
  for (const machine of machines.values())
    for (const name of machine.processes.keys()) await machine.stop(name, 'SIGKILL');
});

const on = (name) => pages.filter((page) => page.cookie === name);
const lines_of = (some) => some.map((page) => page.lines);
const seconds = (ms) => `${(ms / 1000).toFixed(1)} s`;
const tell = (context, came, since) => context.diagnostic(`${came.length} visits have a picture ` +
    `of the same pose again after ${seconds(came[came.length >> 1] - since)} (median), ` +
    `${seconds(came.at(-1) - since)} (all)`);

// What a server says itself, in percent.
async function weight_of(name) {
  const line = await read_socket({ host: machines.get(name).address, port: 8090 });
  return /^(\d+)%\n$/.exec(line)[1];
}

test('each server weighs what it says that it serves', { skip }, async () => {
  for (const name of names)
    await until(async () => await weight_of(name) === await thought(name, 'weight'),
        'HAProxy hears it');
});

const beside = (x, z) => [centre[0] + x, centre[1], centre[2] + z];

test('visitors are spread, and each stays with one server', { skip }, async () => {
  for (let k = 0; k < count; k++) {
    const way = 2 * Math.PI * k / count, address = `10.97.1.${k + 1}`;
    add_address(address);
    const position = beside(0.5 * Math.sin(way), 0.5 * Math.cos(way));
    pages.push(new ReturningPage(front, { position, yaw: way - 3, pitch: -0.1 }, address));
    await pages.at(-1).enter();
  }
  for (const name of names) assert.ok(on(name).length > 0, `nobody is on ${name}`);
  assert.ok(pages.every((page) => page.cookie === page.first_node && page.lines === 1));
});

// Somebody looks around all the time, so that there is something to trace and to show.
async function begin_to_walk() {
  walker = new ReturningPage(front, { position: beside(0, 0.3), yaw: 0, pitch: 0 }, here);
  await walker.enter();
  let seq = 1;
  walks = setInterval(() => {
    seq++;
    walker.line.send({ type: 'input', seq, move: [0, 0, 0], look: [seq % 2 ? 0.1 : -0.1, 0] });
  }, 250);
}
const pictures_go_on = async () => { for (let k = 0; k < 3; k++) await walker.line.picture(); };

test('samples come from both workers, and Prometheus is told', { skip }, async () => {
  await begin_to_walk();
  const some = (all, name) => [...all]
      .filter(([series]) => series.startsWith(`wellspring_${name}{`));
  await until(async () => {
    const busy = some(await metrics(walker.cookie), 'worker_samples_total')
        .filter(([, samples]) => samples > 100);
    return busy.length === workers.length;
  }, () => workers.map((name) => machines.get(name).said('worker')).join(''));
  const all = await metrics(walker.cookie);
  assert.equal(all.get('wellspring_workers_connected'), 1);
  assert.equal(some(all, 'worker_requests_in_flight').length, workers.length);
});

test('a server is killed: its visits go on with others', { skip }, async (context) => {
  const killed = names.find((name) => name !== walker.cookie && on(name).length > 0);
  const lost = on(killed), lines = lines_of(lost);
  const others = pages.filter((page) => !lost.includes(page));
  const since = performance.now();
  const ended = machines.get(killed).stop('server', 'SIGKILL');
  tell(context, await all_come_back(lost, lines), since);
  assert.equal(await ended, 'SIGKILL');
  assert.equal(on(killed).length, 0);
  assert.ok(others.every((page) => page.closes.length === 0), 'nobody else notices');
  // As its unit has it: Restart=always.
  assert.deepEqual(unit('wellspring-server').Restart, ['always']);
  start_server(killed);
  await served(killed);
});

test('a server falls off the net: its visits go on with others', { skip }, async (context) => {
  const gone = names.find((name) => name !== walker.cookie && on(name).length > 0);
  const lost = on(gone), lines = lines_of(lost), since = performance.now();
  machines.get(gone).plug(false);
  tell(context, await all_come_back(lost, lines), since);
  machines.get(gone).plug(true);
  await served(gone);
});

test('NATS is killed: pictures go on, and workers come back with it', { skip }, async () => {
  await machines.get('nats').stop('nats', 'SIGKILL');
  const connected = async () => (await metrics(walker.cookie)).get('wellspring_workers_connected');
  await until(async () => await connected() === 0, 'the loss is noticed');
  await pictures_go_on();
  assert.ok(pages.every((page) => !page.closed_at), 'no visit is broken off');
  start_nats();
  const samples = async () =>
    (await metrics(walker.cookie)).get('wellspring_workers_samples_total');
  const before_it = await samples();
  await until(async () => await samples() > before_it, 'samples come again');
});

test('one server after the other is upgraded: no visit is lost', { skip }, async (context) => {
  const since = performance.now();
  for (const page of pages) page.gaps = [];
  for (const name of names) {
    const lost = on(name), lines = lines_of(lost);
    const others = pages.filter((page) => !lost.includes(page)), before_it = lines_of(others);
    const ended = machines.get(name).stop('server');
    if (lost.length > 0) {
      await until(async () => !await healthy(name), 'it says that it drains');
      assert.ok(lost.every((page) => !page.closed_at), 'meanwhile its visitors stay');
    }
    await all_come_back(lost, lines);
    assert.equal(await ended, 0, machines.get(name).said('server'));
    assert.ok(lost.every((page) => page.closes.at(-1) === 1001), 'they are told');
    assert.deepEqual(lines_of(others), before_it, 'nobody else notices');
    start_server(name);
    await served(name);
  }
  await pictures_go_on();
  const gaps = pages.flatMap((page) => page.gaps).sort((a, b) => a - b);
  context.diagnostic(`three servers upgraded in ${seconds(performance.now() - since)}; ` +
      `${gaps.length} times a visit moved, without a picture for ` +
      `${gaps[gaps.length >> 1].toFixed(1)} s (median), ${gaps.at(-1).toFixed(1)} s (longest)`);
});

test('where DNS names the servers, they come and go by it', { skip }, async () => {
  // HAProxy's environment is that of its pod in Kubernetes.
  const [container] = load_module('yaml').parseAllDocuments(
      readFileSync(deploy('kubernetes/proxy.yaml'), 'utf8')).map((one) => one.toJS())
      .find(({ kind }) => kind === 'Deployment').spec.template.spec.containers;
  const words = Object.fromEntries(container.env.filter(({ value }) => value)
      .map(({ name, value }) => [name, value.replace('$(NAMESPACE)', 'museum')]));
  const address = (name) => machines.get(name).address;
  const there = new Set(names.slice(0, 2).map(address));
  name_server = await start_name_server(here, { [words.NODES.split(':')[0]]: there });
  await start_proxy(words, 'dns.sock');
  const up = async (...wanted) => {
    const found = Object.values(await thoughts('dns.sock'))
        .filter((one) => one.status.startsWith('UP') && one.addr).map(({ addr }) => addr);
    return wanted.every((name) => found.includes(`${address(name)}:8080`))
        && found.length === wanted.length;
  };
  const say = () => machines.get('proxy').said('dns.sock');
  await until(() => up('node1', 'node2'), say);
  const place = `${network(9)}${words.MUSEUM}`, own = [];
  for (let k = 0; k < 4; k++) {
    const page = new ReturningPage({ url: `http://${place}/`, ws: `ws://${place}` },
        { position: beside(0, 0.2 * k), yaw: 0.1 * k, pitch: 0 }, here);
    pages.push(page);
    own.push(page);
    await page.enter();
  }
  const cookies = new Set(own.map(({ cookie }) => cookie));
  assert.equal(cookies.size, 2, 'a cookie for each server');
  // As a rollout goes: a new server is named; an old one drains, ends, and is named no more.
  there.add(address('node3'));
  await until(() => up('node1', 'node2', 'node3'), say);
  const node1 = async () => Object.values(await thoughts('dns.sock'))
      .find(({ addr }) => addr === `${address('node1')}:8080`);
  await until(async () => (await node1()).weight === await weight_of('node1'), say);
  const { cookie } = await node1();
  const lost = own.filter((page) => page.cookie === cookie), lines = lines_of(lost);
  assert.ok(lost.length > 0 && lost.length < own.length);
  assert.equal(await machines.get('node1').stop('server'), 0);
  there.delete(address('node1'));
  await all_come_back(lost, lines);
  await until(() => up('node2', 'node3'), say);
  for (const page of own) assert.equal(page.closes.length, lost.includes(page) ? 1 : 0);
});
