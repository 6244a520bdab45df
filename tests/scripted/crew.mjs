// SPDX-License-Identifier: Apache-2.0
// Starts what the scripted tests of workers need: a NATS server, workers, and a visitor who walks
// and stands; and reads what a server says of them.
import { spawn, spawnSync } from 'node:child_process';
import net from 'node:net';
import { join } from 'node:path';
import { source, until } from '../server.mjs';

export const skip =
    spawnSync('nats-server', ['--version']).error ? 'nats-server is not installed' : false;
export const content = join(source, 'content');

export function free_port() {
  return new Promise((resolve) => {
    const socket = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = socket.address();
      socket.close(() => resolve(port));
    });
  });
}

// Resolves with the process when it answers.
export async function start_nats(port) {
  const nats = spawn('nats-server', ['-a', '127.0.0.1', '-p', String(port)], { stdio: 'ignore' });
  const answers = () => new Promise((resolve) => {
    const socket = net.connect(port, '127.0.0.1');
    socket.on('data', () => { socket.destroy(); resolve(true); });
    socket.on('error', () => resolve(false));
  });
  await until(answers, 'nats-server answers');
  return nats;
}

// Resolves with {child, log()} when the worker has said who it is. `prefix` is a command that
// starts it.
export function start_worker(name, port,
    { exhibits = content, cache, words = [], key = '', prefix = [], environment = {} } = {}) {
  const command = [...prefix, join(process.env.WELLSPRING_BIN, 'wellspring_worker'),
    '--nats', `nats://127.0.0.1:${port}`, '--content', exhibits, '--exhibit', 'first-room',
    '--cache', cache, '--name', name, '--cores', '1', ...words];
  const child = spawn(command[0], command.slice(1), { stdio: ['ignore', 'pipe', 'pipe'],
    env: { ...process.env, WELLSPRING_WORKERS_KEY: key, ...environment } });
  let log = '';
  child.stderr.on('data', (bytes) => { log += bytes; });
  return new Promise((resolve, reject) => {
    child.stdout.once('data', () => resolve({ child, log: () => log }));
    child.once('error', reject);
    child.once('exit', (status) =>
        reject(new Error(`worker ${name} ended with ${status}\n${log}`)));
  });
}

export const kill = (child, signal = 'SIGKILL') => new Promise((resolve) => {
  if (child.exitCode !== null || child.signalCode !== null) return resolve(child.exitCode);
  child.on('exit', (status) => resolve(status));
  child.kill(signal);
});

// Reads the server's numbers of one moment: by name, and by name and label.
export async function read_numbers(server) {
  const numbers = {};
  for (const line of (await (await fetch(`${server.url}/metrics`)).text()).split('\n')) {
    const match = /^wellspring_(workers?_\w+)(?:\{\w+="([^"]*)"\})? (\S+)$/.exec(line);
    if (match) numbers[match[2] ? `${match[1]} ${match[2]}` : match[1]] = Number(match[3]);
  }
  return numbers;
}
export async function worker_state(server, name) {
  const { workers } = await (await fetch(`${server.url}/api/v1/status`)).json();
  return workers.find((one) => one.name === name);
}

// Walks and stands in turn, so that both kinds of samples are asked for. Returns how to stop.
export function begin_to_walk(visitor) {
  let seq = 1;
  const timer = setInterval(() => {
    seq++;
    visitor.send({ type: 'input', seq, move: [0, 0, seq % 16 < 8 ? 0 : seq % 32 < 16 ? 0.4 : -0.4],
      look: [seq % 16 < 8 ? 0 : 0.02, 0] });
  }, 250);
  return () => clearInterval(timer);
}
