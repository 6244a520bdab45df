// SPDX-License-Identifier: Apache-2.0
// A vitrine as the castle's others: a dark plinth with brass edges, velvet, panes, a lamp in the
// lid. Metres, y up; the velvet that the mummy stands on lies at FLOOR.
export const FLOOR = 1.04;
const VELVET = 0.02;

export class Part {
  constructor(name, material) {
    Object.assign(this, { name, material, points: [], normals: [], uv: undefined, triangles: [] });
  }

  // Four corners, counter-clockwise as seen from where the face is seen.
  quad(corners) {
    const [a, b, , d] = corners, first = this.points.length;
    const u = b.map((c, k) => c - a[k]), v = d.map((c, k) => c - a[k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...n);
    for (const corner of corners) {
      this.points.push(corner);
      this.normals.push(n.map((c) => c / size));
    }
    this.triangles.push([first, first + 1, first + 2], [first, first + 2, first + 3]);
  }

  box([x0, y0, z0], [x1, y1, z1], bevel = 0.003) {
    const low = [x0, y0, z0], high = [x1, y1, z1];
    for (let axis = 0; axis < 3; axis++) {
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      for (const up of [false, true]) {
        const corner = (a, b) => {
          const p = [];
          p[axis] = up ? high[axis] : low[axis];
          p[u] = a ? high[u] - bevel : low[u] + bevel;
          p[v] = b ? high[v] - bevel : low[v] + bevel;
          return p;
        };
        const loop = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        this.quad(up ? loop : loop.reverse());
      }
      // The bevels along this axis.
      for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
        const edge = (end, onto_u) => {
          const p = [];
          p[axis] = end ? high[axis] - bevel : low[axis] + bevel;
          p[u] = a ? high[u] - (onto_u ? 0 : bevel) : low[u] + (onto_u ? 0 : bevel);
          p[v] = b ? high[v] - (onto_u ? bevel : 0) : low[v] + (onto_u ? bevel : 0);
          return p;
        };
        const loop = [edge(0, true), edge(0, false), edge(1, false), edge(1, true)];
        this.quad(a === b ? loop : loop.reverse());
      }
    }
    // The corners' small triangles.
    for (let n = 0; n < 8; n++) {
      const far = [n & 1, (n >> 1) & 1, (n >> 2) & 1];
      const three = [0, 1, 2].map((axis) => far.map((up, k) =>
        (up ? high[k] : low[k]) + (k === axis ? 0 : up ? -bevel : bevel)));
      const first = this.points.length;
      for (const corner of three) {
        this.points.push(corner);
        this.normals.push(far.map((up) => (up ? 1 : -1) / Math.sqrt(3)));
      }
      this.triangles.push((far[0] + far[1] + far[2]) % 2 ? [first, first + 1, first + 2]
        : [first, first + 2, first + 1]);
    }
  }
}

// Returns the parts of a vitrine whose panes reach from `base` to `top`.
export function make_case(name, width, base, top, cloth) {
  const w = width / 2, plinth = new Part(`Vitrine ${name}`, 'plinth');
  const brass = new Part(`Brass ${name}`, 'brass'), velvet = new Part(`Velvet ${name}`, cloth);
  const glass = new Part(`Glass ${name}`, 'glass');
  plinth.box([-w, 0.07, -w], [w, base - 0.02, w]);
  plinth.box([-w + 0.03, 0, -w + 0.03], [w - 0.03, 0.07, w - 0.03]);
  plinth.box([-w, top + 0.012, -w], [w, top + 0.09, w]);
  velvet.box([-w + 0.018, base - 0.01, -w + 0.018], [w - 0.018, base + VELVET, w - 0.018]);
  const rim = w + 0.012;
  brass.box([-rim, top - 0.008, -rim], [rim, top + 0.016, rim]);
  brass.box([-rim, base - 0.03, -rim], [rim, base, rim]);
  for (const sx of [-1, 1])
    for (const sz of [-1, 1])
      brass.box([sx * w - 0.01, base, sz * w - 0.01], [sx * w + 0.01, top, sz * w + 0.01]);
  const g = w - 0.003;
  const round = [[-g, g], [g, g], [g, -g], [-g, -g]];
  round.forEach(([x, z], i) => {
    const [x1, z1] = round[(i + 1) % 4];
    glass.quad([[x, base, z], [x1, base, z1], [x1, top, z1], [x, top, z]]);
  });
  return [plinth, brass, velvet, glass];
}

export const pbr = (color, roughness, metallic = 0) => ({ baseColorFactor: [...color, 1],
  metallicFactor: metallic, roughnessFactor: roughness });
export const plinth = { name: 'plinth', pbrMetallicRoughness: pbr([0.0242, 0.0232, 0.0252], 0.38) };
export const brass = { name: 'brass', pbrMetallicRoughness: pbr([0.72, 0.50, 0.22], 0.3, 1) };
export const pane = { name: 'glass', pbrMetallicRoughness: pbr([1, 1, 1], 0), doubleSided: true,
  extensions: { KHR_materials_transmission: { transmissionFactor: 1 },
    KHR_materials_ior: { ior: 1.5 } } };

export function make_vitrine() {
  const top = 1.66, base = FLOOR - VELVET;
  const from = [0, top - 0.03, 0.11], half = Math.PI / 4 - Math.atan2(0.11, top - 0.03 - 1.2) / 2;
  return {
    generator: 'art/castle/falcon/make_falcon.mjs',
    parts: make_case('Falcon', 0.5, base, top, 'red velvet'),
    materials: [plinth, brass,
      { name: 'red velvet', pbrMetallicRoughness: pbr([0.205, 0.0060, 0.0144], 0.9) }, pane],
    // A light shines along -z; this one is tipped down and a little back.
    nodes: [{ name: 'Lamp Falcon 1', translation: from,
      rotation: [-Math.sin(half), 0, 0, Math.cos(half)],
      extensions: { KHR_lights_punctual: { light: 0 } } }],
    extras: { extensions: { KHR_lights_punctual: { lights: [{ name: 'Lamp Falcon 1', type: 'spot',
      color: [1, 0.93, 0.82], intensity: 0.9,
      spot: { innerConeAngle: 0.5, outerConeAngle: 0.76 } }] } } },
  };
}
