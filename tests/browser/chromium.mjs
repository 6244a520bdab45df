// SPDX-License-Identifier: Apache-2.0
// The browser of the tests: Debian's Chromium, without a screen, by Playwright.
import { existsSync } from 'node:fs';
import { deadline, load_module } from '../server.mjs';

const executable = [
  '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome',
].find(existsSync);
export const skip = !executable && 'no Chromium on this machine';
// a folder for screenshots, for people to look at
export const pictures = process.env.WELLSPRING_PICTURES;

// With these arguments the processor draws in three dimensions, slowly.
export const by_processor = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
// Starts the browser. Without `drawing` it draws nothing in three dimensions, so that pictures come
// finished and cores are left for the server.
export async function launch(drawing = ['--disable-gpu', '--disable-3d-apis']) {
  const browser = await load_module('playwright-core').chromium.launch({
    executablePath: executable,
    args: ['--no-sandbox', ...drawing, '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  });
  const make = browser.newContext.bind(browser);
  browser.newContext = async (options) => {
    const context = await make(options);
    context.setDefaultTimeout(deadline);
    return context;
  };
  return browser;
}
