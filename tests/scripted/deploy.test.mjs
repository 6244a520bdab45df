// SPDX-License-Identifier: Apache-2.0
// What a kiosk is started with: whatever dies of it comes back, and all of it ends.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, symlinkSync,
  writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { sleep, source } from '../server.mjs';

const patience = 120000;  // milliseconds; only who fails waits so long
const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const started = [];
after(() => {
  for (const { pid } of started) try { process.kill(-pid, 'SIGKILL'); } catch { /* has ended */ }
  rmSync(folder, { recursive: true, force: true });
});
const program = (name, text) => {
  writeFileSync(join(folder, name), `#!/bin/sh\n${text}\n`, { mode: 0o755 });
  return join(folder, name);
};

function free_port() {
  return new Promise((resolve) => {
    const socket = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = socket.address();
      socket.close(() => resolve(port));
    });
  });
}

async function until(holds, what) {
  for (const end = Date.now() + patience; Date.now() < end; await sleep(50)) {
    const found = await holds();
    if (found) return found;
  }
  assert.fail(`never: ${what()}`);
}

// kiosk.sh in a process group of its own: {child, said(), ended}.
function start(environment) {
  const child = spawn(join(source, 'deploy', 'kiosk.sh'), [], { detached: true,
    stdio: ['ignore', 'pipe', 'pipe'],
    env: { ...process.env, WELLSPRING_CONFIG: join(folder, 'none'), XDG_RUNTIME_DIR: folder,
      WELLSPRING_CACHE: join(folder, 'cache'), WELLSPRING_SUMS: join(folder, 'sums.sqlite'),
      WELLSPRING_EYE_OPTIONS: '--camera synthetic-live --loop',
      WELLSPRING_SERVER_OPTIONS: '--technique direct --still-technique direct --no-bake',
      ...environment } });
  started.push(child);
  let text = '';
  for (const stream of [child.stdout, child.stderr])
    stream.on('data', (chunk) => { text += chunk; });
  return { child, said: () => text, ended: new Promise((resolve) => child.on('close', resolve)) };
}

const is_left = (pid) => {
  try { process.kill(-pid, 0); return true; } catch { return false; }
};

test('what dies comes back, and nothing is left at the end', async () => {
  const port = await free_port();
  const screen = program('screen', 'echo "screen shows $1"; exec sleep 1000000');
  const environment = { WELLSPRING_PORT: String(port), WELLSPRING_SCREEN: screen };
  const kiosk = start(environment);
  const all = (pattern) => [...kiosk.said().matchAll(pattern)].map((match) => match[1]);
  const processes = (part) => all(new RegExp(`^kiosk: ${part} is process (\\d+)$`, 'gm'));
  const get = async (path) => {
    try {
      return await (await fetch(`http://127.0.0.1:${port}${path}`)).text();
    } catch { return ''; }
  };
  const observed = /^wellspring_kiosk_observations_total\{exhibit="castle"\} (\S+)$/m;
  const observations = async () => Number(observed.exec(await get('/metrics'))?.[1] ?? -1);
  const serves = async () => (await get('/healthz')).includes('ok');
  const sees = async () => {
    const before = await observations();
    return until(async () => (await observations()) > before, kiosk.said);
  };
  const shows = () => all(/^screen shows (\S+)$/gm);
  await until(serves, kiosk.said);
  await sees();
  await until(() => shows().length === 1, kiosk.said);
  assert.deepEqual(shows(), [`http://127.0.0.1:${port}/kiosk`]);

  const second = start(environment);
  assert.equal(await second.ended, 1);
  assert.match(second.said(), /is running already/);

  for (const [part, works] of [['screen', () => until(() => shows().length === 2, kiosk.said)],
      ['eye', sees], ['server', () => until(serves, kiosk.said).then(sees)]]) {
    const before = processes(part);
    process.kill(Number(before.at(-1)), 'SIGKILL');
    await until(() => processes(part).length > before.length, kiosk.said);
    assert.notEqual(processes(part).at(-1), before.at(-1));
    await works();
  }
  assert.equal(shows().length, 2, 'a page finds the server by itself');

  kiosk.child.kill('SIGTERM');
  assert.equal(await kiosk.ended, 0, kiosk.said());
  await until(() => !is_left(kiosk.child.pid), kiosk.said);
});

