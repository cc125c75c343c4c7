// What elements gain that are divided anew while a strand moves.
import { number, percent, range, rows_of, table } from '../markdown.mjs';

const worthwhile = 1.5;

const rows = (tables, part) =>
  rows_of(tables, 'regrading').filter(
    (row) => row.part === part && row.status === 'ok',
  );
const shown = (tables) =>
  rows(tables, 'elements').filter((row) => row.gain > 0);

const ratio = (x) => (x > 0 ? number(x, 3) : '');

export const gains = (tables) => {
  const limits = rows(tables, 'limit').map((row) => [
    row.scene.replaceAll('_', ' '),
    'many elements',
    '',
    '',
    ratio(row.gain),
    ratio(row.gain_following),
  ]);
  const measured = shown(tables).map((row) => [
    row.scene.replaceAll('_', ' '),
    percent(row.target_rel),
    number(row.elements_fixed, 3),
    row.fixed_cuts,
    ratio(row.gain),
    ratio(row.gain_following),
  ]);
  return table(
    ['scene', 'distance', 'fixed elements', 'their cut', 'anew', 'following'],
    [...measured, ...limits].sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0)),
  );
};

const reached = (all, column) => {
  const many = all.filter((row) => row[column] >= worthwhile).length;
  const most = Math.max(...all.map((row) => Number(row[column])));
  return `${many} of ${all.length} reach ${worthwhile}; the largest is ${number(most, 3)}.`;
};

export const worth_anew = (tables) => reached(shown(tables), 'gain');
export const worth_following = (tables) => reached(shown(tables), 'gain_following');
const between = (tables, column) =>
  range(shown(tables).map((row) => Number(row[column])), (x) => number(x, 3));
export const always_anew = (tables) => between(tables, 'gain_always');
export const always_following = (tables) => between(tables, 'gain_following_always');

export const verdict = (tables) => {
  const anew = [...shown(tables), ...rows(tables, 'limit')].filter(
    (row) => row.gain >= worthwhile,
  ).length;
  const following = shown(tables).filter((row) => row.gain_following >= worthwhile).length;
  const always = shown(tables).filter(
    (row) => row.gain_following_always >= worthwhile,
  ).length;
  return (
    `Cuts that move gain ${worthwhile} times in ${anew} cases; numbers that follow gain it in ` +
    `${following} of ${shown(tables).length} by the error that all tables here use, the rms over a run, ` +
    `and in ${always} where the worst instant counts`
  );
};

// Hairs that are let go: "26 of 36 ... with half the tolerance 30".
export const in_motion = (tables) => {
  const all = rows(tables, 'in_motion');
  const asked = Math.max(...all.map((row) => Number(row.tolerance_rel)));
  const within = (rows) => rows.filter((row) => row.tip_error_rel <= asked).length;
  const full = all.filter((row) => Number(row.tolerance_rel) === asked);
  const half = all.filter((row) => Number(row.tolerance_rel) < asked);
  const worst = Math.max(...half.map((row) => Number(row.tip_error_rel)));
  return (
    `${within(full)} of ${full.length} hairs keep a tolerance of ${percent(asked)} of their length; ` +
    `cut for half of it, ${within(half)} do, and the worst is off by ${percent(worst)}.`
  );
};

// Those whose motion was tried.
export const pilot = (tables) => {
  const all = rows(tables, 'pilot');
  const asked = Number(all[0].tolerance_rel);
  const within = (column) => all.filter((row) => row[column] <= asked).length;
  const numbers = (column) => all.map((row) => Number(row[column]));
  const once = all.filter((row) => Number(row.work_rel) === 3).length;
  return (
    `${within('tip_error_rel')} of ${all.length} hairs keep ${percent(asked)} of their length by the same measure, and ` +
    `${within('largest_error_rel')} at every joint and frame, with ${range(numbers('elements'), number)} elements. ` +
    `For ${once} of them the elements of rest were enough; the runs of a pilot have ` +
    `${range(numbers('work_rel'), (x) => number(x, 2))} times the elements of the run that it prepares.`
  );
};

const with_points = (tables) =>
  rows(tables, 'points').filter((row) => row.points_error_rel !== undefined);

export const points = (tables) =>
  table(
    ['scene', 'elements', 'by more points', 'from a fine cut'],
    with_points(tables).map((row) => [
      row.scene.replaceAll('_', ' '),
      number(row.elements),
      percent(row.points_error_rel),
      percent(row.tip_error_rel),
    ]),
  );

// Contact acts at the points.
const touching = ['edge', 'fall_on_sphere'];

export const points_verdict = (tables) => {
  const share = (rows) =>
    percent(Math.max(...rows.map((row) => row.points_error_rel / row.tip_error_rel)));
  const all = with_points(tables);
  return (
    `Where nothing touches, more points are worth ${share(all.filter((row) => !touching.includes(row.scene)))} ` +
    'of the error of the elements at most, so that points that follow the motion are not built. Contact acts at the ' +
    `points: there more of them are worth up to ${share(all.filter((row) => touching.includes(row.scene)))}, ` +
    'since they find a small body sooner, not since an element winds; the option `quadrature` gives them.'
  );
};
