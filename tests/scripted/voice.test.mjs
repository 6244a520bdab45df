// SPDX-License-Identifier: Apache-2.0
// The storyteller heard over the WebSocket: sound in time with the mouth, as documented.
import assert from 'node:assert/strict';
import {
  cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, source, start_server } from '../server.mjs';

const skip = !existsSync(join(process.env.WELLSPRING_BIN, 'wellspring_voice'))
    && 'wellspring_voice has not been built';
let server;
before(async () => { if (!skip) server = await start_server(); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

const metric = async (name) => {
  const metrics = await (await fetch(`${server.url}/metrics`)).text();
  return Number(new RegExp(`^wellspring_${name} (\\S+)$`, 'm').exec(metrics)[1]);
};
async function lines_are_spoken() {
  for (let i = 0; i < 300; i++) {
    if (await metric('voice_lines') > 0 && await metric('voice_lines_waiting') === 0) return;
    await sleep(100);
  }
  assert.fail('the lines are not spoken within 30 s');
}
const loudness = (samples) =>
    Math.sqrt(samples.reduce((sum, v) => sum + v * v, 0) / Math.max(1, samples.length));

test('a story is heard, and the mouth moves in time with it', { skip }, async () => {
  await lines_are_spoken();
  assert.equal(await metric('voice_running'), 1);
  assert.equal(await metric('voice_failed_total'), 0);
  const visitor = new Visitor(server);
  const { stories, storyteller } = await visitor.hello({ lang: 'en' });
  const mouths = [];
  visitor.next((item) => {
    if (item.message?.type === 'agent' && item.message.mouth) mouths.push(item.message.mouth);
    return false;
  }, '', 60000).catch(() => {});
  const started = visitor.message('speech', (message) => message.action === 'start');
  visitor.send({ type: 'storyteller', story: stories[0].id });
  const speech = await started;
  assert.equal(speech.lang, 'en');
  assert.equal(speech.words.length, speech.text.split(/\s+/).length);
  const next = await visitor.message('speech', (message) => message.action === 'start');
  assert.ok(next.utterance > speech.utterance);
  const pieces = visitor.sounds.filter((sound) => sound.utterance === speech.utterance);
  const { rate, total, time_us, mouth } = pieces[0];
  assert.ok(Math.abs(total / rate - speech.seconds) < 1e-3);
  const heard = pieces.flatMap((sound) => sound.samples);
  assert.equal(heard.length, total, 'every sample, once');
  let at = 0;
  for (const piece of pieces) {
    assert.equal(piece.start, at);
    assert.ok(Math.abs(piece.time_us - time_us - 1e6 * at / rate) < 2);
    at += piece.samples.length;
  }
  assert.ok(loudness(heard) > 300, `loudness ${loudness(heard)}`);
  // The mouth is on the storyteller's head.
  const [right, up, back] = mouth.map((x, axis) => x - storyteller.position[axis]);
  assert.ok(Math.hypot(right, back) < 0.5);
  assert.ok(up > 1.2 && up < 1.9, `mouth at ${mouth}`);
  // Lips as the pictures show them, against the sound of the same moment.
  const around = (seconds) => loudness(heard.slice(Math.max(0, Math.round((seconds - 0.02) * rate)),
      Math.max(0, Math.round((seconds + 0.02) * rate))));
  const seen = mouths.filter((one) => one.utterance === speech.utterance && one.seconds >= 0
      && one.seconds < speech.seconds);
  assert.ok(seen.length > 10, `${seen.length} mouths seen`);
  const levels = (test) => seen.filter(test).map((one) => around(one.seconds))
      .sort((a, b) => a - b);
  const vowels = levels((one) => ['aa', 'E', 'ih', 'oh', 'ou'].includes(one.viseme));
  assert.ok(vowels.length > 2 && vowels[vowels.length >> 1] > 0.7 * loudness(heard),
      `vowels ${vowels}`);
  const closed = levels((one) => one.viseme === 'sil');
  if (closed.length)
    assert.ok(closed[closed.length >> 1] < 0.3 * loudness(heard), `silence ${closed}`);
  visitor.send({ type: 'storyteller', action: 'stop' });
  await visitor.message('agent', (message) => message.story === null);
  await visitor.close();
});

test('stop is heard at once, and nothing is sent to those who do not listen', { skip },
    async () => {
  await lines_are_spoken();
  const visitor = new Visitor(server), deaf = new Visitor(server);
  const { stories } = await visitor.hello({ lang: 'sk' });
  await deaf.hello();
  deaf.send({ type: 'settings', sound: false });
  await sleep(200);
  const started = visitor.message('speech',
      (message) => message.action === 'start' && message.lang === 'sk');
  visitor.send({ type: 'storyteller', story: stories[0].id });
  const { utterance } = await started;
  await sleep(500);
  const stopped = visitor.message('speech', (message) => message.action === 'stop');
  visitor.send({ type: 'storyteller', action: 'stop' });
  assert.equal((await stopped).utterance, utterance);
  const sent = visitor.sounds.length;
  assert.ok(sent > 0);
  await sleep(700);
  assert.equal(visitor.sounds.length, sent);
  assert.equal(deaf.sounds.length, 0);
  await visitor.close();
  await deaf.close();
});

// Returns when sound begins after 100 ms of silence: the first 5 ms that are louder than 40 dB
// under the loudest.
function onsets(samples, rate) {
  const window = Math.round(rate / 200), energy = [];
  for (let i = 0; i + window <= samples.length; i += window)
    energy.push(loudness(samples.slice(i, i + window)));
  const threshold = Math.max(...energy) * 0.01, found = [];
  let quiet = 1000;
  energy.forEach((value, i) => {
    if (value > threshold) {
      if (quiet >= 20) found.push(i * window / rate);
      quiet = 0;
    } else quiet++;
  });
  return found;
}

test('words and lips come with the sound as it is sent', { skip }, async () => {
  await lines_are_spoken();
  const visitor = new Visitor(server), errors = [];
  const { stories } = await visitor.hello({ lang: 'en' });
  const lines = [];
  const fourth = visitor.next(({ message }) => {
    if (message?.type === 'speech' && message.action === 'start') lines.push(message);
    return lines.length === 4;
  }, 'the fourth sentence', 60000);
  visitor.send({ type: 'storyteller', story: stories[0].id });
  await fourth;
  for (const line of lines.slice(0, 3)) {
    const pieces = visitor.sounds.filter((sound) => sound.utterance === line.utterance);
    const heard = onsets(pieces.flatMap((sound) => sound.samples), pieces[0].rate);
    assert.ok(heard.length >= 1);
    for (const at of heard)
      errors.push(Math.min(...line.words.map(({ begin }) => Math.abs(begin - at))));
  }
  errors.sort((a, b) => a - b);
  assert.ok(errors[errors.length >> 1] <= 0.03 && errors.at(-1) <= 0.08, `seconds off: ${errors}`);
  visitor.send({ type: 'storyteller', action: 'stop' });
  await visitor.message('agent', (message) => message.story === null);
  await visitor.close();
});

test('a pause rests with the word and goes on with it, in time', { skip }, async () => {
  await lines_are_spoken();
  const visitor = new Visitor(server);
  const { stories } = await visitor.hello({ lang: 'de' });
  const started = visitor.message('speech', (message) => message.action === 'start');
  visitor.send({ type: 'storyteller', story: stories[1].id });
  const first = await started;
  await sleep(1500);
  const stopped = visitor.message('speech', (message) => message.action === 'stop');
  visitor.send({ type: 'storyteller', action: 'pause' });
  assert.equal((await stopped).utterance, first.utterance);
  await sleep(300);
  const sent = visitor.sounds.length;
  await sleep(1000);
  assert.equal(visitor.sounds.length, sent, 'nothing is sent while it rests');
  const resumed = visitor.message('speech', (message) => message.action === 'start');
  visitor.send({ type: 'storyteller', action: 'play' });
  const again = await resumed;
  assert.ok(again.utterance > first.utterance);
  assert.equal(again.text, first.text);
  await sleep(600);
  const piece = visitor.sounds.find((sound) => sound.utterance === again.utterance);
  const at = piece.start / piece.rate,
      off = Math.min(...again.words.map(({ begin }) => Math.abs(begin - at)));
  assert.ok(at > 0.3 && off < 0.002, `goes on at ${at} s, ${off} s from a word`);
  visitor.send({ type: 'storyteller', action: 'stop' });
  await visitor.message('agent', (message) => message.story === null);
  await visitor.close();
});

test('a tour is told to its visitor alone, and pauses', { skip }, async () => {
  await lines_are_spoken();
  const visitor = new Visitor(server), other = new Visitor(server);
  const { tours } = await visitor.hello({ lang: 'en' });
  await other.hello({ lang: 'en' });
  const started = visitor.message('speech', (message) => message.action === 'start');
  visitor.send({ type: 'tour', action: 'play', name: tours[0].id });
  const speech = await started;
  assert.match(speech.text, /great hall/);
  const state = await visitor.message('state', (message) => message.tour?.state === 'playing');
  assert.ok(state.tour.stops >= 5);
  await sleep(500);
  assert.equal(other.sounds.length, 0);
  const stopped = visitor.message('speech', (message) => message.action === 'stop');
  visitor.send({ type: 'tour', action: 'pause' });
  await stopped;
  const again = visitor.message('speech', (message) => message.action === 'start');
  visitor.send({ type: 'tour', action: 'play' });
  assert.equal((await again).text, speech.text);
  visitor.send({ type: 'tour', action: 'stop' });
  await visitor.message('state', (message) => message.tour === null);
  await visitor.close();
  await other.close();
});

test('the description names sound and speech', { skip }, async () => {
  const api = await (await fetch(`${server.url}/api/v1/`)).json();
  assert.equal(api.binary.sound.magic, 'WSA1');
  assert.ok(api.server_to_browser.speech.utterance && api.browser_to_server.settings.sound);
});

// A package of a camera, a lamp, the castle's storyteller, and a story with its narrator's
// recording: the synthesiser in another voice.
async function recorded_package(folder) {
  const room = join(folder, 'room');
  const text = 'The castle stands above the river, and nobody remembers who built its tower. '
      + 'On quiet evenings you can hear the great bell from the bridge.';
  mkdirSync(room);
  cpSync(join(source, 'content', 'castle', 'figures'), join(room, 'figures'),
      { recursive: true, filter: (from) => !/\.py$|people/.test(from) });
  writeFileSync(join(room, 'tale.en.txt'), text);
  writeFileSync(join(room, 'scene.gltf'), JSON.stringify({
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0, 1] }],
    nodes: [{ camera: 0, name: 'door', translation: [0, 1.6, 2] },
        { translation: [1, 3, 2], extensions: { KHR_lights_punctual: { light: 0 } } }],
    cameras: [{ type: 'perspective', perspective: { yfov: 0.8, znear: 0.1 } }],
    extensionsUsed: ['KHR_lights_punctual'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'point', intensity: 20 }] } },
  }));
  writeFileSync(join(room, 'exhibit.json'), JSON.stringify({
    id: 'room', title: { en: 'Room' }, scene: 'scene.gltf',
    storyteller: { figure: 'figures/storyteller.x3d', position: [0, 0, 0], yaw_deg: 180 },
    stories: [{ id: 'tale', title: { en: 'Tale' }, text: { en: 'tale.en.txt' },
        sound: { en: 'tale.wav' } }],
  }));
  const { status, stderr } = await run('wellspring_speak',
      ['--story', join(room, 'tale.en.txt'), '--lang', 'en-us', '--variant', 'f4',
          '--words-per-minute', '140', '--wav', join(room, 'tale.wav')]);
  assert.equal(status, 0, stderr);
  const wav = readFileSync(join(room, 'tale.wav'));
  return { room, samples: new Int16Array(wav.buffer, wav.byteOffset + 44, (wav.length - 44) / 2),
    rate: wav.readUInt32LE(24) };
}

