// SPDX-License-Identifier: Apache-2.0
// The storyteller's voice: pieces of sound played with the picture of the same server time, from
// where the mouth is. Browsers allow sound after a visitor has touched the page; until then none is
// asked for.
import { kept } from './kept.js';
import { read_sound } from './packet.js';

const near = 1.5, faintest = 0.1;  // metres of full loudness; a far voice stays audible
const slip = 0.06;                 // seconds a piece may be off before it is put right

// Returns how loud a voice is at `distance` metres: inverse distance, with a floor.
export const loudness = (distance) => Math.max(faintest, near / Math.max(near, distance));

// Returns where a world position is for a listener at `state` {position, yaw}: [right, up, back]
// metres. `behind`: metres that the listener stands behind that place.
export function in_front_of(state, position, behind = 0) {
  const [x, y, z] = position.map((v, i) => v - state.position[i]);
  const c = Math.cos(state.yaw), s = Math.sin(state.yaw);
  return [x * c - z * s, y, x * s + z * c - behind];
}

// Measures how long after its server time a picture is seen, on performance.now()'s clock: the
// median of the last ones, since single pictures are late but none is early.
export function make_delay(most = 31) {
  const seen = [];
  return {
    shown(time_us, now) {
      seen.push(now - time_us / 1000);
      if (seen.length > most) seen.shift();
    },
    // Milliseconds to add to a server time; null before the first picture.
    value: () => (seen.length ? [...seen].sort((a, b) => a - b)[seen.length >> 1] : null),
  };
}

