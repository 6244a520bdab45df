// SPDX-License-Identifier: Apache-2.0
// The slider of the hour of the day, where the exhibit has one.
import { by_id } from './element.js';

const between_orders = 250;  // milliseconds
const left_alone = 1500;     // milliseconds after which the slider shows what the server says

// order(hour): null for the exhibit's own.
export function make_hour(order) {
  const slider = by_id('hour');
  let day = null, format = null, touched_at = -Infinity, timer = 0;
  const tell = () => {
    const text = format.format(new Date(Number(slider.value) * 3600e3));
    slider.setAttribute('aria-valuetext', text);
    by_id('hour-time').textContent = text;
  };
  const show = (hour) => { slider.value = String(hour); tell(); };
  const send = () => {
    timer = 0;
    const hour = Number(slider.value);
    order(Math.abs(hour - day.at) < Number(slider.step) / 2 ? null : hour);
  };
  slider.addEventListener('input', () => {
    touched_at = performance.now();
    tell();
    timer ||= setTimeout(send, between_orders);
  });
  return {
    welcome(message) {
      ({ day } = message);
      by_id('hour-row').hidden = !day;
      if (!day) return;
      format = new Intl.DateTimeFormat(message.lang,
          { hour: 'numeric', minute: '2-digit', timeZone: 'UTC' });
      slider.min = String(day.from), slider.max = String(day.to);
      show(day.hour);
    },
    state(message) {
      if (day && performance.now() - touched_at > left_alone) show(message.hour);
    },
  };
}
