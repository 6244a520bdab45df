// SPDX-License-Identifier: Apache-2.0
// Speed against error as a picture: processor time of a picture across, its error up, a colour for
// each technique.
const left = 56, right = 20, top = 14, bottom = 48;
export const colours = ['#4a4640', '#0b6e99', '#b3541e', '#2f7d4f', '#8a3b7b', '#8c7000'];

const element = (name, attributes, text) => {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
};

// "250 ms", "4 s"
export const time_text = (seconds) => seconds < 1
  ? `${Number((1000 * seconds).toPrecision(2))} ms` : `${Number(seconds.toPrecision(2))} s`;

// Makes the scales of a picture of that size: across the logarithm of seconds, up FLIP.
// {x(seconds), y(flip), ticks_x: [seconds], ticks_y: [flip]}
export function make_scale(points, width, height) {
  const seconds = points.map((point) => point.seconds);
  const low = Math.floor(Math.log10(Math.min(...seconds)));
  const high = Math.max(low + 1, Math.ceil(Math.log10(Math.max(...seconds))));
  const highest = Math.max(...points.map((point) => point.flip), 0.01);
  const step = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5].find((one) => highest / one <= 6) ?? 1;
  const most = Math.ceil(highest / step - 1e-9) * step;
  return {
    x: (value) => left + (Math.log10(value) - low) / (high - low) * (width - left - right),
    y: (value) => height - bottom - value / most * (height - top - bottom),
    ticks_x: Array.from({ length: high - low + 1 }, (_, i) => 10 ** (low + i)),
    ticks_y: Array.from({ length: Math.round(most / step) + 1 }, (_, i) => i * step),
  };
}

// points: [{technique, seconds, flip, spp}] of one scene; techniques: all, in the order of colours;
// room: pixels that there are across.
export function draw_speeds(points, techniques, title, room) {
  const width = Math.min(Math.max(room, 280), 1000), height = Math.min(380, 120 + 0.36 * width);
  const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, width, height, role: 'img',
    'aria-label': `${title}: error over time, as in the table below` });
  const shown = points.filter((point) => point.seconds > 0 && Number.isFinite(point.flip));
  if (shown.length === 0) return svg;
  const scale = make_scale(shown, width, height);
  for (const tick of scale.ticks_x) {
    const x = scale.x(tick);
    svg.append(element('line', { class: 'grid', x1: x, x2: x, y1: top, y2: height - bottom }));
    svg.append(element('text', { x, y: height - bottom + 18, 'text-anchor': 'middle' },
        time_text(tick)));
  }
  for (const tick of scale.ticks_y) {
    const y = scale.y(tick);
    svg.append(element('line', { class: 'grid', x1: left, x2: width - right, y1: y, y2: y }));
    svg.append(element('text', { x: left - 8, y: y + 4, 'text-anchor': 'end' },
        Number(tick.toPrecision(2))));
  }
  svg.append(element('text', { x: (left + width - right) / 2, y: height - 8,
    'text-anchor': 'middle' }, 'processor time of a picture'));
  svg.append(element('text', { x: 14, y: (top + height - bottom) / 2, 'text-anchor': 'middle',
    transform: `rotate(-90 14 ${(top + height - bottom) / 2})` }, 'error (FLIP)'));
  techniques.forEach((technique, index) => {
    const own = shown.filter((point) => point.technique === technique)
        .sort((a, b) => a.seconds - b.seconds);
    const colour = colours[index % colours.length];
    svg.append(element('polyline', { fill: 'none', stroke: colour, 'stroke-opacity': .35,
      points: own.map((point) => `${scale.x(point.seconds)},${scale.y(point.flip)}`).join(' ') }));
    for (const point of own) {
      const dot = element('circle', { cx: scale.x(point.seconds), cy: scale.y(point.flip), r: 4.5,
        fill: colour, 'data-technique': technique });
      dot.append(element('title', {}, `${technique}, ${point.spp} samples a pixel: `
        + `${time_text(point.seconds)}, FLIP ${point.flip.toFixed(3)}`));
      svg.append(dot);
    }
  });
  return svg;
}
