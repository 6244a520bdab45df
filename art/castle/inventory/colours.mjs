// SPDX-License-Identifier: Apache-2.0
// Colours of what the castle's holdings are made of, and painted with.
export const colours = {
  gold: '#c9a24b', silver: '#b9bcc0', iron: '#55575a', steel: '#7f858b', bronze: '#7a5c33',
  copper: '#a5633c', brass: '#b5923f', pewter: '#8c8d88', lead: '#6d7073', oak: '#6f5233',
  walnut: '#4e3826', lime: '#c9b38c', pear: '#a5744a', linen: '#d9d0bb', wool: '#b8a58a',
  silk: '#cdb98f', crimson: '#8e1f2d', madder: '#a63c32', indigo: '#2f4064', woad: '#5b7a99',
  weld: '#c7a93b', green: '#4f6b45', verdigris: '#4c8f80', ivory: '#e8dec6', bone: '#d9ceb2',
  parchment: '#d8c79f', ink: '#2a2520', white: '#ece7da', azurite: '#3f6ea0', ochre: '#b5813c',
  umber: '#5d4632', vermilion: '#b83a26', clay: '#a85a3a', honey: '#9a6a2c', cobalt: '#31509a',
  slate: '#5c6670', marble: '#e2ddd3', sandstone: '#c2ab85', glass: '#8fae93', wax: '#d9b96a',
  leather: '#6b4427', black: '#1f1c1a', rose: '#c48a83', sky: '#9db8c9', snow: '#dfe4e6',
  amber: '#b8742a', feather: '#8a7762',
};
