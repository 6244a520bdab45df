// SPDX-License-Identifier: Apache-2.0
// What is being told, and the buttons for it: pause, skip, from the start, stop. A tour when there
// is one, else the story.
import { by_id } from './element.js';
import { word } from './words.js';

/**
 * @param {any} orders {tour(action), story_action(action)}
 * @param {(rests: boolean) => void} on_pause whether what is told rests
 */
export function make_player(orders, on_pause = () => {}) {
  const bar = by_id('player'), pause = by_id('player-pause');
  let lang = 'en', titles = { tour: {}, story: {} }, tour = null, story = null, paused = null;

  const act = (action) => (tour ? orders.tour(action) : orders.story_action(action));
  const toggle = () => act(pause.dataset.next);
  pause.addEventListener('click', toggle);
  by_id('player-stop').addEventListener('click', () => act('stop'));
  by_id('player-skip').addEventListener('click', () => orders.story_action('skip'));
  by_id('player-restart').addEventListener('click', () => orders.story_action('restart'));
  addEventListener('keydown', (event) => {
    const busy = event.target instanceof Element
        && event.target.closest('button, input, select, a');
    if (event.code !== 'Space' || bar.hidden || busy || event.repeat) return;
    event.preventDefault();
    toggle();
  });

  function label(element, name) {
    element.setAttribute('aria-label', word(lang, name));
    element.title = word(lang, name);
  }

  function show() {
    const playing = tour ?? story;
    bar.hidden = !playing;
    document.body.classList.toggle('playing', !!playing);
    const rests = !!playing?.paused;
    if (rests !== paused) on_pause(paused = rests);
    if (!playing) return;
    by_id('player-title').textContent = titles[tour ? 'tour' : 'story'][playing.id] ?? '';
    pause.dataset.next = rests ? 'play' : 'pause';
    label(pause, rests ? 'resume' : 'pause');
    by_id('player-skip').hidden = by_id('player-restart').hidden = !!tour;
    const { at = 0, of = 0 } = playing;
    by_id('player-progress').style.setProperty('--told', of > 0 ? Math.min(1, (at + 1) / of) : 0);
  }

  return {
    welcome(message) {
      lang = message.lang;
      titles = {
        tour: Object.fromEntries(message.tours.map(({ id, title }) => [id, title])),
        story: Object.fromEntries(message.stories.map(({ id, title }) => [id, title])),
      };
      for (const name of ['stop', 'skip', 'restart']) label(by_id(`player-${name}`), name);
      show();
    },
    state({ tour: ride }) {
      tour = ride && {
        id: ride.id, paused: ride.state === 'paused', at: ride.stop, of: ride.stops,
      };
      show();
    },
    agent(message) {
      story = message.story && {
        id: message.story, paused: message.paused, at: message.sentence, of: message.sentences,
      };
      show();
    },
  };
}
