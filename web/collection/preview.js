// SPDX-License-Identifier: Apache-2.0
// A small picture of a collection's first map, for the page of a kiosk's book.
import { fetch_level } from './levels.js';
import { color_of } from './plane.js';

const asked = new Map();  // exhibit -> its map, which comes
const side = 720;         // pixels

// Draws the map when it is there; without one nothing is drawn.
export async function draw_preview(canvas, exhibit) {
  if (!asked.has(exhibit)) asked.set(exhibit, fetch_level(exhibit, '', () => true));
  const { level } = await asked.get(exhibit);
  if (!level) return asked.delete(exhibit);
  const most = Math.max(1e-9, ...level.items.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
  canvas.width = canvas.height = side;
  const context = canvas.getContext('2d'), scale = 0.44 * side / most;
  const radius = Math.max(4, 0.012 * side);
  for (const { x, y, cluster, object } of level.items) {
    context.beginPath();
    context.arc(side / 2 + x * scale, side / 2 - y * scale, radius, 0, 2 * Math.PI);
    context.fillStyle = color_of(cluster);
    context.fill();
    context.lineWidth = object ? 4 : 1.5;
    context.strokeStyle = object ? '#6d2a1d' : '#5a4322aa';
    context.stroke();
  }
  return true;
}
