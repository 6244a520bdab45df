// SPDX-License-Identifier: Apache-2.0
// Clang compiles the fuzz targets and all headers that they include, with the flags of the build.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { cpus } from 'node:os';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';

const build = join(process.env.WELLSPRING_BIN, '..');
const commands = JSON.parse(readFileSync(join(build, 'compile_commands.json'), 'utf8'))
  .filter(({ command }) => command.includes('/fuzz_replay.dir/'));

// Returns the defines, folders, standard and warnings of a command of GCC.
function flags(command) {
  const words = command.split(/\s+/), kept = [];
  for (let i = 0; i < words.length; i++)
    if (/^-(D|I|std=|m(?!no-)|W)/.test(words[i])) kept.push(words[i].replaceAll('\\"', '"'));
    else if (words[i] === '-isystem') kept.push(words[i], words[++i]);
  return kept;
}

test('the fuzz targets compile with Clang', async () => {
  const sources = commands.map(({ file }) => file + readFileSync(file, 'utf8')).join();
  for (const name of readdirSync(join(process.env.WELLSPRING_SOURCE, 'tests/fuzz')))
    if (/^fuzz_\w+\.cpp$/.test(name)) assert.ok(sources.includes(name), `${name} is compiled`);
  const queue = [...commands], faults = [];
  const work = async () => {
    for (let one = queue.pop(); one; one = queue.pop())
      await promisify(execFile)('clang++', [...flags(one.command), '-Wno-unknown-warning-option',
        '-Werror', '-fsyntax-only', one.file], { cwd: one.directory, maxBuffer: 1 << 26 })
        .catch((error) => faults.push(`${basename(one.file)}: ${error.stderr ?? error}`));
  };
  await Promise.all(Array.from({ length: cpus().length }, work));
  assert.deepEqual(faults, []);
});
