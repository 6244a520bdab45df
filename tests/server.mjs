// SPDX-License-Identifier: Apache-2.0
// Starts the real programs for the scripted tests, and speaks to them.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';
import { join } from 'node:path';

export const source = process.env.WELLSPRING_SOURCE;
export const data = process.env.WELLSPRING_DATA ?? '';
const bin = process.env.WELLSPRING_BIN;
const require = createRequire(join(process.env.WELLSPRING_NODE, 'index.js'));

// Loads a package of npm. If it is not installed the script ends, and CTest calls it skipped
// because of this text (tests.cmake).
export function load_module(name) {
  try {
    return require(name);
  } catch (error) {
    if (error.code !== 'MODULE_NOT_FOUND') throw error;
    console.log(`The package ${name} of npm is not installed, so this script is skipped.`);
    return process.exit(0);
  }
}
export const WebSocket = load_module('ws');

// Says how many times longer than usual a deadline is: programs built with a sanitizer are slower.
export const patience = Number(process.env.WELLSPRING_PATIENCE ?? 1);
// An event that has not happened by then never will, however busy the machine is.
export const deadline = 180000 * patience;  // ms
// The memory of such programs says nothing of others'.
export const judges_memory = patience === 1;
// The programs keep results here that would take each of them minutes.
const cache = process.env.WELLSPRING_CACHE;

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Waits until `holds` says so. `what` it is, text or a function that makes it, is told when it
// never does.
export async function until(holds, what = String(holds)) {
  for (const end = performance.now() + deadline; performance.now() < end; await sleep(50))
    if (await holds()) return;
  assert.fail(`never: ${what instanceof Function ? what() : what}`);
}

// These arguments are for tests that judge no picture: the server leaves the cores to the browser.
export const little_light = ['--technique', 'direct', '--still-technique', 'direct', '--no-bake',
  '--fps', '10'];

// Runs a program to its end: {status, stdout, stderr}.
export function run(name, args, { timeout = deadline } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(join(bin, name), args, { stdio: ['ignore', 'pipe', 'pipe'] });
    let stdout = '', stderr = '';
    child.stdout.on('data', (chunk) => { stdout += chunk; });
    child.stderr.on('data', (chunk) => { stderr += chunk; });
    const timer = setTimeout(() => child.kill('SIGKILL'), timeout);
    child.on('error', (error) => {  // there is no such program
      clearTimeout(timer);
      reject(error);
    });
    child.on('close', (status, signal) => {
      clearTimeout(timer);
      resolve({ status: signal ?? status, stdout, stderr });
    });
  });
}

const stop_child = (child) => (signal = 'SIGTERM') => new Promise((done) => {
  if (child.exitCode !== null || child.signalCode !== null) return done(child.exitCode);
  child.on('close', (status) => done(status));
  child.kill(signal);
});

// A server that may not have loaded yet: {child, stop()}.
export function start_program(args,
    { content = join(source, 'content'), programs = bin, places = true, prefix = [] } = {}) {
  const command = [...prefix, join(programs, 'wellspring_server'),
    ...places ? ['--content', content, '--web', join(source, 'web')] : [], ...args];
  const child = spawn(command[0], command.slice(1), { stdio: ['ignore', 'pipe', 'pipe'] });
  return { child, stop: stop_child(child) };
}

// A running server: {port, url, ws, child, stop()}. Resolves when it has printed its address.
// Serves the castle where nothing else is said. `places` false: it finds content and pages itself.
// `prefix`: a command that starts it, as `ip netns exec` does. Nobody waits for a seat, however
// busy the machine is, unless the test says at which rate.
export function start_server(words = [],
    { port = 0, content, programs = bin, places = true, prefix = [] } = {}) {
  const args = content || words.includes('--exhibit') ? [...words]
      : ['--exhibit', 'castle', ...words];
  if (!args.includes('--least-fps')) args.push('--least-fps', '0.01');
  if (cache && !args.includes('--cache')) args.push('--cache', cache);
  content ??= join(source, 'content');
  return new Promise((resolve, reject) => {
    const { child, stop } =
        start_program(['--port', String(port), ...args], { content, programs, places, prefix });
    let stdout = '', stderr = '';
    const timer = setTimeout(() => {
      child.kill('SIGKILL');
      reject(new Error(`no address within ${deadline} ms\n${stderr}`));
    }, deadline);
    child.stderr.on('data', (chunk) => { stderr += chunk; });
    child.on('error', reject);  // there is no such program
    child.on('close', (status) => {
      clearTimeout(timer);
      reject(new Error(`server ended with ${status}\n${stderr}`));
    });
    child.stdout.on('data', (chunk) => {
      stdout += chunk;
      const match = /http(s?):\/\/[^:]+:(\d+)\//.exec(stdout);
      if (!match) return;
      clearTimeout(timer);
      const found = Number(match[2]), place = `${match[1]}://127.0.0.1:${found}`;
      resolve({
        child, port: found, url: `http${place}`, ws: `ws${place}`,
        log: () => stderr, stop,
      });
    });
  });
}

