// SPDX-License-Identifier: Apache-2.0
// `wellspring nebula`: makes a volume of the castle's nebula, and names what is wrong.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { gunzipSync } from 'node:zlib';
import { run, source } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-nebula-'));
after(() => rmSync(folder, { recursive: true }));
const picture = join(source, 'content/castle/pictures/nebula.png');

test('the castle\'s nebula becomes a volume, and a picture of it', async () => {
  const out = join(folder, 'nebula.nrrd');
  const { status, stdout, stderr } = await run('wellspring_nebula',
      [picture, '--tilt', '27', '--rings', '20x40', '--side', '64', '--out', out]);
  assert.equal(status, 0, stderr);
  assert.match(stdout, /^stars: [4-9]\d filled/m);
  assert.match(stdout, /^axis: 3\d\.\d degrees, proposed$/m);
  const file = readFileSync(out), end = file.indexOf('\n\n') + 2;
  const [, x, y, z] = /sizes: 3 (\d+) (\d+) (\d+)/.exec(file.toString('latin1', 0, end));
  assert.equal(gunzipSync(file.subarray(end)).length, 3 * x * y * z);
  assert.ok(x <= 64 && y <= 64 && z > 16, `${x} ${y} ${z}`);
  assert.ok(existsSync(join(folder, 'nebula.png')));
});

test('wrong words and files are told apart', async () => {
  assert.equal((await run('wellspring_nebula', [])).status, 2);
  assert.equal((await run('wellspring_nebula', [picture, '--tilt', '90'])).status, 2);
  assert.equal((await run('wellspring_nebula', [picture, '--rings', 'many'])).status, 2);
  const none = await run('wellspring_nebula', [join(folder, 'none.png')]);
  assert.equal(none.status, 1);
  assert.match(none.stderr, /none\.png/);
});
