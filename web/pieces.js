// SPDX-License-Identifier: Apache-2.0
// Offers on the card of a piece all that can be done with it: of a very large picture the year of
// a map, another layer, two of them compared, a glass over it; of what was scanned see volume.js.
import { by_id, element } from './element.js';
import { make_choice, make_slider } from './piece_choice.js';
import { as_at_first, make_volume } from './volume.js';
import { word } from './words.js';

const blends = ['curtain', 'fade', 'difference'];

// Milliseconds after a choice in which the server may still tell of an earlier one.
const settles = 1000;

// orders: {piece({name, layer, over, by, share, turn, low, high, plane})}; glass, ruler: as of
// make_glass(), make_ruler().
export function make_pieces(orders, glass, ruler) {
  const room = by_id('card-piece');
  let pieces = [], lang = 'en', shown = null, choice = null, name = '', seen = '';
  let changed_at = -settles, held = false, kept = {};

  const first = () => shown.layers[0];
  const has_inside = () => Boolean(shown?.volume ?? shown?.scan);
  const dated = () => shown.layers.every((layer) => layer.year !== undefined);
  const title = (layer) => (layer === first() && !dated() ? word(lang, 'as_it_is') : layer.label);
  const layer_of = (id) => shown.layers.find((layer) => layer.id === id) ?? first();
  const titles = (without) => shown.layers.filter((layer) => layer !== without)
      .map((layer) => [layer.id, title(layer)]);

  function change(fields) {
    choice = { ...choice, ...fields };
    changed_at = performance.now();
    orders.piece({ name: shown.id, ...choice });
  }

  function make_dial() {
    const years = [...shown.layers].sort((a, b) => a.year - b.year);
    const at = Math.max(0, years.findIndex((layer) => layer.id === choice.layer));
    const value = element('output', { textContent: years[at].label });
    const dial = make_slider(word(lang, 'year'), years.length - 1, 1, at, (index) => {
      value.textContent = years[index].label;
      dial.setAttribute('aria-valuetext', years[index].label);
      say(years[index]);
      change({ layer: years[index].id });
    });
    dial.setAttribute('aria-valuetext', years[at].label);
    return element('div.dial', {}, value, dial);
  }

  function say(layer) { by_id('card-piece-text').textContent = layer?.text ?? ''; }

  function make_comparison() {
    const other = choice.by === 'none' ? '' : choice.over;
    const parts = [make_choice(word(lang, 'compare_with'),
        [['', word(lang, 'nothing')], ...titles(layer_of(choice.layer))], other, (over) => {
          change(over ? { over, by: choice.by === 'none' ? 'curtain' : choice.by }
            : { over: '', by: 'none' });
          fill();
        })];
    if (!other) return parts;
    parts.push(make_choice(word(lang, 'compare_by'),
        blends.map((blend) => [blend, word(lang, blend)]), choice.by, (by) => {
          change({ by });
          fill();
        }));
    if (choice.by !== 'difference')
      parts.push(make_slider(word(lang, choice.by), 1, 0.01, choice.share,
          (share) => change({ share })));
    return parts;
  }

  // Offers all that the glass may show: the same larger, another layer, how one differs.
  function make_glass_choice() {
    const options = [['', word(lang, 'no_glass')], ['larger', word(lang, 'larger')],
      ['closest', word(lang, 'closest')],
      ...titles(null).map(([id, text]) => [`layer ${id}`, text]),
      ...titles(layer_of(choice.layer)).map(([id, text]) =>
        [`difference ${id}`, word(lang, 'difference_to').replace('{layer}', text)])];
    const held = glass.held();
    const now = !held ? '' : !held.name ? (held.zoom ? 'larger' : 'closest')
      : `${held.difference ? 'difference' : 'layer'} ${held.layer}`;
    return make_choice(word(lang, 'glass'), options, now, (value) => {
      if (!value) return glass.put_down();
      const [kind, id] = value.split(' ');
      const label = options.find(([one]) => one === value)[1];
      say(id ? layer_of(id) : null);
      // 0: the picture's own texels become pixels.
      if (!id) glass.hold({ zoom: kind === 'larger' ? 4 : 0 }, label);
      else glass.hold({ zoom: 1, name: shown.id, layer: id, difference: kind === 'difference' },
          `${name}: ${label}`);
    });
  }

  function make_ruler_button() {
    const button = element('button', { type: 'button', textContent: word(lang, 'ruler'),
      ariaPressed: String(ruler.used()), onclick() {
        ruler.use(!ruler.used());
        button.ariaPressed = String(ruler.used());
        say({ text: ruler.used() ? word(lang, 'ruler_hint') : '' });
      } });
    return button;
  }

  function make_reset_button() {
    return element('button', { type: 'button', textContent: word(lang, 'as_at_first'), onclick() {
      glass.put_down();
      say(null);
      kept = { cuts_open: kept.cuts_open };
      change({ layer: first().id, ...as_at_first });
      fill();
      by_id('card-piece').querySelector('.row button:last-child').focus();
    } });
  }

  function fill() {
    room.replaceChildren();
    room.hidden = !shown;
    room.classList.toggle('volume', has_inside());
    held = Boolean(glass.held());
    if (!shown) return;
    if (has_inside()) {
      room.append(...make_volume({ piece: shown, name, lang, choice: () => choice,
        orders: { change, say }, glass, kept }),
      element('div.row', {}, make_ruler_button(), make_reset_button()));
      return;
    }
    if (dated()) room.append(make_dial());
    else room.append(make_choice(word(lang, 'layer'), titles(null), choice.layer, (layer) => {
      say(layer_of(layer));
      change({ layer });
      fill();
    }));
    room.append(...make_comparison(), make_glass_choice(), make_ruler_button());
  }

  return {
    welcome(message) {
      ({ pieces, lang } = message);
      if (shown) shown = pieces.find(({ id }) => id === shown.id) ?? null;
      if (shown) fill();
    },
    state(message) {
      const view = JSON.stringify([message.position, message.yaw, message.pitch, message.fov]);
      if (shown && view !== seen) ruler.scale(true);
      seen = view;
      if (!shown || room.contains(document.activeElement) || room.matches(':active')) return;
      if (performance.now() - changed_at < settles) return;
      const told = message.pieces?.[shown.id];
      const is_new = told && JSON.stringify(told) !== JSON.stringify(choice);
      if (!is_new && held === Boolean(glass.held())) return;
      if (is_new) choice = told;
      fill();
    },
    // As still.jpg asks for them.
    looks(state) {
      const chosen = Object.entries(state?.pieces ?? {}).map(([id, one]) => {
        const mixed = one.by === 'none' ? ['', '', ''] : [one.over, one.by, one.share];
        const turned = one.low ? [one.turn, one.low.join(';'), one.high.join(';')] : [];
        return [id, one.layer, ...mixed, ...turned].join(':').replace(/:+$/, '');
      });
      return chosen.length ? { pieces: chosen.join(',') } : {};
    },
    // The card of an object was opened; null: closed.
    show(object, state) {
      shown = pieces.find(({ id }) => id === object?.id) ?? null;
      name = object?.title ?? '';
      say(null);
      choice = shown && (state?.pieces?.[shown.id]
        ?? { layer: first().id, over: '', by: 'none', share: 0.5,
          ...(has_inside() && as_at_first) });
      kept = {};
      glass.put_down();
      ruler.use(false);
      seen = '';
      ruler.scale(shown !== null);
      fill();
    },
  };
}
