// SPDX-License-Identifier: Apache-2.0
// The include direction of ARCHITECTURE.md, and what else the tree promises about itself.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { test } from 'node:test';
import { folder_of, may_include } from './layers.mjs';

const root = process.env.WELLSPRING_SOURCE;

// Rooms: layer -> room -> rooms of the same layer it may include, besides itself. '' is the layer's
// own folder. Every room has a README.md that says who lives there.
const may_enter = {
  avatar: {
    figure: [],
    load: ['figure'],
    speech: [],
    align: ['speech'],
    face: ['figure', 'speech'],
    body: ['figure', 'face'],
    story: ['body', 'align', 'speech'],
    mind: ['figure', 'face', 'body', 'story'],
  },
  store: {
    '': [],
    picture: [''],
    remote: [],
    bands: ['picture', ''],
    format: ['bands', 'remote', 'picture', ''],
    band_files: ['bands', 'format', 'picture', ''],
    geography: [],
    painting: ['geography', 'picture', ''],
    open: ['bands', 'format', 'painting', 'remote', 'picture', ''],
  },
  spectrum: {
    '': [],
    read: [''],
    report: [''],
  },
  volume: {
    '': [],
    format: [''],
    reconstruct: [''],
    compressed: [''],
    compare: ['reconstruct', ''],
    nebula: [''],
    bricks: ['reconstruct', 'format', ''],
    draw: ['bricks', 'reconstruct', 'format', ''],
  },
  scan: {
    '': [],
    las: [''],
    format: ['las', ''],
    tree: [''],
    splats: ['format', ''],
    splat_draw: ['splats', ''],
    'tree/import': ['tree', ''],
    draw: ['tree', ''],
  },
  collection: {
    '': [],
    read: [''],
  },
  world: {
    '': [],
    motion: [''],
    load: ['', 'motion'],
    raster: [''],
  },
  light: {
    random: [],
    material: ['random'],
    '': ['material'],
    sample: ['', 'material', 'random'],
    walk: ['', 'sample', 'material', 'random'],
    kept: ['', 'walk', 'sample', 'material', 'random'],
    'kept/skin': ['', 'walk', 'sample', 'material', 'random'],
    visible: ['', 'kept/skin', 'kept', 'walk', 'sample', 'material', 'random'],
    virtual: ['', 'visible', 'kept', 'walk', 'sample', 'material', 'random'],
    technique: ['', 'virtual', 'visible', 'kept', 'walk', 'sample', 'material', 'random'],
  },
  cache: {
    '': [],
  },
  picture: {
    cells: [],
    still: ['cells'],
    '': ['cells', 'still'],
  },
  workers: {
    package: [],
    '': ['package'],
    jobs: [''],
  },
  kiosk: {
    frame: [],
    gesture: [],
    network: [],
    'network/graph': ['network'],
    process: [],
    face: ['frame', 'network', 'network/graph'],
    tree: [],
    station: ['frame', 'tree'],
    body: ['frame', 'network', 'network/graph'],
    hand: ['frame', 'network', 'network/graph'],
    '': ['body', 'face', 'frame', 'gesture', 'hand', 'network', 'process', 'station', 'tree'],
  },
  show: {
    lighting: [],
    exhibit: ['lighting'],
    scanner: ['exhibit'],
    'exhibit/pieces': ['scanner', 'exhibit'],
    'exhibit/load': ['exhibit/pieces', 'exhibit'],
    moving: ['exhibit'],
    volumes: ['exhibit/pieces', 'exhibit'],
    lawns: ['exhibit/pieces', 'exhibit'],
    check: ['exhibit/pieces', 'exhibit'],
    proposal: ['check', 'exhibit/load', 'exhibit'],
    house: ['exhibit/load', 'exhibit'],
    questions: ['exhibit'],
    storyteller: ['moving', 'exhibit', 'lighting'],
    kiosk: ['storyteller', 'moving', 'exhibit'],
    visit: ['storyteller', 'moving', 'exhibit'],
    wall: [],
    state: ['wall', 'house', 'questions', 'volumes', 'lawns', 'kiosk', 'visit', 'storyteller',
      'moving', 'exhibit/pieces', 'exhibit', 'lighting'],
    count: ['state', 'house', 'questions', 'kiosk', 'visit', 'storyteller', 'moving', 'exhibit'],
    answer: ['wall', 'count', 'state', 'house', 'questions', 'kiosk', 'visit', 'storyteller',
      'moving', 'exhibit/pieces', 'exhibit'],
    workers: ['state', 'storyteller', 'moving', 'exhibit/pieces', 'exhibit'],
    http: ['workers', 'lens', 'volumes', 'lawns', 'answer', 'state', 'house', 'questions', 'kiosk',
      'visit', 'storyteller', 'moving', 'exhibit/pieces', 'exhibit'],
    status: ['http', 'answer', 'state', 'house', 'kiosk', 'visit', 'storyteller', 'moving',
      'exhibit'],
    watch: ['state', 'house', 'kiosk', 'visit', 'storyteller', 'moving', 'exhibit'],
    lens: ['state', 'house', 'kiosk', 'visit', 'storyteller', 'moving', 'exhibit/pieces',
      'exhibit'],
    draw: ['workers', 'wall', 'lens', 'state', 'house', 'kiosk', 'visit', 'storyteller', 'moving',
      'exhibit'],
    // The tick.
    '': ['draw', 'workers', 'answer', 'count', 'state', 'house', 'kiosk', 'visit', 'storyteller',
      'moving', 'exhibit'],
  },
};
// Files in a layer's own folder where that is no room.
const at_home = { avatar: /^main[^/]*\.cpp$/ };
const most_files_a_folder = 30;

