// SPDX-License-Identifier: Apache-2.0
// What ESLint and the TypeScript compiler say about the pages' scripts, and ESLint about the tests.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, relative } from 'node:path';
import { test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;
const require = createRequire(join(process.env.WELLSPRING_NODE, 'package.json'));
const scripts = readdirSync(join(root, 'web'), { recursive: true })
  .filter((name) => name.endsWith('.js')).map((name) => join(root, 'web', name));

test('ESLint has nothing to say', async () => {
  const { ESLint } = require('eslint'), { configs } = require('@eslint/js');
  const rules = [configs.recommended, {
    languageOptions: { ecmaVersion: 2023, sourceType: 'module' },
    rules: {
      'no-undef': 'off',  // names of the browser and of Node are the compiler's task
      'no-unused-vars': ['error', { ignoreRestSiblings: true }],
      'prefer-const': 'error', 'no-var': 'error', eqeqeq: 'error',
    },
  }];
  const eslint = new ESLint({ cwd: root, overrideConfigFile: true, overrideConfig: rules });
  const looked = await eslint.lintFiles(['web/**/*.js', 'tests/**/*.mjs']);
  assert.ok(looked.length > scripts.length);
  assert.deepEqual(looked.flatMap(({ filePath, messages }) => messages.map(({ line, message }) =>
    `${relative(root, filePath)}:${line} ${message}`)), []);
});

test('the types of the pages\' scripts agree', () => {
  const ts = require('typescript');
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
