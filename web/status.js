// SPDX-License-Identifier: Apache-2.0
// The technician's page: what is wrong in words, as the server judges it, and figures, once a
// second.
import { by_id } from './element.js';
import { of_tab } from './kept.js';
import { colours, draw_speeds, time_text } from './speeds.js';

// Prometheus text to [{name, labels, value}].
function parse_metrics(text) {
  const found = [];
  for (const line of text.split('\n')) {
    const match = /^wellspring_(\w+?)(?:\{(.*)\})? (\S+)$/.exec(line);
    if (!match) continue;
    const labels = {};
    for (const [, name, value] of (match[2] ?? '').matchAll(/(\w+)="([^"]*)"/g))
      labels[name] = value;
    found.push({ name: match[1], labels, value: Number(match[3]) });
  }
  return found;
}

function make(name, text, class_name = '') {
  const element = document.createElement(name);
  element.textContent = text;
  element.className = class_name;
  return element;
}

// heads: names of columns, or null: the first cell of each row is its name. A cell is a text, or
// {text, bad}.
function fill(table, heads, list) {
  const cell = (one, kind, scope) => {
    const element = make(kind, one.text ?? one, one.bad ? 'bad' : '');
    if (scope) element.scope = scope;
    return element;
  };
  const rows = list.map((cells) => {
    const row = document.createElement('tr');
    row.append(...cells.map((one, i) => cell(one, i ? 'td' : 'th', i ? '' : 'row')));
    return row;
  });
  const body = document.createElement('tbody'), head = document.createElement('thead');
  body.append(...rows);
  if (heads) {
    const row = document.createElement('tr');
    row.append(...heads.map((name) => cell(name, 'th', 'col')));
    head.append(row);
    table.replaceChildren(head, body);
  } else table.replaceChildren(body);
}

// "14:03", or with its day where that is another.
function since_text(seconds) {
  const then = new Date(Date.now() - 1000 * seconds);
  const clock = then.toLocaleTimeString('en-GB', { hour: '2-digit', minute: '2-digit' });
  return then.toDateString() === new Date().toDateString() ? clock
    : `${then.toLocaleDateString('en-GB', { day: 'numeric', month: 'long' })}, ${clock}`;
}
const duration = (seconds) => seconds < 120 ? `${Math.round(seconds)} s`
  : seconds < 7200 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
const mebibytes = (bytes) => `${Math.round(bytes / 2 ** 20)} MiB`;
const number = (value, digits = 0) => value === undefined
  ? '–' : value.toLocaleString('en', { maximumFractionDigits: digits });

let told = '';
function tell(state, headline, findings) {
  const lines = findings.map(({ what, seconds, why, remedy, grave }) =>
    ({ line: `${what}${seconds === null ? '' : ` since ${since_text(seconds)}`}`
      + `${why ? `: ${why}` : ''}.`, remedy, grave }));
  const all = JSON.stringify([state, headline, lines]);
  if (all === told) return;  // screen readers hear of changes alone
  told = all;
  by_id('verdict').dataset.state = state;
  by_id('verdict-word').textContent = headline;
  by_id('findings').replaceChildren(...lines.map(({ line, remedy, grave }) => {
    const item = make('li', '', grave ? 'grave' : '');
    item.append(make('p', line), make('p', remedy, 'remedy'));
    return item;
  }));
}

function judge({ findings }) {
  const grave = findings.filter((one) => one.grave).length, others = findings.length - grave;
  if (grave)
    tell('bad', grave === 1 ? 'Something is wrong' : `${grave} things are wrong`, findings);
  else if (others) tell('note', 'Guests are well; something could be better', findings);
  else tell('fine', 'Everything is fine', []);
}

const camera_words = { good: 'works', dark: 'sees only black', frozen: 'stands still',
  missing: 'gives no picture', slow: 'is slow', silent: 'says nothing',
  disconnected: 'not connected', calibrating: 'is being calibrated' };

const eye_words = { faces: 'faces', mesh: 'fine faces', expression: 'expressions',
  bodies: 'bodies', hands: 'hands', objects: 'objects' };

// Says what a camera's program sees, and what it is asked for and cannot see.
function say_eyes(eyes = {}) {
  const of = (works) => Object.keys(eye_words).filter((part) => eyes[part] === works)
    .map((part) => eye_words[part]).join(', ');
  const missing = of(false);
  return { text: missing ? `${of(true) || '–'}; without networks: ${missing}` : of(true),
    bad: missing !== '' };
}

