// SPDX-License-Identifier: Apache-2.0
// What can be said of docker/ without Docker: sources, users, health checks, and the proxy's file.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;
const read = (name) => readFileSync(join(root, name), 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
after(() => rmSync(folder, { recursive: true, force: true }));

// Stages of a Dockerfile, by name: {base, steps: [{word, text}]}.
function stages(text) {
  const found = new Map();
  let stage;
  const lines = text.replaceAll(/^#.*\n/gm, '').replaceAll(/\\\n\s*/g, '').split('\n');
  for (const line of lines.filter((one) => one.trim())) {
    const [, word, rest] = /^([A-Z]+) (.*)$/.exec(line) ?? assert.fail(`no instruction: ${line}`);
    if (word === 'FROM') {
      const [, base, name] = /^(\S+) AS (\S+)$/.exec(rest) ?? assert.fail(line);
      found.set(name, stage = { base, steps: [] });
    } else stage.steps.push({ word, text: rest });
  }
  return found;
}
const dockerfile = stages(read('docker/Dockerfile'));
const images = ['server', 'kiosk'];
const steps = (name, word) => dockerfile.get(name).steps.filter((step) => step.word === word)
    .map((step) => step.text);

test('every image has a user of its own, a signal to stop and a word on its health', () => {
  for (const name of images) {
    const user = steps(name, 'USER').at(-1);
    assert.ok(user && !/^(root|0)\b/.test(user), `${name} runs as ${user}`);
    assert.equal(steps(name, 'HEALTHCHECK').length, 1, name);
    assert.deepEqual(steps(name, 'STOPSIGNAL'), ['SIGTERM']);
    const last = dockerfile.get(name).steps.findLastIndex(({ word }) => word === 'RUN');
    const at = dockerfile.get(name).steps.findIndex(({ word }) => word === 'USER');
    assert.ok(at > last, `${name} installs as its user`);
  }
  assert.match(steps('server', 'HEALTHCHECK')[0], /\/healthz/);
  assert.match(steps('server', 'VOLUME')[0], /\/var\/lib\/wellspring.*\/var\/cache\/wellspring/);
  for (const { base } of dockerfile.values()) assert.equal(base, 'debian:bookworm-slim');
});

test('what is copied is there', () => {
  const packages = /^set\(CPACK_DEBIAN_\w+_PACKAGE_NAME (\S+)\)$/gm;
  const made = [...read('cmake/package.cmake').matchAll(packages)].map(([, name]) => name);
  const ignored = read('.dockerignore').split('\n');
  for (const [name, stage] of dockerfile)
    for (const { text } of stage.steps.filter(({ word }) => ['COPY', 'ADD'].includes(word))) {
      const words = text.split(' '), from = /^--from=(\S+)$/.exec(words[0])?.[1];
      const source = words.at(-2);
      if (!from) {
        assert.ok(existsSync(join(root, source)), `${name}: ${source}`);
        assert.ok(!ignored.includes(source), `${name}: ${source} is ignored`);
        continue;
      }
      assert.ok(dockerfile.has(from), `${name} copies from ${from}`);
      const [, wanted] = /^\/src\/build\/package\/(\S+)_\*\.deb$/.exec(source);
      assert.ok(made.includes(wanted), `${name}: no package ${wanted} is made`);
    }
  // The launcher writes packages where the images take them from.
  assert.match(read('wellspring'), /cpack -B "\$here\/build\/package"/);
});

test('compose names targets and files that there are', () => {
  const compose = read('docker/compose.yaml');
  for (const [, target] of compose.matchAll(/target: (\w+)/g)) assert.ok(images.includes(target));
  for (const [, file] of compose.matchAll(/"\.\/([\w.]+):/g))
    assert.ok(readdirSync(join(root, 'docker')).includes(file), file);
  const named = [...compose.matchAll(/^ {6}- (\w+):(\S+)$/gm)].map(([, , at]) => at);
  assert.deepEqual(named, JSON.parse(steps('server', 'VOLUME')[0]));
});

test('nginx takes the proxy\'s file', (context) => {
  if (spawnSync('nginx', ['-v']).error) return context.skip('there is no nginx here');
  const own = read('docker/nginx.conf').replace('server:8080', '127.0.0.1:8080')
      .replace('listen 80;', 'listen 127.0.0.1:8099;');
  writeFileSync(join(folder, 'nginx.conf'), `pid ${folder}/pid;\nerror_log stderr;\nevents {}\n` +
    `http { access_log off;\n${own}}\n`);
  const { status, stderr } = spawnSync('nginx', ['-t', '-e', 'stderr', '-p', folder, '-c',
    join(folder, 'nginx.conf')], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
});
