#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Makes the exhibits' files again:
//   node art/make.mjs [--check] [PART ...]     all parts, or those named, such as castle/torch
// Files that differ are replaced; with --check they are named, and the program ends with 1.
// art/made.json notes which scripts each file was made of; tests compare it with the tree.
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync,
  statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { argv, exit } from 'node:process';
import { fileURLToPath } from 'node:url';
import { isDeepStrictEqual } from 'node:util';

const art = dirname(fileURLToPath(import.meta.url)), root = dirname(art);
const ledger = join(art, 'made.json');
const blender = (script, ...given) =>
  ['blender', '-b', '--factory-startup', '--python-exit-code', '1', '--python', join(art, script),
    '--', ...given];

// A part: its scripts, where its files belong, which of that folder's files are its own, and the
// command that makes them in another folder.
export const parts = {
  'castle/scene': { scripts: ['castle/make_scene.py', 'castle/scripts'], into: 'content/castle',
    files: /^scene\.glb$/,
    command: (out) => blender('castle/make_scene.py', join(out, 'scene.glb')) },
  'castle/ludmila': { scripts: ['castle/figures'], into: 'content/castle/figures',
    files: /^storyteller[._]/,
    command: (out) => blender('castle/figures/make_figure.py', 'ludmila', out) },
  'castle/matous': { scripts: ['castle/figures'], into: 'content/castle/figures',
    files: /^chronicler[._]/,
    command: (out) => blender('castle/figures/make_figure.py', 'matous', out) },
  'castle/torch': { scripts: ['castle/props'], into: 'content/castle/props', files: /^torch\.glb$/,
    command: (out) => ['python3', 'castle/props/make_torch.py', join(out, 'torch.glb')] },
  'castle/falcon': { scripts: ['castle/falcon'], into: 'content/castle/volumes',
    files: /^(falcon|vitrine|replica)\./,
    command: (out) => ['node', 'castle/falcon/make_falcon.mjs', out] },
  'castle/niche': { scripts: ['castle/niche', 'castle/falcon/files.mjs'],
    into: 'content/castle/volumes', files: /^niche\.glb$/,
    command: (out) => ['node', 'castle/niche/make_niche.mjs', out] },
  'castle/spectra': { scripts: ['castle/spectra'], into: 'content/castle/spectra',
    files: /\.(csv|yml)$/,
    command: (out) => ['node', 'castle/spectra/make_spectra.mjs', out] },
  'castle/gems': {
    scripts: ['castle/gems', 'castle/spectra', 'castle/falcon/vitrine.mjs',
      'castle/falcon/files.mjs', 'castle/falcon/field.mjs'],
    into: 'content/castle/gems', files: /\.glb$/,
    command: (out) => ['node', 'castle/gems/make_gems.mjs', out] },
  'castle/dusk': {
    scripts: ['castle/dusk', 'castle/spectra', 'castle/falcon/files.mjs',
      'castle/falcon/field.mjs'],
    into: 'content/castle/pictures', files: /^second_falcon\.tif$/,
    command: (out) => ['node', 'castle/dusk/make_dusk.mjs', out] },
  'castle/lawn': {
    scripts: ['castle/lawn', 'castle/falcon/files.mjs', 'castle/falcon/field.mjs'],
    into: 'content/castle/pictures', files: /^courtyard_grass\.png$/,
    command: (out) => ['node', 'castle/lawn/make_lawn.mjs', out] },
  'castle/book': { scripts: ['castle/book'], into: 'content/castle/book', files: /\.(jpg|webm)$/,
    command: (out) => ['bash', 'castle/book/make_pictures.sh', out] },
  'castle/pictures': { scripts: ['paintings.mjs', 'paintings'], into: 'content/castle/pictures',
    files: /\.(painting\.json|geojson)$/, command: (out) => ['node', 'paintings.mjs', out] },
  'castle/inventory': { scripts: ['castle/inventory'], into: 'content/castle/collection',
    files: /^holdings\.json$/,
    command: (out) => ['node', 'castle/inventory/make_inventory.mjs', out] },
  'castle/nebula': { scripts: ['nebula.mjs'], into: 'content/castle/pictures',
    files: /^nebula\.png$/, command: (out) => ['node', 'nebula.mjs', out] },
  'chapel/scene': { scripts: ['chapel', 'castle/falcon/field.mjs', 'castle/falcon/files.mjs'],
    into: 'content/chapel', files: /^(chapel|scene)\.glb$/,
    command: (out) => ['node', 'chapel/make_chapel.mjs', out] },
  'chapel/capital': { scripts: ['chapel/make_capital.mjs', 'chapel/shapes.mjs',
    'castle/falcon/field.mjs'], into: 'content/chapel', files: /^capital\.spz$/,
    command: (out) => ['node', 'chapel/make_capital.mjs', out] },
  'galaxies/all': { scripts: ['galaxies', 'chapel/shapes.mjs', 'castle/falcon/field.mjs',
    'castle/falcon/files.mjs'], into: 'content/galaxies', files: /^(galaxies-\d\.ply|scene\.glb)$/,
    command: (out) => ['node', 'galaxies/make_galaxies.mjs', out] },
  'first-room/scene': { scripts: ['first-room'], into: 'content/first-room', files: /^scene\.glb$/,
    command: (out) => blender('first-room/make_room.py', join(out, 'scene.glb')) },
};

