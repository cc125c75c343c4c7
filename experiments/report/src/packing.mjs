// Scenes as bytes that compress well, and back: the text of everything else, then positions
// and channels as differences from what their neighbours say. Nothing is lost.

const header_bytes = 4; // of the text's length, little endian

// What a word (16 bits) is expected to be: the point goes on as in the two frames before, and
// as the point before it on its strand was off that, so is this one.
function expected(words, wide, frame, i, first) {
  const at = frame * wide + i;
  if (frame === 0) return first ? 0 : words[at - 3];
  const before = (k) =>
    frame === 1 ? words[k - wide] : 2 * words[k - wide] - words[k - 2 * wide];
  return before(at) + (first ? 0 : words[at - 3] - before(at - 3));
}

// Calls `each(frame, i, first, k)` for every word, coordinate by coordinate; `first`: of a
// strand; `k` counts.
function every_word(frames, strand_points, each) {
  let k = 0;
  for (let c = 0; c < 3; ++c)
    for (let frame = 0; frame < frames; ++frame) {
      let i = c;
      for (const n of strand_points)
        for (let p = 0; p < n; ++p, i += 3) each(frame, i, p === 0, k++);
    }
}

// Small numbers of either sign as small words without one.
const folded = (d) => ((d << 1) ^ (d >> 31)) & 65535;
const unfolded = (z) => (z >>> 1) ^ -(z & 1);

// `scene`: as data.mjs decodes it, positions and values as arrays.
export function bytes_of_scene({ positions, channels, ...rest }) {
  const header = {
    ...rest,
    channels: channels.map(({ values: _, ...channel }) => channel),
  };
  const text = new TextEncoder().encode(JSON.stringify(header));
  const points = rest.strand_points.reduce((sum, n) => sum + n, 0);
  const frames = rest.times_s.length;
  const words = frames * points * 3;
  const out = new Uint8Array(
    header_bytes + text.length + 2 * words + channels.length * frames * points,
  );
  new DataView(out.buffer).setUint32(0, text.length, true);
  out.set(text, header_bytes);
  const low = header_bytes + text.length;
  every_word(frames, rest.strand_points, (frame, i, first, k) => {
    const guess = expected(positions, 3 * points, frame, i, first);
    const word = folded(((positions[frame * 3 * points + i] - guess) << 16) >> 16);
    out[low + k] = word & 255;
    out[low + words + k] = word >> 8;
  });
  let at = low + 2 * words;
  for (const { values } of channels)
    for (let k = 0; k < values.length; ++k)
      out[at++] = values[k] - (k < points ? 0 : values[k - points]);
  return out;
}

export function scene_of_bytes(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const low = header_bytes + view.getUint32(0, true);
  const scene = JSON.parse(new TextDecoder().decode(bytes.subarray(header_bytes, low)));
  const points = scene.strand_points.reduce((sum, n) => sum + n, 0);
  const frames = scene.times_s.length;
  const words = frames * points * 3;
  const positions = new Uint16Array(words);
  every_word(frames, scene.strand_points, (frame, i, first, k) => {
    const difference = unfolded(bytes[low + k] | (bytes[low + words + k] << 8));
    positions[frame * 3 * points + i] =
      expected(positions, 3 * points, frame, i, first) + difference;
  });
  let at = low + 2 * words;
  const channels = scene.channels.map((channel) => {
    const values = new Uint8Array(frames * points);
    for (let k = 0; k < values.length; ++k)
      values[k] = bytes[at++] + (k < points ? 0 : values[k - points]);
    return { ...channel, values };
  });
  return { ...scene, positions, channels };
}
