// SPDX-License-Identifier: Apache-2.0
// Lamps and the hour of the day over the WebSocket: who changes one is told and sent other
// pictures, nobody else.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Visitor, sleep, start_server } from '../server.mjs';

let server;
before(async () => { server = await start_server(); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

// A dark picture says less: of the same view its JPEG is smaller at the same quality. Both become
// finer with time, so that those of one moment are compared, as long as a busy machine may take.
async function assert_darker(dark, light) {
  const bytes = (visitor) => ({ size: visitor.last?.jpeg.length, quality: visitor.last?.quality });
  const is_darker = () => bytes(dark).size < 0.8 * bytes(light).size
      && bytes(dark).quality >= bytes(light).quality;
  for (let k = 0; k < 600 && !is_darker(); k++) await sleep(100);
  assert.ok(is_darker(), `${JSON.stringify(bytes(dark))} of ${JSON.stringify(bytes(light))}`);
}

test('who switches a lamp is told, and sees it; others do not', async () => {
  const one = new Visitor(server), other = new Visitor(server);
  const welcome = await one.hello(), greeted = await other.hello({ lang: 'de', role: 'kiosk' });
  assert.ok(welcome.lamps.length >= 3);
  const { name } = welcome.lamps.find((lamp) => lamp.name === 'daylight');
  assert.ok(welcome.lamps.every((lamp) => lamp.on && lamp.title && !lamp.shared));
  assert.notEqual(greeted.lamps[0].title, welcome.lamps[0].title);
  // Both visitors stand at the well: nothing moves there, so that pictures are alike but for their
  // light, and most of that light is the day's.
  for (const visitor of [one, other])
    visitor.send({ type: 'viewpoint', seq: 1, name: 'well' });
  const told = other.message('state', (message) => message.lamps[name] === false);
  other.send({ type: 'lamp', name, on: false });
  assert.equal((await told).lamps.chandeliers, true);
  await assert_darker(other, one);
  // The other's is as it was, and so is that of who comes later.
  assert.equal((await one.message('state')).lamps[name], true);
  const late = new Visitor(server);
  assert.equal((await late.hello()).lamps.find((lamp) => lamp.name === name).on, true);
  await late.close();
  const back = other.message('state', (message) => message.lamps[name]);
  other.send({ type: 'lamp', name, on: true });
  await back;
  for (const visitor of [one, other]) await visitor.close();
});

test('what is no lamp is refused', async () => {
  const visitor = new Visitor(server);
  await visitor.hello();
  for (const [message, code] of [[{ type: 'lamp', name: 'moon', on: false }, 'unknown_lamp'],
      [{ type: 'lamp', name: 'fire' }, 'bad_field'], [{ type: 'lamp', on: true }, 'bad_field']]) {
    const error = visitor.message('error');
    visitor.send(message);
    assert.equal((await error).code, code);
  }
  const about = await (await fetch(`${server.url}/api/v1/exhibits/castle`)).json();
  assert.ok(about.lamps.every((lamp) => lamp.name && lamp.title.en && lamp.on_at_first === true));
  // The server renews /metrics now and then.
  const switched = /^wellspring_lamps_switched_total 2$/m;
  const metrics = async () => (await fetch(`${server.url}/metrics`)).text();
  for (let i = 0; i < 50 && !switched.test(await metrics()); i++) await sleep(100);
  assert.match(await metrics(), switched);
  await visitor.close();
});

test('who chooses a late hour is told, and sees the evening', async () => {
  const one = new Visitor(server), other = new Visitor(server);
  const { day } = await one.hello();
  await other.hello();
  assert.ok(day.from < day.at && day.at < day.to && day.hour === day.at, JSON.stringify(day));
  for (const visitor of [one, other])
    visitor.send({ type: 'viewpoint', seq: 1, name: 'well' });
  const told = one.message('state', (message) => message.hour === day.to);
  one.send({ type: 'hour', value: day.to });
  await told;
  await assert_darker(one, other);
  assert.equal((await other.message('state')).hour, day.at);
  const error = one.message('error');
  one.send({ type: 'hour', value: 'late' });
  assert.equal((await error).code, 'bad_field');
  const back = one.message('state', (message) => message.hour === day.at);
  one.send({ type: 'hour', value: null });
  await back;
  const about = await (await fetch(`${server.url}/api/v1/exhibits/castle`)).json();
  assert.deepEqual(about.day, { from: day.from, to: day.to, at: day.at });
  for (const visitor of [one, other]) await visitor.close();
});
