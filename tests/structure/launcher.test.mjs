// SPDX-License-Identifier: Apache-2.0
// The launcher's words where something fails, and what it counts at the end of a test run.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { chmodSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

const source = process.env.WELLSPRING_SOURCE;
const folder = mkdtempSync(join(tmpdir(), 'wellspring-launcher-'));
after(() => rmSync(folder, { recursive: true, force: true }));

// Calls functions of the launcher, whose products go to `folder`. `npm` stands in for the program.
function launcher(commands, npm, env = {}) {
  const bin = join(folder, 'bin');
  mkdirSync(bin, { recursive: true });
  writeFileSync(join(bin, 'npm'), `#!/bin/sh\n${npm}\n`);
  chmodSync(join(bin, 'npm'), 0o755);
  const script = `source '${source}/wellspring' help >/dev/null
    build='${folder}/build'
    ${commands}`;
  const path = `${bin}:${process.env.PATH}`;
  return spawnSync('bash', ['-c', script], { encoding: 'utf8',
    env: { ...process.env, WELLSPRING_NO_INSTALL: '', CI: '', PATH: path, ...env } });
}
const no_certificate = 'echo "npm error code SELF_SIGNED_CERT_IN_CHAIN" >&2; exit 1';

test('where npm cannot install, what it said and what to do are shown', () => {
  const scripts = launcher('install_test_scripts; echo goes on', no_certificate);
  assert.equal(scripts.status, 0, scripts.stderr);
  assert.match(scripts.stdout, /goes on/);
  assert.match(scripts.stderr, /SELF_SIGNED_CERT_IN_CHAIN/);
  assert.match(scripts.stderr, /NODE_EXTRA_CA_CERTS/);
  const weights = launcher(`install_from '${source}/kiosk/weights' '${folder}/weights' ` +
      '"faces are found by cascades" face-api model/a.bin', no_certificate);
  assert.equal(weights.status, 0, weights.stderr);
  assert.match(weights.stderr,
      /SELF_SIGNED_CERT_IN_CHAIN[^]*face-api could not be installed: faces are/);
});

test('continuous integration does not go on without the scripts\' packages', () => {
  const { status, stdout } = launcher('install_test_scripts; echo goes on', no_certificate,
      { CI: 'true' });
  assert.equal(status, 1);
  assert.doesNotMatch(stdout, /goes on/);
});

test('what npm installs is taken once', () => {
  const npm = 'mkdir -p node_modules; echo run >>"$RUNS"';
  const runs = join(folder, 'runs');
  const { status, stderr, stdout } = launcher(
      'install_test_scripts; install_test_scripts; cat "$RUNS"', npm, { RUNS: runs });
  assert.equal(status, 0, stderr);
  assert.equal(stdout, 'run\n');
});

test('single tests that were skipped are counted and named with their reasons', () => {
  const log = join(folder, 'log');
  writeFileSync(log, `3/9 Testing: unit.frame.1
/somewhere/tests/unit/frame/flip_test.cpp:155: Skipped
no pictures of the reference tool

ok 1 - pages are read # SKIP there is no Chromium here
﹣ pages are heard (0.2ms) # SKIP there is no Chromium here
# skipped 2
Command: "/usr/bin/node" "--test" "/somewhere/tests/browser/page.test.mjs"
The package ws of npm is not installed, so this script is skipped.
`);
  const { stdout } = spawnSync('awk', ['-f', join(source, 'tests/skipped.awk'), log],
      { encoding: 'utf8' });
  const [head, ...reasons] = stdout.trim().split('\n');
  assert.equal(head, '4 tests were skipped:');
  assert.deepEqual(reasons.sort(), [
    '  The package ws of npm is not installed: all of page.test.mjs',
    '  no pictures of the reference tool: flip_test.cpp:155',
    '  there is no Chromium here: pages are read, pages are heard']);
});
