// SPDX-License-Identifier: Apache-2.0
// Text to the clipboard: the new way where the browser gives it (on this machine's own address, or
// by HTTPS), else the old one. Resolves to whether it is there.
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const before = /** @type {HTMLElement} */ (document.activeElement);
    const field = document.createElement('textarea');
    field.value = text;
    document.body.append(field);
    field.select();
    const copied = document.execCommand('copy');
    field.remove();
    before?.focus();
    return copied;
  }
}
