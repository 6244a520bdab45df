// SPDX-License-Identifier: Apache-2.0
// Old painters' pigments as few numbers each: what a thick coat throws back is a ground, edges
// beyond which it is brighter, and bells about a colour. Edges and bells lie where handbooks have
// them (A. Roy, E. West FitzHugh et al., "Artists' Pigments", vol. 1 to 4; R. Johnston-Feller,
// "Color Science in the Examination of Museum Objects", 2001); heights were set by hand until
// colours were near those of measured coats (tests/structure/palette.test.mjs).
import { NM } from './colour.mjs';

// Each: ground, edges [nm, slope in nm, height], bells [nm, width at half height, height], and how
// strongly a gram scatters beside lead white.
const table = {
  'burnt umber': [0.028, [[600, 35, 0.03]], [], 0.5],
  'raw umber': [0.03, [[570, 35, 0.045]], [], 0.5],
  'Vandyke brown': [0.035, [[640, 40, 0.06]], [], 0.3],
  'burnt sienna': [0.03, [[580, 14, 0.03], [680, 40, 0.02]], [], 0.5],
  'raw sienna': [0.05, [[548, 18, 0.15], [670, 40, 0.09]], [], 0.5],
  'red ochre': [0.042, [[582, 12, 0.11], [680, 40, 0.09]], [], 0.6],
  'red lead': [0.065, [[572, 8, 0.7], [650, 40, 0.1]], [], 0.9],
  'cadmium red': [0.05, [[608, 8, 0.72]], [], 0.8],
  'alizarin': [0.045, [[606, 10, 0.8]], [], 0.15],
  'madder lake': [0.175, [[592, 13, 0.45], [650, 30, 0.25]], [], 0.15],
  'lac dye': [0.07, [[615, 14, 0.42], [660, 30, 0.16]], [[420, 60, 0.03]], 0.15],
  'carmine lake': [0.018, [[620, 12, 0.42], [670, 25, 0.18]], [], 0.15],
  'vermilion': [0.06, [[598, 9, 0.43]], [], 0.9],
  'realgar': [0.065, [[558, 12, 0.48], [650, 40, 0.1]], [], 0.5],
  'yellow lake of weld': [0.04, [[515, 18, 0.23], [630, 40, 0.33]], [], 0.15],
  'massicot': [0.06, [[435, 18, 0.3], [545, 40, 0.14]], [], 0.8],
  'yellow ochre': [0.06, [[535, 16, 0.25], [720, 25, 0.12]], [], 0.6],
  'gamboge': [0.09, [[518, 14, 0.45], [610, 40, 0.14]], [], 0.15],
  'Naples yellow': [0.09, [[508, 13, 0.33], [560, 25, 0.17]], [], 0.8],
  'lead-tin yellow II': [0.11, [[496, 14, 0.42], [560, 40, 0.24]], [], 0.9],
  'lead-tin yellow I': [0.16, [[462, 18, 0.54], [540, 40, 0.12]], [], 0.9],
  'saffron': [0.13, [[530, 15, 0.46], [610, 40, 0.12]], [], 0.15],
  'orpiment': [0.085, [[512, 14, 0.4], [590, 40, 0.15]], [], 0.6],
  'cobalt yellow': [0.04, [[513, 12, 0.42], [640, 60, 0.25]], [], 0.4],
  'cadmium yellow': [0.05, [[497, 6, 0.7]], [], 0.8],
  'chrome green': [0.085, [[700, 40, 0.12]], [[528, 70, 0.1]], 0.6],
  'cobalt green': [0.055, [[730, 18, 0.25]], [[527, 75, 0.14]], 0.5],
  'cadmium green': [0.055, [], [[508, 70, 0.3]], 0.7],
  'green earth': [0.055, [[500, 25, 0.03]], [[560, 110, 0.015]], 0.3],
  'viridian': [0.032, [[735, 8, 0.15]], [[508, 65, 0.08]], 0.3],
  'phthalo green': [0.033, [], [[499, 60, 0.1]], 0.2],
  'verdigris': [0.075, [], [[485, 110, 0.25]], 0.3],
  'malachite': [0.04, [], [[520, 125, 0.14]], 0.5],
  'blue bice': [0.1, [], [[498, 75, 0.14]], 0.5],
  'cobalt blue': [0.045, [[700, 10, 0.6]], [[458, 90, 0.29]], 0.4],
  'azurite': [0.032, [], [[460, 95, 0.1]], 0.5],
  'Egyptian blue': [0.045, [[700, 30, 0.25]], [[450, 105, 0.15]], 0.4],
  'ultramarine': [0.04, [[715, 20, 0.15]], [[455, 80, 0.1]], 0.3],
  'phthalo blue': [0.036, [], [[455, 60, 0.075]], 0.2],
  'smalt': [0.03, [[690, 12, 0.42]], [[435, 85, 0.19]], 0.12],
  'indigo': [0.018, [[730, 15, 0.12]], [[440, 90, 0.012]], 0.2],
  'Maya blue': [0.03, [[710, 18, 0.2]], [[475, 120, 0.105]], 0.3],
  'Prussian blue': [0.019, [[740, 20, 0.02]], [[445, 80, 0.015]], 0.15],
  'cobalt violet': [0.035, [[640, 12, 0.46]], [[405, 70, 0.33]], 0.4],
  'ivory black': [0.017, [], [], 0.3],
  'vine black': [0.022, [], [], 0.3],
  'bone black': [0.018, [], [], 0.3],
  'lamp black': [0.04, [], [], 0.3],
  'gypsum': [0.1, [[405, 30, 0.32], [520, 60, 0.18]], [], 0.4],
  'chalk': [0.1, [[400, 30, 0.36], [580, 70, 0.28]], [], 0.4],
  'lead white': [0.55, [[400, 16, 0.33]], [], 1],
  'zinc white': [0.1, [[388, 5, 0.83]], [], 0.9],
  'titanium white': [0.1, [[405, 6, 0.86]], [], 1.6],
  'lithopone': [0.5, [[385, 10, 0.42]], [], 1],
};

export const pigments = Object.keys(table);

// Returns what a thick coat throws back at NM or at other wavelengths, 0 to 1.
export function reflectance(name, wavelengths = NM) {
  if (!(name in table)) throw new Error(`no pigment ${name}`);
  const [ground, edges, bells] = table[name];
  return wavelengths.map((nm) => Math.min(0.98, ground +
      edges.reduce((sum, [at, slope, height]) =>
        sum + height / (1 + Math.exp((at - nm) / slope)), 0) +
      bells.reduce((sum, [at, width, height]) =>
        sum + height * Math.exp(-4 * Math.LN2 * ((nm - at) / width) ** 2), 0)));
}
const scattering = (name) => table[name][3];

// Returns what a coat of pigments throws back (Kubelka and Munk 1931, Duncan 1940): `parts` holds
// the share of each by name.
export function mix_pigments(parts, wavelengths = NM) {
  const all = Object.entries(parts).map(([name, share]) =>
    ({ weight: share * scattering(name), coat: reflectance(name, wavelengths) }));
  const scatters = all.reduce((sum, { weight }) => sum + weight, 0);
  return wavelengths.map((_, i) => {
    const ks = all.reduce((sum, { weight, coat }) =>
      sum + weight * (1 - coat[i]) ** 2 / (2 * coat[i]), 0) / scatters;
    return 1 + ks - Math.sqrt(ks * ks + 2 * ks);
  });
}
