// SPDX-License-Identifier: Apache-2.0
// The kiosk's own words, in the house's languages; the exhibit's words come from the server.
export const words = {
  en: {
    map_open: 'Open the map',
    map_about: 'What the house keeps lies here on a map: things that are alike in age, colour and '
      + 'kind lie near one another. Choose one, draw a circle around it and dive in.',
    not_trusted: 'This screen is not known to the museum yet. Whoever looks after it opens it '
      + 'once with its token: /kiosk#token=…',
    touch_water: 'Touch the water', touch_twice: 'Touch the water twice: the book of this house '
      + 'will rise', contents: 'Contents', topics: 'To read', presentations: 'To watch',
    museum: 'The museum', partners: 'With thanks to', close_book: 'Let the book sink',
    to_book: 'Back to the book', page_next: 'Turn the page', page_back: 'Turn back',
    play: 'Play', pause: 'Pause', stop: 'Stop', forward: 'Next picture',
    back: 'Picture before', tell_me: 'Let her tell', walk: 'Walk through the house',
    walk_hint: 'Draw across the picture to look round. The ring walks.',
    tour: 'Guided tour', call: 'Call the storyteller', louder: 'Volume',
    elsewhere: 'The storyteller is with another guest just now. She will gladly come to you '
      + 'afterwards.', gesture_hint: 'Without touching: swipe through the air to turn the page, '
      + 'draw a number to choose.', goodbye: 'Goodbye, and come again!',
    heard: 'You know this one.', take_along: 'Take the story along',
    picture_of: 'Picture {n} of {all}',
    pictures: '{n} pictures', headphones: 'It is quiet time in this house. Headphones '
      + 'hang beside the screen.',
  },
  de: {
    map_open: 'Die Karte öffnen',
    map_about: 'Was das Haus bewahrt, liegt hier auf einer Karte: Was sich in Alter, Farbe und Art '
      + 'ähnlich ist, liegt nah beieinander. Wählen Sie etwas, ziehen Sie einen Kreis darum '
      + 'und tauchen Sie ein.',
    not_trusted: 'Das Museum kennt diesen Bildschirm noch nicht. Wer ihn betreut, öffnet ihn '
      + 'einmal mit seinem Schlüssel: /kiosk#token=…',
    touch_water: 'Berühren Sie das Wasser', touch_twice: 'Zweimal das Wasser berühren: Das Buch '
      + 'des Hauses steigt auf', contents: 'Inhalt', topics: 'Zum Lesen',
    presentations: 'Zum Ansehen', museum: 'Das Museum', partners: 'Mit Dank an',
    close_book: 'Das Buch versinken lassen', to_book: 'Zurück zum Buch',
    page_next: 'Weiterblättern', page_back: 'Zurückblättern', play: 'Abspielen',
    pause: 'Pause', stop: 'Beenden', forward: 'Nächstes Bild', back: 'Bild davor',
    tell_me: 'Erzählen lassen', walk: 'Durch das Haus gehen',
    walk_hint: 'Ziehen Sie im Bild, um sich umzusehen. Mit dem Ring gehen Sie.',
    tour: 'Rundgang', call: 'Die Erzählerin rufen', louder: 'Lautstärke',
    take_along: 'Die Geschichte mitnehmen',
    elsewhere: 'Die Erzählerin ist gerade bei einem anderen Gast. Danach kommt sie gern zu Ihnen.',
    gesture_hint: 'Ohne Berühren: durch die Luft wischen blättert um, eine Ziffer in die Luft '
      + 'zeichnen wählt aus.', goodbye: 'Auf Wiedersehen, und kommen Sie wieder!',
    heard: 'Die kennen Sie schon.', picture_of: 'Bild {n} von {all}',
    pictures: '{n} Bilder', headphones: 'Im Haus ist Ruhezeit. Kopfhörer hängen neben '
      + 'dem Bildschirm.',
  },
  sk: {
    map_open: 'Otvoriť mapu',
    map_about: 'Čo dom uchováva, leží tu na mape: čo sa podobá vekom, farbou a druhom, leží blízko '
      + 'seba. Vyberte si niečo, zakreslite okolo toho kruh a vnorte sa.',
    not_trusted: 'Múzeum túto obrazovku ešte nepozná. Kto sa o ňu stará, otvorí ju raz s jej '
      + 'kľúčom: /kiosk#token=…',
    take_along: 'Vezmite si príbeh so sebou',
    touch_water: 'Dotknite sa vody', touch_twice: 'Dotknite sa vody dvakrát: vynorí sa kniha '
      + 'tohto domu', contents: 'Obsah', topics: 'Na čítanie', presentations: 'Na pozeranie',
    museum: 'Múzeum', partners: 'S vďakou', close_book: 'Nechať knihu klesnúť',
    to_book: 'Späť ku knihe', page_next: 'Otočiť stranu', page_back: 'Otočiť späť',
    play: 'Prehrať', pause: 'Pauza', stop: 'Ukončiť', forward: 'Ďalší obrázok',
    back: 'Predchádzajúci obrázok', tell_me: 'Nechať rozprávať', walk: 'Prejsť sa domom',
    walk_hint: 'Ťahaním po obraze sa rozhliadate. Kruhom kráčate.', tour: 'Prehliadka',
    call: 'Zavolať rozprávačku', louder: 'Hlasitosť',
    elsewhere: 'Rozprávačka je práve pri inom hosťovi. Potom rada príde k vám.',
    gesture_hint: 'Bez dotyku: mávnutím otočíte stranu, číslicou nakreslenou vo vzduchu si '
      + 'vyberiete.', goodbye: 'Dovidenia a príďte zas!',
    heard: 'Tento už poznáte.', picture_of: 'Obrázok {n} z {all}', pictures: 'Počet obrázkov: {n}',
    headphones: 'V dome je čas ticha. Slúchadlá visia vedľa obrazovky.',
  },
  fr: {
    map_open: 'Ouvrir la carte',
    map_about: 'Ce que la maison conserve est ici sur une carte : ce qui se ressemble par l’âge, '
      + 'la couleur et le genre est proche. Choisissez un objet, tracez un cercle autour et '
      + 'plongez.',
    not_trusted: 'Le musée ne connaît pas encore cet écran. La personne qui s’en occupe l’ouvre '
      + 'une fois avec sa clé : /kiosk#token=…',
    touch_water: 'Touchez l’eau', touch_twice: 'Touchez l’eau deux fois : le livre de cette maison '
      + 'remontera', contents: 'Sommaire', topics: 'À lire', presentations: 'À regarder',
    museum: 'Le musée', partners: 'Avec nos remerciements à',
    close_book: 'Laisser le livre s’enfoncer', to_book: 'Retour au livre',
    page_next: 'Tourner la page', page_back: 'Page précédente', play: 'Lire', pause: 'Pause',
    stop: 'Arrêter', forward: 'Image suivante', back: 'Image précédente',
    tell_me: 'Laisser raconter', walk: 'Se promener dans la maison',
    walk_hint: 'Glissez sur l’image pour regarder autour de vous. L’anneau fait marcher.',
    tour: 'Visite guidée', call: 'Appeler la conteuse', louder: 'Volume',
    elsewhere: 'La conteuse est avec un autre visiteur. Elle viendra volontiers ensuite.',
    gesture_hint: 'Sans toucher : balayez l’air pour tourner la page, dessinez un chiffre pour '
      + 'choisir.', goodbye: 'Au revoir, et à bientôt !', heard: 'Vous le connaissez déjà.',
    take_along: 'Emporter le récit',
    picture_of: 'Image {n} sur {all}', pictures: '{n} images',
    headphones: 'C’est l’heure calme dans cette maison. Des casques pendent à côté de l’écran.',
  },
  es: {
    map_open: 'Abrir el mapa',
    map_about: 'Lo que guarda la casa está aquí en un mapa: lo que se parece en edad, color y tipo '
      + 'está cerca. Elija algo, trace un círculo a su alrededor y sumérjase.',
    not_trusted: 'El museo aún no conoce esta pantalla. Quien la cuida la abre una vez con su '
      + 'clave: /kiosk#token=…',
    touch_water: 'Toque el agua', touch_twice: 'Toque el agua dos veces: subirá el libro de esta '
      + 'casa', contents: 'Índice', topics: 'Para leer', presentations: 'Para ver',
    museum: 'El museo', partners: 'Con nuestro agradecimiento a',
    close_book: 'Dejar que el libro se hunda', to_book: 'Volver al libro',
    page_next: 'Pasar la página', page_back: 'Página anterior', play: 'Reproducir',
    pause: 'Pausa', stop: 'Terminar', forward: 'Imagen siguiente', back: 'Imagen anterior',
    tell_me: 'Que lo cuente ella', walk: 'Pasear por la casa',
    walk_hint: 'Arrastre sobre la imagen para mirar alrededor. Con el anillo se anda.',
    tour: 'Visita guiada', call: 'Llamar a la narradora', louder: 'Volumen',
    elsewhere: 'La narradora está con otro visitante. Después vendrá con mucho gusto.',
    gesture_hint: 'Sin tocar: deslice la mano en el aire para pasar la página, dibuje un número '
      + 'para elegir.', goodbye: '¡Adiós, y vuelva pronto!', heard: 'Este ya lo conoce.',
    take_along: 'Llevarse el relato',
    picture_of: 'Imagen {n} de {all}', pictures: '{n} imágenes',
    headphones: 'Es hora de silencio en esta casa. Junto a la pantalla hay auriculares.',
  },
};

export function kiosk_word(lang, name, values = {}) {
  const text = (words[lang] ?? words[lang?.split('-')[0]] ?? words.en)[name] ?? words.en[name];
  return Object.entries(values).reduce((all, [key, value]) => all.replace(`{${key}}`, value), text);
}

// A text of the exhibit {language: text} in `lang`, else in its base language, else in any.
export const local = (text, lang) => (text
  ? text[lang] ?? text[lang?.split('-')[0]] ?? Object.values(text)[0] ?? '' : '');
