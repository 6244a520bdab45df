// SPDX-License-Identifier: Apache-2.0
// The configurations of deploy/ for reverse proxies, as they are but for ports and files: the page,
// a visit, whom the server sees, and what the proxies refuse.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import https from 'node:https';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, source, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-proxy-'));
const path = (name) => join(folder, name);
const from = { localAddress: '127.0.0.9' };  // a visitor who is not this machine
let server, ca;

before(async () => {
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256',
    '-nodes', '-days', '2', '-subj', '/CN=museum.example', '-addext',
    'subjectAltName=IP:127.0.0.1', '-keyout', path('site.key'), '-out', path('site.crt')],
  { stdio: 'ignore' });
  ca = readFileSync(path('site.crt'));
  writeFileSync(path('site.pem'), [ca, readFileSync(path('site.key'))].join(''));
  const content = path('content');
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  server = await start_server(['--exhibit', 'giza', '--trusted-proxy', '127.0.0.1'], { content });
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true });
});

// Two ports that nobody listens on.
async function free_ports() {
  const listening = await Promise.all([0, 0].map(() => new Promise((resolve) => {
    const one = net.createServer().listen(0, '127.0.0.1', () => resolve(one));
  })));
  const ports = listening.map((one) => one.address().port);
  await Promise.all(listening.map((one) => new Promise((done) => one.close(done))));
  return ports;
}

// The file with every one of `changes` ([what is there, what is there instead]) made, each of which
// must be possible.
function adapt(file, changes) {
  let text = readFileSync(join(source, 'deploy', file), 'utf8');
  for (const [there, instead] of changes) {
    assert.ok(text.includes(there), `${file} has no '${there}'`);
    text = text.replaceAll(there, instead);
  }
  writeFileSync(path(file), text);
  return path(file);
}

const proxies = {
  nginx: ([plain, secure]) => {
    const site = adapt('nginx.conf', [['listen 80;', `listen 127.0.0.1:${plain};`],
      ['listen 443 ', `listen 127.0.0.1:${secure} `],
      ['127.0.0.1:8080', `127.0.0.1:${server.port}`],
      ['/etc/ssl/museum.example.crt', path('site.crt')],
      ['/etc/ssl/private/museum.example.key', path('site.key')]]);
    mkdirSync(path('nginx'));
    const temporary = ['client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi']
        .map((name) => `${name}_temp_path ${path('nginx')}/${name};`).join(' ');
    writeFileSync(path('whole.conf'), `daemon off; pid ${path('nginx.pid')}; error_log stderr;
      events {} http { access_log off; ${temporary} include ${site}; }`);
    return ['-p', path('nginx'), '-e', 'stderr', '-c', path('whole.conf')];
  },
  haproxy: ([plain, secure]) => ['-db', '-f', adapt('haproxy.cfg', [
    ['bind :80', `bind 127.0.0.1:${plain}`], ['bind :443 ', `bind 127.0.0.1:${secure} `],
    ['127.0.0.1:8080', `127.0.0.1:${server.port}`],
    ['/etc/haproxy/museum.example.pem', path('site.pem')]])],
};

function ask(url, options = {}) {
  return new Promise((resolve, reject) => {
    const { request } = url.startsWith('https') ? https : http;
    request(url, { ca, agent: false, ...from, ...options }, (reply) => {
      let body = '';
      reply.on('data', (part) => { body += part; });
      reply.on('end', () => resolve({ status: reply.statusCode, headers: reply.headers, body }));
    }).on('error', reject).end();
  });
}

for (const [name, configure] of Object.entries(proxies)) {
  test(`a visit through ${name}`, async (t) => {
    const program = ['/usr/sbin', '/usr/bin', '/usr/local/sbin'].map((place) => join(place, name))
        .find((file) => spawnSync(file, ['-v']).status === 0);
    if (!program) return t.skip(`${name} is not installed`);
    const ports = await free_ports();
    const child = spawn(program, configure(ports), { stdio: ['ignore', 'pipe', 'pipe'] });
    let said = '';
    for (const stream of [child.stdout, child.stderr])
      stream.on('data', (part) => { said += part; });
    const ended = new Promise((resolve) => child.on('close', resolve));
    try {
      const [plain, secure] = ports, url = `https://127.0.0.1:${secure}`;
      let page;
      for (let i = 0; i < 100 && page?.status !== 200; i++) {  // until it listens, and has looked
        assert.equal(child.exitCode, null, said);
        page = await ask(`${url}/`).catch(() => sleep(100));
      }
      assert.equal(page?.status, 200, said);
      assert.match(page.body, /<html/);
      assert.match(page.headers['strict-transport-security'], /^max-age=31536000/);
      assert.match(page.headers['content-security-policy'], /^default-src 'none'/);
      const sent = await ask(`http://127.0.0.1:${plain}/kiosk?a=b`);
      assert.equal(sent.status, 308);
      assert.match(sent.headers.location, /^https:\/\/127\.0\.0\.1.*\/kiosk\?a=b$/);
      const foreign_name = { headers: { host: 'evil.example' }, checkServerIdentity: () => {} };
      assert.equal((await ask(`${url}/`, foreign_name)).status, 421);

      const place = { ws: `wss://127.0.0.1:${secure}` };
      const options = { ca, ...from, origin: url, headers: { 'X-Forwarded-For': '127.0.0.1' } };
      const visitor = new Visitor(place, { options });
      await visitor.hello();
      await visitor.picture();
      const next = visitor.picture((picture) => picture.seq === 1);
      visitor.send({ type: 'input', seq: 1, move: [0, 0, 0], look: [0.3, 0] });
      await next;
      await visitor.close();
      assert.match(server.log(), /joined from 127\.0\.0\.0\/24 by 127\.0\.0\.1:/);
      assert.doesNotMatch(server.log(), /joined from 127\.0\.0\.1:/);
      const evil = { ...options, origin: 'https://evil.example' };
      const foreign = new Visitor(place, { options: evil });
      await assert.rejects(foreign.opened, /403/);
    } finally {
      child.kill('SIGTERM');
      await ended;
    }
  });
}
