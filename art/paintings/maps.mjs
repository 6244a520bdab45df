// SPDX-License-Identifier: Apache-2.0
// Draws the valley's map in five years, each in the manner of its time. Places are in metres east
// and north of a corner of the valley.
import { make_frame, make_signs } from './map_signs.mjs';
import { parish_item } from './parishes.mjs';
import { box, fill, oval, random_source, round, Sheet, stroke } from './pen.mjs';

const east = 4000, north = 2500;
const frame = { left: 0.05, top: 0.05, right: 0.95, bottom: 0.6125 };
const whole = (x) => Math.round(x * 10) / 10;
const at = ([x, y]) => [whole(x), whole(y)];

const feature = (kind, type, coordinates, label) => ({ type: 'Feature',
  properties: { kind, ...(label && { label }) }, geometry: { type, coordinates } });
const spot = (kind, place, label) => feature(kind, 'Point', at(place), label);
const way = (kind, places, label) => feature(kind, 'LineString', places.map(at), label);
const area = (kind, places, label) => feature(kind, 'Polygon', [[...places, places[0]].map(at)],
  label);

// Returns a ring around a place, rough by a share of its size.
function ring(random, x, y, rx, ry, count, rough = 0.2) {
  return Array.from({ length: count }, (_, i) => {
    const turn = 2 * Math.PI * i / count, far = 1 - rough * random();
    return [x + rx * far * Math.cos(turn), y + ry * far * Math.sin(turn)];
  });
}

const old_river = [[1750, 2560, 26], [1900, 2330, 28], [1700, 2120, 32], [1420, 1980, 34],
  [1380, 1760, 38],
  [1640, 1600, 42], [1930, 1450, 48], [1960, 1240, 54], [1720, 1060, 60], [1560, 830, 70],
    [1700, 560, 80],
  [1950, 330, 90], [1980, 100, 100], [1900, -60, 110]];
const new_river = [[1750, 2560, 26], [1840, 2330, 28], [1760, 2120, 30], [1640, 1940, 32],
  [1640, 1760, 34],
  [1740, 1600, 36], [1860, 1420, 40], [1880, 1240, 44], [1800, 1040, 50], [1740, 830, 56],
    [1780, 560, 62],
  [1860, 330, 70], [1890, 100, 76], [1880, -60, 80]];
const banks = (river) => [...river.map(([x, y, w]) => [x - w / 2, y]),
  ...river.map(([x, y, w]) => [x + w / 2, y]).reverse()];

const names = {
  river: { en: 'River Falk', de: 'die Falke', sk: 'rieka Sokolica' },
  castle: { en: 'Falconwell', de: 'Falkenbrunn', sk: 'Sokolí Prameň' },
  tower: { en: 'Watchtower', de: 'Wachtturm', sk: 'Strážna veža' },
  ford: { en: 'The Ford', de: 'Die Furt', sk: 'Brod' },
  bridge: { en: 'Bridge', de: 'Brücke', sk: 'Most' },
  town: { en: 'Falconwell Town', de: 'Stadt Falkenbrunn', sk: 'Mesto Sokolí Prameň' },
  village: { en: 'Lower Village', de: 'Niederdorf', sk: 'Nižná Ves' },
  huts: { en: 'Five Huts', de: 'Fünf Hütten', sk: 'Päť chalúp' },
  wood: { en: 'The Great Wood', de: 'Der große Wald', sk: 'Veľký les' },
  south: { en: 'Bell Wood', de: 'Glockenholz', sk: 'Zvonový háj' },
  mill: { en: 'Mill', de: 'Mühle', sk: 'Mlyn' },
  field: { en: 'Long Fields', de: 'Lange Äcker', sk: 'Dlhé polia' },
  foundry: { en: 'Bell Foundry', de: 'Glockengießerei', sk: 'Zvonolejáreň' },
  station: { en: 'Station', de: 'Bahnhof', sk: 'Stanica' },
  museum: { en: 'Castle Museum', de: 'Burgmuseum', sk: 'Hradné múzeum' },
  gallows: { en: 'Crow Hill', de: 'Krähenberg', sk: 'Vraní vrch' },
  school: { en: 'School', de: 'Schule', sk: 'Škola' },
};

