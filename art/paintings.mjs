#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes the descriptions of the castle's pictures without end: the valley and its maps.
//   node art/paintings.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';

import { make_maps } from './paintings/maps.mjs';
import { make_parishes } from './paintings/parishes.mjs';
import { make_valley } from './paintings/valley.mjs';

const folder = argv[2];
if (!folder) {
  console.error('usage: node art/paintings.mjs FOLDER');
  exit(2);
}
for (const [name, file] of [['valley', make_valley()], ...make_maps()])
  writeFileSync(join(folder, `${name}.painting.json`), `${JSON.stringify(file)}\n`);
writeFileSync(join(folder, 'parishes_1850.geojson'), `${JSON.stringify(make_parishes())}\n`);
