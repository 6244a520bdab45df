// SPDX-License-Identifier: Apache-2.0
// Keeps a visitor's choices in the browser. If the browser may keep nothing, the page itself does,
// for as long as it is open.
function make_store(kind) {
  const own = new Map();
  const store = () => /** @type {Storage} */ (globalThis[kind]);  // may throw, as may its functions
  return {
    /** @returns {string | null} */
    get(name) {
      try { return store().getItem(`wellspring.${name}`); } catch { return own.get(name) ?? null; }
    },
    set(name, value) {
      own.set(name, String(value));
      try { store().setItem(`wellspring.${name}`, String(value)); } catch { /* it is in `own` */ }
    },
    remove(name) {
      own.delete(name);
      try { store().removeItem(`wellspring.${name}`); } catch { /* nothing was kept */ }
    },
  };
}

export const kept = make_store('localStorage');     // for good
export const of_tab = make_store('sessionStorage'); // for as long as the tab lives
