// SPDX-License-Identifier: Apache-2.0
// The token by which a server on another machine trusts this screen. It comes once, in the address
// (/kiosk#token=..., which no server and no log sees), and stays in the tab.
import { of_tab } from '../kept.js';

function take() {
  const given = /^#token=(.+)$/.exec(location.hash)?.[1];
  if (!given) return false;
  let token = given;
  try { token = decodeURIComponent(given); } catch { /* it has a % of its own */ }
  of_tab.set('kiosk-token', token);
  history.replaceState(null, '', location.pathname + location.search);
  return true;
}

take();
// Typed into the address of a page that is open already.
addEventListener('hashchange', () => { if (take()) location.reload(); });

/** @returns {string | undefined} */
export const kiosk_token = () => of_tab.get('kiosk-token') ?? undefined;
