// SPDX-License-Identifier: Apache-2.0
// Configuration files: every option is a key, and what is wrong is named with its line.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const write = (text) => {
  writeFileSync(join(folder, 'a.conf'), text);
  return join(folder, 'a.conf');
};
delete process.env.WELLSPRING_WEIGHTS;

test('what is printed has every option, and is read as it was', async () => {
  const help = await run('wellspring_server', ['--help']);
  const options = [...help.stdout.matchAll(/^ +(?:-\w,)?--([a-z-]+)/gm)].map((match) => match[1])
      .filter((name) => !['help', 'version', 'config', 'print-config'].includes(name));
  assert.ok(options.length > 20, help.stdout);
  const printed = await run('wellspring_server', ['--print-config']);
  assert.equal(printed.status, 0, printed.stderr);
  const keys = [...printed.stdout.matchAll(/^#?([a-z-]+) =(.*)$/gm)].map((match) => match[1]);
  assert.deepEqual(keys, options);
  for (const block of printed.stdout.split('\n\n'))
    assert.match(block, /^# .+\n(# .*\n)*#?[a-z-]+ =/, 'every key says what it is for');
  // All defaults, set in the file, are good values.
  const set = (text) => text.replaceAll(/^#([a-z-]+ =)/gm, '$1');
  const aloud = set(printed.stdout);
  const again = await run('wellspring_server', ['--config', write(aloud), '--print-config']);
  assert.equal(again.status, 0, again.stderr);
  assert.equal(set(again.stdout), aloud);
});

test('a worker reads such a file, too, and says what it lacks', async () => {
  const file = write('nats = nats://10.0.0.5:4222\ncores = 1\n');
  const { status, stdout } = await run('wellspring_worker', ['--config', file, '--print-config']);
  assert.equal(status, 0);
  assert.match(stdout, /^nats = nats:\/\/10\.0\.0\.5:4222$/m);
  assert.match(stdout, /^cores = 1$/m);
  const without = await run('wellspring_worker', ['--config', write('cores = 1\n')]);
  assert.equal(without.status, 2);
  assert.match(without.stderr, /--nats is missing/);
  const wrong = await run('wellspring_worker', ['--config', write('nuts = 1\n')]);
  assert.equal(wrong.status, 1);
  assert.match(wrong.stderr, /a\.conf: line 1: .*nuts/);
});

test('a wrong file is named with its lines, and nothing starts', async () => {
  const file = write('port = 8080\n\nprot = 1\ntechnique = majic\nwatch = perhaps\nport = 1\n');
  const { status, stdout, stderr } = await run('wellspring_server', ['--config', file]);
  assert.equal(status, 1);
  assert.equal(stdout, '');
  const lines = stderr.trim().split('\n');
  assert.equal(lines.length, 4, stderr);
  assert.equal(lines[0], `error: ${file}: line 3: there is no key 'prot'; did you mean 'port'?`);
  assert.match(lines[1], /line 4: technique: .*majic.*gather/);
  assert.match(lines[2], /line 5: watch: 'perhaps' is not true or false/);
  assert.match(lines[3], /line 6: port stands here again; line 1 has it/);
});

test('a file that is not there is an error, and the command line wins', async () => {
  const none = await run('wellspring_server', ['--config', join(folder, 'none.conf')]);
  assert.equal(none.status, 1);
  assert.match(none.stderr, /none\.conf: cannot be read/);
  const both = await run('wellspring_server',
      ['--config', write('port = 81\nfps = 12\n'), '--port', '82', '--print-config']);
  assert.match(both.stdout, /^port = 82$/m);
  assert.match(both.stdout, /^fps = 12$/m);
});