test('the pause grows while something dies again and again', async () => {
  const bin = join(folder, 'bin');
  mkdirSync(bin);
  for (const name of ['wellspring_server', 'wellspring_kiosk'])
    cpSync(program(name, 'exit 3'), join(bin, name));
  const kiosk = start({ WELLSPRING_BIN: bin, WELLSPRING_PORT: String(await free_port()) });
  const pauses = (part) => [...kiosk.said().matchAll(
      new RegExp(`^kiosk: ${part} ended with 3; again in (\\d+) s$`, 'gm'))].map(([, s]) => s);
  for (const part of ['server', 'eye']) {
    await until(() => pauses(part).length >= 3, kiosk.said);
    assert.deepEqual(pauses(part).slice(0, 3), ['1', '2', '4']);
  }
  kiosk.child.kill('SIGTERM');
  assert.equal(await kiosk.ended, 0, kiosk.said());
  await until(() => !is_left(kiosk.child.pid), kiosk.said);
});

test('a kiosk of a server elsewhere shows its token, and no command line has it', async () => {
  const bin = join(folder, 'bin-elsewhere'), state = join(folder, 'state');
  mkdirSync(bin);
  for (const name of ['wellspring_server', 'wellspring_kiosk'])
    cpSync(program(name, `echo "${name} gets $*"; exec sleep 1000000`), join(bin, name));
  const token = 'sixteen or more&"letters'.replaceAll(' ', '-'), file = join(folder, 'token');
  writeFileSync(file, `# of this kiosk\nhall ${token}\n`, { mode: 0o600 });
  const port = await free_port();
  const listens = net.createServer().listen(port, '127.0.0.1');
  const kiosk = start({ WELLSPRING_BIN: bin, WELLSPRING_PORT: String(port),
    WELLSPRING_HOST: '0.0.0.0', WELLSPRING_TOKEN_FILE: file, XDG_STATE_HOME: state,
    WELLSPRING_SCREEN: program('screen', 'echo "screen shows $1"; exec sleep 1000000') });
  const shown = join(state, 'wellspring', 'screen.html');
  await until(() => kiosk.said().includes(`screen shows file://${shown}\n`), kiosk.said);
  await until(() => kiosk.said().includes(`wellspring_kiosk gets --server ws://0.0.0.0:${port}`
    + `/api/v1/eye --token-file ${file} --camera synthetic-live --loop\n`), kiosk.said);
  assert.equal(statSync(shown).mode & 0o777, 0o600);
  const address = /location\.replace\("(.*)"\)/.exec(readFileSync(shown, 'utf8'))[1];
  assert.equal(address, `http://0.0.0.0:${port}/kiosk#token=${encodeURIComponent(token)}`);
  assert.ok(!kiosk.said().includes('server is process'), 'there is none here');
  assert.ok(!kiosk.said().includes(token));
  kiosk.child.kill('SIGTERM');
  assert.equal(await kiosk.ended, 0, kiosk.said());
  listens.close();
});

test('systemd takes the units', (context) => {
  if (spawnSync('systemd-analyze', ['--version']).error)
    return context.skip('there is no systemd-analyze here');
  const home = join(folder, 'home');
  mkdirSync(home);
  symlinkSync(source, join(home, 'wellspring'));
  const units = readdirSync(join(source, 'deploy')).filter((name) => name.startsWith('wellspring'));
  assert.equal(units.length, 4);
  const { status, stdout, stderr } = spawnSync('systemd-analyze',
      ['verify', '--user', '--man=no', ...units.map((name) => join(source, 'deploy', name))],
      { env: { ...process.env, HOME: home, XDG_RUNTIME_DIR: folder }, encoding: 'utf8' });
  assert.equal(status, 0, stdout + stderr);
  for (const name of units) assert.ok(!stderr.includes(name), stderr);
});
