// SPDX-License-Identifier: Apache-2.0
// Makes the borders of the valley's parishes in 1850, as GeoJSON: areas with names, borders along
// the river and over land, and the stones that stand on them.
import { random_source } from './pen.mjs';

const east = 4000, north = 2500;  // metres
// The valley is nowhere; its corner is put where such valleys are.
const west_degrees = 13.21, south_degrees = 49.04, metres_a_degree = 111195;
const along = metres_a_degree * Math.cos(Math.PI / 180 * (south_degrees + 0.5 * north /
  metres_a_degree));

const rounded = (x) => Number(x.toFixed(6));
const degrees = ([x, y]) => [rounded(west_degrees + x / along),
  rounded(south_degrees + y / metres_a_degree)];
export const bounds = [...degrees([0, 0]), ...degrees([east, north])];

// Returns a line that strays to both sides, as borders over land do.
function strayed(random, corners, amount, rounds) {
  let line = corners;
  for (let round = 0; round < rounds; round++, amount /= 2.1) {
    const finer = [line[0]];
    for (let i = 1; i < line.length; i++) {
      const [a, b] = [line[i - 1], line[i]];
      const off = amount * (random() - 0.5);
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      finer.push([(a[0] + b[0]) / 2 - off * (b[1] - a[1]) / length,
        (a[1] + b[1]) / 2 + off * (b[0] - a[0]) / length], b);
    }
    line = finer;
  }
  return line;
}

const river = [[1830, 2500], [1840, 2330], [1760, 2120], [1640, 1940], [1640, 1760], [1740, 1600],
  [1860, 1420], [1880, 1240], [1800, 1040], [1740, 830], [1780, 560], [1860, 330], [1890, 100],
  [1886, 0]];

const feature = (properties, type, coordinates) => ({ type: 'Feature', properties,
  geometry: { type, coordinates } });
const names = (en, de, sk) => ({ name: en, 'name:de': de, 'name:sk': sk });
const roman = (n) => ['X', 'IX', 'V', 'IV', 'I'].reduce(([text, rest], sign) => {
  const worth = { X: 10, IX: 9, V: 5, IV: 4, I: 1 }[sign], count = Math.floor(rest / worth);
  return [text + sign.repeat(count), rest - count * worth];
}, ['', n])[0];

export function make_parishes() {
  const random = random_source(1850);
  const upper = strayed(random, [[0, 1690], [620, 1700], [1240, 1790], [1640, 1760]], 190, 4);
  const lower = strayed(random, [[0, 960], [560, 930], [1150, 890], [1740, 830]], 150, 4);
  const eastern = strayed(random, [[1860, 1420], [2300, 1640], [2900, 1700], [3500, 1640],
    [4000, 1730]], 210, 4);
  const ring = (...lines) => {
    const places = lines.flat().map(degrees);
    return [[...places, places[0]]];
  };
  const back = (line) => [...line].reverse();
  // RFC 7946 wants outer rings to go round to the left. Names stand where the map has room.
  const parishes = [
    [names('Parish of Saint Adela', 'Pfarre Sankt Adela', 'Farnosť svätej Adely'), [1150, 2010],
      ring(upper, river.slice(0, 5).reverse(), [[0, 2500]])],
    [names('Parish of Falconwell Town', 'Stadtpfarre Falkenbrunn', 'Farnosť Sokolí Prameň'), [640, 1085],
      ring(lower, river.slice(4, 10).reverse().slice(1), back(upper).slice(1))],
    [names('Parish of Bell Wood', 'Pfarre Glockenholz', 'Farnosť Zvonový háj'), [1330, 330],
      ring([[0, 0]], river.slice(9).reverse(), back(lower).slice(1))],
    [names('Parish of the Great Wood', 'Pfarre am Großen Wald', 'Farnosť pri Veľkom lese'), [2200, 1990],
      ring(eastern, [[4000, 2500]], river.slice(0, 6))],
    [names('Parish of the Castle', 'Burgpfarre', 'Hradná farnosť'), [3520, 1290],
      ring(river.slice(6).reverse().slice(0, -1), eastern.slice(0, 1), eastern.slice(1),
        [[4000, 0]]).map((places) => [...places].reverse())],
  ];
  const areas = parishes.flatMap(([name, spot, places]) => [
    feature({ kind: 'parish', ...name }, 'Polygon', places),
    feature({ kind: 'parish_name', ...name }, 'Point', degrees(spot))]);
  const borders = [river, upper, lower, eastern].map((line, i) => feature(
    { kind: i === 0 ? 'river_border' : 'border' }, 'LineString', line.map(degrees)));
  let number = 0;
  const stones = [upper, lower, eastern].flatMap((line) => line.filter((_, i) => i % 4 === 2)
    .map((place) => feature({ kind: 'stone', ...names(`Boundary stone ${roman(++number)}`,
      `Grenzstein ${roman(number)}`, `Hraničný kameň ${roman(number)}`) }, 'Point',
    degrees(place))));
  return { type: 'FeatureCollection', bbox: bounds, features: [...areas, ...borders, ...stones] };
}

// Returns the item that shows them on the map of that year.
export const parish_item = (frame) => ({
  geojson: 'parishes_1850.geojson', bounds,
  frame: [frame.left, frame.top, frame.right, frame.bottom], styles: {
    parish_name: { label: { size_mm: 12, slanted: true, fill: '#8a3a4a', halo: '#eee8d8b0',
      halo_mm: 0.9 } },
    border: { stroke: '#6a2436', width_mm: 0.4, dash_mm: [3, 1.2], casing: '#c0506850',
      casing_mm: 3.2 },
    river_border: { casing: '#c0506838', casing_mm: 4.5 },
    stone: { fill: '#6a2436', stroke: '#eee8d8', width_mm: 0.15, radius_mm: 0.45,
      label: { size_mm: 0.9, font: 'serif', fill: '#38342f', halo: '#eee8d8c0', halo_mm: 0.12 } },
  },
});
