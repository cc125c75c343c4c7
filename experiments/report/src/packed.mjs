// Bytes as the page carries them: base64 of DEFLATE, which cannot end a script element.
import { deflateRawSync } from 'node:zlib';

export const packed = (bytes) => deflateRawSync(bytes, { level: 9 }).toString('base64');
