// SPDX-License-Identifier: Apache-2.0
// Reads a wall from an address: /wall?name=hall&columns=3&rows=1&column=0&row=0&bezel=0.02,0.02
// and, where wanted, exhibit=ID, viewpoint=NAME, fov=DEGREES from the left to the right of the
// wall, or bezel=8,8&screen=520,290: millimetres between two pictures, and of one picture.
export const most_a_side = 8, most_tiles = 16;

const pair = (text) => {
  const numbers = (text ?? '').split(',').map((word) => (word.trim() ? Number(word) : NaN));
  return numbers.length === 2 && numbers.every((v) => v >= 0 && v < Infinity) ? numbers : null;
};
const whole = (text, least, most) => {
  const number = Number(text);
  return text !== null && text !== '' && Number.isInteger(number) && number >= least
    && number <= most ? number : null;
};

// Returns {wall: as `hello` has it, without column and row for the assistant, exhibit, problem:
// what is wrong with the address, empty: nothing}. search: of an address.
export function read_layout(search) {
  const asks = new URLSearchParams(search);
  let problem = '';
  const take = (name, least, most, otherwise) => {
    if (!asks.has(name)) return otherwise;
    const number = whole(asks.get(name), least, most);
    if (number === null) problem ||= `${name} must be a whole number from ${least} to ${most}`;
    return number ?? otherwise;
  };
  const columns = take('columns', 1, most_a_side, 2), rows = take('rows', 1, most_a_side, 1);
  if (columns * rows > most_tiles) problem ||= `a wall has at most ${most_tiles} screens`;
  const column = take('column', 0, columns - 1, null), row = take('row', 0, rows - 1, null);
  if ((column === null) !== (row === null)) problem ||= 'column and row go together';
  let bezel = asks.has('bezel') ? pair(asks.get('bezel')) : [0, 0];
  if (asks.has('screen')) {
    const screen = pair(asks.get('screen'));
    if (!screen || screen.includes(0)) problem ||= 'screen must be width,height in millimetres';
    else bezel &&= bezel.map((v, i) => v / screen[i]);
  }
  if (!bezel || bezel.some((v) => v > 1)) {
    problem ||= 'bezel must be width,height: shares of a picture, or millimetres beside screen';
    bezel = [0, 0];
  }
  const degrees = asks.has('fov') ? Number(asks.get('fov')) : 0;
  if (!(degrees >= 0 && degrees <= 160)) problem ||= 'fov must be 0 to 160 degrees';
  const wall = { name: asks.get('name') || 'wall', columns, rows, bezel };
  if (degrees > 0) Object.assign(wall, { fov: degrees * Math.PI / 180 });
  if (asks.get('viewpoint')) Object.assign(wall, { viewpoint: asks.get('viewpoint') });
  if (column !== null && row !== null) Object.assign(wall, { column, row });
  return { wall, exhibit: asks.get('exhibit') ?? '', problem };
}

// Returns the address of a tile, as this one's page has it otherwise.
export function tile_address(href, column, row) {
  const url = new URL(href);
  url.searchParams.set('column', column);
  url.searchParams.set('row', row);
  url.hash = '';
  return url.href;
}

// Returns the address of a page whose visit leads the wall.
export function leader_address(href, { name }, exhibit) {
  const url = new URL('.', href);
  url.search = new URLSearchParams({ ...(exhibit && { exhibit }), wall: name }).toString();
  return url.href;
}
