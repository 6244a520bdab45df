// SPDX-License-Identifier: Apache-2.0
// For a technician who sets up a wall: its measures, a link for every screen, and a test pattern,
// whose lines and circles go on from screen to screen when the measures are right.
import { element } from '../element.js';
import { leader_address, tile_address } from './layout.js';

const svg_space = 'http://www.w3.org/2000/svg';
function shape(name, fields) {
  const made = document.createElementNS(svg_space, name);
  for (const [key, value] of Object.entries(fields)) made.setAttribute(key, String(value));
  return made;
}

// Draws what a tile shows of a pattern that spans the wall, in units of a tile's height.
// aspect: width of a tile's picture over its height.
export function draw_pattern({ columns, rows, bezel, column, row }, aspect) {
  const step_x = aspect * (1 + bezel[0]), step_y = 1 + bezel[1];
  const width = step_x * columns - aspect * bezel[0], height = step_y * rows - bezel[1];
  const svg = shape('svg', { class: 'pattern', preserveAspectRatio: 'none',
    viewBox: `${column * step_x} ${row * step_y} ${aspect} 1` });
  const line = (x1, y1, x2, y2) => svg.append(shape('line', { x1, y1, x2, y2 }));
  for (let x = 0; x <= width; x += 0.25) line(x, 0, x, height);
  for (let y = 0; y <= height; y += 0.25) line(0, y, width, y);
  line(0, 0, width, height);
  line(0, height, width, 0);
  for (const share of [0.25, 0.5, 0.98])
    svg.append(shape('circle', { cx: width / 2, cy: height / 2, r: share * height / 2 }));
  svg.append(shape('rect', { x: column * step_x, y: row * step_y, width: aspect, height: 1 }));
  return svg;
}

// Shows the pattern with the tile's number over everything.
export function open_pattern(main, { wall }) {
  const number = wall.row * wall.columns + wall.column + 1;
  const show = () => main.replaceChildren(draw_pattern(wall, innerWidth / innerHeight),
      element('p.number', { textContent: String(number) }),
      element('p.place', { textContent: `column ${wall.column}, row ${wall.row}` }));
  addEventListener('resize', show);
  show();
}

const fields = [
  ['name', 'Name of the wall'], ['columns', 'Screens beside one another'],
  ['rows', 'Screens above one another'],
  ['bezel', 'Frames between two pictures: width, height, as shares of a picture, or in mm'],
  ['screen', 'One picture: width, height in mm, if the frames are in mm'],
  ['fov', 'Degrees from left to right; empty: as the viewpoint has it'],
  ['viewpoint', 'Viewpoint where it begins'], ['exhibit', 'Exhibit'],
];

export function open_assistant(main, { wall, exhibit, problem }) {
  const asks = new URLSearchParams(location.search);
  const inputs = fields.map(([name, label]) => element('label', {}, label,
      element('input', { name, value: asks.get(name) ?? wall[name] ?? '' })));
  const form = element('form', {}, ...inputs, element('button', { textContent: 'Show the links' }));
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    const given = inputs.map((label) => label.querySelector('input')).filter(({ value }) => value);
    location.search =
        new URLSearchParams(given.map(({ name, value }) => [name, value])).toString();
  });
  main.append(element('h1', { textContent: 'A wall of screens' }), form);
  if (problem) {
    main.append(element('p.problem', { role: 'alert', textContent: problem }));
    return;
  }
  const grid = element('div.grid');
  grid.style.gridTemplateColumns = `repeat(${wall.columns}, 1fr)`;
  for (let row = 0; row < wall.rows; row++)
    for (let column = 0; column < wall.columns; column++) {
      const address = tile_address(location.href, column, row);
      const test = new URL(address);
      test.searchParams.set('pattern', '1');
      grid.append(element('div.tile', {},
          element('b', { textContent: String(row * wall.columns + column + 1) }),
          element('a', { href: address, target: '_blank', textContent: 'picture' }),
          element('a', { href: test.href, target: '_blank', textContent: 'test pattern' })));
    }
  const leads = leader_address(location.href, wall, exhibit);
  main.append(
      element('p', { textContent: 'Open each screen\'s test pattern on that screen and make it the '
        + 'whole screen (F11, or a double click in the picture). When lines go on behind the '
        + 'frames and circles are round, open the pictures.' }),
      grid,
      element('p', {}, 'On another computer than the server, put #token= and a kiosk token behind '
        + 'the address. Keys and dragging on any screen move the wall; so does ',
      element('a', { href: leads, textContent: 'a visit that leads it' }),
      ', or a kiosk whose address has wall=', element('b', { textContent: wall.name }), '.'));
}