// Returns houses along the town's streets, the oldest first: a place, a turn, and the year.
function make_houses() {
  const random = random_source(99), houses = [];
  for (let i = 0; i < 260; i++) {
    const far = Math.sqrt(i / 260), turn = 2.4 * i + 0.5 * random();
    houses.push([980 + 560 * far * Math.cos(turn) + 30 * random(), 1330 +
      330 * far * Math.sin(turn) + 24 * random()]);
  }
  return houses;
}
const house_counts = { 1210: 5, 1450: 42, 1650: 84, 1850: 150, 1950: 260 };

function wood_of(year, random) {
  const woods = [area('forest', ring(random, 3250, 2080, 720, 360, 15), names.wood)];
  if (year < 1850) woods.push(area('forest', ring(random, 480, 1990, 460, 250, 13)));
  if (year < 1650) woods.push(area('forest', ring(random, 2950, 620, 800, 420, 16)));
  woods.push(area('forest', ring(random, 560, 420, 480, 300, 13), names.south));
  if (year >= 1650) woods.push(area('forest', ring(random, 3550, 480, 340, 260, 11)));
  return woods;
}

function fields_of(year, random) {
  const fields = [];
  if (year < 1450) return [area('field', ring(random, 1060, 1000, 200, 110, 9), names.field)];
  const rows = year < 1650 ? 3 : 5;
  for (let k = 0; k < rows; k++)
    for (let i = 0; i < 6; i++) {
      const x = 2240 + 250 * i + 40 * k, y = 1000 - 150 * k;
      if (x > 3800) continue;
      const corner = () => 16 * (random() - 0.5);
      fields.push(area('field', [[x + corner(), y + corner()],
        [x + 220 + corner(), y + 14 + corner()],
        [x + 224 + corner(), y + 128 + corner()], [x + 4 + corner(), y + 120 + corner()]]));
    }
  if (year >= 1650)
    for (let i = 0; i < 7; i++)
      fields.push(area('field', [[180 + 170 * i, 740 + 16 * i], [330 + 170 * i, 750 + 16 * i],
        [330 + 170 * i, 900 + 10 * i], [180 + 170 * i, 880 + 10 * i]]));
  return fields;
}

function hills_of(year, random) {
  const hills = [[2760, 1480, 430, 300], [3380, 1500, 300, 170], [460, 1780, 320, 150],
    [2650, 2260, 380, 170]];
  if (year < 1650)
    return hills.flatMap(([x, y, rx], i) => [spot('hill', [x, y - 40]),
      spot('hill', [x + rx * 0.7, y + 40])]
      .slice(i === 0 ? 0 : 0, 2));
  const levels = year === 1950 ? [1, 0.84, 0.68, 0.52, 0.36, 0.2] : [1, 0.7, 0.42];
  return hills.flatMap(([x, y, rx, ry]) => levels.map((size) =>
    area('hill', ring(random_source(x), x, y, rx * size, ry * size, 14, 0.22))));
}

