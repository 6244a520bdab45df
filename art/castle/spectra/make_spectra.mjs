#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes what the castle's gems take from light, its painter's pigments, and how glass and gems
// bend light.
//   node art/castle/spectra/make_spectra.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { NM } from './colour.mjs';
import { absorption_at, gems, sources } from './gems.mjs';
import { glasses } from './glass.mjs';
import { pigments, reflectance } from './pigments.mjs';

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/castle/spectra/make_spectra.mjs FOLDER');
  exit(2);
}
const write = (name, lines) => writeFileSync(join(folder, name), `${lines.join('\n')}\n`);
const short = (value) => String(Number(value.toPrecision(4)));
const table = (notes, nm, names, columns) => [...notes.map((note) => `# ${note}`),
  ['wavelength_nm', ...names].join(','),
  ...nm.map((at, i) => [at, ...columns.map((column) => short(column[i]))].join(','))];

// The R lines of chromium are narrow: every nanometre is told.
const fine = Array.from({ length: 401 }, (_, i) => 380 + i);
write('gems.csv', table(['Absorption of gems in 1/m.',
  ...gems.map((gem) => `Source of ${gem}: ${sources[gem]}.`)], fine, gems,
gems.map((gem) => fine.map((nm) => absorption_at(gem, nm)))));
write('pigments.csv', table(['Reflectance of thick coats of pigments, 0 to 1.',
  'Source: models with a few numbers each, art/castle/spectra/pigments.mjs.'], NM, pigments,
pigments.map((name) => reflectance(name))));

// Files as those of refractiveindex.info, of what spreads colours in the castle.
for (const name of ['F2', 'diamond']) {
  const [source, formula, range, coefficients] = glasses[name];
  write(`${name}.yml`, ['REFERENCES: |', `    ${source}`, 'DATA:', `  - type: formula ${formula}`,
    `    wavelength_range: ${range.join(' ')}`, `    coefficients: ${coefficients.join(' ')}`]);
}
