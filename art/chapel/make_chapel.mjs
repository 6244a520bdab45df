#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes a ruined chapel that is made to be scanned (chapel.glb), and the meadow with hills and
// trees in which its scan stands (scene.glb). Metres, y up.
//   node art/chapel/make_chapel.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';

import { glb } from '../castle/falcon/files.mjs';
import { build } from './chapel.mjs';
import { ground, make_grass, make_ground, make_ivy } from './plants.mjs';
import { make_land } from './land.mjs';
import { Part } from './shapes.mjs';
import { soil_picture, stone_picture, stone_relief } from './surfaces.mjs';

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/chapel/make_chapel.mjs FOLDER');
  exit(2);
}

const generator = 'art/chapel/make_chapel.mjs';
const rough = (more = {}) => ({ metallicFactor: 0, roughnessFactor: 0.95, ...more });
const picture = (index) => ({ baseColorTexture: { index } });

const stone = new Part('Stone', 'stone'), core = new Part('Mortar', 'mortar');
const earth = new Part('Ground', 'soil'), grass = new Part('Grass', 'leaves');
const ivy = new Part('Ivy', 'leaves');
build(stone, core, ground);
make_ground(earth);
make_grass(grass);
make_ivy(ivy);
writeFileSync(join(folder, 'chapel.glb'), glb({ generator, wrap: 10497,
  parts: [stone, core, earth, grass, ivy],
  pictures: [stone_picture(), stone_relief(), soil_picture()],
  materials: [
    { name: 'stone', pbrMetallicRoughness: rough(picture(0)), normalTexture: { index: 1 } },
    { name: 'mortar', pbrMetallicRoughness: rough(picture(2)) },
    { name: 'soil', pbrMetallicRoughness: rough(picture(2)) },
    { name: 'leaves', pbrMetallicRoughness: rough(), doubleSided: true },
  ] }));

writeFileSync(join(folder, 'scene.glb'), glb({ generator, ...make_land() }));