test('a narrator\'s recording is heard as it is, with words, subtitles and lips in time', { skip },
    async () => {
  const folder = mkdtempSync(join(tmpdir(), 'wellspring-recorded-'));
  let room_server = null;
  try {
    const { room, samples, rate } = await recorded_package(folder);
    const checked = await run('wellspring_check', [room]);
    assert.equal(checked.status, 0, checked.stdout + checked.stderr);
    room_server = await start_server(['--exhibit', 'room', '--cache', join(folder, 'cache')],
        { content: folder });
    const visitor = new Visitor(room_server);
    await visitor.hello({ lang: 'en' });
    const mouths = [], starts = [];
    const two = visitor.next(({ message }) => {
      if (message?.type === 'agent' && message.mouth) mouths.push(message.mouth);
      if (message?.type === 'speech' && message.action === 'start') starts.push(message);
      return starts.length === 2;
    }, 'the second sentence', 40000);
    visitor.send({ type: 'storyteller', story: 'tale' });
    await two;
    const [first] = starts;
    assert.ok(visitor.messages.some((message) => message.type === 'subtitle'
        && message.text === first.text));
    const pieces = visitor.sounds.filter((sound) => sound.utterance === first.utterance),
        heard = pieces.flatMap((sound) => sound.samples);
    assert.equal(pieces[0].rate, rate);
    assert.equal(heard.length, pieces[0].total);
    assert.ok(heard.every((sample, i) => sample === samples[i]),
        'the recording itself, from its beginning');
    // Words where the sound is, lips that move with it.
    const found = onsets(heard, rate);
    for (const at of found)
      assert.ok(Math.min(...first.words.map(({ begin }) => Math.abs(begin - at))) <= 0.08,
          `no word at ${at}`);
    const around = (seconds) =>
        loudness(heard.slice(Math.max(0, Math.round((seconds - 0.02) * rate)),
            Math.max(0, Math.round((seconds + 0.02) * rate))));
    const levels = mouths.filter((one) => one.utterance === first.utterance && one.seconds >= 0
        && ['aa', 'E', 'ih', 'oh', 'ou'].includes(one.viseme))
      .map((one) => around(one.seconds)).sort((a, b) => a - b);
    assert.ok(levels.length > 2 && levels[levels.length >> 1] > 0.7 * loudness(heard),
        `vowels ${levels}`);
    await visitor.close();
    // The text of another story: refused, with the recording's name.
    writeFileSync(join(room, 'tale.en.txt'),
        'Two brothers once quarrelled about the best horse of the whole wide valley. '
        + 'They shouted so loudly that all ravens left the tower.');
    const refused = await run('wellspring_check', [room]);
    assert.equal(refused.status, 1);
    assert.match(refused.stdout, /error: .*tale\.wav: the recording does not say this text/);
  } finally {
    if (room_server) assert.equal(await room_server.stop(), 0);
    rmSync(folder, { recursive: true, force: true });
  }
});
