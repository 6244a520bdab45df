// SPDX-License-Identifier: Apache-2.0
// The page /wall: a screen of a wall, its test pattern, or the assistant.
import { by_id } from '../element.js';
import { open_assistant, open_pattern } from './assistant.js';
import { read_layout } from './layout.js';
import { open_tile } from './tile.js';

const layout = read_layout(location.search), main = document.querySelector('main');
const is_tile = 'column' in layout.wall && !layout.problem;
document.body.classList.add(is_tile ? 'tile' : 'assistant');
if (!is_tile) open_assistant(main, layout);
else if (new URLSearchParams(location.search).has('pattern')) open_pattern(main, layout);
else open_tile(main, layout);
by_id('picture')?.focus();
