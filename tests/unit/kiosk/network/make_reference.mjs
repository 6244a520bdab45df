// SPDX-License-Identifier: Apache-2.0
// Makes reference.json: what the package @vladmandic/face-api itself computes, with its
// weights, for pictures that a formula gives (network_test.cpp has the same one).
//   cd FOLDER && npm ci --ignore-scripts    in a copy of kiosk/weights
//   node make_reference.mjs FOLDER > reference.json
import { copyFileSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const folder = join(process.argv[2], 'node_modules/@vladmandic/face-api');
// The bundle is a module but does not say so in its name.
const copy = join(process.argv[2], 'face-api.mjs');
copyFileSync(join(folder, 'dist/face-api.esm.js'), copy);
// Its TensorFlow asks for a platform and knows browsers; the arithmetic needs none of that.
globalThis.window = { document: {}, addEventListener() {} };
const api = await import(pathToFileURL(copy));
const { tf } = api;
await tf.setBackend('cpu');
await tf.ready();

// Level of colour c at column x and row y of picture `which`.
function level(which, x, y, c) {
  if (which === 0) return (x * 7 + y * 13 + c * 29 + ((x * y) % 31) * 5) % 256;
  const u = x - 56, v = y - 56;
  return Math.max(0, 230 - Math.floor((u * u + 2 * v * v) / 40) - c * 10);
}
const picture = (which, width, height) => tf.tidy(() => {
  const levels = new Float32Array(width * height * 3);
  for (let y = 0, i = 0; y < height; y++)
    for (let x = 0; x < width; x++)
      for (let c = 0; c < 3; c++) levels[i++] = level(which, x, y, c);
  return tf.tensor3d(levels, [height, width, 3]);
});

function load(network, name) {
  const manifest = JSON.parse(readFileSync(join(folder, 'model', `${name}-weights_manifest.json`)));
  const bytes = readFileSync(join(folder, 'model', `${name}.bin`));
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  network.loadFromWeightMap(tf.io.decodeWeights(buffer, manifest[0].weights));
  return network;
}
const detector = load(new api.TinyFaceDetector(), 'tiny_face_detector_model');
const landmarks = load(new api.FaceLandmark68Net(), 'face_landmark_68_model');
const expression = load(new api.FaceExpressionNet(), 'face_expression_model');
const round = (tensor) => [...tensor.dataSync()].map((value) => Number(value.toPrecision(7)));

const result = { package: '@vladmandic/face-api 1.7.15', pictures: [] };
for (const which of [0, 1]) {
  const small = new api.NetInput([picture(which, 112, 112)]);
  const wide = new api.NetInput([picture(which, 128, 128)]);
  result.pictures.push({
    landmarks: round(landmarks.forwardInput(small)),
    expression: round(expression.forwardInput(small)),
    detector: round(detector.forwardInput(wide, 128)),
  });
}
console.log(JSON.stringify(result));
