// SPDX-License-Identifier: Apache-2.0
// The Debian packages: what is in them, and that the server runs from where they are unpacked.
// With WELLSPRING_DEBIAN_ROOT=FOLDER, as root, they are installed, upgraded and purged there: in a
// Debian that debootstrap has made for this test.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { appendFileSync, copyFileSync, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync,
  readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const build = dirname(process.env.WELLSPRING_BIN);
const root = join(folder, 'root');
delete process.env.WELLSPRING_WEIGHTS;
after(() => rmSync(folder, { recursive: true, force: true }));

function call(program, args, { status = 0, ...options } = {}) {
  const done = spawnSync(program, args, { encoding: 'utf8', maxBuffer: 1 << 26, ...options });
  assert.equal(done.status, status, `${program} ${args.join(' ')}: ${done.error ?? ''}\n` +
    `${done.stdout}${done.stderr}`);
  return done.stdout;
}
// The packages of this build as VERSION, in a folder.
function pack(version) {
  const into = join(folder, version);
  call('cpack', ['-B', into, '-R', version], { cwd: build });
  const found = readdirSync(into).filter((name) => name.endsWith('.deb')).sort();
  return found.map((name) => join(into, name));
}
let server_deb, kiosk_deb;
before(() => {
  [kiosk_deb, server_deb] = pack('0.9.1');
  for (const deb of [server_deb, kiosk_deb]) call('dpkg-deb', ['-x', deb, root]);
});

