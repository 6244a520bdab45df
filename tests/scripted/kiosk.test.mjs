// SPDX-License-Identifier: Apache-2.0
// The kiosk end to end: camera program -> server -> storyteller -> page.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, readlinkSync, rmSync, writeFileSync }
  from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, beforeEach, test } from 'node:test';
import { Visitor, data, run, sleep, source, start_server, until } from '../server.mjs';

let server;
before(async () => { server = await start_server(); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

// Each test begins when guests of an earlier one are gone.
const is_empty = [/^wellspring_kiosk_cameras 0$/m, /^wellspring_audience\{state="absent"\} 1$/m];
beforeEach(async () => {
  await until(async () => {
    const metrics = await (await fetch(`${server.url}/metrics`)).text();
    return is_empty.every((line) => line.test(metrics));
  });
  await sleep(2200);  // a camera's last words count for two seconds
});

function start_kiosk(cameras, more = [], on = server) {
  const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
      [...[cameras].flat().flatMap((camera) => ['--camera', camera]), '--server', on.ws,
        '--print', ...more],
    { stdio: ['ignore', 'pipe', 'pipe'] });
  const observations = [];
  let rest = '';
  child.stdout.on('data', (chunk) => {
    const lines = (rest + chunk).split('\n');
    rest = lines.pop();
    for (const line of lines)
      if (line.startsWith('{')) observations.push(JSON.parse(line));  // else advice
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
  const seen = page.messages.filter((message) => message.type === 'kiosk').at(-1);
  assert.equal(seen.state, 'person');
  assert.equal(seen.distance, 1);
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

test('what is wrong with a camera is told in the metrics', async () => {
  const camera = await eye();
  camera.send({ ...nobody(1), camera_state: 'dark' });
  const told = async () => (await (await fetch(`${server.url}/metrics`)).text())
      .match(/^wellspring_kiosk_camera_seconds\{.*$/m)?.[0] ?? '';
  await until(async () => (await told()).includes('state="dark"'));
  camera.send(nobody(2));
  await until(async () => (await told()).includes('state="good"'));
  await until(async () => (await told()).includes('state="silent"'));
  await camera.close();
});

test('two cameras of one kiosk see one guest, and one of them may be missing', async () => {
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  // Both look at the same room: what one sees to its left the other sees to its right.
  const kiosk = start_kiosk(['synthetic', 'synthetic', '/dev/wellspring_no_such_camera'],
      ['--name', 'hall', ...['-0.3,0.1,0', '0.3,0.1,0', '0,0,0'].flatMap((offset) =>
        ['--mount-offset', offset]), '--width', '320', '--rate', '15']);
  const names = ['hall, synthetic', 'hall, synthetic 2'];
  const last = (name) => kiosk.observations.filter((one) => one.camera_name === name).at(-1);
  await until(() => names.every((name) => last(name)?.people.length === 1));
  const before = page.messages.length;
  await sleep(1000);
  const [left, right] = names.map((name) => last(name).people[0].position);
  assert.ok(Math.hypot(...left.map((value, i) => value - right[i])) < 0.4, `${left} and ${right}`);
  const told = page.messages.map((message) => message.type === 'kiosk' ? message.people : null);
  const people = (list) => list.filter((count) => count !== null);
  assert.deepEqual([people(told).at(-1), ...people(told.slice(before))].filter((n) => n !== 1), []);
  const metrics = await (await fetch(`${server.url}/metrics`)).text();
  const state = (name) => new RegExp('^wellspring_kiosk_camera_seconds'
      + `\\{kiosk="hall",camera="\\d+",name="${name}",state="(\\w+)"\\}`, 'm').exec(metrics)?.[1];
  assert.deepEqual([...names, 'hall, wellspring_no_such_camera'].map(state),
      ['good', 'good', 'missing']);
  await kiosk.stop();
  await page.close();
});

test('the calibration of a camera is shown, and its program ends with what is wrong', async () => {
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  const folder = mkdtempSync(join(tmpdir(), 'wellspring-kiosk-'));
  const kiosk = start_kiosk('synthetic', ['--config', join(folder, 'kiosk.json'), '--calibrate']);
  const near = await page.message('kiosk', (message) => message.calibration?.step === 'near');
  assert.equal(near.calibration.metres, 1);
  assert.equal(near.people, 0);
  await page.message('kiosk', (message) => message.calibration?.progress > 0.2);
  await kiosk.stop();
  await page.message('kiosk', (message) => !message.calibration);
  await page.close();
  rmSync(folder, { recursive: true });
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
      'greeting');
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

test('a kiosk\'s camera and screen find one another by name, and the eye hears what is needed',
    async (context) => {
  const hall = new Visitor(server), attic = new Visitor(server);
  await hall.hello({ role: 'kiosk', kiosk: 'hall' });
  await attic.hello({ role: 'kiosk', kiosk: 'attic' });
  const kiosk = start_kiosk('synthetic', ['--name', 'hall']);
  context.after(() => kiosk.stop());
  const last_of = (page) => page.messages.filter((message) => message.type === 'kiosk').at(-1);
  await until(() => kiosk.observations.at(-1)?.state === 'person'
      && last_of(hall)?.stage === 'person');
  assert.deepEqual([last_of(hall).kiosk, last_of(hall).cameras], ['hall', 1]);
  assert.equal(kiosk.observations.at(-1).kiosk, 'hall');
  const other = last_of(attic);
  assert.deepEqual([other.stage, other.cameras, other.people], ['sleep', 0, 0]);
  const camera = await eye(), needs = camera.message('kiosk');
  camera.send({ ...nobody(1), kiosk: 'attic' });
  assert.deepEqual(await needs, { type: 'kiosk', stage: 'sleep',
    needs: { faces: false, expression: false, gestures: false } });
  attic.send({ type: 'kiosk', showing: 'book', touched: true });
  await attic.next((item) => item.message?.stage === 'engaged', 'engaged');
  await until(async () => /^wellspring_kiosk_stage\{kiosk="attic",stage="engaged"\} 1$/m
      .test(await (await fetch(`${server.url}/metrics`)).text()));
  await Promise.all([camera.close(), hall.close(), attic.close()]);
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
  // Subtitles before he is seen are for somebody else, of whom the storyteller still takes leave.
  const says = (item) => item.message?.type === 'subtitle' && item.message.text;
  do await page.next(says, 'greeting');
  while (!kiosk.observations.some((one) => one.state === 'person'));
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

const weights = process.env.WELLSPRING_WEIGHTS ?? join(source, 'build', 'weights');
test('a visitor who smiles is smiled at',
    { skip: !existsSync(join(weights, 'face')) && 'no weights of the face\'s networks' },
    async (context) => {
  // A figure's neutral face, then its happy one, as a film: JPEGs in a row, 25 a second. The head
  // turns a little to and fro, as who never stirs is a picture on the wall.
  const folder = mkdtempSync(join(tmpdir(), 'smile-'));
  context.after(() => rmSync(folder, { recursive: true }));
  const draw = async (more, turn) => {
    const file = join(folder, 'picture.jpg');
    const drawn = await run('wellspring_avatar', [
      join(source, 'content/castle/figures/storyteller.x3d'), '--close', '--rest', '--spp', '4',
      '--size', '640x480', '--turn', `${turn}`, '--out', file, ...more]);
    assert.equal(drawn.status, 0, drawn.stderr);
    return readFileSync(file);
  };
  const take = async (frames, more) => {
    const ahead = await draw(more, 0), left = await draw(more, 3), right = await draw(more, -3);
    return Array.from({ length: frames },
        (_, k) => [ahead, left, ahead, right][Math.floor(k / 5) % 4]);
  };
  const film = join(folder, 'smile.mjpeg');
  writeFileSync(film, Buffer.concat([...await take(125, []),
    ...await take(375, ['--expression', 'joy'])]));
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk' });
  const joys = () => page.messages.filter((message) => message.type === 'agent')
      .map((message) => message.face.joy ?? 0);
  // Every picture is seen, however slow the machine; what was seen is then played at its own pace.
  const file = join(folder, 'seen.jsonl');
  const eye_run = await run('wellspring_kiosk', ['--camera', film, '--no-pace', '--print',
    '--expression', 'on', '--fov', '23', '--record', file]);
  assert.equal(eye_run.status, 0, eye_run.stderr);
  const joy_of = (one) => one.people[0]?.expression?.joy;
  const lines = readFileSync(file, 'utf8').trim().split('\n');
  const seen = lines.map((line) => joy_of(JSON.parse(line)));
  assert.ok(seen.filter((joy) => joy < 0.1).length > 20,
      `at first the face is calm: ${seen.slice(0, 150).join(' ')}`);
  assert.ok(seen.filter((joy) => joy > 0.4).length > 20, 'then joy is seen');
  const kiosk = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
      ['--replay', file, '--server', server.ws], { stdio: 'ignore' });
  context.after(() => kiosk.kill());
  const before = joys().length;
  await until(() => joys().slice(before).some((joy) => joy > 0.15), 'joy in the answering face');
  await page.close();
});

// Children of a process and its threads, by the kernel's own list.
function children(pid) {
  return readdirSync(`/proc/${pid}/task`).flatMap((task) =>
    readFileSync(`/proc/${pid}/task/${task}/children`, 'utf8').split(' ').filter(Boolean))
      .map(Number);
}

test('the process that sees pictures has no network, and is begun again when it dies',
    async (context) => {
  const kiosk = start_kiosk('synthetic');
  context.after(() => kiosk.stop());
  await until(() => kiosk.observations.length > 3, 'observations');
  const [eye_pid] = children(kiosk.child.pid);
  const status = readFileSync(`/proc/${eye_pid}/status`, 'utf8');
  assert.match(status, /^Seccomp:\t2$/m, 'it is in a sandbox');
  let files = [];
  try {
    // But for what whoever started us reads.
    files = readdirSync(`/proc/${eye_pid}/fd`).filter((fd) => fd > 2)
        .map((fd) => readlinkSync(`/proc/${eye_pid}/fd/${fd}`));
  } catch (error) {
    assert.equal(error.code, 'EACCES');  // as it cannot be looked into, but by root
  }
  assert.deepEqual(files.filter((name) => name.startsWith('socket:')), []);
  const before = kiosk.observations.length;
  process.kill(eye_pid, 'SIGKILL');
  await until(() => kiosk.observations.length > before + 10, 'observations after it died');
  assert.notEqual(children(kiosk.child.pid)[0], eye_pid);
  const [second] = children(kiosk.child.pid);
  assert.equal(await kiosk.stop(), 0);
  await until(() => !existsSync(`/proc/${second}`), 'the end of both');
});

test('what was recorded is played again', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'kiosk-')), file = join(folder, 'seen.jsonl');
  const run = (args) => {
    const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'), args);
    let out = '', problem = '';
    child.stdout.on('data', (chunk) => { out += chunk; });
    child.stderr.on('data', (chunk) => { problem += chunk; });
    return new Promise((resolve) => child.on('close', (code) => resolve({ code, out, problem })));
  };
  const first = await run(['--camera', 'synthetic', '--no-pace', '--print', '--rate', '5',
    '--record', file]);
  assert.equal(first.code, 0);
  assert.ok(first.out.split('\n').length > 20);
  assert.equal(readFileSync(file, 'utf8'), first.out);
  const again = await run(['--replay', file, '--no-pace', '--print']);
  assert.deepEqual([again.code, again.out], [0, first.out]);
  writeFileSync(file, '{"type":"observation"}\n');
  const bad = await run(['--replay', file, '--no-pace', '--print']);
  assert.equal(bad.code, 1);
  assert.match(bad.problem, /seen\.jsonl: line 1: /);
  const config = join(folder, 'kiosk.json');
  writeFileSync(config, '{"presence": {"hold": 3}}');
  const wrong = await run(['--camera', 'synthetic', '--config', config]);
  assert.equal(wrong.code, 2);
  assert.match(wrong.problem, /kiosk\.json: line 1, \/presence\/hold: is unknown/);
  rmSync(folder, { recursive: true });
});

test('while the house is closed an eye looks now and then', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'wellspring-')), house = join(folder, 'house.json');
  writeFileSync(house, JSON.stringify({ hours: {} }));
  const closed = await start_server(['--house', house]);
  const kiosk = start_kiosk('synthetic-live', ['--loop'], closed);
  const idles = () => {
    const last = kiosk.observations.slice(-6);
    return last.length === 6
        && last.slice(1).every(({ time }, i) => Math.abs(time - last[i].time) >= 0.49);
  };
  await until(idles);
  kiosk.stop();
  await kiosk.ended;
  await closed.stop();
  rmSync(folder, { recursive: true });
});
