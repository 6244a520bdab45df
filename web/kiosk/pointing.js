// SPDX-License-Identifier: Apache-2.0
// Shows where a guest points at the screen: a soft ring. What it rests on for a second is touched,
// once; it must leave that before it touches it again.
import { element } from '../element.js';

const dwell = 1000;    // milliseconds
const reach = 0.03;    // of the screen's width: so far beside a thing it still counts
const touchable = 'button:not(:disabled), a[href], .entry, summary';

// touched(): somebody does something, without a finger.
export function make_pointing(touched) {
  let ring = null, target = null, timer = 0;

  function thing_at(x, y) {
    const far = reach * innerWidth;
    const places = [[0, 0]];
    for (let k = 0; k < 8; k++)
      places.push([Math.cos(k * Math.PI / 4) * far, Math.sin(k * Math.PI / 4) * far]);
    for (const [dx, dy] of places) {
      const found = document.elementFromPoint(x + dx, y + dy)?.closest(touchable);
      if (found) return found;
    }
    return null;
  }
  function rest_on(thing) {
    if (thing === target) return;
    target = thing;
    clearTimeout(timer);
    ring.classList.toggle('rests', !!thing);
    if (!thing) return;
    timer = setTimeout(() => {
      ring.classList.remove('rests');
      if (!thing.isConnected) return;
      touched();
      thing.click();
    }, dwell);
  }

  // Shares of the screen from its upper left corner; nothing: nobody points at it.
  return (share) => {
    const inside = share && share.every((one) => one >= 0 && one <= 1);
    if (!inside && !ring) return;
    ring ??= document.body.appendChild(element('div.pointing', { ariaHidden: 'true' }));
    ring.hidden = !inside;
    if (!inside) {
      rest_on(null);
      return;
    }
    const [x, y] = [share[0] * innerWidth, share[1] * innerHeight];
    ring.style.transform = `translate(${x}px, ${y}px)`;
    rest_on(thing_at(x, y));
  };
}
