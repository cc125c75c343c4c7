// Bytes as letters that a script element can hold: 13 bits are two of 91 printable letters,
// 8 % less than base64. Bytes of nothing may follow: what reads them knows its end.
const letters = Array.from({ length: 94 }, (_, i) => String.fromCharCode(33 + i)).filter(
  (letter) => !'"&<'.includes(letter),
);
const base = letters.length;
const bits = 13; // 2^13 <= 91^2
const mask = (1 << bits) - 1;

export function letters_of(bytes) {
  const parts = [];
  let [held, count, text] = [0, 0, ''];
  const write = (word) => {
    text += letters[word % base] + letters[Math.floor(word / base)];
  };
  for (const byte of bytes) {
    held |= byte << count;
    count += 8;
    if (count < bits) continue;
    write(held & mask);
    held >>>= bits;
    count -= bits;
    if (text.length > 8192) {
      parts.push(text);
      text = '';
    }
  }
  if (count > 0) write(held);
  return parts.join('') + text;
}

const values = new Uint8Array(128);
letters.forEach((letter, i) => (values[letter.charCodeAt(0)] = i));

export function bytes_of_letters(text) {
  const out = new Uint8Array(Math.floor(((text.length >> 1) * bits) / 8));
  let [held, count, at] = [0, 0, 0];
  for (let i = 0; i + 1 < text.length; i += 2) {
    held |= (values[text.charCodeAt(i)] + base * values[text.charCodeAt(i + 1)]) << count;
    count += bits;
    for (; count >= 8; count -= 8, held >>>= 8) out[at++] = held & 255;
  }
  return out;
}
