// SPDX-License-Identifier: Apache-2.0
// Pixels of screenshots and canvases are compared here.

// The mean difference of two lists of as many bytes.
export const difference = (a, b) =>
  a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;

// Runs in a page: hides all but the museum's picture, wherever it is drawn, or shows it again; the
// focus stays.
export function hide_in_page(hides) {
  const all = /** @type {any} */ (globalThis);
  if (!all.only_picture) {
    all.only_picture = new CSSStyleSheet();
    all.only_picture.replaceSync(
        'body :not(:has(#picture)):not(#picture):not(.local) ' +
        '{ opacity: 0 !important; transition: none !important; }');  // at once, not after a while
  }
  document.adoptedStyleSheets = hides ? [all.only_picture] : [];
}

// Runs in a page: returns mean colours, RGBA, of a grid of cells of a PNG in base64.
export async function shrink_in_page([base64, columns, rows]) {
  const image = new Image();
  image.src = `data:image/png;base64,${base64}`;
  await image.decode();
  const small = document.createElement('canvas');
  small.width = columns;
  small.height = rows;
  const context = small.getContext('2d');
  context.drawImage(image, 0, 0, columns, rows);
  return [...context.getImageData(0, 0, columns, rows).data];
}

// The same of the museum's picture as the page shows it. clip: of the page; none: all.
export async function look(page, columns, rows, clip) {
  await page.evaluate(hide_in_page, true);
  const bytes = await page.screenshot(clip && { clip });
  await page.evaluate(hide_in_page, false);
  return page.evaluate(shrink_in_page, [bytes.toString('base64'), columns, rows]);
}
