// SPDX-License-Identifier: Apache-2.0
// The technician's page: /metrics read once a second and put into words.
const by_id = (id) => document.getElementById(id);

// Prometheus text to [{name, labels, value}].
export function parse_metrics(text) {
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

function rows(table, list) {
  table.replaceChildren(...list.map((cells, index) => {
    const row = document.createElement('tr');
    row.append(...cells.map((cell, column) => {
      const element =
          document.createElement(column === 0 || (index === 0 && cells.length > 2) ? 'th' : 'td');
      element.textContent = cell;
      return element;
    }));
    return row;
  }));
}

const mebibytes = (bytes) => `${Math.round(bytes / 2 ** 20)} MiB`;
const number = (value, digits = 0) => value === undefined
  ? '–' : value.toLocaleString('en', { maximumFractionDigits: digits });

function denoiser(metrics) {
  const found = metrics.find((metric) => metric.name === 'denoiser');
  if (!found?.value) return `off: ${found?.labels.problem ?? 'unknown'}`;
  const one = (name) => metrics.find((metric) => metric.name === name)?.value;
  return `${number(one('reconstructions_total'))} pictures at rest, the last in `
      + `${number(one('reconstruction_milliseconds'))} ms`;
}

function maps(metrics) {
  const one = (name) => metrics.find((metric) => metric.name === name)?.value;
  const percent = (share) => `${number(100 * share, 1)} %`;
  const baked = one('bake_passes_total') > 0
    ? `; ${one('bake_working') ? 'baking' : 'baked'}: ${number(one('bake_passes_total'))} passes, `
      + `error ${percent(one('bake_error'))}` : '';
  if (!one('illumination_map_texels')) return `none yet${baked}`;
  return `${number(one('illumination_map_texels'))} texels, `
    + `error ${percent(one('illumination_map_error'))}${baked}`;
}

async function refresh() {
  const badge = by_id('health');
  try {
    const health = await fetch('healthz', { cache: 'no-store' });
    const metrics = parse_metrics(await (await fetch('metrics', { cache: 'no-store' })).text());
    badge.textContent = health.ok ? 'serving' : 'starting';
    badge.className = health.ok ? 'badge good' : 'badge';
    const one = (name) => metrics.find((metric) => metric.name === name)?.value;
    const seconds = one('up_seconds') ?? 0;
    rows(by_id('server'), [
      ['Up', `${Math.floor(seconds / 3600)} h ${Math.floor(seconds / 60) % 60} min`],
      ['Memory', mebibytes(one('resident_bytes') ?? 0)],
      ['Tick',
        `${number(one('tick_milliseconds'), 1)} ms, of it the storyteller `
          + `${number(one('animate_milliseconds'), 1)} ms`],
      ['Samples',
        `${number(one('samples_per_second'))} a second while tracing; dropped as invalid: `
          + number(one('bad_samples_total'))],
      ['Learned reconstruction', denoiser(metrics)],
      ['Illumination maps', maps(metrics)],
      ['Pictures',
        `${number(one('pictures_total'))} (${mebibytes(one('picture_bytes_total') ?? 0)})`],
      ['Connections',
        `${number(one('connections'))} open, ${number(one('slow_readers_closed_total'))} closed `
          + 'for reading too slowly'],
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
    const of = (id, name, digits) => number(value_of(id, name), digits);
    rows(by_id('visitors'), [
      ['Visitor', 'Pictures/s', 'Round trip ms', 'Display ms', 'Trace ms', 'Tone ms', 'Encode ms',
        'Decode ms', 'Samples', 'Quality', 'Converged %'],
      ...ids.map((id) => [
        name_of(id), of(id, 'pictures_per_second', 1), of(id, 'round_trip_milliseconds'),
        of(id, 'display_milliseconds', 1), of(id, 'trace_milliseconds', 1),
        of(id, 'tonemap_milliseconds', 1), of(id, 'encode_milliseconds', 1),
        of(id, 'decode_milliseconds', 1), of(id, 'samples_per_picture'), of(id, 'jpeg_quality'),
        number(100 * (value_of(id, 'converged_ratio') ?? 0), 1)])]);
    rows(by_id('kiosks'), [
      ['Cameras', number(one('kiosk_cameras'))],
      ['Before them', state_of('audience')],
      ['Storyteller', state_of('storyteller_mood')],
      ['Observations', number(one('kiosk_observations_total'))],
      ['Greetings', number(one('greetings_total'))],
      ['Farewells', number(one('farewells_total'))],
      ['Stories', number(one('stories_total'))],
      ['Voice',
        `${one('voice_running') ? 'running' : 'not running'}, `
          + `restarts ${number(one('voice_restarts_total'))}, `
          + `lines kept ${number(one('voice_lines'))}, `
          + `waiting ${number(one('voice_lines_waiting'))}, `
          + `failed ${number(one('voice_failed_total'))}`],
    ]);
  } catch {
    badge.textContent = 'no answer';
    badge.className = 'badge bad';
  }
  setTimeout(refresh, 1000);
}
by_id('address').textContent = location.origin;
refresh();
