// SPDX-License-Identifier: Apache-2.0
// For browsers that cannot run the page: a plain script, written as it was done before modules.
addEventListener('load', function () {
  if (document.body.className.indexOf('runs') >= 0) return;
  const texts = {
    en: 'This page needs a newer browser.',
    de: 'Diese Seite braucht einen neueren Browser.',
    sk: 'Táto stránka potrebuje novší prehliadač.',
    fr: 'Cette page a besoin d’un navigateur plus récent.',
    es: 'Esta página necesita un navegador más nuevo.',
  };
  const lang = (navigator.language || 'en').slice(0, 2);
  let line = document.getElementById('veil-text');
  if (!line) {
    line = document.createElement('p');
    line.className = 'notice';
    document.body.appendChild(line);
  }
  line.id = 'too-old';
  line.lang = texts[lang] ? lang : 'en';
  line.setAttribute('role', 'alert');
  line.textContent = texts[line.lang];
});