function features_of(year) {
  const random = random_source(year), river = year < 1850 ? old_river : new_river;
  const bridge = year < 1850 ? [[1870, 1150], [2060, 1160]] : [[1780, 1150], [1980, 1160]];
  const list = [...fields_of(year, random), ...hills_of(year, random), ...wood_of(year, random),
    area('river', banks(river))];
  list.push(way('river_name', (year < 1850 ? [[1610, 700], [1560, 860], [1660, 1010]] :
    [[1790, 500], [1745, 760],
    [1790, 980]]).reverse(), names.river));
  const west = [[-40, 1180], [420, 1240], [980, 1300], [1500, 1200], bridge[0]];
  const up = [bridge[1], [2280, 1190], [2560, 1280], [2900, 1330], [2960, 1430], [2780, 1470]];
  if (year >= 1450) list.push(way('road', west), way('road', up),
    way('road', [bridge[1], [2600, 1080], [3300, 1180],
    [4040, 1120]]));
  else list.push(way('road', [[-40, 1180], [900, 1290], [1500, 1200], [2000, 1160], [2500, 1300],
    [2760, 1480]]));
  if (year >= 1650) list.push(way('road', [[980, 1300], [1000, 1700], [1180, 2100], [1300, 2540]]),
    way('road', [[980, 1300], [900, 900], [1080, 500], [1240, -40]]));
  if (year === 1950) list.push(way('rail', [[-40, 1020], [500, 1060], [1100, 1020], [1500, 960],
    [1800, 960],
    [2400, 900], [3200, 820], [4040, 860]]), spot('station', [1100, 1028], names.station));
  if (year >= 1450) list.push(way('bridge', bridge, names.bridge));
  else list.push(spot('name', [1960, 1225], names.ford));
  if (year === 1650 || year === 1450) {
    const count = year === 1450 ? 0 : 16;
    if (count) list.push(area('wall', ring(random_source(5), 985, 1335, 400, 236, count, 0.06)));
  }
  make_houses().slice(0, house_counts[year]).sort((a, b) => b[1] - a[1]).forEach((place) =>
    list.push(spot('house', place)));
  list.push(spot(year < 1450 ? 'name' : 'town', [1000, year < 1450 ? 1440 : year < 1650 ? 1480 :
    1740],
    year < 1450 ? names.huts : year < 1650 ? names.village : names.town));
  if (year >= 1450) list.push(spot('church', [990, 1350]), spot('mill', [1480, 1000], names.mill),
    spot('castle', [2770, 1500], year === 1950 ? names.museum : names.castle));
  else list.push(spot('tower', [2770, 1500], names.tower));
  if (year >= 1650) list.push(spot('church', [720, 1250]),
    spot('name', [1500, 1330], names.foundry));
  if (year === 1950) list.push(spot('name', [330, 1400], names.school));
  list.push(spot('name', [460, year < 1650 ? 1600 : 1800], names.gallows));
  return list;
}

const titles = {
  1210: [{ en: 'The Valley of the Falcon', de: 'Das Tal des Falken', sk: 'Sokolia dolina' },
    { en: 'drawn in the year of our Lord 1210', de: 'gezeichnet im Jahr des Herrn 1210', sk:
      'kreslené roku Pána 1210' }],
  1450: [{ en: 'Falconwell and its Fields', de: 'Falkenbrunn und seine Felder', sk:
    'Sokolí Prameň a jeho polia' },
    { en: 'painted for the castle, 1450', de: 'für die Burg gemalt, 1450', sk:
      'maľované pre hrad, 1450' }],
  1650: [{ en: 'Falconia Vallis', de: 'Falconia Vallis', sk: 'Falconia Vallis' },
    { en: 'engraved in copper, 1650', de: 'in Kupfer gestochen, 1650', sk: 'ryté do medi, 1650' }],
  1850: [{ en: 'District of Falconwell', de: 'Bezirk Falkenbrunn', sk: 'Okres Sokolí Prameň' },
    { en: 'survey of 1850, lithograph', de: 'Aufnahme von 1850, Steindruck', sk:
      'zameranie z roku 1850, litografia' }],
  1950: [{ en: 'Falconwell', de: 'Falkenbrunn', sk: 'Sokolí Prameň' },
    { en: 'hikers’ map, 1950', de: 'Wanderkarte, 1950', sk: 'turistická mapa, 1950' }],
};

