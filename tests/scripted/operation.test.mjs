// SPDX-License-Identifier: Apache-2.0
// What an operator relies on: what the service manager is told, reload, and the log.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, start_server, until } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const content = join(folder, 'content'), manifest = join(content, 'giza', 'exhibit.json');
before(async () => {
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
});
after(() => rmSync(folder, { recursive: true, force: true }));

const serve = (words) => start_server(['--exhibit', 'giza', '--no-bake', ...words], { content });
const healthy = async (server) => (await fetch(`${server.url}/healthz`)).ok;

// A service manager's socket (Node has none of this kind): what it hears, a line each.
async function listen(path) {
  const perl = `use Socket; $| = 1; socket(my $s, AF_UNIX, SOCK_DGRAM, 0) or die;
    bind($s, pack_sockaddr_un($ARGV[0])) or die; print "listens\\n";
    while (defined recv($s, my $m, 4096, 0)) { $m =~ tr/\\n/ /; print "$m\\n"; }`;
  const child = spawn('perl', ['-e', perl, path], { stdio: ['ignore', 'pipe', 'inherit'] });
  let text = '';
  child.stdout.on('data', (chunk) => { text += chunk; });
  const lines = () => text.split('\n').slice(1, -1);
  await until(() => text.startsWith('listens'), () => 'the listener');
  return { lines, close: () => child.kill('SIGKILL') };
}

test('the service manager hears of beginning, ticks, reload and end', async () => {
  const path = join(folder, 'notify'), manager = await listen(path);
  Object.assign(process.env, { NOTIFY_SOCKET: path, WATCHDOG_USEC: '1000000' });
  const server = await serve([]);
  delete process.env.NOTIFY_SOCKET, delete process.env.WATCHDOG_USEC;
  const count = (pattern) => manager.lines().filter((line) => pattern.test(line)).length;
  try {
    await until(() => count(/^WATCHDOG=1$/) >= 3, manager.lines);
    assert.match(manager.lines()[0], /^READY=1 STATUS=serves 'giza' at http:/);
    assert.equal(count(/^READY=1/), 1);
    server.child.kill('SIGHUP');
    await until(() => count(/^READY=1/) === 2, manager.lines);
    assert.equal(count(/^RELOADING=1 MONOTONIC_USEC=\d+$/), 1);
    // A stopped process says nothing: the pings are its own.
    server.child.kill('SIGSTOP');
    await sleep(300);
    const heard = count(/^WATCHDOG=1$/);
    await sleep(1500);
    assert.equal(count(/^WATCHDOG=1$/), heard);
    server.child.kill('SIGCONT');
  } finally {
    await server.stop();
    manager.close();
  }
  assert.equal(manager.lines().at(-1), 'STOPPING=1');
});

test('SIGHUP takes what needs no restart, and begins the log anew', async () => {
  const log = join(folder, 'server.log'), config = join(folder, 'server.conf');
  const settings = (level, port) => writeFileSync(config, `log = ${log}\nlog-level = ${level}\n` +
    `max-visitors = ${port}\n`);
  settings('info', 5);
  const server = await serve(['--config', config]);
  const title = async () => {
    const visitor = new Visitor(server);
    try { return (await visitor.hello()).title; } catch { return ''; } finally { visitor.close(); }
  };
  const logged = (pattern) => existsSync(log) && pattern.test(readFileSync(log, 'utf8'));
  try {
    assert.equal(await title(), 'Pyramid');
    assert.ok(logged(/ server info .*connected/), 'the log goes to its file');
    assert.equal(server.log(), '');
    const changed = JSON.parse(readFileSync(manifest, 'utf8'));
    changed.title.en = 'A great pyramid';
    writeFileSync(manifest, JSON.stringify(changed, null, 2));
    settings('info', 6);
    renameSync(log, `${log}.1`);
    server.child.kill('SIGHUP');
    await until(async () => await title() === 'A great pyramid', server.log);
    assert.ok(logged(/needs a restart to count: max-visitors\n/), readFileSync(log, 'utf8'));
    settings('warn', 'many');
    server.child.kill('SIGHUP');
    const read_log = () => readFileSync(log, 'utf8');
    await until(() => logged(/server\.conf: line 3: max-visitors: /), read_log);
    settings('error', 5);
    server.child.kill('SIGHUP');
    await sleep(500);
    const size = readFileSync(log, 'utf8').length;
    assert.equal(await title(), 'A great pyramid');
    assert.equal(readFileSync(log, 'utf8').length, size, 'a comer is no error');
  } finally {
    assert.equal(await server.stop(), 0);
  }
});

test('killed and started again it goes on with visits at their places', async () => {
  const words = ['--exhibit', 'giza', '--no-bake', '--cache', join(folder, 'cache')];
  const place = [0.5, 1.5, 3.25];
  let token = '', port = 0;
  for (let round = 0; round < 3; round++) {
    const server = await start_server(words, { content, port });
    port = server.port;
    try {
      const visitor = new Visitor(server);
      const state = visitor.message('state');
      const welcome = await visitor.hello({ resume: token });
      if (round > 0) {
        assert.equal(welcome.resumed, true);
        const { position } = await state;
        for (const axis of [0, 1, 2]) assert.ok(Math.abs(position[axis] - place[axis]) < 0.01);
      }
      const keeps = () => visitor.messages.filter(({ type }) => type === 'keep');
      if (round === 0) {
        visitor.send({ type: 'camera', seq: 1, position: place, yaw: 0.25, pitch: 0 });
        await sleep(4500);  // the page is told where its visit is now and then
      }
      await until(() => keeps().length > 0, () => 'a token');
      token = keeps().at(-1).token;
    } finally {
      assert.equal(await server.stop('SIGKILL'), null);
    }
  }
});

test('a full disk stops neither log nor server', async () => {
  const server = await serve(['--log', '/dev/full', '--sums', '/dev/full/sums.sqlite',
    '--cache', '/dev/full/cache']);
  try {
    const visitor = new Visitor(server);
    await visitor.hello();
    await visitor.picture();
    await visitor.close();
    assert.ok(await healthy(server));
  } finally {
    assert.equal(await server.stop(), 0);
  }
  const wrong = await run('wellspring_server', ['--log', join(folder, 'none', 'a.log')]);
  assert.equal(wrong.status, 1);
  assert.match(wrong.stderr, /none\/a\.log: No such file/);
});
