// SPDX-License-Identifier: Apache-2.0
// What gems take from light. Bands of chromium are bell curves over wave numbers; `strength` is the
// absorption in their middle in 1/m of stones as those in the case, of which a ray crosses PATH
// metres. The last band of each stands for the slow rise towards ultraviolet.
import { NM } from './colour.mjs';

export const PATH = 0.034;
const bands = {
  alexandrite: [{ at: 23900, width: 4000, strength: 108 },
    { at: 17450, width: 2400, strength: 94 }, { at: 14738, width: 22, strength: 24 },
    { at: 14697, width: 22, strength: 24 }, { at: 28000, width: 9000, strength: 11 }],
  ruby: [{ at: 24700, width: 4400, strength: 99 }, { at: 18150, width: 3500, strength: 78 },
    { at: 14432, width: 22, strength: 9 }, { at: 14403, width: 22, strength: 12 },
    { at: 28000, width: 13000, strength: 45 }],
};
export const sources = {
  alexandrite: 'places and widths of the bands of Cr3+ in chrysoberyl: R. A. Farrell, '
      + 'R. E. Newnham, Am. Mineral. 50 (1965) 1972; J. Walling et al., IEEE J. Quantum Electron. '
      + '16 (1980) 1302',
  ruby: 'places and widths of the bands of Cr3+ in corundum: T. H. Maiman et al., Phys. Rev. 123 '
      + '(1961) 1151; D. S. McClure, J. Chem. Phys. 36 (1962) 2757',
};

// Returns the absorption in 1/m at a wavelength. `width` is that at half of the height.
export const absorption_at = (gem, nm) => bands[gem].reduce((sum, { at, width, strength }) =>
  sum + strength * Math.exp(-4 * Math.LN2 * ((1e7 / nm - at) / width) ** 2), 0);
export const transmittance = (gem, metres) =>
  NM.map((nm) => Math.exp(-absorption_at(gem, nm) * metres));
export const gems = Object.keys(bands);