test('the packages say what they need and what an operator may change', () => {
  const info = (deb, field) => call('dpkg-deb', ['-f', deb, field]).trim();
  assert.equal(info(server_deb, 'Package'), 'wellspring');
  assert.equal(info(kiosk_deb, 'Package'), 'wellspring-kiosk');
  assert.match(info(server_deb, 'Depends'), /\badduser\b/);
  assert.match(info(server_deb, 'Depends'), /\blibespeak-ng1\b/);
  assert.match(info(server_deb, 'Depends'), /\blibembree/);
  assert.doesNotMatch(info(server_deb, 'Depends'), /opencv/, 'a server needs no eyes');
  assert.match(info(kiosk_deb, 'Depends'), /opencv/);
  const control = join(folder, 'control');
  call('dpkg-deb', ['-e', server_deb, control]);
  for (const file of readFileSync(join(control, 'conffiles'), 'utf8').trim().split('\n'))
    assert.ok(existsSync(join(root, file)), file);
  for (const name of ['preinst', 'postinst', 'prerm', 'postrm']) {
    assert.equal(statSync(join(control, name)).mode & 0o777, 0o755, name);
    call('sh', ['-n', join(control, name)]);
    assert.doesNotMatch(readFileSync(join(control, name), 'utf8'), /@\w+@/, name);
  }
  const listed = call('dpkg-deb', ['-c', server_deb]);
  assert.doesNotMatch(listed, /_CPack|\/work\/|\/root\//);
  for (const line of listed.trim().split('\n')) assert.match(line, / root\/root /, line);
});

test('nothing that is installed knows where it was built', () => {
  const units = 'usr/lib/systemd/system';
  for (const name of ['etc/wellspring/server.conf', `${units}/wellspring-server.service`,
    'etc/wellspring/worker.conf', `${units}/wellspring-worker.service`,
    `${units}/wellspring-kiosk.service`, 'usr/lib/systemd/user/wellspring-screen.service'])
    assert.ok(!readFileSync(join(root, name), 'utf8').includes(folder), name);
  const unit = readFileSync(join(root, units, 'wellspring-server.service'), 'utf8');
  assert.match(unit, /^ExecStart=\/usr\/libexec\/wellspring\/wellspring_server$/m);
  assert.doesNotMatch(unit, /@\w+@/);
});

test('the server runs from where it is unpacked, with what lies beside it', async () => {
  const programs = join(root, 'usr/libexec/wellspring');
  const config = join(root, 'etc/wellspring/server.conf');
  const printed = call(join(programs, 'wellspring_server'), ['--print-config']);
  assert.match(printed, /^content = \/var\/lib\/wellspring\/exhibits$/m, 'it reads its own file');
  assert.equal(readFileSync(config, 'utf8'), printed);
  // The file's folders cannot be written here, so others are put into it: changes of the file
  // count.
  const content = join(folder, 'content');
  call(join(root, 'usr/bin/wellspring'),
      ['new', 'giza', write_pyramid(folder), '--content', content]);
  writeFileSync(config, printed.replace('/var/lib/wellspring/exhibits', content)
      .replaceAll('/var/', `${folder}/var/`));
  const server = await start_server(['--exhibit', 'giza', '--no-bake'],
      { programs, places: false });
  try {
    const visitor = new Visitor(server);
    assert.equal((await visitor.hello()).type, 'welcome');
    await visitor.picture();
    await visitor.close();
    const page = await (await fetch(`${server.url}/`)).text();
    assert.match(page, /<script/);
    assert.doesNotMatch(server.log(), /voice|speech.*cannot|no folder of weights/i);
  } finally {
    assert.equal(await server.stop(), 0);
  }
});

test('the words of the documents work once installed', () => {
  const wellspring = join(root, 'usr/bin/wellspring');
  call(wellspring, ['check', join(root, 'usr/share/wellspring/content/first-room')]);
  for (const word of ['kiosk', 'worker', 'plan']) call(wellspring, [word, '--help']);
  call(wellspring, ['dance'], { status: 2 });
});

test('a worker has its settings in a file of its own, and works for nobody yet', () => {
  const worker = join(root, 'usr/libexec/wellspring/wellspring_worker');
  const printed = readFileSync(join(root, 'etc/wellspring/worker.conf'), 'utf8');
  assert.equal(call(worker, ['--print-config']), printed, 'it reads its own file');
  assert.match(printed, /^content = \/var\/lib\/wellspring\/exhibits$/m);
  assert.match(printed, /^#nats = $/m);
  assert.match(printed, /^#name = $/m, 'it has no name of the machine that built it');
  call(worker, [], { status: 2 });
  const script = readFileSync(join(folder, 'control', 'postinst'), 'utf8');
  assert.doesNotMatch(script, /(enable|start).*wellspring-worker(?<!try-restart.*)/);
  const museum = readdirSync(join(root, 'usr/share/doc/wellspring/museum')).sort();
  assert.deepEqual(museum, ['haproxy-nodes.cfg', 'haproxy.service.d', 'nats-server.service.d',
    'nats.conf', 'secrets.sh', 'server.conf', 'worker.conf']);
});

test('systemd takes the units, and finds the services shut off', (context) => {
  if (spawnSync('systemd-analyze', ['--version']).error)
    return context.skip('there is no systemd-analyze here');
  // The units are checked as they are, but their programs lie where they are unpacked.
  const place = (name) => join(folder, 'units', name);
  mkdirSync(join(folder, 'units'));
  const take = (kind, name) => writeFileSync(place(name),
      readFileSync(join(root, 'usr/lib/systemd', kind, name), 'utf8')
          .replaceAll('/usr/libexec/', join(root, 'usr/libexec/')));
  const verify = (names, ...more) => {
    const { status, stderr } = spawnSync('systemd-analyze', ['verify', '--man=no', ...more,
      ...names.map(place)], { encoding: 'utf8',
      env: { ...process.env, HOME: folder, XDG_RUNTIME_DIR: folder } });
    assert.equal(status, 0, stderr);
    for (const name of names) assert.ok(!stderr.includes(name), stderr);
  };
  const units = ['server', 'worker', 'kiosk'].map((name) => `wellspring-${name}.service`);
  for (const name of units) take('system', name);
  take('user', 'wellspring-screen.service');
  verify(units);
  verify(['wellspring-screen.service'], '--user');
  // Debian's own, with what a museum adds.
  for (const name of ['haproxy.service', 'nats-server.service']) {
    const own = ['/usr/lib', '/lib'].map((at) => join(at, 'systemd/system', name)).find(existsSync);
    if (!own) continue;
    copyFileSync(own, place(name));
    cpSync(join(root, 'usr/share/doc/wellspring/museum', `${name}.d`), place(`${name}.d`),
        { recursive: true });
    verify([name]);
  }
  for (const [name, most] of units.map((one) => [one, 20])) {
    const found = spawnSync('systemd-analyze', ['security', '--offline=true', '--no-pager',
      `--threshold=${most}`, place(name)], { encoding: 'utf8' });
    const score = /Overall exposure level for .*: ([\d.]+)/.exec(found.stdout)?.[1];
    context.diagnostic(`${name}: exposure ${score}`);
    assert.equal(found.status, 0, found.stdout + found.stderr);
  }
});

const debian = process.env.WELLSPRING_DEBIAN_ROOT;
test('an upgrade keeps exhibits and settings, a purge leaves nothing', {
  skip: !debian && 'WELLSPRING_DEBIAN_ROOT names no system to install in',
}, () => {
  const chroot = (...words) => call('chroot', [debian, 'env', 'DEBIAN_FRONTEND=noninteractive',
    ...words]);
  const install = (deb) => {
    copyFileSync(deb, join(debian, 'tmp', 'wellspring.deb'));
    chroot('apt-get', 'install', '-y', '--no-install-recommends', '/tmp/wellspring.deb');
  };
  const there = (name) => existsSync(join(debian, name));
  const config = join(debian, 'etc/wellspring/server.conf');
  const exhibit = 'var/lib/wellspring/exhibits/first-room/exhibit.json';
  chroot('apt-get', 'update');
  install(server_deb);
  assert.ok(there(exhibit), 'there is a first museum');
  appendFileSync(config, '# of the house\n');
  appendFileSync(join(debian, exhibit), '\n');
  rmSync(join(debian, 'var/lib/wellspring/exhibits/castle'), { recursive: true });
  const of_the_house = () => [config, join(debian, exhibit)]
      .map((file) => readFileSync(file, 'utf8'));
  const kept = of_the_house();
  install(pack('0.9.2')[1]);
  assert.match(chroot('dpkg-query', '-W', 'wellspring'), /0\.9\.2/);
  assert.deepEqual(of_the_house(), kept);
  assert.ok(!there('var/lib/wellspring/exhibits/castle'), 'what was removed stays away');
  chroot('su', '-s', '/bin/sh', 'wellspring', '-c',
      '/usr/libexec/wellspring/wellspring_server --print-config');
  chroot('apt-get', 'remove', '-y', 'wellspring');
  assert.ok(there(exhibit) && existsSync(config), 'removed, it can come back');
  chroot('apt-get', 'purge', '-y', 'wellspring');
  for (const name of ['etc/wellspring/server.conf', 'var/lib/wellspring', 'var/cache/wellspring',
    'var/log/wellspring', 'usr/share/wellspring', 'etc/logrotate.d/wellspring'])
    assert.ok(!there(name), name);
  assert.doesNotMatch(readFileSync(join(debian, 'etc/passwd'), 'utf8'), /wellspring/);
});
