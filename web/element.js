// SPDX-License-Identifier: Apache-2.0
// Elements of a page.

/** @param {string} id @returns {any} of the kind that the page says it is */
export const by_id = (id) => document.getElementById(id);

/** @param {string} selector @returns {Iterable<any>} those on the page */
export const all = (selector) => document.querySelectorAll(selector);

/**
 * A new one: element('button.round', {onclick, ariaLabel, dataset}, ...children).
 * @param {string} name @param {any} properties @param {any[]} children @returns {any}
 */
export function element(name, properties = {}, ...children) {
  const [tag, ...classes] = name.split('.');
  const made = document.createElement(tag);
  if (classes.length) made.className = classes.join(' ');
  const { dataset = {}, ...rest } = properties;
  Object.assign(made.dataset, dataset);
  for (const [key, value] of Object.entries(rest))
    if (value !== undefined && value !== null) made[key] = value;
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}
