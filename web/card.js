// SPDX-License-Identifier: Apache-2.0
// The card of an object that is looked at closer: its label, where it comes from, its story.
import { read_address } from './address.js';
import { by_id } from './element.js';
import { text_in, word } from './words.js';

// orders: {story(id), play(id, on), around(id, on), shown(object): null: it was closed}
export function make_card(orders) {
  const card = by_id('card');
  let objects = [], animations = [], lang = 'en', exhibit = '', shown = null, opener = null,
      turned = false;

  function close() {
    if (card.hidden) return;
    const focused = card.contains(document.activeElement);
    if (turned) orders.around(shown.id, false);
    card.hidden = true;
    shown = null;
    orders.shown(null);
    document.body.classList.remove('reads');
    if (focused) (opener?.isConnected ? opener : by_id('picture')).focus();
  }
  by_id('card-close').addEventListener('click', close);
  addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && by_id('menu').hidden) close();
  });
  by_id('card-around').addEventListener('click', () => orders.around(shown.id, !turned));
  by_id('card-story').addEventListener('click', () => orders.story(shown.story));

  // A door leads to another exhibit, if that is open.
  async function offer_door(object) {
    const door = by_id('card-door');
    door.hidden = true;
    if (!object.door) return;
    const { exhibit, viewpoint } = object.door;
    const answer = await fetch(`api/v1/exhibits/${exhibit}`).catch(() => null);
    if (!answer?.ok || shown !== object) return;
    const { title, languages } = await answer.json();
    door.href = `e/${exhibit}${viewpoint ? `?viewpoint=${encodeURIComponent(viewpoint)}` : ''}`;
    door.textContent = word(lang, 'enter').replace('{title}', text_in(title, lang, languages));
    door.hidden = false;
  }

  // Offers the animations that a touch of the object starts.
  function offer_animations(object) {
    const own = animations.filter((animation) => animation.object === object.id);
    by_id('card-animations').replaceChildren(...own.map((animation) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = animation.title || word(lang, 'set_going');
      button.setAttribute('aria-pressed', String(animation.on));
      button.dataset.animation = animation.id;
      button.addEventListener('click', () => orders.play(animation.id, !animation.on));
      return button;
    }));
  }

  function fill(object) {
    by_id('card-title').textContent = object.title;
    by_id('card-text').textContent = object.text ?? '';
    by_id('card-text').hidden = !object.text;
    by_id('card-facts').replaceChildren(...(object.provenance ?? []).flatMap((fact) => {
      const name = document.createElement('dt'), value = document.createElement('dd');
      name.textContent = word(lang, `dc_${fact.element}`);
      value.textContent = fact.value;
      return [name, value];
    }));
    by_id('card-facts').hidden = !object.provenance;
    by_id('card-story').hidden = by_id('card-read').hidden = !object.story;
    if (object.story) by_id('card-read').href = read_address(exhibit, lang, object.story);
    by_id('card-around').hidden = !object.around;
    offer_animations(object);
    by_id('card-manifest').hidden = !object.manifest;
    if (object.manifest) by_id('card-manifest').href = object.manifest;
    offer_door(object);
  }

  return {
    welcome(message) {
      ({ objects, animations, lang, exhibit } = message);
      const now = shown && objects.find(({ id }) => id === shown.id);
      if (now) fill(shown = now);
    },
    state(message) {
      for (const animation of animations) {
        animation.on = message.animations?.[animation.id] ?? animation.on;
        card.querySelector(`[data-animation="${CSS.escape(animation.id)}"]`)
            ?.setAttribute('aria-pressed', String(animation.on));
      }
      turned = Boolean(message.around) && message.around === shown?.id;
      by_id('card-around').setAttribute('aria-pressed', String(turned));
      by_id('card-around-hint').hidden = !turned;
      document.body.classList.toggle('turns', turned);
    },
    objects: () => objects,
    open(id) {
      const object = objects.find((one) => one.id === id);
      if (!object) return close();
      opener = document.activeElement;
      shown = object;
      fill(object);
      orders.shown(object);
      card.hidden = false;
      document.body.classList.add('reads');
      card.scrollTop = 0;
      // A visitor who opened the card by a button reads on here; one who walks goes on walking.
      if (opener?.closest('button')) by_id('card-title').focus({ preventScroll: true });
    },
    close,
  };
}
