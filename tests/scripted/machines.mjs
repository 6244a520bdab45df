// SPDX-License-Identifier: Apache-2.0
// Machines of a museum: each a network namespace with a folder for its root, on which services run
// as systemd's units say. All of it is within a namespace of this script's own, so nothing of it is
// seen outside, and all of it ends with the script.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { appendFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync,
  writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { source } from '../server.mjs';

export const network = (last) => `10.97.0.${last}`;
export const here = '10.97.0.254';

const call = (words) => {
  const { status, stderr, error } = spawnSync(words[0], words.slice(1), { encoding: 'utf8' });
  assert.equal(status, 0, `${words.join(' ')}: ${error ?? stderr}`);
};
const ip = (words) => call(['ip', ...words.split(' ')]);

// Starts this script anew in namespaces of its own, in which it is root, and ends as that does; in
// there it returns {folder}, which is taken away at the end. Where there are none to be had it
// returns {skip}: why.
export async function enter_own_namespaces(file) {
  const given = process.env.WELLSPRING_OWN_NAMESPACES;
  if (given) {
    // Whoever started it holds the other end: all of it ends with them, however they end.
    process.stdin.on('end', () => process.exit(1)).resume().unref();
    return { folder: given };
  }
  const words = ['--map-root-user', '--net', '--mount', '--pid', '--fork', '--kill-child',
    '--mount-proc'];
  const tried = spawnSync('unshare', [...words, 'sh', '-c',
    'mount -t tmpfs tmpfs /run && ip netns add tried'], { encoding: 'utf8' });
  if (tried.status !== 0)
    return { skip: `no network namespaces here: ${tried.error?.message ?? tried.stderr.trim()}` };
  const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
  const child = spawn('unshare', [...words, process.execPath, file], {
    stdio: ['pipe', 'inherit', 'inherit'],
    env: { ...process.env, WELLSPRING_OWN_NAMESPACES: folder } });
  const status = await new Promise((resolve) => child.on('close', resolve));
  rmSync(folder, { recursive: true, force: true });  // what was mounted in it is gone by now
  return process.exit(status ?? 1);
}

// Makes the net that joins the machines, with this script on it. `names`: {name: address}, as
// /etc/hosts has them on every machine.
export function make_net(folder, names) {
  call(['mount', '-t', 'tmpfs', 'tmpfs', '/run']);
  ip('link set lo up');
  ip('link add museum type bridge');
  ip(`addr add ${here}/16 dev museum`);
  ip('link set museum up');
  const lines = Object.entries({ localhost: '127.0.0.1', ...names });
  const files = { hosts: lines.map(([name, address]) => `${address} ${name}\n`).join(''),
    'resolv.conf': `nameserver ${here}\n` };
  for (const [name, text] of Object.entries(files)) {
    writeFileSync(join(folder, name), text);
    call(['mount', '--bind', join(folder, name), join('/etc', name)]);
  }
}
export const add_address = (address) => ip(`addr add ${address}/16 dev museum`);

// Reads a unit, then its drop-ins: {key: [values]}. An empty value takes away those of before.
export function read_unit(...files) {
  const unit = {};
  for (const file of files)
    for (const line of readFileSync(file, 'utf8').replaceAll('\\\n', ' ').split('\n')) {
      if (/^\s*([#;].*|\[.*\])?$/.test(line)) continue;
      const [, key, value] = /^(\w+)=(.*)$/.exec(line) ?? assert.fail(`${file}: ${line}`);
      if (value === '') unit[key] = [];
      else (unit[key] ??= []).push(value);
    }
  return unit;
}

export class Machine {
  // `last`: the last number of its address. Programs lie on it as a package installs them.
  constructor(folder, name, last) {
    this.name = name;
    this.address = network(last);
    this.root = join(folder, name);
    this.processes = new Map();
    for (const place of ['etc/wellspring', 'usr/libexec/wellspring', 'usr/share/wellspring',
      'var/lib/wellspring', 'var/cache/wellspring']) mkdirSync(join(this.root, place),
      { recursive: true });
    call(['mount', '-o', 'bind,ro', process.env.WELLSPRING_BIN,
      join(this.root, 'usr/libexec/wellspring')]);
    symlinkSync(join(source, 'web'), join(this.root, 'usr/share/wellspring/web'));
    const link = `to-${name}`;
    ip(`netns add ${name}`);
    ip(`link add ${link} type veth peer name museum netns ${name}`);
    ip(`link set ${link} master museum up`);
    ip(`-n ${name} addr add ${this.address}/16 dev museum`);
    ip(`-n ${name} link set museum up`);
    ip(`-n ${name} link set lo up`);
  }

  // Says where a place of the machine is.
  at(text) {
    return text.replaceAll(/(?<![\w./])\/(etc\/wellspring|var\/|usr\/libexec\/)/g,
        (place) => join(this.root, place));
  }
  // Installs a configuration, with lines of the house's own behind it.
  configure(name, file, lines = []) {
    const place = join(this.root, 'etc/wellspring', name);
    writeFileSync(place, this.at(readFileSync(file, 'utf8')));
    appendFileSync(place, lines.map((line) => `${line}\n`).join(''));
  }

  environment(unit) {
    const all = { PATH: `${process.env.PATH}:/usr/sbin` };
    const add = (words) => {
      const [, key, value] = /^"?(\w+)=(.*?)"?$/.exec(words) ?? assert.fail(words);
      all[key] = this.at(value.replace('%C', '/var/cache'));
    };
    for (const line of unit.Environment ?? []) line.split(/ (?=\S+=)/).forEach(add);
    for (const name of unit.EnvironmentFile ?? []) {
      const file = this.at(name.replace(/^-/, ''));
      if (name[0] === '-' && !existsSync(file)) continue;
      readFileSync(file, 'utf8').split('\n').filter((line) => /^\w/.test(line)).forEach(add);
    }
    return all;
  }

  // Starts a service as its unit says.
  start(name, unit, more = {}) {
    const [command] = unit.ExecStart;
    assert.equal(unit.ExecStart.length, 1, `${name} starts one program`);
    const words = this.at(command.replaceAll('@libexec@', '/usr/libexec/wellspring')).split(' ');
    const own = { ...unit, EnvironmentFile: unit.EnvironmentFile?.map((file) =>
      file.replaceAll('@settings@', '/etc/wellspring')) };
    const child = spawn('nsenter', [`--net=/run/netns/${this.name}`, '--', ...words],
        { env: { ...this.environment(own), ...more }, stdio: ['ignore', 'pipe', 'pipe'] });
    const process_ = { child, said: '', ended: new Promise((resolve) =>
      child.on('close', (status, signal) => resolve(signal ?? status))) };
    for (const stream of [child.stdout, child.stderr])
      stream.on('data', (chunk) => { process_.said += chunk; });
    this.processes.set(name, process_);
    return process_;
  }

  // Ends a service: resolves with its exit status, or its signal.
  stop(name, signal = 'SIGTERM') {
    const { child, ended } = this.processes.get(name);
    child.kill(signal);
    return ended;
  }
  // Pulls its plug out of the net, or puts it in again.
  plug(is_in) { ip(`-n ${this.name} link set museum ${is_in ? 'up' : 'down'}`); }
  said(name) { return this.processes.get(name).said; }
}
