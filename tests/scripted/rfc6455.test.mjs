// SPDX-License-Identifier: Apache-2.0
// RFC 6455 over a raw socket: what a server must take, answer and refuse, a row for each rule.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { patience, run, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-rfc6455-'));
const at_a_time = 8;
let server;
before(async () => {
  const content = join(folder, 'content');
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  server = await start_server(['--exhibit', 'giza', '--max-visitors', '200'], { content });
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true });
});

const fin = 0x80, text = 1, binary = 2, close = 8, ping = 9, pong = 10, more = 0;
const limit = 65536;  // bytes of a message

// A frame of a client. `size`: how the length is written (7, 16 or 64 bits); `length`: what is
// said of it.
function frame(first, payload = '', { masked = true, size, length } = {}) {
  const body = Buffer.from(payload), says = length ?? body.length;
  size ??= says < 126 ? 7 : says < 65536 ? 16 : 64;
  const head = Buffer.alloc(size === 7 ? 2 : size === 16 ? 4 : 10);
  head[0] = first;
  head[1] = (masked ? 0x80 : 0) | (size === 7 ? says : size === 16 ? 126 : 127);
  if (size === 16) head.writeUInt16BE(says, 2);
  if (size === 64) head.writeBigUInt64BE(BigInt(says), 2);
  const mask = Buffer.from([0x11, 0x92, 0xe3, 0x44]);
  if (!masked) return Buffer.concat([head, body]);
  return Buffer.concat([head, mask, body.map((byte, i) => byte ^ mask[i % 4])]);
}
const code = (number, reason = '') =>
  Buffer.concat([Buffer.from([number >> 8, number & 255]), Buffer.from(reason)]);

// A message that the server answers by an error that repeats `type`.
const message = (type) => JSON.stringify({ type });
// The same, `bytes` long.
const long_message = (bytes) => message('long').padEnd(bytes, ' ');
const whole = (type) => frame(fin | text, message(type));
const bytes = (...numbers) => Buffer.from(numbers);
// A text that is right but for what the bytes mean.
const around = (wrong) => Buffer.concat([Buffer.from('{"type":"'), wrong, Buffer.from('"}')]);
const cut = (buffer, ...places) =>
  [0, ...places].map((begin, i) => buffer.subarray(begin, places[i] ?? buffer.length));
// The bytes of a text as fragments.
const fragments = (...parts) => Buffer.concat(parts.map((part, i) =>
  frame((i === parts.length - 1 ? fin : 0) | (i === 0 ? text : more), part)));

