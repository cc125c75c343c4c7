// What the page carries compressed: base64 of DEFLATE (RFC 1951).
import { inflateSync } from 'fflate';

export const unpacked = (base64) =>
  inflateSync(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)));

export const unpacked_json = (base64) =>
  JSON.parse(new TextDecoder().decode(unpacked(base64)));
