// SPDX-License-Identifier: Apache-2.0
// Who waits is told their place in the queue and comes in by itself; who does nothing for long is
// asked whether they are still there, and else has the visit rest until they are.
import { by_id } from './element.js';
import { word } from './words.js';

// orders: {here(is_here)}; lang() -> the visitor's language.
export function make_presence(orders, lang) {
  const card = by_id('presence'), veil = by_id('veil');
  let state = 'here', answered = false, answer_by = 0, timer = 0;

  function minutes(seconds) {
    const about = Math.max(1, Math.round(seconds / 60));
    return word(lang(), about === 1 ? 'waiting_minute' : 'waiting_minutes')
        .replace('{minutes}', String(about));
  }

  function show() {
    card.hidden = state === 'here';
    if (card.hidden) return;
    const left = Math.max(0, Math.ceil((answer_by - performance.now()) / 1000));
    by_id('presence-title').textContent =
        word(lang(), state === 'asked' ? 'still_there' : 'resting');
    by_id('presence-text').textContent = state === 'asked'
      ? word(lang(), 'still_there_until').replace('{seconds}', String(left))
      : word(lang(), 'resting_until');
    by_id('presence-back').textContent =
        word(lang(), state === 'asked' ? 'still_there_yes' : 'resting_back');
  }

  function become(next) {
    state = next;
    clearInterval(timer);
    if (state === 'asked') timer = setInterval(show, 1000);
    show();
  }

  // Any input answers; it is no step or turn then.
  function answer(event) {
    if (state === 'here' || document.hidden) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    orders.here(true);
    answered = true;
    if (state === 'asked') become('here');
  }
  for (const event of ['pointerdown', 'keydown', 'wheel'])
    addEventListener(event, answer, { capture: true, passive: false });
  document.addEventListener('visibilitychange', () => orders.here(!document.hidden));

  return {
    rests: () => state === 'paused' && !answered,
    // A message of the server's.
    waiting({ place, of, seconds }) {
      become('here');
      veil.classList.remove('lifted');
      const text = word(lang(), 'waiting').replace('{place}', place).replace('{of}', of);
      by_id('veil-text').textContent = seconds ? `${text} ${minutes(seconds)}` : text;
    },
    idle(message) {
      answered = false;
      answer_by = performance.now() + 1000 * (message.seconds ?? 0);
      become(message.state);
    },
    // A visit begins, or goes on.
    welcome() {
      become('here');
      by_id('veil-text').textContent = word(lang(), 'opening');
      if (document.hidden) orders.here(false);
    },
  };
}
