// SPDX-License-Identifier: Apache-2.0
// The speak command as its user meets it: sound and marks out, and what it says of bad input.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-speak-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const speak = (...args) => run('wellspring_speak', args);
const file = (name) => join(folder, name);

// {rate, samples} of a canonical 16-bit mono WAV.
function read_wav(path) {
  const bytes = readFileSync(path);
  assert.equal(bytes.toString('latin1', 0, 4) + bytes.toString('latin1', 8, 16), 'RIFFWAVEfmt ');
  assert.equal(bytes.readUInt32LE(4), bytes.length - 8);
  assert.deepEqual([20, 22, 34].map((at) => bytes.readUInt16LE(at)), [1, 1, 16]);
  assert.equal(bytes.readUInt32LE(40), bytes.length - 44);
  return { rate: bytes.readUInt32LE(24),
    samples: new Int16Array(bytes.buffer, bytes.byteOffset + 44, (bytes.length - 44) / 2) };
}

function check_marks(marks, duration) {
  assert.equal(marks.version, 1);
  assert.ok(Math.abs(marks.duration - duration) < 1e-3);
  let last = 0;
  for (const { start, end } of marks.words) {
    assert.ok(start >= last - 1e-4 && end > start && end <= marks.duration,
        `${start} ${end} after ${last}`);
    last = end;
  }
  last = 0;
  for (const { start, end, word, ipa } of marks.phonemes) {
    assert.ok(Math.abs(start - last) < 2e-4 && end >= start, `a gap at ${start}`);
    assert.ok(word >= -1 && word < marks.words.length);
    assert.ok(word >= 0 || ipa === '');
    last = end;
  }
  assert.ok(Math.abs(last - marks.duration) < 2e-4);
  const sums = new Map();
  for (const { time, weight, viseme } of marks.visemes) {
    assert.match(viseme, /^(sil|PP|FF|TH|DD|kk|CH|SS|nn|RR|aa|E|ih|oh|ou)$/);
    assert.ok(weight >= 0 && weight <= 1);
    sums.set(time, (sums.get(time) ?? 0) + weight);
  }
  for (const [time, sum] of sums)
    assert.ok(Math.abs(sum - 1) < 0.01, `weights at ${time} sum to ${sum}`);
}

test('speaks five languages, the same way every time', async () => {
  const texts = {
    en: 'Pebbles from the tower of the castle, isn’t it beautiful?',
    de: 'Im Jahre 1786 brannte der große Palast über der Stadt.',
    sk: 'Žltý kôň úpel ďábelské ódy pod mostom.',
    fr: 'Un vieux château au bord de l’eau, œuvre du peuple.',
    es: 'El pingüino Wenceslao hizo kilómetros bajo la lluvia.',
  };
  for (const [lang, text] of Object.entries(texts)) {
    const { status, stderr } = await speak(text, '--lang', lang, '--wav', file('a.wav'), '--json',
        file('a.json'));
    assert.equal(status, 0, stderr);
    assert.equal(stderr, '', lang);
    const { rate, samples } = read_wav(file('a.wav'));
    assert.equal(rate, 22050);
    const marks = JSON.parse(readFileSync(file('a.json'), 'utf8'));
    check_marks(marks, samples.length / rate);
    // Every letter belongs to a word, and every word is what its characters say.
    const letters = (words) => words.join('').replace(/[^\p{L}\p{N}]/gu, '');
    const characters = [...text];
    for (const { text: word, characters: [from, to] } of marks.words)
      assert.equal(word, characters.slice(from, to).join(''));
    assert.equal(letters(marks.words.map(({ text: word }) => word)), letters([text]));
    // It is loud while it speaks and silent at the end.
    const loud = (from, to) =>
        Math.max(...samples.slice(Math.round(from * rate), Math.round(to * rate)).map(Math.abs));
    for (const { start, end } of marks.words) assert.ok(loud(start, end) > 1000, lang);
    assert.ok(loud(marks.duration - 0.1, marks.duration) < 300, lang);
    const again = await speak(text, '--lang', lang, '--wav', file('b.wav'));
    assert.equal(again.status, 0);
    assert.deepEqual(readFileSync(file('b.wav')), readFileSync(file('a.wav')));
  }
});