// Says what each age draws with.
const manners = {
  1210: { ink: '#4a2c17', paper: '#e3cf9f', wash: '#dcc48e', roof: '#a8573a', tree: '#7d8a4a', pen:
    0.05, font: 'script',
    wobble: 0.0014, water: '#7d9c93', field: '#d3b566', forest: '#b5ab62', road: '#8a6236', stains:
      0.035 },
  1450: { ink: '#3a2415', paper: '#e8d9b0', wash: '#eadcb8', roof: '#b04a32', tree: '#5f7d42', pen:
    0.03, font: 'script',
    wobble: 0.0009, water: '#5f8aa8', field: '#dcb95a', forest: '#9fb06a', road: '#b08a52', stains:
      0.03 },
  1650: { ink: '#2b2119', paper: '#ebe1c8', wash: '#ebe1c8', roof: '#ded0b0', tree: '#e4d8ba', pen:
    0.012, font: 'serif',
    wobble: 0.0003, forest: '#e6dcc0', road: '#2b2119', stains: 0.024 },
  1850: { ink: '#38342f', paper: '#eee8d8', wash: '#eee8d8', roof: '#c98a72', tree: '#dfe0c4', pen:
    0.006, font: 'serif',
    wobble: 0.0002, water: '#c5d6da', forest: '#d9dfbf', field: '#efe5c2', road: '#e9dfc6', stains:
      0.02 },
  1950: { ink: '#22262a', paper: '#f6f3e8', wash: '#f6f3e8', roof: '#5a5450', tree: '#a3c78b', pen:
    0, font: 'sans',
    wobble: 0, water: '#9fcbe6', forest: '#c3ddb0', field: '#f6eecb', road: '#f2b544', stains:
      0.008 },
};

function styles_of(year, m) {
  const engraved = year === 1650, drawn = year < 1650, plan = year >= 1850;
  const label = (size, fill = m.ink, more = {}) => ({ size, fill, font: m.font, align: 0.5,
    ...more });
  const pen = { wobble: m.wobble, wobble_period: 0.006 };
  const sign = (symbol, scale, more) => ({ symbol, scale, label:
    label(0.011, m.ink, { shift: [0, 0.014] }), ...more });
  const slanted = { slanted: year >= 1650 };
  return {
    river: { stroke: m.ink, width: engraved ? 0.0005 : 0.0008, smooth: true, ...pen,
      ...(m.water && { fill: m.water }),
      ...(year <= 1650 && { hatch: { spacing: engraved ? 0.0009 : 0.0026, angle: engraved ? 0 : 8,
        stroke: `${m.ink}90`,
        width: engraved ? 0.0002 : 0.0004, density: 0.85 } }) },
    river_name: { label: label(0.012, plan ? '#2f6790' : m.ink,
      { ...slanted, shift: [0, 0.004] }) },
    forest: { fill: m.forest, smooth: true, stroke: `${m.ink}90`, width: plan ? 0.0004 : 0.0006,
      ...pen,
      symbol: year === 1450 || year === 1950 ? 'fir_sign' : 'tree_sign', cell:
        [0.014, 0.0115, 0.0085, 0.0075, 0.0085][
        [1210, 1450, 1650, 1850, 1950].indexOf(year)], scale: [0.017, 0.014, 0.0095, 0.0065, 0.006][
        [1210, 1450, 1650, 1850, 1950].indexOf(year)], shade: drawn ? 0.15 : 0,
      label: label(0.018, m.ink, slanted),
      ...(year === 1850 && { hatch: { spacing: 0.0016, angle: 90, stroke: `${m.ink}40`, width:
        0.0002 } }) },
    field: { ...(m.field && { fill: m.field }), stroke: `${m.ink}b0`, width: 0.0004, ...pen,
      hatch: { spacing: drawn ? 0.0032 : 0.0022, angle: drawn ? 12 : 28, stroke: `${m.ink}70`,
        width: 0.0003,
        density: 0.92 }, label: label(0.011) },
    hill: drawn ? { symbol: 'hill_sign', scale: 0.04 } : engraved ?
      { smooth: true, hachures: { length: 0.02,
      spacing: 0.0014, width: 0.0006, fill: m.ink } } : year === 1850 ?
        { smooth: true, hachures: { length: 0.013,
      spacing: 0.0009, width: 0.00045, fill: '#5d5448' } } :
        { smooth: true, stroke: '#b5763f', width: 0.00045 },
    road: plan ? { stroke: m.road, width: 0.0026, casing: m.ink, casing_width: 0.0036, smooth:
      true }
      : { stroke: m.paper, width: 0.0022, casing: m.ink, casing_width: 0.0032, smooth: true,
        ...pen },
    bridge: { stroke: m.wash, width: 0.005, casing: m.ink, casing_width: 0.0066, label:
      label(0.0095, m.ink,
      { shift: [0, 0.014] }) },
    rail: { stroke: '#ffffff', width: 0.0012, casing: '#202020', casing_width: 0.0022, smooth:
      true },
    station: { symbol: 'house_plan', scale: 0.011, label:
      label(0.009, m.ink, { shift: [0, 0.014] }) },
    house: sign(plan ? 'house_plan' : 'house_sign', [0.02, 0.0125, 0.0095, 0.0052, 0.0048][
      [1210, 1450, 1650, 1850, 1950].indexOf(year)]),
    church: sign(plan ? 'church_plan' : 'church_sign', plan ? 0.011 : 0.018),
    castle: sign(plan ? 'castle_plan' : 'castle_sign', plan ? 0.02 : 0.036,
      { label: label(0.016, drawn ? '#8e2a1c' : m.ink,
      { shift: [0, plan ? 0.032 : 0.018] }) }),
    tower: sign('tower_sign', 0.045, { label: label(0.016, '#8e2a1c', { shift: [0, 0.02] }) }),
    mill: sign('mill_sign', plan ? 0.014 : 0.022, {}),
    wall: { stroke: m.ink, width: 0.0014, hachures:
      { length: 0.003, spacing: 0.003, width: 0.001, fill: m.ink } },
    town: { label: label(plan ? 0.022 : 0.019, drawn ? '#8e2a1c' : m.ink,
      { bold: year === 1950 }) },
    name: { label: label(drawn ? 0.0135 : 0.0095, m.ink, slanted) },
  };
}

