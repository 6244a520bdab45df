// SPDX-License-Identifier: Apache-2.0
// Makes well.jpg, what screens without WebGL2 show: node make_still.mjs FOLDER_OF_PLAYWRIGHT_CORE
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(join(process.argv[2], 'index.js'))('playwright-core');
const page_text = `<!doctype html>
<style>html,body,canvas{margin:0;width:100%;height:100%;display:block;
background:#000}</style><canvas></canvas><script type="module">
import { make_well } from '/well.js';
const well = make_well(document.querySelector('canvas'), {}, { fixed: 1440000 });
well.stage('awake');
setTimeout(() => well.touch(520, 640), 9000);
</script>`;
const server = createServer((question, reply) => {
  const script = question.url.endsWith('.js');
  reply.setHeader('content-type', script ? 'text/javascript' : 'text/html');
  reply.end(script ? readFileSync(join(here, question.url)) : page_text);
}).listen(0);
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const page = await browser.newPage({ viewport: { width: 1200, height: 1200 } });
await page.goto(`http://127.0.0.1:${server.address().port}/`);
await page.waitForTimeout(20000);
await page.screenshot({ path: join(here, 'well.jpg'), quality: 82, timeout: 120000 });
await browser.close();
server.close();
