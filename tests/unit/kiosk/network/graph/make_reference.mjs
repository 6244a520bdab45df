// SPDX-License-Identifier: Apache-2.0
// Makes reference.json: what the package @vladmandic/human itself computes, by the TensorFlow.js
// that it ships, for a picture that a formula gives (reference_test.cpp has the same one). An
// output is told by its shape, its mean and some of its values. The network of bodies, which wants
// whole numbers, gets levels of grey and is told whole (unit/kiosk/body/body_marks_test.cpp).
//   cd FOLDER && npm ci --ignore-scripts    in a copy of kiosk/weights
//   node make_reference.mjs FOLDER > reference.json
import { copyFileSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const names = ['facemesh', 'handlandmark-lite', 'iris', 'movenet-lightning'];
const folder = join(process.argv[2], 'node_modules/@vladmandic/human');
// The bundle is a module but does not say so in its name.
const copy = join(process.argv[2], 'tfjs.mjs');
copyFileSync(join(folder, 'dist/tfjs.esm.js'), copy);
// It asks for a platform and knows browsers; the arithmetic needs none of that.
globalThis.window = { document: {}, addEventListener() {} };
const tf = await import(pathToFileURL(copy));
await tf.setBackend('cpu');
await tf.ready();

const level = (x, y, c) => ((x * 7 + y * 13 + c * 29 + ((x * y) % 31) * 5) % 256) / 255;
const round = (value) => Number(value.toPrecision(7));

async function load(name) {
  const file = JSON.parse(readFileSync(join(folder, 'models', `${name}.json`)));
  const bytes = readFileSync(join(folder, 'models', `${name}.bin`));
  return tf.loadGraphModel({
    load: async () => ({
      ...file,
      weightSpecs: file.weightsManifest[0].weights,
      weightData: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length),
    }),
  });
}

const models = {};
for (const name of names) {
  const model = await load(name);
  const [, rows, columns, channels] = model.inputs[0].shape;
  const whole = model.inputs[0].dtype === 'int32';
  const levels = [];
  for (let y = 0; y < rows; y++)
    for (let x = 0; x < columns; x++)
      for (let c = 0; c < channels; c++) levels.push(level(x, y, whole ? 0 : c));
  const picture = tf.tensor4d(whole ? levels.map((l) => Math.round(255 * l)) : levels,
    [1, rows, columns, channels], whole ? 'int32' : 'float32');
  const found = [model.execute(picture)].flat();
  models[name] = {};
  found.forEach((tensor, i) => {
    const values = [...tensor.dataSync()];
    const step = whole ? 1 : Math.max(1, Math.floor(values.length / 12));
    models[name][model.outputNodes[i].replace(/:0$/, '')] = {
      shape: tensor.shape,
      mean: round(values.reduce((sum, value) => sum + value, 0) / values.length),
      step,
      values: values.filter((_, k) => k % step === 0).map(round),
    };
  });
}
const text = Object.entries(models).map(([name, outputs]) => `  "${name}": {\n` +
  Object.entries(outputs).map(([output, about]) => `    "${output}": ${JSON.stringify(about)}`)
    .join(',\n') + '\n  }').join(',\n');
console.log(`{\n${text}\n}`);
