// SPDX-License-Identifier: Apache-2.0
// node clients_in_states.mjs PORT: opens a connection to a server in every state there is, each
// from an address of its own, says "ready" and stays until it is killed.
import net from 'node:net';

const request = (line, rest = '') => `${line} HTTP/1.1\r\nHost: localhost\r\n${rest}\r\n`;
const upgrade = request('GET /api/v1/visit', 'Connection: Upgrade\r\nUpgrade: websocket\r\n' +
  'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n');
const text = Buffer.from(JSON.stringify(
    { type: 'hello', exhibit: '', width: 160, height: 90, lang: 'en', role: 'visitor' }));
const hello = Buffer.concat([Buffer.from([0x81, 0x80 | text.length, 0, 0, 0, 0]), text]);

// A client says the first item at once, and the others after the server's first words.
const states = [
  [''], ['G'], ['GET / HTTP/1.1\r\nHost: loc'], [request('GET /')],
  [`${request('POST /api/v1/admin/announce', 'Content-Length: 99\r\n')}{`],
  [request('GET /api/v1/exhibits/giza/still.jpg?width=64&height=64&spp=64')],
  [upgrade.slice(0, -2)],                                               // half a handshake
  [upgrade],                                                            // nothing said
  [upgrade, hello.subarray(0, 1)], [upgrade, hello.subarray(0, 20)],    // half a frame
  [upgrade, hello],                                                     // a visit
  [upgrade, hello, Buffer.from([0x01, 0x81, 0, 0, 0, 0, 0x7b])],        // half a message
  [upgrade, hello, Buffer.from([0x88, 0x80, 0, 0, 0, 0])],              // a close
];
let left = states.length;
for (const [i, [first, ...rest]] of states.entries()) {
  const socket = net.connect(
      { port: Number(process.argv[2]), host: '127.0.0.1', localAddress: `127.0.4.${i + 1}` });
  socket.on('error', () => {});
  socket.on('connect', () => {
    socket.write(first);
    if (--left === 0) console.log('ready');
  });
  if (rest.length) socket.once('data', () => { for (const part of rest) socket.write(part); });
}