test('prints words when no file is asked for', async () => {
  const { status, stdout } = await speak('Welcome home');
  assert.equal(status, 0);
  assert.match(stdout, /^\s*0\.\d+\s+0\.\d+\s+Welcome\s.*w@/m);
});

test('a recording gives its marks, and marks moved by hand are taken', async () => {
  const text = 'The oldest tower of the castle looks over the river.';
  const said = await speak(text, '--lang', 'en-us', '--words-per-minute', '130', '--pitch', '80',
      '--wav', file('said.wav'), '--json', file('said.json'));
  assert.equal(said.status, 0, said.stderr);
  const { status, stderr } = await speak(text, '--audio', file('said.wav'), '--json',
      file('marks.json'), '--wav', file('same.wav'));
  assert.equal(status, 0, stderr);
  const truth = JSON.parse(readFileSync(file('said.json'), 'utf8'));
  const marks = JSON.parse(readFileSync(file('marks.json'), 'utf8'));
  check_marks(marks, truth.duration);
  assert.deepEqual(marks.words.map(({ text: word }) => word),
      truth.words.map(({ text: word }) => word));
  const errors = marks.words.map(({ start }, i) => Math.abs(start - truth.words[i].start))
      .sort((a, b) => a - b);
  assert.ok(errors[errors.length >> 1] <= 0.03 && errors.at(-1) <= 0.08, errors.join(' '));
  assert.equal(read_wav(file('same.wav')).samples.length,
      read_wav(file('said.wav')).samples.length);

  marks.words.at(-1).end += 0.05;
  writeFileSync(file('moved.json'), JSON.stringify(marks));
  const moved = await speak(text, '--audio', file('said.wav'), '--marks', file('moved.json'),
      '--json', file('again.json'));
  assert.equal(moved.status, 0, moved.stderr);
  const again = JSON.parse(readFileSync(file('again.json'), 'utf8'));
  check_marks(again, truth.duration);
  const last = again.phonemes.filter(({ word }) => word >= 0).at(-1);
  assert.ok(Math.abs(last.end - marks.words.at(-1).end) < 2e-4);
});

test('wrong input is 1 and named', async () => {
  const text_file = file('text.wav'), silent_file = file('silent.wav');
  writeFileSync(text_file, 'This is no sound.');
  const header = Buffer.from(
      '524946460000000057415645666d74201000000001000100401f0000803e000002001000646174610000'
      + '0000', 'hex');
  header.writeUInt32LE(36 + 32000, 4);
  header.writeUInt32LE(32000, 40);
  writeFileSync(silent_file, Buffer.concat([header, Buffer.alloc(32000)]));
  const cases = [
    [[''], /empty/], [['  \n'], /empty/], [['…'.repeat(3400)], /10200 bytes/],
    [['x'.repeat(100000)], /100000 bytes/],
    [['hello', '--lang', 'xx'], /'xx'/], [['hello', '--lang', '../../etc'], /language/],
    [['hello', '--wav', join(folder, 'none', 'a.wav')], /none.a\.wav.*cannot be written/],
    [['hello', '--json', folder], /cannot be written/],
    [['hello', '--audio', file('none.wav')], /none\.wav.*no such file/],
    [['hello', '--audio', folder], /no regular file/],
    [['hello', '--audio', text_file], /text\.wav.*no sound can be read/],
    [['hello', '--audio', silent_file], /silent\.wav.*no sound in the recording/],
    [['hello', '--marks', text_file], /text\.wav.*not JSON at line 1/],
    [['hello', '--marks', file('none.json')], /none\.json.*cannot be read/],
  ];
  for (const [args, message] of cases) {
    const { status, stderr } = await speak(...args);
    assert.equal(status, 1, `${args.join(' ').slice(0, 60)}\n${stderr}`);
    assert.match(stderr, message);
  }
});

test('a wrong command line is 2', async () => {
  for (const args of [[], ['a', 'b'], ['a', '--loud'], ['a', '--words-per-minute', '9'],
      ['a', '--wav']]) {
    const { status, stderr } = await speak(...args);
    assert.equal(status, 2, args.join(' '));
    assert.ok(stderr.length > 0);
  }
});
