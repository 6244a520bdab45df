// SPDX-License-Identifier: Apache-2.0
// Shows the pictures of a visit: drawn here from keyframes with depth, where the device can do
// that; else they come finished.
import { asked_display } from '../address.js';
import { of_tab } from '../kept.js';
import { make_picture } from '../picture.js';
import { make_display } from './display.js';

// Says how long it takes until something shows what an input has done.
function make_round_trip() {
  const asked = new Map();  // seq -> time it was sent, until something shows it
  let milliseconds = 0;
  return {
    asked(seq) { asked.set(seq, performance.now()); },
    seen(seq) {
      let sent = 0;
      for (const [old, time] of asked) {
        if (old > seq) break;
        sent = time;
        asked.delete(old);
      }
      if (sent) milliseconds += (performance.now() - sent - milliseconds) * 0.2;
    },
    forget() { asked.clear(); },
    milliseconds: () => milliseconds,
  };
}

// on_shown: as of make_picture(). send(message): to the server. calm(): as make_display() has it.
export function make_screen(canvas, { on_shown, send, calm }) {
  const trip = make_round_trip();
  const shown = (picture) => {
    if (picture.shown) trip.seen(picture.seq);
    on_shown(picture);
  };
  const finished = make_picture(canvas, shown);
  // Why pictures come finished: asked, unable, slow, lost; empty: they do not.
  let reason = asked_display === 'server' ? 'asked'
    : asked_display === 'local' ? '' : of_tab.get('display') ?? '';
  let display = null;

  const say = () => { document.body.dataset.display = display ? 'local' : 'server'; };
  function give_up(why) {
    if (!display || (why === 'slow' && asked_display === 'local')) return;
    reason = why;
    of_tab.set('display', why);
    display.end();
    display = null;
    say();
    send({ type: 'settings', display: 'server' });
  }
  if (!reason) {
    display = make_display(canvas,
        { on_shown: shown, on_weak: give_up, round_trip: trip.milliseconds, calm });
    if (!display) reason = 'unable';
  }
  say();

  return {
    hello: () => (display ? { display: 'local' } : {}),
    receive(buffer) { if (!display?.receive(buffer)) finished.receive(buffer); },
    joined() { trip.forget(); },
    welcome(message) { display?.welcome(message); },
    pose(message) {
      trip.seen(message.seq);
      display?.told(message);
    },
    // An order was sent that a picture will show.
    asked(seq) { trip.asked(seq); },
    /**
     * An input was sent; moved: it changes the picture.
     * @param {number} seq @param {any} fields @param {boolean} moved
     */
    input(seq, fields, moved) {
      if (moved) trip.asked(seq);
      display?.walker.turn(fields.look);
      display?.walker.sent(seq, fields.move);
    },
    // An order was sent that takes the visitor elsewhere, who stands there.
    stands(seq) { display?.walker.sent(seq, [0, 0, 0]); },
    rate: () => (display ?? finished).rate(),
    round_trip: trip.milliseconds,
    // Tells technicians where pictures are drawn: local, or why not.
    way: () => reason || 'local',
  };
}