// Name, what is sent (a list: one after the other), and what comes: a close code, or a list of
// frames in their order: ['pong', payload], ['answer', text that an error's message holds].
const rows = [
  ['an empty text', frame(fin | text), [['answer', 'not JSON']]],
  ...[125, 126, 127, 128].map((size) =>
    [`a text of ${size} bytes`, frame(fin | text, long_message(size)), [['answer', 'long']]]),
  // A frame as any other, though no page says so much.
  ...[65535, limit].map((size) =>
    [`a text of ${size} bytes`, frame(fin | text, long_message(size)),
      [['answer', 'of more than']]]),
  [`a text of ${limit + 1} bytes`, frame(fin | text, long_message(limit + 1)), 1009],
  ['a huge length, by its header alone',
    frame(fin | text, '', { size: 64, length: 2 ** 40 }), 1009],
  ['a length with its highest bit set',
    frame(fin | text, '', { size: 64, length: 2n ** 63n }), 1009],
  ['16 bits for a short length', frame(fin | text, 'x', { size: 16 }), 1002],
  ['64 bits for a short length', frame(fin | text, 'x', { size: 64 }), 1002],
  ['64 bits for a length of 16', frame(fin | text, 'x'.repeat(300), { size: 64 }), 1002],
  ['byte by byte', cut(whole('slow'), ...Array.from({ length: 20 }, (_, i) => i + 1)),
    [['answer', 'slow']]],
  ['two texts in one piece', Buffer.concat([whole('one'), whole('two')]),
    [['answer', 'one'], ['answer', 'two']]],
  ...[[text, 'text'], [ping, 'ping'], [pong, 'pong'], [close, 'close']].map(([opcode, name]) =>
    [`an unmasked ${name}`, frame(fin | opcode, '', { masked: false }), 1002]),
  ...[0x40, 0x20, 0x10, 0x70].map((bits) =>
    [`reserved bits ${bits} on a text`, frame(fin | bits | text, 'x'), 1002]),
  ['a reserved bit on a ping', frame(fin | 0x40 | ping, 'x'), 1002],
  ['a reserved bit on a continuation',
    Buffer.concat([frame(text, '{'), frame(fin | 0x40, '}')]), 1002],
  ...[3, 4, 5, 6, 7, 11, 12, 13, 14, 15].map((opcode) =>
    [`opcode ${opcode}`, frame(fin | opcode, 'x'), 1002]),
  ['a binary message', frame(fin | binary, 'x'), 1003],
  ['a binary message in fragments', Buffer.concat([frame(binary, 'x'), frame(fin, 'y')]), 1003],

  ['two fragments', fragments('{"type":', '"pieces"}'), [['answer', 'pieces']]],
  ['a fragment for each byte', fragments(...message('bytes')), [['answer', 'bytes']]],
  ['empty fragments at the begin, between and at the end',
    fragments('', '{"type":', '', '', '"empty"}', ''), [['answer', 'empty']]],
  ['only empty fragments', fragments('', '', ''), [['answer', 'not JSON']]],
  ['pings and pongs between fragments', Buffer.concat([frame(text, '{"type":'),
    frame(fin | ping, 'a'), frame(more, '"mid'), frame(fin | pong, 'b'), frame(fin | ping, 'c'),
    frame(fin, 'st"}')]), [['pong', 'a'], ['pong', 'c'], ['answer', 'midst']]],
  ['a continuation of nothing', frame(fin, 'x'), 1002],
  ['a continuation of nothing, with more to come', frame(more, 'x'), 1002],
  ['a continuation after a whole message', Buffer.concat([whole('x'), frame(fin, 'y')]), 1002],
  ['a text within a text', Buffer.concat([frame(text, '{'), whole('x')]), 1002],
  ['a binary message within a text',
    Buffer.concat([frame(text, '{'), frame(fin | binary, 'x')]), 1002],
  ...[[ping, 'ping'], [pong, 'pong'], [close, 'close']].map(([opcode, name]) =>
    [`a fragmented ${name}`, frame(opcode), 1002]),
  ['fragments that are too much together', Buffer.concat([frame(text, 'x'.repeat(limit / 2)),
    frame(more, 'x'.repeat(limit / 2)), frame(fin, 'x')]), 1009],

  ['an empty ping', frame(fin | ping), [['pong', '']]],
  ['a ping of 125 bytes', frame(fin | ping, 'p'.repeat(125)), [['pong', 'p'.repeat(125)]]],
  ['a ping that is not UTF-8', frame(fin | ping, bytes(0xff, 0, 0xfe)),
    [['pong', bytes(0xff, 0, 0xfe)]]],
  ['a ping in pieces', cut(frame(fin | ping, 'pieces'), 1, 3, 7, 9), [['pong', 'pieces']]],
  ['ten pings', Buffer.concat([...'0123456789'].map((digit) => frame(fin | ping, digit))),
    [...'0123456789'].map((digit) => ['pong', digit])],
  ['a pong that nobody asked for', Buffer.concat([frame(fin | pong, 'x'), whole('after')]),
    [['answer', 'after']]],
  ...[[ping, 'ping'], [pong, 'pong'], [close, 'close']].map(([opcode, name]) =>
    [`a ${name} of 126 bytes`, frame(fin | opcode, 'p'.repeat(126)), 1002]),

  ...[['two bytes', 'é'], ['three bytes', '€'], ['four bytes', '😀'], ['the last one', '\u{10ffff}'],
    ['no character, but valid', '\uffff'], ['before the surrogates', '\ud7ff'],
    ['after the surrogates', '\ue000']].map(([name, character]) =>
    [`UTF-8: ${name}`, frame(fin | text, message(character)), [['answer', character]]]),
  ['UTF-8: a character in two fragments', fragments(...cut(around(Buffer.from('😀')), 11)),
    [['answer', '😀']]],
  ...[['a continuation alone', bytes(0x80)], ['a start alone', bytes(0xc3)],
    ['an overlong slash', bytes(0xc0, 0xaf)], ['overlong in three', bytes(0xe0, 0x80, 0xaf)],
    ['overlong in four', bytes(0xf0, 0x80, 0x80, 0xaf)], ['a surrogate', bytes(0xed, 0xa0, 0x80)],
    ['a pair of surrogates', bytes(0xed, 0xa0, 0xbd, 0xed, 0xb8, 0x80)],
    ['beyond the last', bytes(0xf4, 0x90, 0x80, 0x80)], ['five bytes', bytes(0xf8, 0x88, 0x80, 0x80,
      0x80)], ['FE', bytes(0xfe)], ['FF', bytes(0xff)]].map(([name, wrong]) =>
    [`not UTF-8: ${name}`, frame(fin | text, around(wrong)), 1007]),
  ['not UTF-8: ends within a character', frame(fin | text, bytes(0x7b, 0xe2, 0x82)), 1007],
  ['not UTF-8: split over fragments',
    Buffer.concat([frame(text, bytes(0xed)), frame(fin, bytes(0xa0, 0x80))]), 1007],
  ['not UTF-8: in a first fragment, at once', frame(text, around(bytes(0xff))), 1007],
  ['not UTF-8: in a frame that has not ended, at once',
    frame(fin | text, around(bytes(0xff)), { length: 125 }), 1007],

  ['a close without a code', frame(fin | close), 1000],
  ...[1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999].map((number) =>
    [`close code ${number}`, frame(fin | close, code(number)), number]),
  ['a close with a reason of 123 bytes', frame(fin | close, code(1000, 'r'.repeat(123))), 1000],
  ['a close with half a code', frame(fin | close, bytes(3)), 1002],
  ...[0, 999, 1004, 1005, 1006, 1015, 1016, 1100, 2000, 2999].map((number) =>
    [`close code ${number}, which nobody may send`, frame(fin | close, code(number)), 1002]),
  ...[5000, 65535].map((number) => [`close code ${number}, of which the RFC says nothing`,
    frame(fin | close, code(number)), [number, 1002]]),
  ['a reason that is not UTF-8',
    frame(fin | close, Buffer.concat([code(1000), bytes(0xff)])), [1002, 1007]],
  ['what comes after a close is not read', Buffer.concat([frame(fin | close, code(1000)),
    whole('late'), frame(fin | ping, 'late')]), 1000],
  ['two closes', Buffer.concat([frame(fin | close, code(1001)), frame(fin | close, code(1000))]),
    1001],
  ['a close between fragments',
    Buffer.concat([frame(text, '{"type":'), frame(fin | close, code(1000))]), 1000],
];

