// The other end of swing_in_node.h: an engine that is an npm package takes the steps that
// standard input asks for, a line of gravities each, and answers with its wall time, tip
// and kinetic energy.
import { createInterface } from 'node:readline';

/**
 * @param make from the first line to the engine: step(x, y, z) under that gravity, and
 *   motion() with `tip` (3 numbers, null once it gave up) and `kinetic`.
 */
export async function serve(make) {
  let engine = null;
  const answer = (wall) => {
    const { tip, kinetic } = engine.motion();
    const where = tip ? tip.join(' ') : 'nan nan nan';
    process.stdout.write(`${wall} ${where} ${tip ? kinetic : 'nan'}\n`);
  };
  for await (const line of createInterface({ input: process.stdin })) {
    if (engine === null) {
      engine = await make(line);
      answer(0);
      continue;
    }
    const gravity = Float64Array.from(line.trim().split(' '), Number);
    const start = performance.now();
    for (let i = 0; i < gravity.length; i += 3) {
      engine.step(gravity[i], gravity[i + 1], gravity[i + 2]);
    }
    answer((performance.now() - start) / 1e3);
  }
}
