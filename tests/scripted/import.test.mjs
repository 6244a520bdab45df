// SPDX-License-Identifier: Apache-2.0
// `wellspring import`: what it makes hangs in an exhibit, and what is wrong is named.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import {
  cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-import-'));
after(() => rmSync(folder, { recursive: true }));
const poster = join(source, 'content/first-room/poster.jpg');

test('a picture becomes a pyramid that an exhibit hangs', async () => {
  const exhibit = join(folder, 'room');
  cpSync(join(source, 'content/first-room'), exhibit, { recursive: true });
  const made =
      await run('wellspring_import', ['picture', poster, '--width', '1.2', '--out', exhibit]);
  assert.equal(made.status, 0, made.stderr);
  assert.match(made.stderr, /poster\.tif: \d+ x \d+ texels, \d+ levels/);
  const piece = JSON.parse(made.stdout);
  assert.equal(piece.width_m, 1.2);
  const file = join(exhibit, 'exhibit.json');
  const manifest = JSON.parse(readFileSync(file));
  manifest.id = 'room';
  manifest.pieces = [piece];
  writeFileSync(file, JSON.stringify(manifest));
  const checked = await run('wellspring_check', [exhibit]);
  assert.equal(checked.status, 0, checked.stdout + checked.stderr);

  const again = await run('wellspring_import', ['picture', poster, '--out', exhibit]);
  assert.equal(again.status, 1);
  assert.match(again.stderr, /poster\.tif: is there already/);
  const anew = await run('wellspring_import', ['picture', poster, '--out', exhibit, '--overwrite']);
  assert.equal(anew.status, 0, anew.stderr);
});

test('what is no picture is named, and nothing is left of it', async () => {
  const wrong = join(folder, 'wrong.jpg'), out = join(folder, 'out');
  writeFileSync(wrong, 'no picture');
  const made = await run('wellspring_import', ['picture', wrong, '--out', out]);
  assert.equal(made.status, 1);
  assert.match(made.stderr, /wrong\.jpg: vips cannot turn it into a TIFF/);
  assert.deepEqual(existsSync(out) ? readdirSync(out) : [], []);
  const none = await run('wellspring_import', ['picture', join(folder, 'none.tif'), '--out', out]);
  assert.match(none.stderr, /none\.tif: is no file/);
  assert.equal((await run('wellspring_import', ['picture'])).status, 2);
  assert.equal((await run('wellspring_import', ['statue', wrong])).status, 2);
});

// A header of NRRD with two slices behind it.
const nrrd = 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 2\nencoding: raw\n'
  + 'space: RAS\nspace directions: (2,0,0) (0,3,0) (0,0,5)\n';

