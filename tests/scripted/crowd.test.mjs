// SPDX-License-Identifier: Apache-2.0
// Twenty scripted visitors who do anything that is allowed, for WELLSPRING_SOAK seconds: nobody is
// told what another asked for, nothing is refused that should not be, and nothing is left behind.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { Visitor, judges_memory, patience, sleep, start_server } from '../server.mjs';

const seconds = Number(process.env.WELLSPRING_SOAK ?? 20);
const seed = Number(process.env.WELLSPRING_SEED ?? 1);
const crowd_size = 20;
const long_enough = 300;  // seconds after which memory is judged
const warm_up = 120;      // seconds at first in which memory is not judged
const may_grow = 96;      // MiB from then on
const most_waiting = 60000;  // ms for a welcome, on cores that others use, too

let server;
before(async () => { server = await start_server(['--max-visitors', String(crowd_size + 4)]); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

// The same numbers for the same seed (mulberry32).
function make_dice(start) {
  let state = start >>> 0;
  const next = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
  return {
    next, among: (list) => list[Math.floor(next() * list.length)],
    between: (low, high) => low + (high - low) * next(),
  };
}

const resident = () => Number(/^VmRSS:\s+(\d+)/m.exec(
    readFileSync(`/proc/${server.child.pid}/status`, 'utf8'))[1]) / 1024;
const descriptors = () => readdirSync(`/proc/${server.child.pid}/fd`).length;
async function metric(name) {
  const text = await (await fetch(`${server.url}/metrics`)).text();
  return Number(new RegExp(`^wellspring_${name}(?:\\{.*\\})? (\\S+)$`, 'm').exec(text)[1]);
}

// Lists errors that may answer an order that is right: there is no way to the place, or the group
// has gone or its leader decides.
const may_refuse = {
  go: ['no_way', 'nothing_there', 'in_group'], group: ['no_group', 'unknown_group'],
  tour: ['in_group'], lamp: ['in_group'], storyteller: ['in_group'], ask: ['in_group'],
};
// Errors do not say what they answer: an order's are those that it and what is under way may get.
const settled = 5000;  // ms after which an order is no longer under way

const codes = new Set();  // codes of groups that are led

class Guest {
  constructor(number) {
    this.name = `guest ${number}`;
    this.dice = make_dice(seed * 1000 + number);
    this.wrong = [];
    this.sent = [];
    this.done = {};
    this.visits = 0;
    this.resumed = 0;
    this.waited = 0;  // ms for a welcome, at most
    this.seq = 0;
    this.lamps = {};
    this.follows = '';
  }

  async enter() {
    const resume = this.token && this.dice.next() < 0.7 ? this.token : '';
    const lang = this.lang = this.dice.among(['en', 'de', 'sk']);
    this.visitor = new Visitor(server);
    this.visitor.waiting.push((item) => { if (item.message) this.hear(item.message); });
    const began = performance.now();
    const welcome = this.visitor.next((item) => item.message?.type === 'welcome',
        `welcome for ${this.name}${resume && ', who comes back'}`, most_waiting);
    await this.visitor.opened;
    this.send('hello', { exhibit: '', lang, role: 'visitor', ...(resume && { resume }),
      width: this.dice.among([160, 240, 320]), height: 180 });
    this.home = (await welcome).message;
    this.waited = Math.max(this.waited, performance.now() - began);
    this.visits++;
    this.resumed += this.home.resumed;
  }

  // Notes messages that this guest did not ask for.
  hear(message) {
    const { type } = message;
    if (type === 'welcome') {
      if (message.resumed) return;  // earlier orders go on, and lamps are as they were
      for (const lamp of message.lamps) this.lamps[lamp.name] = [lamp.on];
      this.asked = new Set();
      this.asked_story = this.asked_tour = false;
      this.follows = '';
    } else if (type === 'error') {
      if (message.code === 'unknown_group' && this.follows === 'perhaps') this.follows = '';
      const recent = this.sent.filter(({ at }) => performance.now() - at < settled);
      if (!recent.some(({ what }) => may_refuse[what]?.includes(message.code)))
        this.wrong.push(`${message.code}: ${message.message}, after ${this.sent.at(-1)?.what}`);
    } else if (type === 'reply') {
      if (!this.asked.has(message.question)) this.wrong.push(`a reply to '${message.question}'`);
    } else if (type === 'subtitle' && message.text) {
      if (message.lang !== this.lang) this.wrong.push(`a subtitle in ${message.lang}`);
      if (!this.asked.size && !this.asked_story && !this.asked_tour)
        this.wrong.push(`a subtitle '${message.text}'`);
    } else if (type === 'speech' && message.action === 'start') {
      if (!this.asked.size && !this.asked_story && !this.asked_tour)
        this.wrong.push(`sound '${message.text}'`);
    } else if (type === 'agent' && message.story) {
      if (!this.asked_story) this.wrong.push(`the story '${message.story}'`);
    } else if (type === 'state' && message.lamps) {
      for (const [name, on] of Object.entries(message.lamps))
        if (!this.follows && !this.lamps[name].includes(on)) this.wrong.push(`lamp ${name}`);
      if (message.tour && !this.asked_tour) this.wrong.push(`the tour ${message.tour.id}`);
    } else if (type === 'group') {
      this.follows = message.role === 'follower' ? 'surely' : '';  // its leader's lamps are its own
      if (message.role === 'leader') codes.add(this.leads = message.code);
      else if (this.leads) codes.delete(this.leads), this.leads = '';
    } else if (type === 'keep') {
      this.token = message.token;
    }
  }

  send(what, fields = {}) {
    this.done[what] = (this.done[what] ?? 0) + 1;
    this.sent.push({ what, at: performance.now() });
    if (this.sent.length > 50) this.sent.shift();
    this.visitor.send({ type: what, ...fields });
  }

  // One thing of those that visitors do, and how often of a hundred times.
  async act() {
    const { dice, home } = this;
    const seq = ++this.seq;
    const things = [
      [30, () => this.send('input', { seq,
        move: [dice.between(-1.4, 1.4), 0, dice.between(-1.4, 1.4)],
        look: [dice.between(-0.4, 0.4), dice.between(-0.1, 0.1)] })],
      [10, () => this.send('input', { seq, move: [0, 0, 0], look: [dice.between(-1, 1), 0],
        pointer: [dice.next(), dice.next()] })],
      [8, () => this.send('viewpoint', { seq, name: dice.among(home.viewpoints).name })],
      [6, () => this.send('go', { seq, object: dice.among(home.objects).id })],
      [6, () => this.send('go', { seq, at: [dice.next(), dice.next()] })],
      [4, () => this.send('go', { seq, to: [dice.between(-7, 7), 0, dice.between(-4, 4)] })],
      [6, () => {
        this.asked_story = true;
        this.send('storyteller', { story: dice.among(home.stories).id });
      }],
      [5, () => this.send('storyteller',
          { action: dice.among(['pause', 'play', 'stop', 'restart', 'skip']) })],
      [3, () => this.send('storyteller', { visible: dice.next() < 0.5 })],
      [2, () => this.send('storyteller', { teller: dice.among(home.storytellers).id })],
      [7, () => {
        const { name } = dice.among(home.lamps), on = dice.next() < 0.5;
        // Until the order has come the lamp may be either.
        this.lamps[name] = [true, false];
        this.send('lamp', { name, on });
      }],
      [3, () => {
        const text = dice.among(home.questions);
        this.asked.add(text);
        this.send('ask', { text });
      }],
      [3, () => {
        this.asked_tour = true;
        this.send('tour', { action: dice.among(['play', 'play', 'pause', 'stop']) });
      }],
      [3, () => this.send('settings', { quality: Math.floor(dice.between(40, 90)),
        fps: dice.among([5, 15, 30]), comfort: dice.next() < 0.3,
        width: dice.among([160, 240, 320]), height: 180 })],
      [2, () => this.lead_or_follow()],
      [2, () => this.come_and_go()],
    ];
    let left = dice.next() * things.reduce((sum, [weight]) => sum + weight, 0);
    for (const [weight, act] of things) if ((left -= weight) < 0) return await act();
  }

  lead_or_follow() {
    const code = this.dice.among([...codes, '']);
    const action = this.dice.among(code ? ['lead', 'follow', 'rejoin', 'leave', 'leave']
        : ['lead', 'leave']);
    if (action === 'follow') {  // a follower hears what its leader is told
      this.asked_story = this.asked_tour = true;
      this.follows ||= 'perhaps';
    }
    this.send('group', { action, ...(action === 'follow' && { code }) });
  }

  async come_and_go() {
    const said = this.dice.next() < 0.6;
    if (said) this.send('bye');
    await (said ? this.visitor.closed : this.visitor.close());
    if (this.leads) codes.delete(this.leads), this.leads = '';
    this.sent = [];
    await sleep(this.dice.between(0, 400));
    await this.enter();
  }

  async visit(until) {
    while (performance.now() < until) {
      await this.act();
      await sleep(this.dice.between(50, 700));
    }
    await this.visitor.close();
  }
}

// Does nothing: for it the museum stays as it was.
class Onlooker extends Guest {
  async visit(until) {
    this.send('viewpoint', { seq: 1, name: 'hall' });
    const agents = [];
    this.visitor.waiting.push((item) => {
      if (item.message?.type === 'agent') agents.push(item.message);
    });
    while (performance.now() < until) await sleep(200);
    for (const { teller, visible, story } of agents) {
      if (teller !== this.home.storyteller.id || !visible || story)
        this.wrong.push(`the storyteller is ${JSON.stringify({ teller, visible, story })}`);
    }
    this.lasting = { agents: agents.length, pictures: this.visitor.pictures };
    await this.visitor.close();
  }
}

test('a crowd does what it likes, and everybody is by themselves',
    { timeout: (seconds + 120 * patience) * 1e3 }, async () => {
  await sleep(500);
  const at_first = descriptors();
  const guests = Array.from({ length: crowd_size }, (_, n) => new Guest(n + 1));
  const onlooker = new Onlooker(0);
  const everybody = [onlooker, ...guests];
  for (const guest of everybody) await guest.enter();
  const until = performance.now() + seconds * 1e3;
  const memory = [];
  const watch = setInterval(() => memory.push(
      { at: seconds - (until - performance.now()) / 1e3, size: resident() }), 1000);
  const ends = await Promise.allSettled(everybody.map((guest) => guest.visit(until)));
  clearInterval(watch);
  const sum = (read) => everybody.reduce((all, guest) => all + read(guest), 0);
  const done = {};
  for (const guest of everybody)
    for (const [what, times] of Object.entries(guest.done)) done[what] = (done[what] ?? 0) + times;
  const warm = memory.filter(({ at }) => at > Math.min(warm_up, seconds / 2)).map((m) => m.size);
  const third = Math.ceil(warm.length / 3);
  const highest = (list) => Math.max(...list);
  const grown = highest(warm.slice(-third)) - highest(warm.slice(0, third));
  console.log(JSON.stringify({
    seconds, seed, visits: sum((guest) => guest.visits),
    resumed: sum((guest) => guest.resumed), done, onlooker: onlooker.lasting,
    waited: Math.max(...everybody.map((guest) => guest.waited)),
    mib: { first: memory[0]?.size, warm: warm[0], last: warm.at(-1),
      highest: highest(memory.map((m) => m.size)), grown } }));
  const wrong = everybody.flatMap((guest) => guest.wrong.map((what) => `${guest.name}: ${what}`));
  for (const { reason } of ends) if (reason) wrong.unshift(String(reason));
  const said = server.log().split('\n').filter((line) => / (warn|error) /.test(line)).slice(-10);
  assert.deepEqual(wrong.slice(0, 20), [], `${wrong.length} in all; ${said.join('; ')}`);
  assert.ok(onlooker.lasting.agents > 0);
  assert.ok(sum((guest) => guest.visits) > crowd_size, 'some have come back');
  assert.equal(server.child.exitCode, null);
  assert.equal((await fetch(`${server.url}/healthz`)).status, 200);
  assert.equal(await metric('bad_samples_total'), 0);
  if (seconds >= long_enough && judges_memory)
    assert.ok(grown < may_grow, `memory grew by ${grown} MiB`);
  // Closed connections are given back within some seconds.
  for (let k = 0; k < 100 && descriptors() > at_first + 2; k++) await sleep(200);
  assert.ok(descriptors() <= at_first + 2, `${descriptors()} descriptors, ${at_first} at first`);
});
