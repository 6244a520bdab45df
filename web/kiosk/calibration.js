// SPDX-License-Identifier: Apache-2.0
// While the kiosk finds out how its camera sits: big words that ask a person to stand at one mark
// and then at the other, and how much of the time there is over.
const words = {
  en: {
    near: 'Please stand at the first mark, {metres} m before the screen.',
    far: 'Now please step back to the second mark, {metres} m before the screen.',
    still: 'Look at the middle of the screen and keep still.',
    done: 'Thank you. The camera knows where it is.',
    failed: 'That did not work. Please begin once more.',
  },
  de: {
    near: 'Bitte stellen Sie sich auf die erste Markierung, {metres} m vor dem Bildschirm.',
    far: 'Bitte treten Sie zurück auf die zweite Markierung, {metres} m vor dem Bildschirm.',
    still: 'Sehen Sie auf die Mitte des Bildschirms und halten Sie still.',
    done: 'Danke. Die Kamera weiß jetzt, wo sie ist.',
    failed: 'Das hat nicht geklappt. Bitte beginnen Sie noch einmal.',
  },
  sk: {
    near: 'Postavte sa, prosím, na prvú značku, {metres} m pred obrazovkou.',
    far: 'Teraz, prosím, ustúpte na druhú značku, {metres} m pred obrazovkou.',
    still: 'Pozerajte sa na stred obrazovky a nehýbte sa.',
    done: 'Ďakujeme. Kamera už vie, kde je.',
    failed: 'Nepodarilo sa to. Začnite, prosím, ešte raz.',
  },
};

let panel = null;

function make_panel() {
  const made = document.createElement('section');
  made.id = 'calibration';
  made.setAttribute('role', 'status');
  const part = (name) => made.appendChild(document.createElement(name));
  const [step, still, progress] = [part('h1'), part('p'), part('progress')];
  progress.setAttribute('aria-hidden', 'true');  // or it would be read out at every step of it
  document.body.append(made);
  return { made, step, still, progress };
}

// Shows a kiosk message's calibration: {step, metres, progress}; undefined: there is none.
export function show_calibration(calibration, lang) {
  if (!calibration && !panel) return;
  panel ??= make_panel();
  panel.made.hidden = !calibration;
  if (!calibration) return;
  const of = words[lang] ?? words[lang?.split('-')[0]] ?? words.en;
  const stands = calibration.step === 'near' || calibration.step === 'far';
  const metres = calibration.metres.toLocaleString(lang);
  const put = (element, text) => { if (element.textContent !== text) element.textContent = text; };
  put(panel.step, of[calibration.step].replace('{metres}', metres));
  put(panel.still, of.still);
  panel.made.dataset.step = calibration.step;
  panel.progress.value = calibration.progress;
  panel.still.hidden = panel.progress.hidden = !stands;
}