// Heavy headers appear in .cpp files of these layers only.
const heavy = [
  [/^(boost\/(beast|asio)|boost\/)/, ['store', 'stream', 'kiosk']],
  [/^(opencv2?|ZXing)\//, ['kiosk']],
  [/^embree[34]?\//, ['world']],
  [/^pugixml/, ['avatar', 'scan', 'store']],
  [/^sndfile/, ['avatar']],
  [/^espeak-ng\//, []],  // GPL: the voice program's one file
  [/^(turbojpeg|png\.h|webp|stb_image|OpenEXR|Imf)/, ['image']],
  [/^(tiffio|lcms2|cairo)/, ['store']],
  [/^(dnnl|omp)/, ['denoise']],
  [/^sqlite3/, ['ledger']],
  [/^yaml-cpp/, ['spectrum']],
  [/^nats\//, ['workers']],
];

// The one header of a folder through which its own files reach a heavy library; no other folder may
// see it.
const gateways = ['server/stream/asio.h', 'server/workers/connect.h', 'server/world/embree.h'];

function* sources(folder, kind = /\.(h|cpp)$/) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory() && entry.name !== 'node_modules') yield* sources(path, kind);
    else if (kind.test(entry.name)) yield path;
  }
}

function files() {
  const found = [];
  for (const top of ['server', 'avatar', 'kiosk', 'voice'])
    for (const path of sources(join(root, top))) {
      const name = relative(root, path);
      const parts = name.split('/');
      const layer = parts[0] === 'server' ? (parts.length > 2 ? parts[1] : 'main') : parts[0];
      const text = readFileSync(path, 'utf8');
      const includes =
          [...text.matchAll(/^\s*#\s*include\s*[<"]([^>"]+)[>"]/gm)].map((match) => match[1]);
      found.push({ name, layer: /main[^/]*\.cpp$/.test(name) ? 'main' : layer, text, includes,
          lines: text.split('\n').length });
    }
  return found;
}

const all = files();
const by_name = new Map(all.map((file) => [file.name, file]));
const path_of = (include) => ['', 'server/'].map((top) => top + include)
    .find((name) => by_name.has(name));
const included = (file) => file.includes.map(path_of).filter((name) => name);

// Groups of more than one node from each of which every other can be reached (Tarjan 1972).
function circles(graph) {
  const index = new Map(), low = new Map(), stack = [], found = [];
  const visit = (node) => {
    index.set(node, index.size), low.set(node, index.get(node)), stack.push(node);
    for (const next of graph.get(node)) {
      if (!index.has(next)) visit(next), low.set(node, Math.min(low.get(node), low.get(next)));
      else if (stack.includes(next)) low.set(node, Math.min(low.get(node), index.get(next)));
    }
    if (low.get(node) < index.get(node)) return;
    const group = stack.splice(stack.indexOf(node));
    if (group.length > 1) found.push(group.sort());
  };
  for (const node of graph.keys()) if (!index.has(node)) visit(node);
  return found;
}

// The rest of a file's path below its layer's folder.
const room_of = (layer, name) => {
  const rest = name.slice(folder_of(layer).length);
  return rest.includes('/') ? rest.slice(0, rest.lastIndexOf('/')) : '';
};

test('there are sources to check', () => assert.ok(all.length > 50));

test('includes follow the direction of the layers', () => {
  const wrong = [];
  for (const { name, layer, includes } of all) {
    if (layer === 'main') continue;
    assert.ok(may_include[layer], `${name} belongs to no known layer`);
    for (const include of includes) {
      const target = include.split('/')[0];
      if (!include.includes('/') || !(target in may_include)) continue;
      if (target !== layer && !may_include[layer].includes(target))
        wrong.push(`${name} includes ${include}`);
    }
  }
  assert.deepEqual(wrong, []);
});

test('units include one another in one direction', () => {
  // A header and its .cpp are one unit.
  const unit_of = (name) => name.replace(/\.(h|cpp)$/, '');
  const graph = new Map(all.map((file) => [unit_of(file.name), new Set()]));
  for (const file of all)
    for (const name of included(file))
      if (unit_of(name) !== unit_of(file.name)) graph.get(unit_of(file.name)).add(unit_of(name));
  assert.deepEqual(circles(graph), []);
});

test('rooms of a layer include one another as their table says', () => {
  const wrong = [];
  for (const [layer, rooms] of Object.entries(may_enter)) {
    assert.deepEqual(circles(new Map(Object.entries(rooms))), [], `${layer}'s table`);
    for (const file of all) {
      if (!file.name.startsWith(folder_of(layer))) continue;
      const room = room_of(layer, file.name);
      if (!(room in rooms)) {
        if (room !== '' || !at_home[layer]?.test(file.name.slice(folder_of(layer).length)))
          wrong.push(`${file.name} is in no known room`);
        continue;
      }
      for (const name of included(file)) {
        if (!name.startsWith(folder_of(layer))) continue;
        const entered = room_of(layer, name);
        if (entered !== room && !rooms[room].includes(entered))
          wrong.push(`${file.name} includes ${name}`);
      }
    }
  }
  assert.deepEqual(wrong, []);
});

test('every room says who lives there, in a few lines', () => {
  const wrong = [];
  for (const [layer, rooms] of Object.entries(may_enter))
    for (const room of Object.keys(rooms).filter((name) => name !== '')) {
      const name = `${folder_of(layer)}${room}/README.md`;
      let lines = [];
      try {
        lines = readFileSync(join(root, name), 'utf8').trimEnd().split('\n');
      } catch {
        wrong.push(`${name}: missing`);
        continue;
      }
      if (lines.length < 5 || lines.length > 12) wrong.push(`${name}: ${lines.length} lines`);
      if (lines.some((line) => [...line].length > 100)) wrong.push(`${name}: over 100 columns`);
    }
  assert.deepEqual(wrong, []);
});

test(`no folder holds more than ${most_files_a_folder} source files`, () => {
  const count = new Map();
  for (const { name } of all) {
    const folder = name.slice(0, name.lastIndexOf('/'));
    count.set(folder, (count.get(folder) ?? 0) + 1);
  }
  const wrong = [...count].filter(([, files]) => files > most_files_a_folder);
  assert.deepEqual(wrong, []);
});

test('files see a declaration of the types that they name', () => {
  // Files of a folder are compiled together: the compiler finds a missing include only by chance.
  const declares = /\b(?:struct|class|enum(?: class)?|using|concept)\s+([A-Z]\w*)/g;
  const bare = (text) => text.replace(/R"(\w*)\([\s\S]*?\)\1"/g, '').replace(/\/\/.*/g, '')
      .replace(/"(\\.|[^"\\\n])*"/g, '').replace(/alignas\([^)]*\)/g, '');
  const code = new Map(all.map(({ name, text }) => [name, bare(text)]));
  const declared = new Map([...code].map(([name, text]) =>
      [name, new Set([...text.matchAll(declares)].map((match) => match[1]))]));
  const layer_of = (name) => by_name.get(name).layer;
  const reach = (name, found = new Set([name])) => {
    for (const next of included(by_name.get(name)))
      if (!found.has(next)) found.add(next), reach(next, found);
    return found;
  };
  const homes = new Map();  // type at the beginning of a line -> headers that define it
  for (const [name, text] of code)
    if (name.endsWith('.h'))
      for (const [line, type] of text.matchAll(new RegExp(`^${declares.source}.*`, 'gm')))
        if (!line.endsWith(';') || line.startsWith('using'))
          homes.set(type, [...(homes.get(type) ?? []), name]);
  const wrong = [];
  for (const [name, text] of code) {
    const seen = [...reach(name)];
    const near = [layer_of(name), ...(may_include[layer_of(name)] ?? [])];
    for (const type of new Set(text.match(/\b[A-Z]\w*/g)))
      if (homes.get(type)?.some((home) => near.includes(layer_of(home))) &&
          !seen.some((file) => declared.get(file).has(type)))
        wrong.push(`${name} names ${type} of ${homes.get(type)}`);
  }
  assert.ok(homes.size > 500);
  assert.deepEqual(wrong, []);
});

test('heavy headers stay in .cpp files of their own layer', () => {
  const wrong = [];
  for (const { name, layer, includes } of all)
    for (const include of includes)
      for (const [pattern, layers] of heavy)
        if (pattern.test(include)) {
          const speaks = name === 'voice/main.cpp' && /^espeak/.test(include);
          const program = layer === 'main' && (name.startsWith('kiosk/') || speaks);
          if (!(layers.includes(layer) || program)) wrong.push(`${name} includes ${include}`);
          else if (name.endsWith('.h') && !gateways.includes(name))
            wrong.push(`the header ${name} includes ${include}`);
        }
  assert.deepEqual(wrong, []);
});

test('what a gateway header brings in stays in its folder', () => {
  const reaches = (name, seen = new Set()) => {
    if (gateways.includes(name)) return name;
    if (seen.has(name)) return null;
    seen.add(name);
    for (const next of included(by_name.get(name))) {
      const found = reaches(next, seen);
      if (found) return found;
    }
    return null;
  };
  const wrong = [];
  for (const { name, layer } of all) {
    const gateway = reaches(name);
    if (gateway && gateway.split('/')[1] !== layer) wrong.push(`${name} sees ${gateway}`);
  }
  assert.deepEqual(wrong, []);
});

test('no line is longer than 100 columns, but what raw strings quote', () => {
  const wrong = [];
  const folders = ['server', 'avatar', 'kiosk', 'voice', 'web', 'content', 'tests'];
  const kind = /\.(h|cpp|js|mjs|py)$/;
  for (const path of folders.flatMap((top) => [...sources(join(root, top), kind)])) {
    const text = readFileSync(path, 'utf8')
        .replace(/R"(\w*)\([\s\S]*?\)\1"/g, (raw) => raw.replace(/[^\n]/g, ''));
    text.split('\n').forEach((line, i) => {
      if ([...line].length > 100) wrong.push(`${relative(root, path)}:${i + 1}`);
    });
  }
  assert.deepEqual(wrong, []);
});

test('one licence line per file, include guards, and no file over 500 lines', () => {
  const wrong = [];
  for (const { name, text, lines } of all) {
    if (!text.startsWith('// SPDX-License-Identifier: Apache-2.0\n'))
      wrong.push(`${name}: no SPDX line`);
    if (name.endsWith('.h') && !text.includes('#pragma once'))
      wrong.push(`${name}: no #pragma once`);
    if (lines > 500) wrong.push(`${name}: ${lines} lines`);
  }
  for (const path of sources(join(root, 'tests'))) {
    const lines = readFileSync(path, 'utf8').split('\n').length;
    if (lines > 500) wrong.push(`${relative(root, path)}: ${lines} lines`);
  }
  assert.deepEqual(wrong, []);
});
