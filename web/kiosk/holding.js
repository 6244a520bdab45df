// SPDX-License-Identifier: Apache-2.0
// Shows the title of the thing that a guest holds to the camera, and the hint that would help.
let panel = null;

function make_panel() {
  const made = document.createElement('section');
  made.id = 'holding';
  made.setAttribute('role', 'status');
  const part = (name) => made.appendChild(document.createElement(name));
  const [title, hint] = [part('h2'), part('p')];
  document.body.append(made);
  return { made, title, hint };
}

const in_language = (texts, lang) =>
  texts?.[lang] ?? texts?.[lang?.split('-')[0]] ?? texts?.en ?? Object.values(texts ?? {})[0] ?? '';

// Shows a kiosk message's holding: {title, hint}, texts by language; undefined: there is nothing.
export function show_holding(holding, lang) {
  if (!holding && !panel) return;
  panel ??= make_panel();
  panel.made.hidden = !holding;
  if (!holding) return;
  const put = (element, text) => {
    if (element.textContent !== text) element.textContent = text;
    element.hidden = !text;
  };
  put(panel.title, in_language(holding.title, lang) || holding.id || holding.class);
  put(panel.hint, in_language(holding.hint, lang));
}
