// SPDX-License-Identifier: Apache-2.0
// TLS by the server itself: pages and visits, what is refused, and a certificate that is renewed
// while visitors are there.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import https from 'node:https';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import tls from 'node:tls';
import { launch, skip } from '../browser/chromium.mjs';
import { Visitor, run, source, start_server, until } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-tls-'));
const path = (name) => join(folder, name);
const cert = path('cert.pem'), key = path('key.pem');
let server, ca;

// A certificate that signs itself, for museum.test and 127.0.0.1.
function make_certificate(name) {
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256',
    '-nodes', '-days', '2', '-subj', `/CN=${name}`, '-addext',
    'subjectAltName=DNS:museum.test,IP:127.0.0.1', '-keyout', path(`${name}.key`), '-out',
    path(`${name}.crt`)], { stdio: 'ignore' });
  return readFileSync(path(`${name}.crt`));
}

before(async () => {
  ca = [make_certificate('first'), make_certificate('second')];
  copyFileSync(path('first.crt'), cert);
  copyFileSync(path('first.key'), key);
  const content = path('content');
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  server = await start_server(['--exhibit', 'giza', '--tls-cert', cert, '--tls-key', key],
      { content });
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true });
});

// One reply: {status, headers, body}.
function ask(url, options = {}) {
  const { request } = url.startsWith('https') ? https : http;
  return new Promise((resolve, reject) => {
    const asked = request(url, { ca, agent: false, ...options }, (reply) => {
      const parts = [];
      reply.on('data', (part) => parts.push(part));
      reply.on('end', () => resolve({ status: reply.statusCode, headers: reply.headers,
        body: Buffer.concat(parts) }));
    });
    asked.on('error', reject);
    asked.end();
  });
}

// Returns the end of a handshake: {protocol, cipher, name}, or the error's code.
function shake_hands(options = {}) {
  return new Promise((resolve) => {
    const socket = tls.connect({ host: '127.0.0.1', port: server.port, ca, ...options }, () => {
      resolve({ protocol: socket.getProtocol(), cipher: socket.getCipher().name,
        alpn: socket.alpnProtocol, name: socket.getPeerCertificate().subject.CN });
      socket.destroy();
    });
    socket.on('error', (error) => resolve(error.code));
  });
}

test('pages and files come whole, with the header that asks for TLS from now on', async () => {
  assert.ok(server.url.startsWith('https://'));
  const page = await ask(`${server.url}/`);
  assert.equal(page.status, 200);
  assert.match(page.headers['strict-transport-security'], /^max-age=\d{8}/);
  const plain = `http://127.0.0.1:${server.port}`;
  for (const file of ['/visit.js', '/api/v1/']) {
    const here = await ask(plain + file);  // loopback alone may do without TLS
    assert.equal(here.status, 200);
    assert.equal(here.headers['strict-transport-security'], undefined);
    assert.ok((await ask(server.url + file)).body.equals(here.body), file);
  }
});

test('only sound versions and ciphers', async () => {
  assert.equal((await shake_hands()).protocol, 'TLSv1.3');
  const older = await shake_hands({ maxVersion: 'TLSv1.2' });
  assert.equal(older.protocol, 'TLSv1.2');
  assert.match(older.cipher, /^ECDHE-ECDSA-.*(GCM|POLY1305)/);
  assert.equal((await shake_hands({ ALPNProtocols: ['h2', 'http/1.1'] })).alpn, 'http/1.1');
  const weak = { minVersion: 'TLSv1', maxVersion: 'TLSv1.1', ciphers: 'DEFAULT@SECLEVEL=0' };
  assert.match(await shake_hands(weak), /ALERT|VERSION/);
  for (const ciphers of ['ECDHE-ECDSA-AES128-SHA', 'ECDHE-ECDSA-AES256-SHA384'])
    assert.match(await shake_hands({ maxVersion: 'TLSv1.2', ciphers }), /HANDSHAKE_FAILURE/);
  assert.match(await shake_hands({ ALPNProtocols: ['h2'] }), /NO_APPLICATION_PROTOCOL/);
});

test('strangers who do without TLS are sent to it', async () => {
  const from = { localAddress: '127.0.0.2' };
  const reply = await ask(`http://127.0.0.1:${server.port}/kiosk?a=b`, from);
  assert.equal(reply.status, 308);
  assert.equal(reply.headers.location, `https://127.0.0.1:${server.port}/kiosk?a=b`);
  assert.equal((await ask(`${server.url}/kiosk`, from)).status, 200);
});

