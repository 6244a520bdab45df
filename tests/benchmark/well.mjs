// SPDX-License-Identifier: Apache-2.0
// How quickly the kiosk's well is drawn: node well.mjs WEB NODE_MODULES_PARENT [--quick]
// Prints one JSON object a result: {"name","value","unit",...}.
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { existsSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

const [web, modules] = process.argv.slice(2), quick = process.argv.includes('--quick');
const { chromium } = createRequire(resolve(modules, 'index.js'))('playwright-core');
const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
if (!executablePath) throw new Error('no Chromium on this machine');
const tell = (name, value, unit, fields = {}) =>
    console.log(JSON.stringify({ name, value, unit, ...fields }));
const part = (times, share) => [...times].sort((a, b) => a - b)[Math.floor(share * times.length)];

const server = createServer((question, reply) => {
  const script = question.url.endsWith('.js');
  reply.setHeader('content-type', script ? 'text/javascript' : 'text/html');
  reply.end(script ? readFileSync(join(web, 'kiosk', question.url))
    : '<!doctype html><style>html,body,canvas{margin:0;width:100%;height:100%;display:block}'
      + '</style><canvas></canvas>');
}).listen(0, '127.0.0.1');
const browser = await chromium.launch({ executablePath,
  args: ['--no-sandbox', '--ignore-gpu-blocklist', '--enable-unsafe-swiftshader'] });
const page = await browser.newPage({ viewport: { width: 1920, height: 1080 } });
await page.goto(`http://127.0.0.1:${server.address().port}/`);

const steps = await page.evaluate(async () => {
  const { make_water } = await import('/water.js');
  const water = make_water(), times = [];
  water.press(0.3, 0.2);
  for (let i = 0; i < 600; i++) {
    const began = performance.now();
    water.advance(1 / 60);
    water.surface();
    times.push(performance.now() - began);
  }
  return times.slice(100);
});
tell('kiosk.page.water_ms', steps.reduce((a, b) => a + b) / steps.length, 'ms');

for (const pixels of quick ? [120000] : [120000, 500000, 2073600]) {
  const { times, size, card } = await page.evaluate(async ([wanted, seconds]) => {
    const { make_well } = await import('/well.js');
    document.querySelector('canvas').replaceWith(document.createElement('canvas'));
    const canvas = document.querySelector('canvas');
    const well = make_well(canvas, {}, { fixed: wanted });
    well.stage('awake');
    await new Promise((done) => setTimeout(done, 3000));
    const from = well.figures().milliseconds.length;
    for (let i = 0; i < 8 * seconds; i++) {
      well.touch(innerWidth / 2 + 100 * Math.sin(i), innerHeight / 2);
      await new Promise((done) => setTimeout(done, 125));
    }
    const gl = canvas.getContext('webgl2'), about = gl.getExtension('WEBGL_debug_renderer_info');
    const figures = well.figures();
    well.hide(true);
    return { times: figures.milliseconds.slice(Math.min(from, 100)), size: figures.pixels,
      card: about ? gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : '' };
  }, [pixels, quick ? 4 : 10]);
  const fields = { pixels: size, card: /swiftshader|llvmpipe/i.test(card) ? 'none' : card };
  tell('kiosk.page.frame_ms', part(times, 0.5), 'ms', fields);
  tell('kiosk.page.frame_p95_ms', part(times, 0.95), 'ms', fields);
}
await browser.close();
server.close();
