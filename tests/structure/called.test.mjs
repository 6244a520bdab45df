// SPDX-License-Identifier: Apache-2.0
// What a header of the product declares is called by a program. By names: a function whose name
// stands nowhere in server/, avatar/, kiosk/ and voice/ but where it is declared and defined, nor
// in the measurements of `./wellspring bench`, is called by tests alone, or by nobody.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;

// Called by a library or by the language, never by name: name -> who calls it.
const called_elsewhere = {
  allocate: 'std::vector, of its allocator',
  deallocate: 'std::vector, of its allocator',
  async_teardown: 'Boost.Beast, of a stream below a WebSocket',
  beast_close_socket: 'Boost.Beast, likewise',
};

function sources(folder) {
  return readdirSync(join(root, folder), { withFileTypes: true }).flatMap((entry) => {
    const path = `${folder}/${entry.name}`;
    if (entry.isDirectory()) return sources(path);
    return /\.(h|cpp|cpp\.in)$/.test(entry.name) ? [path] : [];
  });
}

// The code of a file: comments, texts and preprocessor lines are blanks.
function code_of(text) {
  return text
    .replace(/R"(\w*)\([^]*?\)\1"/g, '""')
    .replace(/\/\/[^\n]*|\/\*[^]*?\*\/|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)'/g,
      (found) => (found[0] === '"' ? '""' : ' '))
    .replace(/^[ \t]*#(?!define)(?:[^\n]*\\\n)*[^\n]*/gm, '');
}

// The end of what opens at `at`; -1: it does not close.
function closing(code, at) {
  let depth = 0;
  for (let i = at; i < code.length; i++) {
    if (code[i] === '(') depth++;
    else if (code[i] === ')' && --depth === 0) return i;
  }
  return -1;
}

const not_a_type = /\b(return|else|throw|do|case|goto|new|delete|co_return|co_await|co_yield|using|typedef|typename\s*$)\b/;

// Is the name that ends before `open` declared or defined there? A type goes before it, with
// nothing but types since the last statement; a body or ; follows.
function is_declaration(code, begin, open) {
  const close = closing(code, open);
  if (close < 0) return false;
  const after = code.slice(close + 1, close + 120);
  if (!/^\s*(const\b|noexcept\b|override\b|final\b|&&?|->\s*[\w:<>,&*\s]+?|\s)*(;|\{|=\s*(0|default|delete)\b|:)/.test(after))
    return false;
  let start = begin;
  while (start > 0 && !/[;{}()]/.test(code[start - 1])) start--;
  const before = code.slice(start, begin).replace(/^\s*(public|private|protected)\s*:(?!:)/, '');
  const type = before.replace(/(\w+(<[^;{}()]*>)?::)*$/, '');  // without what qualifies the name
  return /\w[\w\s>&*\]]*$/.test(type) && /^[\w\s:<>,&*[\]"]*$/.test(type) && !not_a_type.test(type);
}

const layers = ['server', 'avatar', 'kiosk', 'voice'];
const programs = [...layers, 'tests/benchmark'];

// Returns the functions that headers declare and nothing calls; files: [path, text] each.
function find_idle(files) {
  const declared = new Map();  // name -> file
  const used = new Set();      // names that stand elsewhere than in declarations and definitions
  for (const [file, text] of files) {
    const code = code_of(text);
    for (const found of code.matchAll(/\b[a-z][a-z0-9_]*\b/g)) {
      const name = found[0];
      const end = found.index + name.length;
      const open = end + code.slice(end).match(/^\s*/)[0].length;
      if (code[open] !== '(' || !is_declaration(code, found.index, open)) used.add(name);
      else if (file.endsWith('.h') && !file.startsWith('tests/') && !declared.has(name))
        declared.set(name, file);
    }
  }
  return [...declared].filter(([name]) => !used.has(name) && !(name in called_elsewhere))
    .map(([name, file]) => `${file}: ${name}`);
}

test('declarations and definitions are told from calls', () => {
  const header = `
    // idle_comment() calls nothing.
    int idle_one(int a = twice(2)) noexcept;
    inline std::vector<int> idle_two(const Thing& thing) { return {size_of(thing), 1}; }
    template <class T> T* idle_three(T);
    struct S { S(); bool idle_four() const; static S idle_five(); int size() const; };
    void used_one(); int used_two(int); bool used_three(); void used_four(int); float used_five();
    int twice(int); int size_of(const Thing&);`;
  const source = `
    #include "idle_one()"
    int other::idle_one(int a) noexcept { other::used_one(); return a > 1 && used_three(); }
    bool S::idle_four() const { const char* text = "idle_two()"; return size() < used_two(3); }
    auto table = {&used_four}; const float x = 2 * used_five();`;
  assert.deepEqual(find_idle([['a.h', header], ['a.cpp', source]]),
    ['one', 'two', 'three', 'four', 'five'].map((name) => `a.h: idle_${name}`));
});

test('what a header declares is called by a program, not by tests alone', () => {
  const files = programs.flatMap(sources)
    .map((file) => [file, readFileSync(join(root, file), 'utf8')]);
  assert.ok(files.length > 500);
  assert.deepEqual(find_idle(files), []);
});
