// SPDX-License-Identifier: Apache-2.0
// Keyframes are drawn here by the page's own modules, alone in a page of the museum's address.

// Runs in such a page: gives it `drawing`, which decodes keyframes and draws them on a canvas.
export async function begin_in_page() {
  const at = (file) => import(new URL(file, location.href).href);
  const [{ make_warp }, { read_picture }] =
      await Promise.all([at('/display/warp.js'), at('/packet.js')]);
  const canvas = document.createElement('canvas');
  const warp = make_warp(canvas, () => { throw new Error('the context is lost'); });
  const worker = new Worker('/display/decoder.js', { type: 'module' });
  const decode = (order) => new Promise((resolve) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.postMessage({ id: 0, ...order });
  });
  /** @type {any} */ (globalThis).drawing = {
    warp,
    // Returns the packet in base64 as it is read, and what make_warp() takes of it.
    async load(base64) {
      const picture = read_picture(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer);
      const { payload, sway, keyframe: { color_bytes, view, unit, cuts } } = picture;
      const { problem, ...decoded } = await decode({ color: payload.slice(0, color_bytes),
        depth: payload.slice(color_bytes), width: view.width, height: view.height, sway });
      if (problem) throw new Error(problem);
      const moves = sway && { ...sway, codes: decoded.codes };
      return { picture, keyframe: { view, unit, cuts, ...decoded, sway: moves } };
    },
    // Returns what the canvas shows, RGBA, the lowest row first.
    pixels({ width, height }) {
      const gl = canvas.getContext('webgl2'), rows = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
      return rows;
    },
    end: () => worker.terminate(),
  };
}
