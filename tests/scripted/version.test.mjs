// SPDX-License-Identifier: Apache-2.0
// What programs are made of, as they say and as the linker and their sources have it.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { run, source } from '../server.mjs';

const bin = process.env.WELLSPRING_BIN;
const version = /project\(wellspring VERSION ([\d.]+)/.exec(
    readFileSync(join(source, 'CMakeLists.txt'), 'utf8'))[1];
const server = join(bin, 'wellspring_server');
const output = (program, args) => {
  const { status, stdout, stderr } = spawnSync(program, args, { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  return stdout;
};
const bill = async () => {
  const { status, stdout } = await run('wellspring_server', ['--version', '--json']);
  assert.equal(status, 0);
  return JSON.parse(stdout);
};
const file_of = ({ properties }) => properties?.find(({ name }) => name === 'file').value;

test('every program tells its version', async () => {
  const programs = readdirSync(bin).filter((name) => name.startsWith('wellspring_'));
  assert.ok(programs.includes('wellspring_server'));
  for (const name of programs) {
    const { status, stdout, stderr } = await run(name, ['--version']);
    assert.equal(status, 0, `${name}: ${stderr}`);
    assert.equal(stdout, `${name} ${version}\n`);
  }
});

test('all that is linked is listed, with licence, version and purpose', async () => {
  const { components } = await bill();
  const listed = components.map(file_of).filter((name) => name).sort();
  const linked = output('ldd', [server]).split('\n')
      .map((line) => basename(line.trim().split(' ')[0])).filter((name) => /\.so/.test(name))
      .filter((name) => !name.startsWith('linux-vdso')).sort();
  assert.ok(linked.length > 10, linked.join());
  // If oneTBB's allocator is installed, oneTBB loads it itself.
  const loads = (name) => name.startsWith('libtbbmalloc.');
  assert.deepEqual(listed.filter((name) => linked.includes(name) || !loads(name)), linked);
  const needed = [...output('readelf', ['-d', server]).matchAll(/\(NEEDED\).*\[(.+)\]/g)];
  for (const [, name] of needed) assert.ok(listed.includes(name), name);
  for (const one of components) {
    assert.ok(one.description, `${file_of(one) ?? one.name}: add it to about/version.h`);
    assert.match(one.licenses[0].expression, /^[A-Za-z]/);
    assert.match(one.version, /\d/, `${one.name} has a version`);
  }
});

test('headers that are compiled in are listed, too', async () => {
  const folders = { boost: 'Boost (Asio, Beast)', CLI: 'CLI11', glm: 'GLM',
    nlohmann: 'JSON for Modern C++' };
  const names = new Set((await bill()).components.filter((one) => !file_of(one))
      .map(({ name }) => name));
  const found = new Set();
  for (const top of ['server', 'avatar'])
    for (const path of readdirSync(join(source, top), { recursive: true })) {
      if (!/\.(h|cpp)$/.test(path)) continue;
      const text = readFileSync(join(source, top, path), 'utf8');
      for (const [, include] of text.matchAll(/^#include <([^>]+)>/gm)) {
        if (include.startsWith('stb_')) found.add('stb');
        if (include.split('/')[0] in folders) found.add(folders[include.split('/')[0]]);
      }
    }
  assert.ok(found.size >= 4, [...found].join());
  assert.deepEqual([...names].sort(), [...found].sort());
});

test('the bill is CycloneDX 1.5, and the same in words', async () => {
  const { bomFormat, specVersion, metadata, components, version: number } = await bill();
  assert.deepEqual([bomFormat, specVersion, number], ['CycloneDX', '1.5', 1]);
  assert.equal(metadata.component.name, 'wellspring_server');
  assert.equal(metadata.component.version, version);
  const references = components.map((one) => one['bom-ref']);
  assert.equal(new Set(references).size, references.length);
  for (const { type, purl } of components) {
    assert.equal(type, 'library');
    if (purl) assert.match(purl, /^pkg:deb\/[a-z]+\/[A-Za-z0-9.%-]+@[A-Za-z0-9._~%-]+$/);
  }
  const text = output(server, ['--version', '--verbose']);
  assert.ok(text.startsWith(`wellspring_server ${version}\n`));
  assert.equal(text.trim().split('\n').length, components.length + 2);
  for (const one of components) assert.ok(text.includes(`${one.name} ${one.version} (`), one.name);
  assert.equal(output(join(source, 'wellspring'), ['--version']).split(' ')[0],
      'wellspring_server');
});