// button: turns sound on and off. on_wanted(bool): whether the server should send any. eager: try
// at once (kiosks whose browser allows it). label(name): the words of this page.
export function make_sound(button, { on_wanted, label, eager = false }) {
  let muted = kept.get('sound') === 'off', wanted = null;
  let context = null, loud = null, master = null, volume = 1, panner = null;
  let mouth = null, everywhere = false, state = null;
  let behind = 0;
  let current = null, ended = 0;  // utterance: {number, at, sources}
  const delay = make_delay();

  function show() {
    const on = !muted && context?.state === 'running';
    button.dataset.sound = muted ? 'off' : on ? 'on' : 'waiting';
    button.setAttribute('aria-pressed', String(on));
    const text = label(on ? 'sound_off' : 'sound_on');
    button.setAttribute('aria-label', text);
    button.title = text;
    // Said to those who do not see the button, once it has changed.
    const state_text = document.getElementById('sound-state');
    if (state_text && wanted !== null && wanted !== on)
      state_text.textContent = label(on ? 'sound_is_on' : 'sound_is_off');
    if (wanted !== on) on_wanted(wanted = on);
  }

  function open() {
    if (!window.AudioContext) return;
    if (!context) {
      context = new AudioContext({ latencyHint: 'interactive' });
      master = new GainNode(context, { gain: muted ? 0 : volume });
      loud = new GainNode(context, { gain: 1 });
      // Direction only; distance is `loudness`.
      panner = new PannerNode(context, { panningModel: 'equalpower', rolloffFactor: 0 });
      panner.connect(loud).connect(master).connect(context.destination);
      context.onstatechange = show;
      place();
    }
    if (context.state !== 'running') context.resume().then(show, () => {});
  }

  function set_loudness() {
    if (context) master.gain.setTargetAtTime(muted ? 0 : volume, context.currentTime, 0.05);
  }

  function stop() {
    if (!current) return;
    ended = current.number;
    for (const source of current.sources) try { source.stop(); } catch { /* it has not begun */ }
    current = null;
  }

  function place() {
    if (context && everywhere) {  // a narrator: no direction, no distance
      loud.gain.setTargetAtTime(1, context.currentTime, 0.06);
      [panner.positionX, panner.positionY, panner.positionZ].forEach(
          (axis, i) => axis.setTargetAtTime(i === 2 ? -1 : 0, context.currentTime, 0.06));
      return;
    }
    if (!context || !mouth || !state) return;
    const at = in_front_of(state, mouth, behind), distance = Math.hypot(...at);
    const now = context.currentTime;
    loud.gain.setTargetAtTime(loudness(distance), now, 0.06);
    const away = Math.max(distance, 1e-3);
    [panner.positionX, panner.positionY, panner.positionZ].forEach(
        (axis, i) => axis.setTargetAtTime(at[i] / away, now, 0.06));
  }

  // The context's time at which a sample must be started to be heard at `now_ms` of
  // performance.now().
  function context_time(now_ms) {
    const stamp = context.getOutputTimestamp?.();
    if (stamp?.performanceTime > 0)
      return stamp.contextTime + (now_ms - stamp.performanceTime) / 1000;
    return context.currentTime + (now_ms - performance.now()) / 1000
        - (context.outputLatency || context.baseLatency || 0);
  }

  function play(sound) {
    if (sound.utterance === ended) return;  // a piece that was on its way when it was stopped
    if (current?.number !== sound.utterance) {
      stop();
      current = { number: sound.utterance, at: null, sources: new Set() };
    }
    mouth = sound.mouth;
    everywhere = sound.everywhere;
    place();
    const due = context_time(sound.time_us / 1000
        + (delay.value() ?? performance.now() - sound.time_us / 1000));
    const joined = current.at !== null && Math.abs(due - current.at) < slip;
    const start = joined ? current.at : due, seconds = sound.samples.length / sound.rate;
    button.dataset.slip = current.at === null ? 0 : Math.round(1000 * (due - current.at));
    current.at = start + seconds;
    const late = Math.max(0, context.currentTime - start);
    if (late >= seconds) return;
    const buffer = new AudioBuffer(
        { length: sound.samples.length, sampleRate: sound.rate, numberOfChannels: 1 });
    buffer.copyToChannel(sound.samples, 0);
    const source = new AudioBufferSourceNode(context, { buffer });
    source.connect(panner);
    source.start(Math.max(start, context.currentTime), late);
    const mine = current;
    mine.sources.add(source);
    source.onended = () => mine.sources.delete(source);
    button.dataset.pieces = Number(button.dataset.pieces ?? 0) + 1;
  }

  button.addEventListener('click', () => {
    const on = !muted && context?.state === 'running';
    muted = on;
    kept.set('sound', muted ? 'off' : 'on');
    if (muted) stop(); else open();
    set_loudness();
    show();
  });
  const touched = (event) => {
    if (!muted && !(event.target instanceof Element && event.target.closest(`#${button.id}`)))
      open();
  };
  for (const event of ['pointerup', 'keydown']) addEventListener(event, touched, { passive: true });
  button.hidden = !window.AudioContext;
  if (eager && !muted) open();
  show();

  return {
    // True when the message was sound.
    receive(bytes) {
      const sound = read_sound(bytes);
      if (!sound) return false;
      if (!muted && context?.state === 'running') play(sound);
      return true;
    },
    speech(message) {
      if (message.action === 'stop' && current?.number === message.utterance) stop();
    },
    stop,
    shown: (picture) => delay.shown(picture.time_us, performance.now()),
    moved(to) { state = to; place(); },
    // Says how many metres the listener stands behind the picture's camera.
    stands_behind(metres) { behind = metres; place(); },
    // A new line: numbers of utterances begin anew, and the server must be told again.
    joined() { stop(); ended = 0; wanted = null; show(); },
    relabel: show,
    // 0..1, of everything that this page plays.
    volume(value) { volume = value; set_loudness(); },
    // Resets sound as a new guest finds it: sound is on.
    reset() {
      muted = false;
      kept.remove('sound');
      set_loudness();
      show();
    },
    // Returns where other sounds go: {context, to}; null until the browser allows any.
    output: () => (context?.state === 'running' ? { context, to: master } : null),
    is_heard: () => !!current && current.at > context.currentTime,
  };
}