test('a scan is checked and copied with its companions', async () => {
  const scans = join(folder, 'scans'), out = join(folder, 'scan-out');
  mkdirSync(scans);
  writeFileSync(join(scans, 'small head.nhdr'), `${nrrd}data file: slice.%d 1 2 1\n`);
  writeFileSync(join(scans, 'slice.1'), Buffer.from([7, 8]));
  writeFileSync(join(scans, 'slice.2'), Buffer.from([9, 200]));
  const scan = join(scans, 'small head.nhdr');
  const made = await run('wellspring_import', ['volume', scan, '--out', out]);
  assert.equal(made.status, 0, made.stderr);
  assert.deepEqual(JSON.parse(made.stdout),
      { id: 'small-head', kind: 'volume', source: 'small head.nhdr' });
  assert.deepEqual(readdirSync(out).sort(), ['slice.1', 'slice.2', 'small head.nhdr']);
  assert.match(made.stderr, /NRRD, 2 x 1 x 2 samples, 2 x 3 x 5 mm apart, 4 x 3 x 10 mm in all/);
  assert.match(made.stderr, /values 7 to 200/);
  assert.match(made.stderr, /x runs to the patient's right, y to the front, z up \(RAS\)/);

  const again = await run('wellspring_import', ['volume', scan, '--out', out]);
  assert.equal(again.status, 1);
  assert.match(again.stderr, /small head\.nhdr: is there already/);
  const anew = await run('wellspring_import', ['volume', scan, '--out', out, '--overwrite']);
  assert.equal(anew.status, 0, anew.stderr);
  const there = join(out, 'small head.nhdr');
  const here = await run('wellspring_import', ['volume', there, '--out', out]);
  assert.equal(here.status, 0, here.stderr);
});

test('a scan that is cut off is named, and nothing is left of it', async () => {
  const out = join(folder, 'cut-out'), scan = join(folder, 'cut.nrrd');
  writeFileSync(scan, `${nrrd}\nabc`);
  const made = await run('wellspring_import', ['volume', scan, '--out', out]);
  assert.equal(made.status, 1);
  assert.match(made.stderr, /cut\.nrrd: is cut off: it holds 3 bytes of samples, .* says 4/);
  assert.ok(!existsSync(out));
  const none = await run('wellspring_import', ['volume', join(folder, 'none'), '--out', out]);
  assert.match(none.stderr, /none: is not there/);
});

const dicom = join(process.env.WELLSPRING_DATA ?? '', '10_exhibits/volumes/dicom');
const lacks_dicom = !existsSync(dicom) && `no corpus at ${dicom}`;

test('without dcm2niix a folder of DICOM names the package', { skip: lacks_dicom }, async () => {
  const out = join(folder, 'no-tool'), path = process.env.PATH;
  process.env.PATH = folder;
  const made = await run('wellspring_import', ['volume', join(dicom, 'niivue_mr'), '--out', out])
      .finally(() => { process.env.PATH = path; });
  assert.equal(made.status, 1);
  assert.match(made.stderr, /the program dcm2niix is missing \(Debian: dcm2niix\)/);
});

const lacks_tool = lacks_dicom
  || (spawnSync('dcm2niix', ['--version']).error && 'dcm2niix is not installed');

test('a folder of DICOM becomes NIfTI, of the largest series or a chosen one',
    { skip: lacks_tool }, async () => {
  const out = join(folder, 'dicom'), scans = join(dicom, 'pydicom/series');
  const made = await run('wellspring_import', ['volume', scans, '--out', out]);
  assert.equal(made.status, 0, made.stderr);
  assert.deepEqual(JSON.parse(made.stdout),
      { id: 'series', kind: 'volume', source: 'series.nii.gz' });
  assert.match(made.stderr, /-> series 2: 16 x 16 x \d+ samples, Routine Brain, slices/);
  assert.match(made.stderr, /Interslice distance varies/);
  const other = await run('wellspring_import',
      ['volume', scans, '--out', out, '--series', '4', '--overwrite']);
  assert.equal(other.status, 0, other.stderr);
  assert.match(other.stderr, /-> series 4: 16 x 16 x 5/);
  const none = await run('wellspring_import', ['volume', scans, '--out', out, '--series', '9']);
  assert.equal(none.status, 1);
  assert.match(none.stderr, /has 4 series, so there is no series 9/);

  const one = await run('wellspring_import',
      ['volume', join(dicom, 'pydicom/CT_small.dcm'), '--out', out]);
  assert.equal(one.status, 0, one.stderr);
  assert.match(one.stderr, /CT_small\.nii\.gz: NIfTI-1, 128 x 128 x 1 samples/);
  const packed = await run('wellspring_import',
      ['volume', join(dicom, 'pydicom/MR_small_jp2klossless.dcm'), '--out', out]);
  const plain = await run('wellspring_import',
      ['volume', join(dicom, 'pydicom/MR_small.dcm'), '--out', out]);
  const values = (text) => text.match(/values .*/)?.[0];
  assert.ok(values(plain.stderr), plain.stderr);
  assert.equal(values(packed.stderr), values(plain.stderr));
});

test('the description of raw samples is a schema', async () => {
  const { status, stdout } = await run('wellspring_import', ['volume', '--raw-schema']);
  assert.equal(status, 0);
  assert.deepEqual(JSON.parse(stdout).required, ['file', 'size', 'kind', 'spacing_mm']);
});
