// SPDX-License-Identifier: Apache-2.0
// ESLint and the TypeScript compiler check the pages' scripts, and ESLint the tests. Tests run on
// the oldest Node that a supported system ships: Debian 12's.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { test } from 'node:test';
import { load_module } from '../server.mjs';

const root = process.env.WELLSPRING_SOURCE;
const oldest_node = '>=18.20.0';
const scripts = readdirSync(join(root, 'web'), { recursive: true })
  .filter((name) => name.endsWith('.js')).map((name) => join(root, 'web', name));

test('ESLint has nothing to say', async () => {
  const { ESLint } = load_module('eslint'), { configs } = load_module('@eslint/js');
  const rules = [configs.recommended, {
    languageOptions: { ecmaVersion: 2023, sourceType: 'module' },
    rules: {
      'no-undef': 'off',  // names of the browser and of Node are the compiler's task
      'no-unused-vars': ['error', { ignoreRestSiblings: true }],
      'prefer-const': 'error', 'no-var': 'error', eqeqeq: 'error',
    },
  }];
  const node = 'n/no-unsupported-features';
  rules.push({
    files: ['tests/**/*.mjs', 'art/*.mjs'], plugins: { n: load_module('eslint-plugin-n') },
    settings: { node: { version: oldest_node } },
    rules: {
      [`${node}/node-builtins`]: ['error', { allowExperimental: true }],
      [`${node}/es-builtins`]: 'error',
      [`${node}/es-syntax`]: ['error', { ignores: ['modules'] }],
    },
  });
  const eslint = new ESLint({ cwd: root, overrideConfigFile: true, overrideConfig: rules });
  const looked = await eslint.lintFiles(['web/**/*.js', 'tests/**/*.mjs', 'art/*.mjs']);
  assert.ok(looked.length > scripts.length);
  assert.deepEqual(looked.flatMap(({ filePath, messages }) => messages.map(({ line, message }) =>
    `${relative(root, filePath)}:${line} ${message}`)), []);
});

test('Node takes the pages\' scripts for modules, as browsers do', () => {
  // Node 18 goes by the package.json of the folder, later ones guess by what is in the file.
  assert.equal(JSON.parse(readFileSync(join(root, 'web/package.json'), 'utf8')).type, 'module');
});

test('the types of the pages\' scripts agree', () => {
  const ts = load_module('typescript');
  const program = ts.createProgram(scripts, {
    allowJs: true, checkJs: true, noEmit: true, strict: false, skipLibCheck: true, types: [],
    target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.ESNext,
    moduleResolution: ts.ModuleResolutionKind.Bundler,
    lib: ['lib.es2023.d.ts', 'lib.dom.d.ts', 'lib.dom.iterable.d.ts'],
  });
  const place = (file, start) => file
    && `${relative(root, file.fileName)}:${file.getLineAndCharacterOfPosition(start).line + 1} `;
  assert.deepEqual(ts.getPreEmitDiagnostics(program).map(({ file, start, messageText }) =>
    place(file, start) + ts.flattenDiagnosticMessageText(messageText, ' ')), []);
});
