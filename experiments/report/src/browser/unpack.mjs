// What the page carries compressed: letters of DEFLATE (RFC 1951).
import { inflateSync } from 'fflate';
import { bytes_of_letters } from '../letters.mjs';

export const unpacked = (text) => inflateSync(bytes_of_letters(text));

export const unpacked_json = (text) => JSON.parse(new TextDecoder().decode(unpacked(text)));
