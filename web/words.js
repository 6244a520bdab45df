// SPDX-License-Identifier: Apache-2.0
// The page's own words. The exhibit's words come from the server.
const words = {
  en: {
    menu: 'Menu', close: 'Close', places: 'Places', tours: 'Guided tour', stories: 'Stories',
    storyteller: 'Storyteller', lamps: 'Lights', shown: 'Shown', lively: 'Lively movements',
    language: 'Language', subtitles: 'Subtitles', walking: 'Getting about', key_walk: 'walk',
    key_arrows: 'walk and turn', key_drag_name: 'Drag', key_drag: 'look round',
    key_places: 'go to a place', pause: 'Pause', resume: 'Go on', stop: 'Stop',
    restart: 'From the start', skip: 'Next sentence', key_space_name: 'Space',
    key_space: 'pause and go on', opening: 'Opening the doors…',
    lost: 'The line to the museum is broken. Trying again…',
    full: 'The museum is full just now. Please come back in a moment.',
    busy: 'The storyteller is telling somebody at the museum a story.', sound_on: 'Turn sound on',
    sound_off: 'Turn sound off', sound_is_on: 'Sound is on.', sound_is_off: 'Sound is off.',
    attention: 'Sharp first', attention_eye: 'what catches the eye',
    attention_look: 'what I look at', attention_both: 'both alike',
    invite: 'Step closer, and the castle will tell you its story.',
  },
  de: {
    menu: 'Menü', close: 'Schließen', places: 'Orte', tours: 'Rundgang', stories: 'Geschichten',
    storyteller: 'Wer erzählt', lamps: 'Licht', shown: 'Sichtbar', lively: 'Lebendige Bewegungen',
    language: 'Sprache', subtitles: 'Untertitel', walking: 'Bewegen', key_walk: 'gehen',
    key_arrows: 'gehen und drehen', key_drag_name: 'Ziehen', key_drag: 'umsehen',
    key_places: 'zu einem Ort', pause: 'Pause', resume: 'Weiter', stop: 'Beenden',
    restart: 'Von vorn', skip: 'Nächster Satz', key_space_name: 'Leertaste',
    key_space: 'Pause und weiter', opening: 'Die Türen öffnen sich…',
    lost: 'Die Verbindung zum Museum ist unterbrochen. Neuer Versuch…',
    full: 'Das Museum ist gerade voll. Bitte kommen Sie gleich wieder.',
    busy: 'Im Museum wird gerade jemandem eine Geschichte erzählt.', sound_on: 'Ton einschalten',
    sound_off: 'Ton ausschalten', sound_is_on: 'Der Ton ist an.', sound_is_off: 'Der Ton ist aus.',
    attention: 'Zuerst scharf', attention_eye: 'was ins Auge fällt',
    attention_look: 'was ich ansehe', attention_both: 'beides gleich',
    invite: 'Treten Sie näher, dann erzählt die Burg ihre Geschichte.',
  },
  sk: {
    menu: 'Ponuka', close: 'Zavrieť', places: 'Miesta', tours: 'Prehliadka', stories: 'Príbehy',
    storyteller: 'Kto rozpráva', lamps: 'Svetlá', shown: 'Zobraziť postavu', lively: 'Živé pohyby',
    language: 'Jazyk', subtitles: 'Titulky', walking: 'Pohyb', key_walk: 'chôdza',
    key_arrows: 'chôdza a otáčanie', key_drag_name: 'Ťahanie', key_drag: 'rozhliadanie',
    key_places: 'na miesto', pause: 'Pauza', resume: 'Ďalej', stop: 'Ukončiť',
    restart: 'Od začiatku', skip: 'Ďalšia veta', key_space_name: 'Medzerník',
    key_space: 'pauza a ďalej', opening: 'Otvárame brány…',
    lost: 'Spojenie s múzeom sa prerušilo. Skúšame znova…',
    full: 'Múzeum je práve plné. Príďte, prosím, o chvíľu.',
    busy: 'V múzeu práve niekto počúva príbeh.', sound_on: 'Zapnúť zvuk', sound_off: 'Vypnúť zvuk',
    sound_is_on: 'Zvuk je zapnutý.', sound_is_off: 'Zvuk je vypnutý.',
    attention: 'Najprv ostré', attention_eye: 'čo upúta oko',
    attention_look: 'na čo sa pozerám', attention_both: 'oboje rovnako',
    invite: 'Pristúpte bližšie a hrad vám rozpovie svoj príbeh.',
  },
};
export const language_names = {
  en: 'English', de: 'Deutsch', sk: 'Slovenčina', fr: 'Français', es: 'Español', cs: 'Čeština',
  pl: 'Polski', hu: 'Magyar', it: 'Italiano',
};

export function word(lang, name) {
  return (words[lang] ?? words[lang?.split('-')[0]] ?? words.en)[name] ?? words.en[name] ?? name;
}

// Fills every element that carries data-word, data-word-title or data-word-label.
export function translate_page(lang) {
  document.documentElement.lang = lang;
  for (const element of document.querySelectorAll('[data-word]'))
    element.textContent = word(lang, element.dataset.word);
  for (const element of document.querySelectorAll('[data-word-title]'))
    element.title = word(lang, element.dataset.wordTitle);
  for (const element of document.querySelectorAll('[data-word-label]'))
    element.setAttribute('aria-label', word(lang, element.dataset.wordLabel));
}

// The visitor's language: asked for in the address, chosen before, or the browser's.
export function first_language() {
  return new URLSearchParams(location.search).get('lang') ?? localStorage.getItem('wellspring.lang')
      ?? navigator.language ?? 'en';
}