function show_kiosks({ kiosks, cameras }) {
  fill(by_id('kiosks'), ['Kiosk', 'Stage', 'People', 'Storyteller', 'Screens', 'Cameras'],
      kiosks.map((one) => [one.name || 'without a name', one.stage, one.people,
        one.storyteller ? 'here' : '–', one.screens, one.cameras]));
  fill(by_id('cameras'), ['Camera', 'Kiosk', 'State', 'Sees', 'For'], cameras.map((one) => [
    one.name, one.kiosk || '–', { text: camera_words[one.state] ?? one.state,
      bad: !['good', 'calibrating'].includes(one.state) }, say_eyes(one.eyes),
    duration(one.seconds)]));
  by_id('kiosks-section').hidden = kiosks.length === 0;
  by_id('cameras-section').hidden = cameras.length === 0;
}

function show_workers({ workers }) {
  by_id('workers-section').hidden = workers.length === 0;
  fill(by_id('workers'), ['Worker', 'Exhibit', 'State', 'Cores', 'Samples/s', 'Samples', 'Line ms'],
      workers.map((one) => [one.name, one.exhibit,
        { text: one.problem || (one.same_bits ? 'traces' : 'traces, other bits of the same light'),
          bad: one.problem !== '' },
        number(one.cores), number(one.samples_per_second), number(one.samples),
        number(one.line_ms)]));
}

// Returns a reader of metrics over all exhibits: counts are added, of other values the largest is
// taken.
const reader = (metrics) => (name) => {
  const values = metrics.filter((metric) => metric.name === name).map(({ value }) => value);
  if (values.length === 0) return undefined;
  return name.endsWith('_total') ? values.reduce((a, b) => a + b) : Math.max(...values);
};

function denoiser(metrics) {
  const found = metrics.find((metric) => metric.name === 'denoiser');
  if (!found?.value) return `off: ${found?.labels.problem ?? 'unknown'}`;
  const one = reader(metrics);
  return `${number(one('reconstructions_total'))} pictures at rest, the last in `
      + `${number(one('reconstruction_milliseconds'))} ms`;
}

function maps(metrics) {
  const one = reader(metrics);
  if (!one('illumination_map_texels')) return 'none: nothing is lit diffusely';
  const percent = (share) => `${number(100 * share, 1)} %`;
  const error = one('illumination_map_error'), passes = one('bake_passes_total');
  const shown = error >= 1 ? 'coarse light, the first there is' : `fine to ${percent(error)}`;
  if (!passes) return shown;
  const how = one('bake_working') ? 'better is being found' : 'better as cores are free';
  return `${shown}; ${how}, `
    + `${number(passes)} passes so far, fine to ${percent(one('bake_error'))}`;
}

