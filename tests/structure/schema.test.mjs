// SPDX-License-Identifier: Apache-2.0
// content/exhibit.schema.json is what the program prints of its own reader, and exhibits fit it.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;
const read = (name) => readFileSync(join(root, name), 'utf8');
const schema = JSON.parse(read('content/exhibit.schema.json'));

const type_of = (value) => value === null ? 'null' : Array.isArray(value) ? 'array' : typeof value;

// Returns how `value` breaks the rule, each fault with its place. `words` are the words of JSON
// Schema that the schema uses.
const words = new Set(['$schema', '$ref', '$defs', 'title', 'description', 'type', 'properties',
  'required', 'additionalProperties', 'items', 'minItems', 'maxItems', 'minimum', 'maximum', 'enum',
  'const', 'anyOf', 'oneOf']);
function faults(rule, value, place = '') {
  for (const word of Object.keys(rule)) assert.ok(words.has(word), `the schema says "${word}"`);
  if (rule.$ref) return faults(schema.$defs[rule.$ref.replace('#/$defs/', '')], value, place);
  const found = [], say = (what) => found.push(`${place}: ${what}`);
  const fitting = (rules) => rules.filter((one) => faults(one, value, place).length === 0).length;
  const type = rule.type === 'integer' && Number.isInteger(value) ? 'integer' : type_of(value);
  if (rule.type && type !== rule.type) return [`${place}: is no ${rule.type}`];
  if (rule.enum && !rule.enum.includes(value)) say('is none of the known words');
  if ('const' in rule && rule.const !== value) say(`is not ${rule.const}`);
  if (rule.anyOf && fitting(rule.anyOf) === 0) say('fits nothing');
  if (rule.oneOf && fitting(rule.oneOf) !== 1) say('fits not one alone');
  if (value < rule.minimum || value > rule.maximum) say('is out of range');
  if (type_of(value) === 'array') {
    if (value.length < rule.minItems || value.length > rule.maxItems) say('is of a wrong length');
    if (rule.items) value.forEach((one, i) => found.push(...faults(rule.items, one,
        `${place}/${i}`)));
  }
  if (type_of(value) === 'object') {
    for (const name of rule.required ?? []) if (!(name in value)) say(`lacks ${name}`);
    for (const [name, one] of Object.entries(value)) {
      const known = rule.properties?.[name] ?? rule.additionalProperties;
      if (known === false) say(`has no field ${name}`);
      else if (known) found.push(...faults(known, one, `${place}/${name}`));
    }
  }
  return found;
}

test('the program prints it', () => {
  const printed = execFileSync(join(process.env.WELLSPRING_BIN, 'wellspring_check'),
    ['--schema', 'exhibit'], { encoding: 'utf8' });
  assert.equal(printed, read('content/exhibit.schema.json'),
    'make it again: ./wellspring check --schema exhibit > content/exhibit.schema.json');
});

test('every exhibit fits the schema', () => {
  const exhibits = readdirSync(join(root, 'content'))
      .filter((name) => existsSync(join(root, 'content', name, 'exhibit.json')));
  assert.ok(exhibits.includes('castle'));
  for (const id of exhibits)
    assert.deepEqual(faults(schema, JSON.parse(read(`content/${id}/exhibit.json`))), [], id);
});

test('the examples of content/README.md fit it', () => {
  const examples = [...read('content/README.md').matchAll(/```json\n([\s\S]*?)```/g)]
      .map((match) => JSON.parse(match[1]));
  assert.ok(examples.length >= 2);
  for (const example of examples) {
    const part = example.topics ? { book: example } : example;
    const whole = { title: 'x', ...(part.scenes ? {} : { scene: 'x.glb' }), ...part };
    assert.deepEqual(faults(schema, whole), []);
  }
});

test('mistakes do not fit', () => {
  const good = { title: 'x', scene: 'x.glb' };
  assert.deepEqual(faults(schema, good), []);
  for (const bad of [{ scene: 'x.glb' }, { ...good, scenes: [] }, { title: 'x' },
    { ...good, exposure: 'bright' }, { ...good, light_scale: -1 }, { ...good, expsure: 1 },
    { ...good, viewpoints: [{ name: 'a', position: [0, 1] }] },
    { ...good, viewpoints: [{ position: [0, 1, 2] }] },
    { ...good, objects: { a: { nod: 'x' } } }])
    assert.ok(faults(schema, bad).length > 0, JSON.stringify(bad));
});
