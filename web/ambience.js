// SPDX-License-Identifier: Apache-2.0
// Makes a museum's sounds while nobody speaks: fire, water, wind, the room itself, steps. All of
// them are made here from noise; quiet, each from its place, and quieter still while somebody
// speaks.
import { in_front_of } from './sound.js';

const under_speech = 0.25;   // share of the usual loudness
const step_length = 0.72;    // metres
const overlap = 4096;        // samples in which the end of a noise runs into its beginning
const most_gain = 0.35;      // gain of the loudest place at most: never above a voice

function noise_of(context, seconds, brown) {
  const buffer = context.createBuffer(1, Math.round(seconds * context.sampleRate),
      context.sampleRate);
  const samples = buffer.getChannelData(0);
  let sum = 0;
  for (let i = 0; i < samples.length; i++) {
    const white = 2 * Math.random() - 1;
    sum = brown ? 0.985 * sum + 0.06 * white : white;
    samples[i] = sum;
  }
  for (let i = 0; i < overlap; i++) {
    const t = i / overlap;
    samples[i] = samples[i] * Math.sqrt(t)
      + samples[samples.length - overlap + i] * Math.sqrt(1 - t);
  }
  return buffer;
}

// sound: as of make_sound.
export function make_ambience(sound) {
  let places = [], made = null, state = null, walked = 0;
  const pulse = (context, to, { at, length, frequency, q = 1, gain }) => {
    const source = new AudioBufferSourceNode(context, { buffer: made.white });
    const filter = new BiquadFilterNode(context, { type: 'bandpass', frequency, Q: q });
    const level = new GainNode(context, { gain: 0 });
    source.connect(filter).connect(level).connect(to);
    level.gain.setValueAtTime(0, at);
    level.gain.linearRampToValueAtTime(gain, at + 0.002);
    level.gain.exponentialRampToValueAtTime(1e-4, at + length);
    source.start(at, Math.random() * 2, length + 0.05);
  };
  const drip = (context, to, at, gain, pitch = 700 + 700 * Math.random()) => {
    const tone = new OscillatorNode(context, { frequency: pitch });
    const level = new GainNode(context, { gain: 0 });
    tone.connect(level).connect(to);
    tone.frequency.setValueAtTime(pitch, at);
    tone.frequency.exponentialRampToValueAtTime(1.9 * pitch, at + 0.09);
    level.gain.setValueAtTime(0, at);
    level.gain.linearRampToValueAtTime(gain, at + 0.006);
    level.gain.exponentialRampToValueAtTime(1e-4, at + 0.16);
    tone.start(at);
    tone.stop(at + 0.2);
  };
  // Each kind adds sounds to its steady noise, for the second from `at` on.
  const kinds = {
    fire: { low: 60, high: 420, gain: 0.9, brown: true, live(context, to, at) {
      for (let n = 3 + 9 * Math.random(); n > 0; n--)
        pulse(context, to, { at: at + Math.random(), length: 0.006 + 0.03 * Math.random(),
          frequency: 900 + 3500 * Math.random(), q: 2, gain: 0.1 + 0.8 * Math.random() ** 4 });
    } },
    water: { low: 350, high: 1500, gain: 0.10, live(context, to, at) {
      for (let n = 0; n < 2; n++)
        if (Math.random() < 0.45) drip(context, to, at + Math.random(), 0.05 + 0.1 * Math.random());
    } },
    wind: { low: 180, high: 700, gain: 0.14, live(context, to, at, { filter }) {
      filter.frequency.setTargetAtTime(250 + 350 * Math.random(), at, 1.5);
    } },
    room: { low: 30, high: 140, gain: 0.5, brown: true },
  };

  function build({ context, to }) {
    const bus = new GainNode(context, { gain: 0 });
    bus.connect(to);
    const white = noise_of(context, 3, false), brown = noise_of(context, 5, true);
    const sources = places.filter(({ kind }) => kinds[kind]).map((place) => {
      const kind = kinds[place.kind], level = new GainNode(context, { gain: 0 });
      const filter = new BiquadFilterNode(context, { type: 'lowpass', frequency: kind.high });
      const cut = new BiquadFilterNode(context, { type: 'highpass', frequency: kind.low });
      const panner = new PannerNode(context, { panningModel: 'equalpower', rolloffFactor: 0 });
      const buffer = kind.brown ? brown : white;
      const source = new AudioBufferSourceNode(context,
          { buffer, loop: true, loopEnd: buffer.duration - overlap / buffer.sampleRate });
      const steady = new GainNode(context, { gain: kind.gain });
      source.connect(cut).connect(filter).connect(steady).connect(level).connect(panner)
          .connect(bus);
      source.start(0, Math.random() * 2);
      return { place, kind, level, filter, panner };
    });
    made = { context, bus, white, sources };
  }
  function listen() {
    const output = sound.output();
    if (!output) return;
    if (made?.context !== output.context) build(output);
    const { context } = output, now = context.currentTime;
    made.bus.gain.setTargetAtTime(sound.is_heard() ? under_speech : 1, now, 0.25);
    for (const source of made.sources) {
      const { place, kind, level, panner } = source;
      let far = 1;
      if (place.position && state) {
        const at = in_front_of(state, place.position), distance = Math.hypot(...at);
        far = place.radius / Math.max(place.radius, distance);
        const away = Math.max(distance, 1e-3);
        [panner.positionX, panner.positionY, panner.positionZ].forEach(
            (axis, i) => axis.setTargetAtTime(at[i] / away, now, 0.2));
      }
      level.gain.setTargetAtTime(Math.min(most_gain, place.gain * far * far), now, 0.3);
      if (far > 0.05) kind.live?.(context, level, now + 0.1, source);
    }
  }
  setInterval(listen, 1000);

  return {
    // The exhibit's `sounds`: [{kind, position?, gain, radius}].
    places(list) {
      places = list ?? [];
      if (made) { made.bus.disconnect(); made = null; }
      listen();
    },
    moved(to) {
      if (state && made && to.position) {
        const way = Math.hypot(to.position[0] - state.position[0],
            to.position[2] - state.position[2]);
        walked = way < 2 ? walked + way : 0;  // a jump is no walk
        if (walked >= step_length) {
          walked %= step_length;
          const { context, bus } = made, at = context.currentTime + 0.02;
          pulse(context, bus, { at, length: 0.09, frequency: 190, q: 0.8, gain: 0.22 });
          pulse(context, bus, { at: at + 0.015, length: 0.03, frequency: 1700, gain: 0.035 });
        }
      }
      state = to;
    },
    // A hand in the water: strength 0..1.
    splash(strength) {
      const output = sound.output();
      if (!output) return;
      if (made?.context !== output.context) build(output);
      const { context } = output, at = context.currentTime + 0.005;
      const loud = Math.min(1, strength);
      pulse(context, made.bus, { at, length: 0.25, frequency: 480 + 200 * Math.random(), q: 0.9,
        gain: 0.25 * loud });
      for (let i = 0; i < 3; i++)
        drip(context, made.bus, at + 0.03 + 0.11 * i * (1 + Math.random()), 0.12 * loud / (i + 1),
            380 + 300 * Math.random());
    },
    places_heard: () => made?.sources.length ?? 0,
  };
}
