// SPDX-License-Identifier: Apache-2.0
// What a visitor chooses for eyes and line: leaps instead of glides, how good pictures are, the
// whole screen, figures for technicians. Kept by the browser.
import { all, by_id } from './element.js';
import { kept } from './kept.js';
import { wanted_size } from './picture.js';

// most: pixels; the rest as `settings` has it.
const qualities = {
  fine: { most: 1920 * 1080, fps: 0, quality: 90, max_quality: 95, saver: false },
  plain: { most: 1280 * 720, fps: 0, quality: 82, max_quality: 95, saver: false },
  saver: { most: 640 * 360, fps: 12, quality: 55, max_quality: 70, saver: true },
};

// send(fields): of a settings message. on_change(): the saver is on, or off again.
export function make_comfort(send, on_change) {
  const reduced = matchMedia('(prefers-reduced-motion: reduce)');
  const calm = by_id('comfort'), figures = by_id('figures-on');
  let chosen = kept.get('quality') in qualities ? kept.get('quality')
      : /** @type {any} */ (navigator).connection?.saveData ? 'saver' : 'plain';

  const bandwidth = /** @type {HTMLSelectElement} */ (by_id('bandwidth'));
  bandwidth.value = kept.get('bandwidth') ?? '0';
  if (bandwidth.selectedIndex < 0) bandwidth.value = '0';
  const wishes = () => {
    const { most, fps, ...rest } = qualities[chosen];
    return { ...rest, ...wanted_size(most), fps, bandwidth: Number(bandwidth.value) };
  };
  calm.checked = kept.get('comfort') === null ? reduced.matches : kept.get('comfort') === 'true';
  const tell_comfort = () => send({ comfort: calm.checked });
  calm.addEventListener('change', () => { kept.set('comfort', calm.checked); tell_comfort(); });
  reduced.addEventListener('change', () => {
    if (kept.get('comfort') !== null) return;
    calm.checked = reduced.matches;
    tell_comfort();
  });

  for (const input of all('input[name=quality]')) {
    input.checked = input.value === chosen;
    input.addEventListener('change', () => {
      if (!input.checked) return;
      chosen = input.value;
      kept.set('quality', chosen);
      send(wishes());
      on_change();
    });
  }

  bandwidth.addEventListener('change', () => {
    kept.set('bandwidth', bandwidth.value);
    send(wishes());
  });

  figures.checked = kept.get('figures') === 'true';
  const show_figures = () => { by_id('figures').hidden = !figures.checked; };
  figures.addEventListener('change', () => {
    kept.set('figures', figures.checked);
    show_figures();
  });
  show_figures();

  const whole = by_id('whole-screen');
  whole.hidden = !document.fullscreenEnabled;
  whole.addEventListener('click', () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});
  });
  document.addEventListener('fullscreenchange', () => whole.setAttribute('aria-pressed',
      String(!!document.fullscreenElement)));

  let resize_timer = 0;
  addEventListener('resize', () => {
    clearTimeout(resize_timer);
    resize_timer = setTimeout(() => send(wishes()), 200);
  });
  return {
    size: () => wanted_size(qualities[chosen].most),
    wishes: () => ({ comfort: calm.checked, ...wishes() }),
    leaps: () => calm.checked,
    saves: () => chosen === 'saver',
  };
}