function files_below(path) {
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path).filter((name) => name !== '__pycache__' && !name.endsWith('.md')).sort()
      .flatMap((name) => files_below(join(path, name)));
}
const hash = (...texts) => {
  const sum = createHash('sha256');
  for (const text of texts) sum.update(text);
  return sum.digest('hex');
};

// The hash of a part's scripts, names and texts.
export const hash_scripts = ({ scripts }) =>
  hash(...scripts.flatMap((name) => files_below(join(art, name)))
      .flatMap((path) => [path.slice(art.length), readFileSync(path)]));

// The hashes of a part's files as they lie in `folder`.
export const hash_files = ({ files }, folder) => Object.fromEntries(readdirSync(folder)
    .filter((name) => files.test(name)).sort()
    .map((name) => [name, hash(readFileSync(join(folder, name)))]));

// Processors round differently: two binary glTF files are alike when their numbers differ in the
// last digits alone.
const last_digits = 1e-5;
function are_alike(one, two) {
  if (one.equals(two)) return true;
  if (one.length !== two.length || one.toString('latin1', 0, 4) !== 'glTF') return false;
  const begin = 20 + one.readUInt32LE(12);
  const [json, other] = [one, two].map((file) => JSON.parse(file.toString('utf8', 20, begin)));
  if (!isDeepStrictEqual(json, other)) return false;
  for (let at = begin; at + 4 <= one.length; at += 4)
    if (one.readUInt32LE(at) !== two.readUInt32LE(at) &&
        !(Math.abs(one.readFloatLE(at) - two.readFloatLE(at)) < last_digits)) return false;
  return true;
}

// Makes one part and returns the names of files that were not as it makes them.
function make(name, keep) {
  const part = parts[name], folder = join(root, part.into);
  const out = mkdtempSync(join(tmpdir(), 'wellspring-art-'));
  try {
    const [program, ...given] = part.command(out);
    const { error, status, stdout } = spawnSync(program, given,
        { cwd: art, encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'], maxBuffer: 1e8 });
    if (error) throw new Error(`${name}: ${program} cannot be run (${error.code})`);
    if (status !== 0)
      throw new Error(`${stdout.slice(-2000)}${name}: ${program} ended with ${status}`);
    const made = readdirSync(out).filter((file) => part.files.test(file));
    if (made.length === 0) throw new Error(`${name}: nothing was made`);
    const there = (existsSync(folder) ? readdirSync(folder) : [])
        .filter((file) => part.files.test(file));
    const changed = [...new Set([...made, ...there])].filter((file) =>
      !made.includes(file) || !there.includes(file) ||
          !are_alike(readFileSync(join(out, file)), readFileSync(join(folder, file))));
    if (keep) {
      mkdirSync(folder, { recursive: true });
      for (const file of changed)
        if (made.includes(file)) copyFileSync(join(out, file), join(folder, file));
        else rmSync(join(folder, file));
      const noted = existsSync(ledger) ? JSON.parse(readFileSync(ledger, 'utf8')) : {};
      noted[name] = { scripts: hash_scripts(part), files: hash_files(part, folder) };
      const sorted = Object.keys(parts).filter((one) => noted[one]).map((one) => [one, noted[one]]);
      writeFileSync(ledger, `${JSON.stringify(Object.fromEntries(sorted), null, 1)}\n`);
    }
    return changed;
  } finally {
    rmSync(out, { recursive: true });
  }
}

function main(given) {
  const wanted = given.filter((word) => word !== '--check');
  const unknown = wanted.filter((name) => !(name in parts));
  if (unknown.length) {
    console.error(`no part ${unknown.join(', ')}; there are ${Object.keys(parts).join(', ')}`);
    return 2;
  }
  const check = given.includes('--check');
  let differ = 0;
  for (const name of wanted.length ? wanted : Object.keys(parts)) {
    const changed = make(name, !check);
    differ += changed.length;
    const what = changed.length === 0 ? 'the same'
        : `${changed.join(', ')} ${check ? 'differ' : 'made anew'}`;
    console.log(`${name}: ${what}`);
  }
  return check && differ ? 1 : 0;
}

if (argv[1] === fileURLToPath(import.meta.url)) {
  try {
    exit(main(argv.slice(2)));
  } catch (error) {
    console.error(error.message);
    exit(2);
  }
}
