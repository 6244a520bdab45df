// SPDX-License-Identifier: Apache-2.0
// Pixels of screenshots and canvases are compared here.

// The mean difference of two lists of as many bytes.
export const difference = (a, b) =>
  a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
