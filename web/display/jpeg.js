// SPDX-License-Identifier: Apache-2.0
// A keyframe's colours are decoded as they are, without alpha or another colour space.

/** @param {any} bytes @returns {Promise<ImageBitmap>} */
export const decode_jpeg = (bytes) => createImageBitmap(new Blob([bytes], { type: 'image/jpeg' }),
    { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
