// SPDX-License-Identifier: Apache-2.0
// The layers of ARCHITECTURE.md.

// layer -> layers it may include, besides itself.
export const may_include = {
  base: [],
  config: ['base'],
  about: ['base'],
  json: ['base'],
  wire: ['json', 'base'],
  ledger: ['base'],
  image: ['base'],
  spectrum: ['json', 'base'],
  store: ['spectrum', 'image', 'json', 'base'],
  volume: ['store', 'image', 'json', 'base'],
  scan: ['gltf', 'store', 'image', 'json', 'base'],
  lawn: ['image', 'json', 'base'],
  collection: ['json', 'base'],
  plan: ['base'],
  frame: ['image', 'base'],
  attention: ['frame', 'base'],
  denoise: ['base'],
  gltf: ['base'],
  world: ['gltf', 'volume', 'scan', 'lawn', 'store', 'image', 'spectrum', 'base'],
  light: ['world', 'volume', 'scan', 'lawn', 'store', 'frame', 'spectrum', 'base'],
  cache: ['light', 'world', 'frame', 'base'],
  workers: ['cache', 'light', 'world', 'frame', 'base'],
  picture: ['cache', 'denoise', 'light', 'world', 'scan', 'lawn', 'frame', 'spectrum', 'base'],
  avatar: ['gltf', 'json', 'base'],
  show: ['picture', 'workers', 'cache', 'denoise', 'light', 'world', 'volume', 'scan', 'lawn',
    'store', 'gltf', 'collection', 'attention', 'frame', 'image', 'avatar', 'wire', 'json',
    'ledger', 'spectrum', 'base'],
  museum: ['show', 'wire', 'ledger', 'base'],
  stream: ['wire', 'base'],
  kiosk: ['wire', 'json', 'base'],
};

export const folder_of = (layer) =>
  (['avatar', 'kiosk'].includes(layer) ? `${layer}/` : `server/${layer}/`);