// Frames of a server: {opcode, payload, fin, masked}; takes what is whole off the front of `input`.
function take_frames(input) {
  const frames = [];
  while (input.bytes.length >= 2) {
    const [first, second] = input.bytes;
    const size = second & 0x7f, head = size === 126 ? 4 : size === 127 ? 10 : 2;
    if (input.bytes.length < head) break;
    const length = size === 126 ? input.bytes.readUInt16BE(2)
        : size === 127 ? Number(input.bytes.readBigUInt64BE(2)) : size;
    if (input.bytes.length < head + length) break;
    frames.push({ fin: first & fin, reserved: first & 0x70, opcode: first & 15, masked: second >> 7,
      payload: input.bytes.subarray(head, head + length) });
    input.bytes = input.bytes.subarray(head + length);
  }
  return frames;
}

// All frames that come until there are `wanted` of those that count, or the connection has ended.
// A close is answered; then the server must end the connection.
function talk(sent, wanted) {
  return new Promise((resolve, reject) => {
    const socket = net.connect(server.port, '127.0.0.1');
    const input = { bytes: Buffer.alloc(0) }, frames = [];
    const pieces = [sent].flat();
    let open = false, said_close = false;
    const timer = setTimeout(
        () => socket.destroy(new Error('nothing more in time')), 30000 * patience);
    const done = (error) => {
      clearTimeout(timer);
      if (error) reject(error);
      else resolve(frames);
    };
    const send_piece = () => {
      if (pieces.length === 0 || socket.destroyed) return;
      socket.write(pieces.shift());
      setImmediate(send_piece);
    };
    socket.setNoDelay(true);
    socket.write('GET /api/v1/visit HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n' +
      'Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n' +
      'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n');
    socket.on('data', (chunk) => {
      input.bytes = Buffer.concat([input.bytes, chunk]);
      if (!open) {
        const end = input.bytes.indexOf('\r\n\r\n');
        if (end < 0) return;
        const head = input.bytes.toString('latin1', 0, end);
        if (!head.startsWith('HTTP/1.1 101')) return socket.destroy(new Error(head));
        input.bytes = input.bytes.subarray(end + 4);
        open = true;
        send_piece();
      }
      for (const one of take_frames(input)) {
        if (one.opcode === ping) continue;  // by which the server measures the line
        frames.push(one);
        if (one.opcode === close && !said_close) {
          said_close = true;
          socket.write(frame(fin | close, one.payload));
        }
      }
      if (frames.filter(({ opcode }) => opcode !== close).length >= wanted) socket.destroy();
    });
    socket.on('error', (error) => { if (error.code !== 'ECONNRESET') done(error); });
    socket.on('end', () => socket.end());
    socket.on('close', () => done());
  });
}