// Returns the parts of a picture that is not complete: [{x, y, width, height, jpeg}]; else null.
function read_parts(bytes) {
  if (bytes[25] & 2) return null;
  let at = bytes.readUInt16LE(26);
  return Array.from({ length: bytes.readUInt16LE(28) }, (_, i) => {
    const [x, y, width, height] = [0, 2, 4, 6].map((k) => bytes.readUInt16LE(30 + 12 * i + k));
    const jpeg = bytes.subarray(at, at += bytes.readUInt32LE(38 + 12 * i));
    return { x, y, width, height, jpeg };
  });
}

export function read_picture(bytes) {
  if (bytes.length < 28 || bytes.toString('latin1', 0, 4) !== 'WSF1') return null;
  return {
    frame: bytes.readUInt32LE(4), seq: bytes.readUInt32LE(8), time_us: bytes.readBigUInt64LE(12),
    width: bytes.readUInt16LE(20), height: bytes.readUInt16LE(22), quality: bytes[24],
    flags: bytes[25],
    header: bytes.readUInt16LE(26), jpeg: bytes.subarray(bytes.readUInt16LE(26)),
    parts: read_parts(bytes), bytes: bytes.length,
  };
}

// A piece of an utterance, or null.
export function read_sound(bytes) {
  if (bytes.length < 56 || bytes.toString('latin1', 0, 4) !== 'WSA1') return null;
  const pcm = bytes.subarray(bytes.readUInt16LE(26));
  return {
    utterance: bytes.readUInt32LE(4), start: bytes.readUInt32LE(8),
    time_us: Number(bytes.readBigUInt64LE(12)),
    total: bytes.readUInt32LE(20), channels: bytes[24], rate: bytes.readUInt32LE(28),
    mouth: [32, 40, 48].map((at) => bytes.readDoubleLE(at)),
    samples: Array.from({ length: pcm.length / 2 }, (_, i) => pcm.readInt16LE(2 * i)),
  };
}

// A scripted visitor: collects messages and pictures, acknowledges every picture.
export class Visitor {
  constructor(server, { path = '/api/v1/visit', protocol = 'wellspring.v1', acknowledge = true,
    options = {} } = {}) {
    this.messages = [];
    this.pictures = 0;
    this.sounds = [];
    this.waiting = [];
    this.socket = new WebSocket(server.ws + path, protocol, options);
    this.closed = new Promise((resolve) =>
        this.socket.on('close', (code, reason) => resolve({ code, reason: String(reason) })));
    this.socket.on('error', () => {});
    this.opened = new Promise((resolve, reject) => {
      this.socket.on('open', resolve);
      this.socket.on('error', reject);
    });
    this.socket.on('message', (bytes, binary) => {
      const sound = binary && read_sound(bytes);
      const item = sound ? { sound, at: performance.now() }
          : binary ? { picture: read_picture(bytes), binary: bytes, at: performance.now() }
          : { message: JSON.parse(String(bytes)) };
      if (sound) {
        this.sounds.push(sound);
      } else if (binary) {
        this.pictures++;
        this.last = item.picture;
        if (acknowledge)
          this.send({ type: 'ack', frame: item.picture.frame, decoded_ms: 1, shown: true });
      } else {
        this.messages.push(item.message);
      }
      this.waiting = this.waiting.filter((waiter) => !waiter(item));
    });
  }
  send(message) {
    if (this.socket.readyState === WebSocket.OPEN)
      this.socket.send(typeof message === 'string' ? message : JSON.stringify(message));
  }
  // Resolves with the first item from now on that `test` accepts.
  next(test, what = 'an expected message') {
    return new Promise((resolve, reject) => {
      const late = () => reject(new Error(`no ${what} within ${deadline} ms`));
      const timer = setTimeout(late, deadline).unref();  // who waits no more is not waited for
      this.waiting.push((item) => {
        if (!test(item)) return false;
        clearTimeout(timer);
        resolve(item);
        return true;
      });
    });
  }
  message(type, test = () => true) {
    const wanted = (item) => item.message?.type === type && test(item.message);
    return this.next(wanted, `message ${type}`).then((item) => item.message);
  }
  picture(test = () => true) {
    return this.next((item) => item.picture && test(item.picture), 'picture')
        .then((item) => item.picture);
  }
  async hello(fields = {}) {
    await this.opened;
    const welcome = this.message('welcome');
    this.send({
      type: 'hello', exhibit: '', width: 320, height: 180, lang: 'en', role: 'visitor', ...fields,
    });
    const closed = this.closed.then(({ code }) => { throw new Error(`closed with ${code}`); });
    return Promise.race([welcome, closed]);
  }
  close() { this.socket.close(); return this.closed; }
}
