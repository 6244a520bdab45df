// SPDX-License-Identifier: Apache-2.0
// How glass and gems bend light: public constants, with wavelengths in micrometres.

// Each: source, number of the formula (refractiveindex.info), range in micrometres, coefficients.
export const glasses = {
  'F2': ['SCHOTT optical glass data sheets 2017', 2, [0.32, 2.5],
    [0, 1.34533359, 0.00997743871, 0.209073176, 0.0470450767, 0.937357162, 111.886764]],
  'N-BK7': ['SCHOTT optical glass data sheets 2017', 2, [0.3, 2.5],
    [0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653]],
  'diamond': ['F. Peter, Zeitschrift fuer Physik 15 (1923) 358', 1, [0.226, 0.76],
    [0, 0.3306, 0.175, 4.3356, 0.106]],
  'corundum': ['I. H. Malitson, M. J. Dodge, J. Opt. Soc. Am. 62 (1972) 1405 (ordinary ray)', 1,
    [0.2, 5], [0, 1.4313493, 0.0726631, 0.65054713, 0.1193242, 5.3414021, 18.028251]],
  'chrysoberyl': ['J. Walling et al., IEEE J. Quantum Electron. 16 (1980) 1302; P. Loiko, A. '
      + 'Major, Opt. Mater. Express 6 (2016) 2177 (middle axis)', 4, [0.25, 2.6],
  [1.58829, 1.42711, 2, 0.01113, 1, 0, 0, 0, 0, -0.01696, 2]],
};

// Returns the index of refraction.
export function index_at(name, nm) {
  const [, formula, , c] = glasses[name], squared = (nm / 1000) ** 2;
  let sum = formula === 4 ? c[0] : 1 + c[0];
  if (formula === 4) {
    // Powers of the length alone, as those of chrysoberyl.
    for (const [i, j] of [[1, 3], [5, 7]])
      sum += c[i] * (nm / 1000) ** c[i + 1] / (squared - c[j] ** c[j + 1]);
    sum += c[9] * (nm / 1000) ** c[10];
  } else {
    for (let i = 1; i < c.length; i += 2)
      sum += c[i] * squared / (squared - (formula === 1 ? c[i + 1] ** 2 : c[i + 1]));
  }
  return Math.sqrt(sum);
}
// Returns what glTF takes for dispersion, 20 over the Abbe number.
export const dispersion = (name) =>
  20 * (index_at(name, 486.1327) - index_at(name, 656.2725)) / (index_at(name, 587.5618) - 1);
