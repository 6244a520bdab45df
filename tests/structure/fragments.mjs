// SPDX-License-Identifier: Apache-2.0
// Finds comments that are no sentences: `node tests/structure/fragments.mjs FILES` lists them.
import { readFileSync } from 'node:fs';
import { argv } from 'node:process';

// A comment of several lines is one text, with the line that it begins in.
function comments(source) {
  const found = [];
  let goes_on = false;
  source.split('\n').forEach((line, index) => {
    const [, code, text] = line.match(/^((?:[^"/]|\/(?!\/)|"(?:[^"\\]|\\.)*")*)\/\/ ?(.*)$/) ?? [];
    if (text === undefined) goes_on = false;
    else if (goes_on && code.trim() === '') found.at(-1).text += ` ${text.trim()}`;
    else found.push({ line: index + 1, text: text.trim() });
    goes_on = text !== undefined && (goes_on || code.trim() === '') && text.trim() !== '';
  });
  return found;
}

// A fragment hangs on a subject that stands elsewhere: "of the depth", "Where light is kept".
export const fragments = (source) => comments(source).filter(({ text }) =>
  /^(of|what|where|that)\b/i.test(text) || /[.!?] (Of|What|Where|That)\b/.test(text));

if (import.meta.url === `file://${argv[1]}`)
  for (const file of argv.slice(2))
    for (const { line, text } of fragments(readFileSync(file, 'utf8')))
      console.log(`${file}:${line}: ${text}`);
