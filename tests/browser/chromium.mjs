// SPDX-License-Identifier: Apache-2.0
// The browser of the tests: Debian's Chromium, without a screen, by Playwright.
import { existsSync } from 'node:fs';
import { load_module } from '../server.mjs';

const executable = [
  '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome',
].find(existsSync);
export const skip = !executable && 'no Chromium on this machine';
// a folder for screenshots, for people to look at
export const pictures = process.env.WELLSPRING_PICTURES;

export const launch = () => load_module('playwright-core').chromium.launch({
  executablePath: executable,
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
