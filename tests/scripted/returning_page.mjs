// SPDX-License-Identifier: Apache-2.0
// A visitor as the page is one (web/connection.js): it keeps its cookie and the text that tells
// where its visit is, and comes back by itself, later each time.
import assert from 'node:assert/strict';
import http from 'node:http';
import { Visitor, deadline, read_picture, sleep } from '../server.mjs';

export class ReturningPage {
  // `front`: {url, ws}; `pose`: {position, yaw, pitch}; `address`: this visitor's own.
  constructor(front, pose, address) {
    Object.assign(this, { front, pose, address, retries: 0, lines: 0, closes: [], gaps: [] });
  }

  // Asks for the page, goes to its pose, and waits until it is told where that is.
  async enter() {
    const headers = await new Promise((resolve, reject) => {
      http.get(this.front.url, { localAddress: this.address, agent: false }, (answer) => {
        answer.resume();
        resolve(answer.headers);
      }).on('error', reject);
    });
    this.cookie = /wellspring=(\w+)/.exec(headers['set-cookie'])[1];
    this.first_node = this.cookie;
    await this.open();
    await this.seen;
    const settled = this.line.message('state', (state) => state.seq === 1);
    this.line.send({ type: 'camera', seq: 1, ...this.pose });
    await settled;
    for (const end = Date.now() + deadline; !this.is_kept(); await sleep(50))
      assert.ok(Date.now() < end, 'the page is never told where it is');
  }

  // Says whether the token's text has the pose: a server seals the token, but its text is no
  // secret.
  is_kept() {
    if (!this.token) return false;
    const { place } = JSON.parse(Buffer.from(this.token.split('.')[0], 'base64url'));
    return this.pose.position.every((v, i) => Math.abs(v - place[i]) < 1e-3);
  }

  // Opens a line; when it breaks, another is opened later. `seen`: the first messages of each type
  // on this line.
  async open() {
    const headers = { cookie: `wellspring=${this.cookie}` };
    const line = new Visitor(this.front, { options: { headers, localAddress: this.address } });
    this.line = line;
    line.socket.on('upgrade', (response) => {
      const set = /wellspring=(\w+)/.exec(response.headers['set-cookie'] ?? '');
      if (set) this.cookie = set[1];
    });
    this.seen = new Promise((resolve) => {
      const first = {};
      line.socket.on('message', (bytes, binary) => {
        const message = binary ? { type: read_picture(bytes) ? 'picture' : 'sound' }
          : JSON.parse(String(bytes));
        if (message.type === 'keep') this.token = message.token;
        if (message.type === 'welcome') this.lines++, this.retries = 0;
        first[message.type] ??= { ...message, at: performance.now() };
        if (!first.welcome || !first.state || !first.picture || first.all) return;
        first.all = true;
        if (this.closed_at) this.gaps.push((first.picture.at - this.closed_at) / 1000);
        this.closed_at = 0;
        resolve(first);
      });
    });
    line.closed.then(({ code }) => {
      if (this.left) return;
      this.closed_at ||= performance.now();
      this.closes.push(code);
      this.later();
    });
    await line.opened;
    line.send({ type: 'hello', exhibit: '', width: 320, height: 180, lang: 'en', role: 'visitor',
      ...(this.token ? { resume: this.token } : {}) });
  }

  later() {
    const seconds = Math.min(8, 0.4 * 2 ** this.retries++) * (0.75 + 0.5 * Math.random());
    setTimeout(() => { if (!this.left) this.open().catch(() => {}); }, 1000 * seconds);
  }

  leave() { this.left = true; return this.line?.close(); }
}

// Waits until every one of them has a line that is not among its `lines` of before, and a picture
// of where it was. Returns the milliseconds by the clock at which they had it, in order.
export async function all_come_back(pages, lines) {
  const came = await Promise.all(pages.map(async (page, i) => {
    for (const end = Date.now() + deadline; page.lines <= lines[i]; await sleep(10))
      assert.ok(Date.now() < end, `never back: closes ${page.closes}`);
    const { welcome, state, picture } = await page.seen;
    assert.ok(welcome.resumed, 'the other server knows the text');
    state.position.forEach((v, k) => assert.ok(Math.abs(v - page.pose.position[k]) < 1e-3,
        `${state.position} was ${page.pose.position}`));
    assert.ok(Math.abs(state.yaw - page.pose.yaw) < 1e-3);
    assert.ok(Math.abs(state.pitch - page.pose.pitch) < 1e-3);
    return picture.at;
  }));
  return came.sort((a, b) => a - b);
}
