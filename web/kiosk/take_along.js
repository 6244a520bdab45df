// SPDX-License-Identifier: Apache-2.0
// A code beside a story that opens it on the guest's own phone.
const stays = 20;  // seconds after the story's end

// element: a figure with a picture and a caption.
export function make_take_along(element) {
  const picture = element.querySelector('img');
  let offered = false, timer = 0, shown = '';

  function hide() {
    clearTimeout(timer);
    timer = 0;
    element.hidden = true;
    shown = '';
  }

  return {
    house({ take_along }) {
      offered = take_along;
      if (!offered) hide();
    },
    // story: id of what is told now, null: none.
    follow(exhibit, story, lang) {
      if (!offered) return;
      if (!story) {
        if (!element.hidden && !timer) timer = setTimeout(hide, 1000 * stays);
        return;
      }
      clearTimeout(timer);
      timer = 0;
      const address = `api/v1/exhibits/${encodeURIComponent(exhibit)}/qr.svg`
          + `?story=${encodeURIComponent(story)}&lang=${encodeURIComponent(lang)}`;
      if (shown !== address) picture.src = shown = address;
      element.hidden = false;
    },
    hide,
  };
}
