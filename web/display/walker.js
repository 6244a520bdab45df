// SPDX-License-Identifier: Apache-2.0
// The visitor's own camera: it moves with the input at once, as server/show/visit/place.cpp moves
// it, and passes into where the server says it is. The server stays the judge: what it says belongs
// to a moment a round trip ago, when the page was somewhere, too; the difference is eased away.
const ease_seconds = 0.09;     // how softly a visitor starts and stops, as the server's
const level_seconds = 0.4;     // how softly who walks comes upright, likewise
const agree_seconds = 0.1;     // how softly the camera comes to where the server has it
const steepest = 1.45;         // radians up or down, as the server's
const jump = 2;                // metres: farther is another place
const remembered_ms = 2000;
const circle = 2 * Math.PI;

const turn_between = (from, to) => {
  const turn = (to - from) % circle;
  return turn > Math.PI ? turn - circle : turn < -Math.PI ? turn + circle : turn;
};

// set_ground() takes {free(x, z)}, which says whether there is room to stand.
export function make_walker() {
  let pose = null, velocity = [0, 0, 0], move = [0, 0, 0], cut = -1, led = false, ground = null;
  let apart = [0, 0, 0], apart_yaw = 0, apart_pitch = 0;  // from where the server has it
  let apart_lens = [0, 0, 0];
  let rates = null;         // a led camera's motion a second: {position, yaw, pitch, lens, at}
  let past = [];            // {time, position}
  const turned = new Map();  // seq -> yaw and pitch after that input
  let shown = null;          // the pose that advance() left

  const copy = (one) => ({ ...one, position: [...one.position], lens: [...one.lens] });
  const minus = (a, b) => a.map((v, i) => v - b[i]);

  function walk(dt) {
    const share = 1 - Math.exp(-dt / ease_seconds);
    velocity = velocity.map((v, i) => v + (move[i] - v) * share);
    if (move.every((v) => v === 0) && Math.hypot(...velocity) < 0.01) velocity = [0, 0, 0];
    if (velocity.every((v) => v === 0)) return;
    pose.roll *= Math.exp(-dt / level_seconds);
    const [right, up, forward] = velocity, sin = Math.sin(pose.yaw), cos = Math.cos(pose.yaw);
    const step = [(right * cos - forward * sin) * dt, up * dt, (-right * sin - forward * cos) * dt];
    if (!ground) { pose.position = pose.position.map((v, i) => v + step[i]); return; }
    // Along a wall goes on what of the step is free; who stands where there is no room is not held.
    const [x, , z] = pose.position, free = (a, b) => ground.free(a, b) || !ground.free(x, z);
    const [to_x, to_z] = [[x + step[0], z + step[2]], [x + step[0], z], [x, z + step[2]]]
        .find(([a, b]) => free(a, b)) ?? [x, z];
    pose.position[0] = to_x;
    pose.position[2] = to_z;
  }

  // A share of the difference is made up for now.
  function agree(dt) {
    const share = 1 - Math.exp(-dt / agree_seconds);
    apart.forEach((v, i) => { pose.position[i] += v * share; });
    for (const one of past) apart.forEach((v, i) => { one.position[i] += v * share; });
    apart = apart.map((v) => v * (1 - share));
    pose.lens = pose.lens.map((v, i) => v + apart_lens[i] * share);
    apart_lens = apart_lens.map((v) => v * (1 - share));
    pose.yaw += apart_yaw * share;
    pose.pitch += apart_pitch * share;
    for (const one of turned.values()) {
      one.yaw += apart_yaw * share;
      one.pitch += apart_pitch * share;
    }
    apart_yaw *= 1 - share;
    apart_pitch *= 1 - share;
  }

  function leap(told) {
    pose = copy(told);
    velocity = [0, 0, 0];
    apart = [0, 0, 0];
    apart_lens = [0, 0, 0];
    apart_yaw = apart_pitch = 0;
    rates = null;
    past = [];
    turned.clear();
  }

  // A led camera goes on as the server's last two poses say.
  function follow(told, now) {
    const before = rates?.told ?? told, passed = rates ? (now - rates.at) / 1000 : 0;
    const rate = (change) => (passed > 0.005 && passed < 0.5 ? change / passed : 0);
    rates = { at: now, told,
      position: minus(told.position, before.position).map(rate),
      lens: minus(told.lens, before.lens).map(rate),
      yaw: rate(turn_between(before.yaw, told.yaw)), pitch: rate(told.pitch - before.pitch) };
    apart = minus(told.position, pose.position);
    apart_lens = minus(told.lens, pose.lens);
    apart_yaw = turn_between(pose.yaw, told.yaw);
    apart_pitch = told.pitch - pose.pitch;
  }

  return {
    pose: () => pose,
    led: () => led,
    set_ground(one) { ground = one; },
    turn(look) {  // as an input says it
      if (!pose || led) return;
      pose.yaw = turn_between(0, pose.yaw + look[0]);
      pose.pitch = Math.min(steepest, Math.max(-steepest, pose.pitch + look[1]));
    },
    sent(seq, moves) {
      move = [...moves];
      if (!pose) return;
      turned.set(seq, { yaw: pose.yaw, pitch: pose.pitch });
      for (const old of turned.keys()) { if (turned.size < 256) break; turned.delete(old); }
    },
    // The server says where it has the visitor: {seq, position, yaw, pitch, roll, fov, middle, cut,
    // led}. round_trip: milliseconds.
    told(message, now, round_trip) {
      const told = { ...message, lens: [Math.tan(message.fov / 2), ...message.middle] };
      const far = pose && Math.hypot(...minus(told.position, pose.position)) > jump;
      if (!pose || told.cut !== cut || far) leap(told);
      cut = told.cut;
      if (led !== told.led) rates = null;
      led = told.led;
      if (led) { pose.roll = told.roll; return follow(told, now); }
      apart_lens = minus(told.lens, pose.lens);
      const own = turned.get(told.seq);
      if (own) {
        apart_yaw = turn_between(own.yaw, told.yaw);
        apart_pitch = told.pitch - own.pitch;
        for (const old of turned.keys()) { if (old >= told.seq) break; turned.delete(old); }
      } else if (turned.size === 0) {
        apart_yaw = turn_between(pose.yaw, told.yaw);
        apart_pitch = told.pitch - pose.pitch;
      }
      if (turned.size === 0) pose.roll = told.roll;
      const then = past.findLast((one) => one.time <= now - round_trip) ?? past[0];
      apart = minus(told.position, (then ?? pose).position);
    },
    // Returns whether the camera has moved or turned since the last call.
    advance(dt, now) {
      if (!pose) return false;
      const before = shown ?? pose;
      if (!led) walk(dt);
      else if (rates && now - rates.at < 200) {
        pose.position = pose.position.map((v, i) => v + rates.position[i] * dt);
        pose.lens = pose.lens.map((v, i) => v + rates.lens[i] * dt);
        pose.yaw += rates.yaw * dt;
        pose.pitch += rates.pitch * dt;
      }
      agree(dt);
      past.push({ time: now, position: [...pose.position] });
      while (past.length > 2 && now - past[1].time > remembered_ms) past.shift();
      shown = copy(pose);
      const differs = (a, b) => a.some((v, i) => Math.abs(v - b[i]) > 1e-5);
      return differs(before.position, pose.position) || differs(before.lens, pose.lens)
        || Math.abs(before.yaw - pose.yaw) + Math.abs(before.pitch - pose.pitch)
          + Math.abs(before.roll - pose.roll) > 1e-6;
    },
  };
}

// The map over HTTP says where there is room to walk.
export function make_ground({ cell, corner, rows }) {
  return { free(x, z) {
    const row = rows[Math.floor((z - corner[1]) / cell)];
    return row?.[Math.floor((x - corner[0]) / cell)] === 'o';
  } };
}