function show_figures(metrics) {
  const one = reader(metrics);
  const seconds = one('up_seconds') ?? 0;
  fill(by_id('server'), null, [
    ['Up', `${Math.floor(seconds / 3600)} h ${Math.floor(seconds / 60) % 60} min`],
    ['Memory', mebibytes(one('resident_bytes') ?? 0)],
    ['Tick', `${number(one('tick_milliseconds'), 1)} ms, of it the storyteller `
      + `${number(one('animate_milliseconds'), 1)} ms`],
    ['Samples', `${number(one('samples_per_second'))} a second while tracing; dropped as invalid: `
      + number(one('bad_samples_total'))],
    ['Network', denoiser(metrics)],
    ['Light maps', maps(metrics)],
    ['Pictures',
      `${number(one('pictures_total'))} (${mebibytes(one('picture_bytes_total') ?? 0)})`],
    ['Connections', `${number(one('connections'))} open, `
      + `${number(one('slow_readers_closed_total'))} closed for reading too slowly, `
      + `${number(one('floods_closed_total'))} for sending too much; `
      + `could not be accepted: ${number(one('accept_errors_total'))}`],
    ['Messages',
      `${number(one('messages_total'))}, refused ${number(one('refused_messages_total'))}`],
  ]);
  const ids = [...new Set(metrics.filter((m) => m.labels.visitor).map((m) => m.labels.visitor))];
  const state_of = (name) =>
    metrics.find((metric) => metric.name === name && metric.value === 1)?.labels.state ?? '–';
  const name_of = (id) => {
    const kiosk = metrics.find((m) => m.labels.visitor === id && m.labels.kiosk)?.labels.kiosk;
    return kiosk ? `${id} (${kiosk})` : id;
  };
  const value_of = (id, name) =>
    metrics.find((m) => m.labels.visitor === id && m.name === `visitor_${name}`)?.value;
  const limit_of = (id) => metrics.find((m) => m.labels.visitor === id
      && m.name === 'visitor_limit' && m.value === 1)?.labels.limit ?? '–';
  by_id('visitors-section').hidden = ids.length === 0;
  const of = (id, name, digits) => number(value_of(id, name), digits);
  fill(by_id('visitors'), ['Visitor', 'Pictures/s', 'Round trip ms', 'Display ms', 'Trace ms',
    'Tone ms', 'Encode ms', 'Decode ms', 'Samples', 'Quality', 'Scale %', 'Line Mbit/s', 'Limit',
    'Converged %'],
  ids.map((id) => [
    name_of(id), of(id, 'pictures_per_second', 1), of(id, 'round_trip_milliseconds'),
    of(id, 'display_milliseconds', 1), of(id, 'trace_milliseconds', 1),
    of(id, 'tonemap_milliseconds', 1), of(id, 'encode_milliseconds', 1),
    of(id, 'decode_milliseconds', 1), of(id, 'samples_per_picture'), of(id, 'jpeg_quality'),
    number(100 * (value_of(id, 'picture_scale') ?? 1)),
    number(8e-6 * (value_of(id, 'line_bytes_per_second') ?? 0), 1), limit_of(id),
    number(100 * (value_of(id, 'converged_ratio') ?? 0), 1)]));
  fill(by_id('storyteller'), null, [
    ['House', `${one('house_open') ? 'open' : 'closed'}${one('house_quiet') ? ', quiet' : ''}`],
    ['Before her', state_of('audience')],
    ['Mood', state_of('storyteller_mood')],
    ['Greetings', `${number(one('greetings_total'))}, farewells ${number(one('farewells_total'))}`],
    ['Stories', number(one('stories_total'))],
    ['Observations', number(one('kiosk_observations_total'))],
    ['Voice', `${one('voice_running') ? 'running' : 'not running'}, `
      + `restarts ${number(one('voice_restarts_total'))}, `
      + `lines kept ${number(one('voice_lines'))}, `
      + `waiting ${number(one('voice_lines_waiting'))}, `
      + `failed ${number(one('voice_failed_total'))}`],
  ]);
}

// Shows how much the store of very large pictures holds, waits for and could not read.
function show_store(metrics) {
  const one = reader(metrics), pieces = one('store_pieces');
  by_id('store-section').hidden = pieces === undefined;
  if (pieces === undefined) return;
  const read = (result) => metrics.find((metric) =>
    metric.name === 'store_fetched_total' && metric.labels.result === result)?.value ?? 0;
  const all = read('piece') + read('absent') + read('failed');
  const looks = (detail) => metrics.find((metric) =>
    metric.name === 'store_looks_total' && metric.labels.detail === detail)?.value ?? 0;
  const soft = looks('too_coarse'), all_looks = soft + looks('wanted');
  const coarser = one('store_coarser_levels');
  fill(by_id('store'), null, [
    ['Pictures', number(one('store_sources'))],
    ['In memory', `${number(pieces)} pieces, ${mebibytes(one('store_bytes'))} of `
      + `${mebibytes(one('store_budget_bytes'))}; dropped to make room: `
      + number(one('store_dropped_total'))],
    ['Shown', coarser > 0 ? { text: `${number(coarser, 1)} levels coarser than they could be: `
      + 'give pieces-memory more', bad: true } : 'as fine as visitors can see'],
    ['Too soft', all_looks > 0 ? `${number(100 * soft / all_looks, 1)} % of their pixels so far, `
      + 'while pieces were on their way' : 'nobody has looked yet'],
    ['Wanted', `${number(one('store_waiting'))} waited for, `
      + `${number(one('store_under_way'))} being read`],
    ['Read', `${number(read('piece'))}, `
      + `${number(1000 * one('store_fetch_seconds_total') / Math.max(all, 1), 1)} ms each; `
      + `none there: ${number(read('absent'))}`],
    ['Failed', { text: number(read('failed')), bad: read('failed') > 0 }],
  ]);
}

