// SPDX-License-Identifier: Apache-2.0
// A slow line on the way to a server: a TCP proxy of so many bits a second, with delay and a queue
// of bounded length, both ways. By itself: node shaped_line.mjs PORT MBIT_S ROUND_TRIP_MS
// QUEUE_BYTES, which prints its own port and ends with its standard input.
import { createServer, connect } from 'node:net';
import { pathToFileURL } from 'node:url';

// Carries bytes from one socket to the other. line: {rate: bytes a second, delay: ms one way,
// queue: bytes}, read anew for each piece.
function carry(from, to, line) {
  let free = 0, queued = 0;  // when the line has sent all that it was given; bytes
  const pieces = [];         // in their order, whichever timer comes first
  from.on('data', (bytes) => {
    for (let at = 0; at < bytes.length; at += 1448) {  // as packets
      const piece = bytes.subarray(at, at + 1448), now = performance.now();
      free = Math.max(free, now) + 1000 * piece.length / line.rate;
      queued += piece.length;
      pieces.push(piece);
      setTimeout(() => {
        const first = pieces.shift();
        queued -= first.length;
        if (!to.destroyed) to.write(first);
        if (queued <= line.queue && from.isPaused()) from.resume();
      }, free + line.delay - now);
    }
    if (queued > line.queue) from.pause();
  });
  const end = () => setTimeout(() => to.destroy(),
      Math.max(0, free - performance.now()) + line.delay);
  from.on('close', end);
  from.on('error', end);
}

// {port, line, close()}; line may be changed at any time.
export function shape_line(port, { mbit, round_trip, queue = 64 * 1024 }) {
  const line = { rate: mbit * 1e6 / 8, delay: round_trip / 2, queue };
  const sockets = new Set();
  const server = createServer((client) => {
    const other = connect(port, '127.0.0.1');
    for (const socket of [client, other]) {
      socket.setNoDelay(true);
      sockets.add(socket);
      socket.on('close', () => sockets.delete(socket));
    }
    carry(client, other, line);
    carry(other, client, line);
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve({
    port: /** @type {import('node:net').AddressInfo} */ (server.address()).port, line,
    close() {
      for (const socket of sockets) socket.destroy();
      server.close();
    },
  })));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const [port, mbit, round_trip, queue] = process.argv.slice(2).map(Number);
  const shaped = await shape_line(port, { mbit, round_trip, queue });
  console.log(shaped.port);
  process.stdin.resume();
  process.stdin.on('data', (text) => { shaped.line.rate = Number(text) * 1e6 / 8; });
  process.stdin.on('end', () => process.exit(0));
}
