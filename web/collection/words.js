// SPDX-License-Identifier: Apache-2.0
// The words of the collection's map, in the languages of the page.
export const words = {
  en: {
    map: 'Map of the collection',
    map_keys: 'Arrow keys go to the nearest object in that direction. Enter opens it, once '
      + 'more dives into the circle around it. [ and ] change the circle, + and − '
      + 'enlarge, 0 shows all, numbers choose groups, Backspace goes back.',
    close: 'Close the map', close_card: 'Close the card', back: 'Back',
    trail: 'The way to this map',
    everything: 'Everything', around: 'Around “{title}”', only: 'Only {groups}',
    loading: 'The map is being drawn…', failed: 'There is no map just now.', again: 'Try again',
    gone: 'The way to that map is not known any more. Here is everything.',
    region: 'This map is about all {n} objects.',
    region_part: 'This map is about {n} of {all} objects.',
    shown: 'It shows {n} of them, drawn by lot.',
    stress_0: 'It is faithful: what lies near is alike.',
    stress_1: 'It is mostly faithful: what lies near is nearly always alike.',
    stress_2: 'It is rough: what lies near is often alike, not always. Smaller circles give truer '
      + 'maps.',
    stress_3: 'It is very rough: a first sketch. Smaller circles give truer maps.',
    too_near: 'Objects that only looked near in the last circle: {n}. They were not counted in.',
    groups: 'Groups', alone: 'Look at these alone', mixed: 'a bit of everything',
    objects_count: 'objects: {n}', bc: '{n} BC', truth_0: 'It lies in its true place.',
    truth_1: 'It lies about where it belongs.', truth_2: 'It belongs somewhat elsewhere.',
    truth_3: 'It found no good place on this map.', there: 'Take me there',
    page: 'Its page in the catalogue', circle: 'The circle', radius: 'Size of the circle',
    inside: 'In the circle: {n}', dive: 'Dive in', list: 'In view',
    list_count: 'Objects in view: {n}', whole: 'Show all of the map', larger: 'Larger',
    smaller: 'Smaller', of_group: 'Group: {group}.', in_exhibit: 'It stands in this exhibit.',
    hint: 'What is alike lies near. Touch a dot, size the circle, dive in.',
    legend: 'Pale: its place is less true. Gold ring: it stands in this exhibit.',
    to_exhibit: 'To the exhibit', no_collection: 'There is no collection to be seen here.',
  },
  de: {
    map: 'Karte der Sammlung', map_keys: 'Pfeiltasten führen zum nächsten Gegenstand in dieser '
      + 'Richtung. Eingabe öffnet ihn, noch einmal taucht in den Kreis um ihn ein. [ und ] ändern '
      + 'den Kreis, + und − die Größe, 0 zeigt alles, Ziffern wählen Gruppen, Rücktaste geht '
      + 'zurück.',
    close: 'Karte schließen', close_card: 'Kärtchen schließen', back: 'Zurück',
    trail: 'Der Weg zu dieser Karte', everything: 'Alles', around: 'Um „{title}“',
    only: 'Nur {groups}', loading: 'Die Karte wird gezeichnet…',
    failed: 'Es gibt gerade keine Karte.', again: 'Noch einmal versuchen',
    gone: 'Der Weg zu jener Karte ist nicht mehr bekannt. Hier ist alles.',
    region: 'Diese Karte handelt von allen {n} Gegenständen.',
    region_part: 'Diese Karte handelt von {n} der {all} Gegenstände.',
    shown: 'Sie zeigt {n} davon, durch das Los bestimmt.',
    stress_0: 'Sie ist getreu: Was nah beieinander liegt, ist sich ähnlich.',
    stress_1: 'Sie ist meist getreu: Was nah beieinander liegt, ist sich fast immer ähnlich.',
    stress_2: 'Sie ist grob: Was nah beieinander liegt, ist sich oft ähnlich, nicht immer. '
      + 'Kleinere Kreise geben treuere Karten.',
    stress_3: 'Sie ist sehr grob: eine erste Skizze. Kleinere Kreise geben treuere Karten.',
    too_near: 'Gegenstände, die im letzten Kreis nur nah aussahen: {n}. Sie zählten nicht mit.',
    groups: 'Gruppen', alone: 'Nur diese ansehen', mixed: 'von allem etwas',
    objects_count: 'Gegenstände: {n}', bc: '{n} v. Chr.', truth_0: 'Er liegt an seinem wahren Ort.',
    truth_1: 'Er liegt ungefähr, wo er hingehört.',
    truth_2: 'Er gehört eigentlich etwas woandershin.',
    truth_3: 'Er hat auf dieser Karte keinen guten Platz gefunden.', there: 'Führ mich hin',
    page: 'Seine Seite im Katalog', circle: 'Der Kreis', radius: 'Größe des Kreises',
    inside: 'Im Kreis: {n}', dive: 'Eintauchen', list: 'Zu sehen',
    list_count: 'Zu sehende Gegenstände: {n}', whole: 'Die ganze Karte zeigen', larger: 'Größer',
    smaller: 'Kleiner', of_group: 'Gruppe: {group}.', in_exhibit: 'Er steht in dieser Ausstellung.',
    hint: 'Ähnliches liegt nah beieinander. Einen Punkt berühren, den Kreis ziehen, eintauchen.',
    legend: 'Blass: Der Ort ist weniger wahr. Goldring: steht in dieser Ausstellung.',
    to_exhibit: 'Zur Ausstellung', no_collection: 'Hier ist keine Sammlung zu sehen.',
  },
  sk: {
    map: 'Mapa zbierky', map_keys: 'Šípky vedú k najbližšiemu predmetu v tom smere. Enter ho '
      + 'otvorí, ďalší raz vnorí do kruhu okolo neho. [ a ] menia kruh, + a − zväčšenie, 0 ukáže '
      + 'všetko, číslice vyberajú skupiny, Backspace vráti späť.',
    close: 'Zavrieť mapu', close_card: 'Zavrieť kartu', back: 'Späť', trail: 'Cesta k tejto mape',
    everything: 'Všetko', around: 'Okolo „{title}“', only: 'Iba {groups}',
    loading: 'Mapa sa kreslí…', failed: 'Mapa teraz nie je.', again: 'Skúsiť znova',
    gone: 'Cesta k tej mape už nie je známa. Tu je všetko.',
    region: 'Táto mapa je o všetkých predmetoch: {n}.',
    region_part: 'Táto mapa je o časti predmetov: {n} z {all}.',
    shown: 'Ukazuje z nich {n}, vybraných žrebom.',
    stress_0: 'Je verná: čo leží blízko, to sa podobá.',
    stress_1: 'Je zväčša verná: čo leží blízko, to sa takmer vždy podobá.',
    stress_2: 'Je hrubá: čo leží blízko, to sa často podobá, nie vždy. Menšie kruhy dávajú '
      + 'vernejšie mapy.',
    stress_3: 'Je veľmi hrubá: prvý náčrt. Menšie kruhy dávajú vernejšie mapy.',
    too_near: 'Predmety, ktoré v poslednom kruhu len vyzerali blízko: {n}. Nepočítali sa.',
    groups: 'Skupiny', alone: 'Pozrieť iba tieto', mixed: 'zo všetkého trochu',
    objects_count: 'predmety: {n}', bc: '{n} pred Kr.', truth_0: 'Leží na svojom pravom mieste.',
    truth_1: 'Leží približne tam, kam patrí.', truth_2: 'Patrí vlastne trochu inam.',
    truth_3: 'Na tejto mape nemá dobré miesto.', there: 'Zaveď ma tam',
    page: 'Jeho stránka v katalógu', circle: 'Kruh', radius: 'Veľkosť kruhu',
    inside: 'V kruhu: {n}', dive: 'Vnoriť sa', list: 'Na dohľad',
    list_count: 'Predmety na dohľad: {n}', whole: 'Ukázať celú mapu', larger: 'Zväčšiť',
    smaller: 'Zmenšiť', of_group: 'Skupina: {group}.', in_exhibit: 'Stojí na tejto výstave.',
    hint: 'Podobné leží blízko seba. Dotknite sa bodu, zväčšite kruh, vnorte sa.',
    legend: 'Bledé: miesto je menej pravé. Zlatý krúžok: stojí na tejto výstave.',
    to_exhibit: 'Na výstavu', no_collection: 'Tu nie je žiadna zbierka na pozeranie.',
  },
  fr: {
    map: 'Carte de la collection', map_keys: 'Les flèches mènent à l’objet le plus proche dans '
      + 'cette direction. Entrée l’ouvre, une seconde fois plonge dans le cercle autour de lui. '
      + '[ et ] changent le cercle, + et − la taille, 0 montre tout, les chiffres choisissent des '
      + 'groupes, Retour arrière revient.',
    close: 'Fermer la carte', close_card: 'Fermer la fiche', back: 'Retour',
    trail: 'Le chemin vers cette carte', everything: 'Tout', around: 'Autour de « {title} »',
    only: 'Seulement {groups}', loading: 'La carte se dessine…',
    failed: 'Il n’y a pas de carte pour le moment.', again: 'Réessayer',
    gone: 'Le chemin vers cette carte n’est plus connu. Voici tout.',
    region: 'Cette carte parle des {n} objets.',
    region_part: 'Cette carte parle de {n} objets sur {all}.',
    shown: 'Elle en montre {n}, tirés au sort.',
    stress_0: 'Elle est fidèle : ce qui est proche se ressemble.',
    stress_1: 'Elle est plutôt fidèle : ce qui est proche se ressemble presque toujours.',
    stress_2: 'Elle est approximative : ce qui est proche se ressemble souvent, pas toujours. De '
      + 'plus petits cercles donnent des cartes plus justes.',
    stress_3: 'Elle est très approximative : une première esquisse. De plus petits cercles donnent '
      + 'des cartes plus justes.',
    too_near: 'Objets qui ne semblaient proches que dans le dernier cercle : {n}. Ils n’ont pas '
      + 'compté.',
    groups: 'Groupes', alone: 'Ne regarder qu’eux', mixed: 'un peu de tout',
    objects_count: 'objets : {n}', bc: '{n} av. J.-C.', truth_0: 'Il est à sa vraie place.',
    truth_1: 'Il est à peu près à sa place.', truth_2: 'Sa vraie place est un peu ailleurs.',
    truth_3: 'Il n’a pas trouvé de bonne place sur cette carte.', there: 'Emmenez-moi',
    page: 'Sa page dans le catalogue', circle: 'Le cercle', radius: 'Taille du cercle',
    inside: 'Dans le cercle : {n}', dive: 'Plonger', list: 'En vue',
    list_count: 'Objets en vue : {n}', whole: 'Montrer toute la carte', larger: 'Agrandir',
    smaller: 'Réduire', of_group: 'Groupe : {group}.', in_exhibit: 'Il est dans cette exposition.',
    hint: 'Ce qui se ressemble est proche. Touchez un point, réglez le cercle, plongez.',
    legend: 'Pâle : sa place est moins juste. Anneau doré : il est dans cette exposition.',
    to_exhibit: 'Vers l’exposition', no_collection: 'Il n’y a pas de collection à voir ici.',
  },
  es: {
    map: 'Mapa de la colección', map_keys: 'Las flechas llevan al objeto más cercano en esa '
      + 'dirección. Intro lo abre; otra vez se sumerge en el círculo que lo rodea. [ y ] cambian '
      + 'el círculo, + y − el tamaño, 0 muestra todo, los números eligen grupos, Retroceso vuelve.',
    close: 'Cerrar el mapa', close_card: 'Cerrar la ficha', back: 'Volver',
    trail: 'El camino a este mapa', everything: 'Todo', around: 'Alrededor de «{title}»',
    only: 'Solo {groups}', loading: 'Se está dibujando el mapa…',
    failed: 'Ahora mismo no hay mapa.', again: 'Intentar de nuevo',
    gone: 'El camino a ese mapa ya no se conoce. Aquí está todo.',
    region: 'Este mapa trata de los {n} objetos.',
    region_part: 'Este mapa trata de {n} de los {all} objetos.',
    shown: 'Muestra {n} de ellos, elegidos al azar.',
    stress_0: 'Es fiel: lo que está cerca se parece.',
    stress_1: 'Es bastante fiel: lo que está cerca se parece casi siempre.',
    stress_2: 'Es aproximado: lo que está cerca se parece a menudo, no siempre. Círculos más '
      + 'pequeños dan mapas más fieles.',
    stress_3: 'Es muy aproximado: un primer boceto. Círculos más pequeños dan mapas más fieles.',
    too_near: 'Objetos que en el último círculo solo parecían cercanos: {n}. No contaron.',
    groups: 'Grupos', alone: 'Ver solo estos', mixed: 'un poco de todo',
    objects_count: 'objetos: {n}', bc: '{n} a. C.', truth_0: 'Está en su verdadero lugar.',
    truth_1: 'Está más o menos donde le toca.', truth_2: 'En realidad le toca algo más allá.',
    truth_3: 'No encontró buen lugar en este mapa.', there: 'Llévame allí',
    page: 'Su página en el catálogo', circle: 'El círculo', radius: 'Tamaño del círculo',
    inside: 'En el círculo: {n}', dive: 'Sumergirse', list: 'A la vista',
    list_count: 'Objetos a la vista: {n}', whole: 'Mostrar todo el mapa', larger: 'Ampliar',
    smaller: 'Reducir', of_group: 'Grupo: {group}.', in_exhibit: 'Está en esta exposición.',
    hint: 'Lo parecido está cerca. Toque un punto, ajuste el círculo, sumérjase.',
    legend: 'Pálido: su lugar es menos fiel. Anillo dorado: está en esta exposición.',
    to_exhibit: 'A la exposición', no_collection: 'Aquí no hay ninguna colección que ver.',
  },
};

export function map_word(lang, name, values = {}) {
  const text = (words[lang] ?? words[lang?.split('-')[0]] ?? words.en)[name] ?? words.en[name];
  return Object.entries(values).reduce((all, [key, value]) =>
    all.replace(`{${key}}`, () => String(value)), text);
}