// From another machine the server tells all of this only with the admin token. The token stays in
// the tab.
function ask(path) {
  const token = of_tab.get('admin-token');
  const headers = token ? { Authorization: `Bearer ${token}` } : undefined;
  return fetch(path, { cache: 'no-store', headers });
}
by_id('sign-in').addEventListener('submit', (event) => {
  event.preventDefault();
  const field = /** @type {HTMLInputElement} */ (by_id('token'));
  of_tab.set('admin-token', field.value.trim());
  field.value = '';
  refresh();
});

// Says what the server says to who may not read it.
function stay_out({ error }) {
  const { code, message } = error, tried = of_tab.get('admin-token') !== null;
  of_tab.remove('admin-token');
  document.body.classList.add('closed');
  by_id('sign-in').hidden = code !== 'wrong_token';
  tell('note', tried ? 'The server does not know this token'
    : code === 'wrong_token' ? 'The server tells this to who has its admin token'
      : `${message[0].toUpperCase()}${message.slice(1)}.`, []);
}

by_id('sums-link').addEventListener('click', async (event) => {
  if (!of_tab.get('admin-token')) return;  // a plain link will do
  event.preventDefault();
  const answer = await ask('api/v1/sums.csv');
  if (!answer.ok) return;
  const link = make('a', '');
  link.href = URL.createObjectURL(await answer.blob());
  link.download = 'sums.csv';
  link.click();
  URL.revokeObjectURL(link.href);
});

let next = 0, speeds_shown = false;
async function refresh() {
  clearTimeout(next);
  let pause = 1000;
  const token = of_tab.get('admin-token');
  try {
    const [answer, figures] = await Promise.all([ask('api/v1/status'), ask('metrics')]);
    const status = await answer.json();
    if (token !== of_tab.get('admin-token')) return;  // given meanwhile: another refresh has it
    if (answer.status === 401) {
      stay_out(status);
      pause = 10000;
    } else {
      document.body.classList.remove('closed');
      by_id('sign-in').hidden = true;
      judge(status);
      show_kiosks(status);
      show_workers(status);
      by_id('sums').hidden = !status.sums;
      const metrics = parse_metrics(await figures.text());
      show_figures(metrics);
      show_store(metrics);
      if (!speeds_shown) show_speeds().catch(() => say_speeds('The server does not tell.'));
      speeds_shown = true;
    }
  } catch {
    tell('bad', 'The server does not answer', []);
  }
  clearTimeout(next);
  next = setTimeout(refresh, pause);
}

const say_speeds = (text) => { by_id('speeds-about').textContent = text; };
async function show_speeds() {
  const speeds = await (await ask('api/v1/speeds')).json();
  if (speeds.problem) {
    say_speeds(`${speeds.problem[0].toUpperCase()}${speeds.problem.slice(1)}.`);
    return;
  }
  say_speeds(
      `Left and low is best. Measured ${speeds.date} on ${speeds.cores} cores of ${speeds.cpu}.`);
  const scenes = [...new Set(speeds.points.map((point) => point.scene))];
  const techniques = [...new Set(speeds.points.map((point) => point.technique))];
  const legend = make('ul', '');
  legend.id = 'legend';
  legend.append(...techniques.map((name, index) => {
    const item = make('li', ''), dot = make('i', '');
    dot.style.background = colours[index % colours.length];
    item.append(dot, name);
    return item;
  }));
  const draw = () => {
    const scene = by_id('scene').value;
    const points = speeds.points.filter((point) => point.scene === scene);
    by_id('chart').replaceChildren(legend,
        draw_speeds(points, techniques, scene, by_id('chart').clientWidth));
    fill(by_id('speeds-table'), ['Technique', 'Samples a pixel', 'Time', 'FLIP'],
        points.map((point) =>
          [point.technique, point.spp, time_text(point.seconds), point.flip.toFixed(3)]));
  };
  by_id('scene').replaceChildren(...scenes.map((name) => make('option', name)));
  by_id('scene').addEventListener('change', draw);
  addEventListener('resize', draw);
  by_id('scene-label').hidden = scenes.length < 2;
  by_id('speeds-numbers').hidden = false;
  draw();
}

by_id('address').textContent = location.origin;
refresh();