async function check([name, sent, expected]) {
  const codes = [expected].flat().filter((one) => typeof one === 'number');
  const answers = codes.length ? [] : expected;
  const frames = await talk(sent, codes.length ? Infinity : answers.length);
  for (const one of frames) {
    assert.ok(one.fin && !one.reserved, `${name}: a whole frame without reserved bits`);
    assert.equal(one.masked, 0, `${name}: a server masks nothing`);
  }
  const closes = frames.filter(({ opcode }) => opcode === close);
  if (codes.length) {
    assert.equal(closes.length, 1, `${name}: one close frame, of ${frames.length}`);
    assert.equal(frames.at(-1), closes[0], `${name}: nothing after the close`);
    const { payload } = closes[0];
    const number = payload.length ? payload.readUInt16BE(0) : 1000;
    assert.ok(codes.includes(number), `${name}: closed with ${number}, not ${codes}`);
    return;
  }
  assert.equal(closes.length, 0, `${name}: closed`);
  assert.equal(frames.length, answers.length, name);
  for (const [i, [kind, holds]] of answers.entries()) {
    const { opcode, payload } = frames[i];
    assert.equal(opcode, kind === 'pong' ? pong : text, `${name}: ${kind}`);
    if (kind === 'pong') assert.ok(payload.equals(Buffer.from(holds)), `${name}: its payload`);
    else assert.ok(JSON.parse(payload).message.includes(holds), `${name}: ${payload}`);
  }
}

test(`framing, fragments, control frames, UTF-8 and closes: ${rows.length} rules`, async () => {
  const wrong = [];
  const left = [...rows];
  const work = async () => {
    for (let row; (row = left.shift());)
      await check(row).catch((error) => wrong.push(error.message.split('\n')[0]));
  };
  await Promise.all(Array.from({ length: at_a_time }, work));
  assert.deepEqual(wrong, []);
  const metrics = await (await fetch(`${server.url}/metrics`)).text();
  assert.match(metrics, /^wellspring_floods_closed_total 0$/m);
});
