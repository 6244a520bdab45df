// SPDX-License-Identifier: Apache-2.0
// Writes the castle's inventory: node make_inventory.mjs FOLDER makes holdings.json there.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv } from 'node:process';

import { colours } from './colours.mjs';
import { departments, shown } from './holdings.mjs';

const first_number = 101;  // lower ones stand in the great hall
const cells = (row, count) => {
  const all = row.split('|').map((cell) => cell.trim());
  if (all.length !== count) throw new Error(`"${row}" has ${all.length} cells, not ${count}`);
  return all;
};
const list = (cell) => cell.split(',').map((word) => word.trim()).filter(Boolean);
const palette = (names) => names.map((name) => {
  if (!(name in colours)) throw new Error(`there is no colour "${name}"`);
  return colours[name];
});

function record(id, [title, maker, date, subjects, materials, colors]) {
  return { id, title, ...(maker && { maker }), date, subjects, materials, colors: palette(colors) };
}

const exhibited = shown.map((row) => {
  const [id, , title, maker, date, ...rest] = cells(row, 8);
  return record(id, [title, maker, date, ...rest.map(list)]);
});
let number = first_number;
const stored = departments.flatMap((department) => department.rows.map((row) => {
  const [title, maker, date, subjects, materials, colors] = cells(row, 6);
  return record(`FW ${number++}`, [title, maker, date,
    [...new Set([...list(department.subjects), ...list(subjects)])],
    list(materials || department.materials), list(colors || department.colours)]);
}));

const lines = [...exhibited, ...stored].map((one) => `  ${JSON.stringify(one)}`);
writeFileSync(join(argv[2], 'holdings.json'), `{
 "about": "Written for the exhibit of Falconwell Castle, which exists in it alone: no museum holds these things.",
 "rights": "CC0",
 "records": [
${lines.join(',\n')}
 ]
}
`);