test('what is no handshake harms nobody', async () => {
  for (const bytes of [Buffer.from([22]), Buffer.from([22, 3, 1, 0, 4, 1, 0, 0, 0]),
    Buffer.from([22, ...Array(300).fill(255)]), Buffer.from([0x80, 0x2e, 1, 3, 1])])
    await new Promise((resolve) => {
      const socket = http.Agent.prototype.createConnection.call(null,
          { host: '127.0.0.1', port: server.port });
      socket.on('error', () => {});
      socket.on('close', resolve);
      socket.on('data', () => {});
      socket.end(bytes);
    });
  assert.equal((await ask(`${server.url}/healthz`)).status, 200);
});

test('the page opens its visit over TLS, too', { skip }, async () => {
  const browser = await launch();
  try {
    const page = await (await browser.newContext({ ignoreHTTPSErrors: true })).newPage();
    const problems = [];
    page.on('pageerror', (error) => problems.push(String(error)));
    page.on('console', (said) => { if (said.type() === 'error') problems.push(said.text()); });
    const visit = page.waitForEvent('websocket');
    await page.goto(`${server.url}/`);
    const socket = await visit;
    assert.ok(socket.url().startsWith('wss://127.0.0.1'), socket.url());
    await socket.waitForEvent('framereceived', {
      predicate: ({ payload }) => payload.subarray?.(0, 4).toString('latin1') === 'WSF1' });
    assert.deepEqual(problems, []);
  } finally {
    await browser.close();
  }
});

// Runs a kiosk's program until its log matches `wanted`, or for a minute; returns the log.
function kiosk_says(address, args, wanted) {
  return new Promise((resolve) => {
    const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
        ['--camera', 'synthetic', '--loop', '--server', address, ...args]);
    let said = '';
    const timer = setTimeout(() => child.kill('SIGKILL'), 60000);
    child.stderr.on('data', (chunk) => {
      said += chunk;
      if (wanted.test(said)) child.kill('SIGTERM');
    });
    child.on('close', () => { clearTimeout(timer); resolve(said); });
  });
}

test('a kiosk program comes by TLS, and only to whom it can trust', async () => {
  const address = `wss://127.0.0.1:${server.port}`;
  const good = /connected to wss:\/\/127\.0\.0\.1/;
  assert.match(await kiosk_says(address, ['--ca-file', path('first.crt')], good), good);
  for (const [where, args, wanted] of [
    [address, [], /not accepted: self[- ]signed certificate.*--ca-file FILE/],
    [address, ['--ca-file', path('second.crt')], /not accepted: (self[- ]signed|unable to get)/],
    [`wss://localhost:${server.port}`, ['--ca-file', path('first.crt')],
      /not accepted: hostname mismatch/i],
    [address, ['--ca-file', path('first.key')], /first\.key: no certificates in PEM/],
  ]) assert.match(await kiosk_says(where, args, wanted), wanted);
});

test('a certificate is renewed under a visit; a bad one is refused', async () => {
  const visitor = new Visitor(server, { options: { ca } });
  await visitor.hello();
  await visitor.picture();
  assert.equal((await shake_hands()).name, 'first');
  copyFileSync(path('second.crt'), cert);  // its key comes later: both are read then
  copyFileSync(path('second.key'), key);
  await until(async () => (await shake_hands()).name === 'second', server.log);
  // Asked for, it is read whether it has changed or not.
  const readings = () => server.log().split('read anew').length - 1;
  const read = readings();
  server.child.kill('SIGHUP');
  await until(() => readings() > read, server.log);
  assert.equal((await shake_hands()).name, 'second');
  writeFileSync(cert, 'no certificate\n');
  await until(() => server.log().includes('the old one stays'), server.log);
  assert.match(server.log(), /cert\.pem: no certificate in PEM/);
  assert.equal((await shake_hands()).name, 'second');
  const next = visitor.picture((picture) => picture.seq === 1);
  visitor.send({ type: 'input', seq: 1, move: [0, 0, 0], look: [0.3, 0] });
  await next;
  await visitor.close();
  assert.ok(!server.log().includes('PRIVATE'));
});

test('a key of another certificate, or none, is an error that names the file', async () => {
  const args = ['--content', join(source, 'content'), '--web', join(source, 'web'), '--port', '0',
    '--tls-cert', path('first.crt')];
  const wrong = await run('wellspring_server', [...args, '--tls-key', path('second.key')]);
  assert.equal(wrong.status, 1);
  assert.match(wrong.stderr, /second\.key: no key in PEM that belongs to .*first\.crt/);
  const none = await run('wellspring_server', args);
  assert.equal(none.status, 1);
  assert.match(none.stderr, /both a certificate and its key/);
});
