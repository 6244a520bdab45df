// SPDX-License-Identifier: Apache-2.0
// Visiting together: one leads and gives a code, others follow by it.
import { asked_group, group_address } from './address.js';
import { copy } from './copy.js';
import { by_id } from './element.js';
import { of_tab } from './kept.js';
import { word } from './words.js';

const kept_name = 'group';  // role and code, for as long as the browser's tab lives

// orders: {group(action, code), notice(text), close()}: a message to the server, quiet words over
// the picture, and the menu is in the way
export function make_group(orders) {
  let lang = 'en', wish = asked_group, leaving = false;
  let now = { role: 'none', code: '', followers: 0, away: false };

  function say(text) { by_id('group-answer').textContent = text; }

  function show() {
    const leads = now.role === 'leader', follows = now.role === 'follower';
    by_id('group-none').hidden = leads || follows;
    by_id('group-leads').hidden = !leads;
    by_id('group-follows').hidden = !follows;
    by_id('group-bar').hidden = !follows;
    by_id('group-back').hidden = !now.away;
    document.body.classList.toggle('follows', follows);
    if (leads) {
      by_id('group-code').textContent = now.code;
      by_id('group-link').value = group_address(now.code);
      const count = now.followers === 1 ? 'group_one' : 'group_count';
      by_id('group-followers').textContent = word(lang, now.followers ? count : 'group_nobody')
          .replace('{n}', String(now.followers));
    }
    if (follows)
      by_id('group-state').textContent = word(lang, now.away ? 'group_away' : 'group_following');
  }

  function follow(code) {
    if (!code.trim()) return;
    wish = code.trim();
    orders.group('follow', wish);
  }
  function leave() {
    leaving = true;
    orders.group('leave');
  }
  by_id('group-lead').addEventListener('click', () => orders.group('lead'));
  by_id('group-form').addEventListener('submit', (event) => {
    event.preventDefault();
    follow(by_id('group-wish').value);
  });
  by_id('group-copy').addEventListener('click', async () => {
    say(await copy(by_id('group-link').value) ? word(lang, 'copied') : '');
  });
  by_id('group-link').addEventListener('focus', () => by_id('group-link').select());
  by_id('group-end').addEventListener('click', leave);
  by_id('group-leave').addEventListener('click', leave);
  by_id('group-leave-menu').addEventListener('click', leave);
  by_id('group-back').addEventListener('click', () => orders.group('rejoin'));

  return {
    // A group that this visit was in already is taken up again; an address leads into another.
    welcome(message) {
      ({ lang } = message);
      show();
      const before = JSON.parse(of_tab.get(kept_name) ?? 'null');
      if (wish) follow(wish);
      else if (before && message.resumed) orders.group('rejoin');
      else if (before?.role === 'follower') follow(before.code);
    },
    // Takes the server's news of the group; missing fields have not changed.
    message(news) {
      const before = now.role, focused = document.activeElement;
      now = { ...now, away: false, ...news };
      show();
      if (now.role === 'none') of_tab.remove(kept_name);
      else of_tab.set(kept_name, JSON.stringify({ role: now.role, code: now.code }));
      if (now.role === before) return;
      say('');
      wish = null;
      by_id('group-wish').value = '';
      if (now.role === 'follower') orders.close();
      if (before === 'follower' && !leaving) orders.notice(word(lang, 'group_ended'));
      leaving = false;
      // The focus stays near the button that has gone.
      if (focused?.closest('[hidden]')) {
        const section = [...by_id('group-section').querySelectorAll('button')];
        const place = by_id('menu').hidden ? by_id('picture')
          : section.find((button) => !button.closest('[hidden]'));
        place?.focus();
      }
    },
    // Says whether the error is one of groups, of which the visitor is told here.
    error({ code }) {
      if (code === 'unknown_group') {
        const text = word(lang, 'group_unknown').replace('{asked}', wish ?? '');
        wish = null;
        of_tab.remove(kept_name);
        if (by_id('menu').hidden) orders.notice(text);
        else say(text);
      } else if (code === 'in_group') {
        orders.notice(word(lang, 'group_decides'));
      } else if (code === 'no_group') {
        now = { ...now, role: 'none' };
        of_tab.remove(kept_name);
        show();
      } else {
        return false;
      }
      return true;
    },
  };
}