function make_map(year) {
  const m = manners[year];
  const sheet = new Sheet({ width: 40960, height: 27136, metres: 1.1, seed: year });
  make_signs(sheet, m);
  const random = random_source(year + 1), stains = [];
  sheet.symbol('stain', [oval(0, 0, 1, 1, sheet.radial(0, 0, 1, 0, '#6b421800', 0.8, '#6b421818',
    0.93, '#6b421828', 1,
    '#6b421800'))]);
  sheet.symbol('dirt', [oval(0, 0, 1, 1, sheet.radial(0, 0, 1, 0, '#5a381426', 1, '#5a381400'))]);
  for (let i = 0; i < (year < 1900 ? 9 : 2); i++)
    stains.push({ include: i % 3 === 0 ? 'stain' : 'dirt', move:
      [random(), 0.65 * random()].map((n) => Number(n.toFixed(4))),
      scale: Number((0.04 + 0.12 * random()).toFixed(4)) });
  for (const [x, y] of [[0, 0], [1, 0], [0, 0.66], [1, 0.66]])
    if (year < 1900) stains.push({ include: 'dirt', move: [x, y], scale: 0.28 });
  const folds = year >= 1650 ? [0.25, 0.5, 0.75].map((x) =>
    ({ box: [x, -0.01, x + 0.0012, 0.7], fill: '#3a2a1828' })) : [];
  const map = { features: { type: 'FeatureCollection', features: features_of(year) }, styles:
    styles_of(year, m),
    metres: [0, 0, east, north], frame: [frame.left, frame.top, frame.right, frame.bottom] };
  const [title, subtitle] = titles[year];
  sheet.layer('paint', m.paper, { grain: { period: year < 1500 ? 0.0004 : 0.00025, depth: m.stains,
    octaves: 9 } },
    [map, ...(year === 1850 ? [parish_item(frame)] : []),
    ...make_frame({ ...m, ...frame, title, subtitle, metres: east,
      measure: { en: '500 metres', de: '500 Meter', sk: '500 metrov' } }), ...folds, ...stains]);
  return sheet.file;
}

export const make_maps = () => [1210, 1450, 1650, 1850, 1950].map((year) =>
  [`map_${year}`, make_map(year)]);
