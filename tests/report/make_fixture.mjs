// Writes small tables with made-up but plausible numbers and the columns of the real
// ones: `node tests/report/make_fixture.mjs DIRECTORY`. Nothing in here is a measurement.
import './fixture/drift.mjs';
import './fixture/questions.mjs';
import './fixture/scenes.mjs';
import './fixture/strand.mjs';
import './fixture/work.mjs';
import { write } from './fixture/write.mjs';

write(
  'benchmark_extra',
  ['model', 'elements', 'time_s'],
  [10, 100, 1000].map((n) => ({ model: 'chain <n>', elements: n, time_s: 4e-7 * n })),
);
