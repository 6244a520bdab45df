// SPDX-License-Identifier: Apache-2.0
// The castle's pigments are near measured ones, and what a later hand has painted over the sky of
// the second falcon is not seen by day.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import { LAMPS, NM, difference, lab } from '../../art/castle/spectra/colour.mjs';
import { mixtures, row_names } from '../../art/castle/dusk/palette.mjs';
import { mix_pigments, pigments, reflectance } from '../../art/castle/spectra/pigments.mjs';
const data = process.env.WELLSPRING_DATA ?? '';

const measured = join(data, '10_exhibits/spectra/pigments/paints.csv');
// Names of the measured file that are not ours without blanks. One column of it is a copy of the
// wavelengths.
const other_names = { yellowlakeresed: 'yellow lake of weld', lampblaxk: 'lamp black',
  'leadtinyellow..II': 'lead-tin yellow II', 'leadtinyellow..I': 'lead-tin yellow I' };
const ours = new Map(pigments.map((name) => [name.toLowerCase().replaceAll(' ', ''), name]));

test('differences of colours are those of the formula\'s authors', () => {
  // Sharma, Wu, Dalal 2005, table 1: pairs 1, 7, 13, 17 and 25.
  for (const [one, two, expected] of [
    [[50, 2.6772, -79.7751], [50, 0, -82.7485], 2.0425],
    [[50, 0, 0], [50, -1, 2], 2.3669],
    [[50, -0.001, 2.49], [50, 0.0011, -2.49], 4.7461],
    [[50, 2.5, 0], [73, 25, -18], 27.1492],
    [[60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644],
  ]) assert.ok(Math.abs(difference(one, two) - expected) < 1e-4, `${difference(one, two)}`);
});

// The instrument saw some light of its own: its blacks throw back a sixth of all light, its whites
// more than there is. So lamp black and titanium white are taken for ours, and others lie between.
test('pigments are near measured ones', (t) => {
  if (!data || !existsSync(measured))
    return t.skip('there are no measured pigments: WELLSPRING_DATA names the folder of test data');
  const [head, ...lines] = readFileSync(measured, 'utf8').trim().split('\n')
    .map((line) => line.split(','));
  const read = (word) => NM.map((nm) => {
    const near = lines.filter(([at]) => Math.abs(at - nm) < 2.5);
    return near.reduce((sum, row) => sum + Number(row[head.indexOf(word)]), 0) / near.length;
  });
  const ends = [read('lampblaxk'), read('titaniumwhite')];
  const own = ['lamp black', 'titanium white'].map((name) => reflectance(name));
  const known = (word) => other_names[word] ?? ours.get(word);
  const found = head.slice(1).filter((word) => known(word) && word !== 'vandykebrown')
    .map((word) => {
      const values = read(word).map((value, i) => Math.max(0.005, own[0][i] +
          (value - ends[0][i]) / (ends[1][i] - ends[0][i]) * (own[1][i] - own[0][i])));
      const name = known(word);
      return [difference(lab(values, LAMPS.D65), lab(reflectance(name), LAMPS.D65)), name];
    }).sort(([a], [b]) => a - b);
  assert.equal(found.length, 53);
  const median = found[found.length >> 1][0];
  const told = found.map(([away, name]) => `${name} ${away.toFixed(1)}`).join(', ');
  t.diagnostic(`median ${median.toFixed(2)}: ${told}`);
  assert.ok(median < 4 && found.at(-1)[0] < 12, told);
});

test('a mixture lies between its pigments, and black is stronger than white', () => {
  const at = (parts) => lab(mix_pigments(parts), LAMPS.D65)[0];
  assert.ok(Math.abs(at({ azurite: 1 }) - lab(reflectance('azurite'), LAMPS.D65)[0]) < 1e-9);
  const [white, half, black] = [at({ 'lead white': 1 }), at({ 'lead white': 1, 'lamp black': 1 }),
    at({ 'lamp black': 1 })];
  assert.ok(black < half && half < (white + black) / 2, `${black} ${half} ${white}`);
});

test('the later hand matches the first by day and by no other light', () => {
  // Rows are equally long; the sky is the first, the later hand's the last.
  const steps = mixtures.length / row_names.length, told = [];
  mixtures.slice(0, 10).forEach((parts, i) => {
    const one = mix_pigments(parts), other = mix_pigments(mixtures.at(i - steps));
    const [day, candle] = ['D65', 'candle'].map((lamp) =>
      difference(lab(one, LAMPS[lamp]), lab(other, LAMPS[lamp])));
    told.push(`${day.toFixed(2)} ${candle.toFixed(2)}`);
    assert.ok(day < 0.1 && candle > 3, told.at(-1));
  });
});
