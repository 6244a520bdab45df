// SPDX-License-Identifier: Apache-2.0
// Stands between a client of NATS and its server, and makes a bad line of a good one: delays, holds
// or cuts what passes, lets little through, and doubles or mixes up messages. It knows how NATS
// frames messages, so that what arrives is well formed.
import net from 'node:net';

const with_payload = /^H?(PUB|MSG) /;  // lines that bytes follow; their number is the last word

// Cuts bytes into lines of the protocol, with the payload that belongs to them.
function take_units(state, bytes) {
  state.rest = Buffer.concat([state.rest, bytes]);
  const units = [];
  for (let end; (end = state.rest.indexOf('\r\n')) >= 0;) {
    const line = state.rest.toString('latin1', 0, end), is_message = with_payload.test(line);
    const size = end + 2 + (is_message ? Number(line.split(' ').at(-1)) + 2 : 0);
    if (state.rest.length < size) break;
    units.push({ bytes: state.rest.subarray(0, size), is_message });
    state.rest = state.rest.subarray(size);
  }
  return units;
}

export class ShapingProxy {
  // These may be changed at any time, and count for what arrives from then on.
  delay = 0;         // ms, each way
  rate = Infinity;   // bytes a second, each way
  stalled = false;   // nothing passes, and nothing is lost
  refuses = false;   // nobody connects
  copies = 1;        // times that each message passes
  shuffled = false;  // messages pass in another order than they came
  // Counts messages, there and back, that passed; and those that passed before an older one.
  messages = 0;
  overtaking = 0;

  constructor(target, listens = 0) {
    this.target = target;
    this.pairs = new Set();
    this.server = net.createServer((client) => this.join(client));
    this.opened = new Promise((resolve) =>
        this.server.listen(listens, '127.0.0.1', () => resolve(this.server.address().port)));
  }

  join(client) {
    if (this.refuses) return client.destroy();
    const server = net.connect(this.target, '127.0.0.1');
    const pair = { client, server, ways: [this.carry(client, server), this.carry(server, client)] };
    this.pairs.add(pair);
    const end = () => {
      this.pairs.delete(pair);
      for (const way of pair.ways) clearInterval(way.timer);
      client.destroy(), server.destroy();
    };
    for (const socket of [client, server]) {
      socket.setNoDelay(true);
      socket.on('error', end), socket.on('close', end);
    }
  }

  carry(from, to) {
    const way = { rest: Buffer.alloc(0), queue: [], held: [], number: 0, passed: 0, free_at: 0 };
    from.on('data', (bytes) => {
      for (const unit of take_units(way, bytes)) this.enqueue(way, unit);
      this.pass(way, to);
    });
    way.timer = setInterval(() => this.pass(way, to), 5);
    return way;
  }

  enqueue(way, unit) {
    const due = performance.now() + this.delay;
    if (!unit.is_message) return way.queue.push({ ...unit, due });
    const number = way.number++;
    for (let i = 0; i < this.copies; i++) way.held.push({ ...unit, due, number });
    way.held_since ??= performance.now();
  }

  // Mixed up are messages that come within so many milliseconds, or so many of them.
  release(way) {
    if (!way.held.length) return;
    const waits = this.shuffled && way.held.length < 8 * this.copies;
    if (waits && performance.now() - way.held_since < 100) return;
    if (this.shuffled) way.held.reverse();
    way.queue.push(...way.held.splice(0));
    way.held_since = undefined;
  }

  pass(way, to) {
    this.release(way);
    const now = performance.now();
    while (!this.stalled && way.queue.length && way.queue[0].due <= now && way.free_at <= now) {
      const { bytes, is_message, number } = way.queue.shift();
      way.free_at = Math.max(way.free_at, now - 5) + 1000 * bytes.length / this.rate;
      if (!to.destroyed) to.write(bytes);
      if (!is_message) continue;
      this.messages++;
      this.overtaking += number < way.passed;
      way.passed = Math.max(way.passed, number);
    }
  }

  // Ends all connections; clients may come again.
  cut() {
    for (const { client } of [...this.pairs]) client.destroy();
  }
  close() {
    this.cut();
    this.server.close();
  }
}
