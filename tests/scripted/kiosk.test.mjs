// SPDX-License-Identifier: Apache-2.0
// The kiosk end to end: camera program -> server -> storyteller -> page.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, data, sleep, start_server } from '../server.mjs';

let server;
before(async () => { server = await start_server(); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

function start_kiosk(camera, more = []) {
  const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
      ['--camera', camera, '--server', server.ws, '--print', ...more],
    { stdio: ['ignore', 'pipe', 'pipe'] });
  const observations = [];
  let rest = '';
  child.stdout.on('data', (chunk) => {
    const lines = (rest + chunk).split('\n');
    rest = lines.pop();
    for (const line of lines) observations.push(JSON.parse(line));
  });
  child.stderr.resume();
  const ended = new Promise((resolve) => child.on('close', resolve));
  return { child, observations, ended, stop: () => { child.kill('SIGTERM'); return ended; } };
}

async function eye() {
  const visitor = new Visitor(server, { path: '/api/v1/eye', protocol: [] });
  await visitor.opened;
  return visitor;
}
const person = (time, x = 0, y = 0, z = 1, id = 1) => ({
  type: 'observation', time, presence: true, state: 'person',
  people: [{ id, position: [x, y, z], rotation: [0, 0, 0], confidence: 0.9 }] });
const nobody = (time) =>
    ({ type: 'observation', time, presence: false, state: 'absent', people: [] });

test('a scripted person is soon greeted, looked at, and seen off', async () => {
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  const camera = await eye();
  let time = 0, x = -0.3, timer = setInterval(() => camera.send(person(time += 0.05, x)), 50);
  const appeared = performance.now();
  const subtitle = await page.message('subtitle', (message) => message.text.length > 0);
  assert.ok(performance.now() - appeared < 3000,
      `greeted after ${performance.now() - appeared} ms`);
  assert.equal(subtitle.lang, 'en');
  assert.equal(page.messages.filter((message) => message.type === 'kiosk').at(-1).state, 'person');
  await sleep(1500);
  const left = (await page.message('agent')).gaze[0];
  x = 0.3;
  await sleep(1500);
  const right = (await page.message('agent')).gaze[0];
  // Screen right is the storyteller's own left: its yaw grows.
  assert.ok(right - left > 0.15, `gaze went from ${left} to ${right}`);
  clearInterval(timer);
  const farewell = page.message('agent', (message) => message.mood === 'farewell');
  const goodbye = page.message('subtitle',
      (message) => message.text.length > 0 && message.text !== subtitle.text);
  timer = setInterval(() => camera.send(nobody(time += 0.05)), 50);
  await Promise.all([farewell, goodbye]);
  clearInterval(timer);
  await camera.close();
  await page.close();
});

test('bad observations are answered, and the connection lives on', async () => {
  const camera = await eye();
  for (const text of ['{', '{"type":"observation"}',
      '{"type":"observation","time":1,"presence":true,"state":"ghost","people":[]}',
      '['.repeat(40000)]) {
    const error = camera.message('error');
    camera.send(text);
    assert.ok((await error).message);
  }
  camera.send(nobody(1));
  await sleep(200);
  assert.equal(camera.socket.readyState, 1);
  await camera.close();
});

test('the synthetic camera brings a person, and the kiosk program survives a server that goes away',
    async () => {
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  const kiosk = start_kiosk('synthetic');
  const greeting = await page.next((item) => item.message?.type === 'subtitle' && item.message.text,
      'greeting', 40000);
  assert.ok(greeting.message.text.length > 0);
  const seen = kiosk.observations.find((one) => one.state === 'person');
  assert.ok(seen && seen.people.length === 1 && seen.people[0].position[2] > 0.2);
  await page.close();
  const { port } = server;
  await server.stop();
  await sleep(700);
  server = await start_server([], { port });
  const again = new Visitor(server);
  await again.hello({ role: 'kiosk' });
  await again.next((item) => item.message?.type === 'kiosk' && item.message.cameras === 1,
      'kiosk back', 20000);
  await again.close();
  await kiosk.stop();
});

const video = join(data, '5_faces', 'headtrackr', 'capture4.mp4');
test('a filmed man: the storyteller\'s gaze follows his head',
    { skip: !existsSync(video) && 'no real videos beside this checkout' }, async (context) => {
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  const kiosk = start_kiosk(video);
  const pairs = [];
  const timer = setInterval(() => {
    const last = kiosk.observations.at(-1),
        agent = page.messages.filter((message) => message.type === 'agent').at(-1);
    if (last?.state === 'person' && agent?.guest)
      pairs.push([last.people[0].position[0], agent.gaze[0]]);
  }, 100);
  context.after(() => clearInterval(timer));  // a failed test ends, too
  context.after(() => kiosk.stop());
  const greeting = await page.next((item) => item.message?.type === 'subtitle' && item.message.text,
      'greeting', 40000);
  assert.ok(greeting);
  // How soon is the pace of the machine, and whether she still takes leave of somebody else.
  assert.ok(kiosk.observations.some((one) => one.state === 'person'), 'greeted nobody');
  await Promise.race([kiosk.ended, sleep(30000)]);
  assert.ok(pairs.length > 20, `${pairs.length} pairs of head and gaze`);
  // Correlation of head place and gaze, the gaze trailing by up to half a second.
  const correlation = (lag) => {
    const a = pairs.slice(0, pairs.length - lag).map((pair) => pair[0]),
        b = pairs.slice(lag).map((pair) => pair[1]);
    const mean = (v) => v.reduce((s, x) => s + x, 0) / v.length, ma = mean(a), mb = mean(b);
    const cov = a.reduce((s, x, i) => s + (x - ma) * (b[i] - mb), 0);
    return cov / Math.sqrt(a.reduce((s, x) => s + (x - ma) ** 2, 0)
        * b.reduce((s, x) => s + (x - mb) ** 2, 0));
  };
  const best = Math.max(...[0, 1, 2, 3, 4, 5].map(correlation));
  assert.ok(best > 0.6, `correlation of head and gaze is ${best}`);
  await page.close();
});
