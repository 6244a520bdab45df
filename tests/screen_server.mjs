// SPDX-License-Identifier: Apache-2.0
// A server that a test plays: serves the pages of web/, speaks the messages that the test tells it
// to, and keeps those of the page. So every state of a screen can be shown without waiting for one.
import { createServer } from 'node:http';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { extname, join, normalize } from 'node:path';
import { source } from './server.mjs';

const { WebSocketServer } = createRequire(join(process.env.WELLSPRING_NODE, 'index.js'))('ws');
const types = { '.js': 'text/javascript', '.css': 'text/css', '.html': 'text/html',
  '.svg': 'image/svg+xml', '.jpg': 'image/jpeg', '.json': 'application/json' };

// exhibit: what GET /api/v1/exhibits/ID answers. Resolves to {url, heard, send(message),
// picture(jpeg), stop()}; heard: the pages' messages, oldest first. welcome: fields of that message
// that differ. level(trail): what GET /api/v1/exhibits/ID/collection answers.
export function start_screen_server(exhibit, welcome = {}, level = null) {
  const heard = [];
  const pages = new Set();
  let frame = 0;
  const server = createServer((question, reply) => {
    const { pathname: path, searchParams } = new URL(question.url, 'http://x');
    const about = `/api/v1/exhibits/${exhibit.id}`;
    const told = path === about ? exhibit
      : path === `${about}/collection` ? level?.(searchParams.get('trail') ?? '') : null;
    if (told) {
      reply.setHeader('content-type', types['.json']);
      return reply.end(JSON.stringify(told));
    }
    const file = normalize(join(source, 'web', path === '/kiosk' ? 'kiosk.html' : path));
    try {
      const bytes = path.startsWith('/files/')
        ? readFileSync(join(source, 'content/castle/poster.jpg')) : readFileSync(file);
      reply.setHeader('content-type', types[extname(file)] ?? 'image/jpeg');
      reply.end(bytes);
    } catch {
      reply.statusCode = 404;
      reply.end();
    }
  });
  const send = (message) => { for (const page of pages) page.send(JSON.stringify(message)); };
  // A line that says nothing is given up by the page.
  const alive = setInterval(() => send({ type: 'alive' }), 2000);
  new WebSocketServer({ server }).on('connection', (socket) => {
    pages.add(socket);
    socket.on('close', () => pages.delete(socket));
    socket.on('message', (text) => {
      const message = JSON.parse(text);
      heard.push(message);
      if (message.type === 'hello')
        send({ type: 'welcome', exhibit: exhibit.id, title: Object.values(exhibit.title)[0],
          description: '', lang: message.lang, languages: exhibit.languages, walk_speed: 1.4,
          viewpoints: [{ name: 'hall', title: 'Great hall' }, { name: 'teller', title: 'She' }],
          tours: exhibit.tours.map((one) => ({ ...one, title: Object.values(one.title)[0] })),
          stories: exhibit.stories.map((one) => ({ ...one, title: Object.values(one.title)[0] })),
          lamps: [], storyteller: { id: 'she', viewpoint: 'teller' }, storytellers: [],
          sounds: [], ...welcome });
    });
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve({
    url: `http://127.0.0.1:${server.address().port}`, heard, send,
    picture(jpeg) {
      const header = Buffer.alloc(28);
      header.write('WSF1');
      header.writeUInt32LE(++frame, 4);
      header.writeBigUInt64LE(BigInt(Date.now()) * 1000n, 12);
      header.writeUInt16LE(28, 26);
      for (const page of pages) page.send(Buffer.concat([header, jpeg]));
    },
    stop: () => new Promise((done) => {
      clearInterval(alive);
      for (const page of pages) page.terminate();
      server.close(done);
    }),
  })));
}
