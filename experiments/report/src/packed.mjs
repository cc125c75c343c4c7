// Bytes as the page carries them: letters of DEFLATE, which cannot end a script element.
import { deflateRawSync } from 'node:zlib';
import { letters_of } from './letters.mjs';

export const packed = (bytes) => letters_of(deflateRawSync(bytes, { level: 9 }));
