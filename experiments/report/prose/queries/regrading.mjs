// What remeshing gains while a strand moves.
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
    ['scene', 'distance', 'fixed elements', 'their mesh', 'remeshed', 'following'],
    [...measured, ...limits].sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0)),
  );
};

const reached = (all, column) => {
  const many = all.filter((row) => row[column] >= worthwhile).length;
  const most = Math.max(...all.map((row) => Number(row[column])));
  return `${many} of ${all.length} measured cases reach ${worthwhile}; the largest is ${number(most, 3)}.`;
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
    `Remeshing gains a factor of ${worthwhile} in ${anew} of ${shown(tables).length + rows(tables, 'limit').length} cases, limits included. ` +
    `Numbers of elements that follow the motion gain it in ${following} of ${shown(tables).length} measured cases by the rms error over a run, ` +
    `and in ${always} where the worst instant counts`
  );
};

// Hairs that are let go, meshed for the tolerance and for a tighter one.
export const in_motion = (tables) => {
  const all = rows(tables, 'in_motion');
  const asked = Math.max(...all.map((row) => Number(row.tolerance_rel)));
  const within = (rows) => rows.filter((row) => row.tip_error_rel <= asked).length;
  const full = all.filter((row) => Number(row.tolerance_rel) === asked);
  const half = all.filter((row) => Number(row.tolerance_rel) < asked);
  const worst = Math.max(...half.map((row) => Number(row.tip_error_rel)));
  return (
    `${within(full)} of ${full.length} hairs keep a tolerance of ${percent(asked)} of their length. Meshed for a tolerance of ` +
    `${percent(Number(half[0].tolerance_rel))}, ${within(half)} of ${half.length} keep the former, and the worst is off by ${percent(worst)}.`
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
    `Of ${all.length} hairs, ${within('tip_error_rel')} keep ${percent(asked)} of their length by the same measure, and ` +
    `${within('largest_error_rel')} at every joint and frame, with ${range(numbers('elements'), number)} elements. ` +
    `For ${once} of them the elements of rest were enough. The runs of a pilot have ` +
    `${range(numbers('work_rel'), (x) => number(x, 2))} times the elements of the run that they prepare.`
  );
};

const with_points = (tables) =>
  rows(tables, 'points').filter((row) => row.points_error_rel !== undefined);

export const points = (tables) =>
  table(
    ['scene', 'elements', 'with more points', 'from a fine mesh'],
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
    `Where nothing touches, more points change at most ${share(all.filter((row) => !touching.includes(row.scene)))} ` +
    'of the error of the elements, so points that follow the motion are not implemented. Contact acts at the ' +
    `points: there more of them change up to ${share(all.filter((row) => touching.includes(row.scene)))}, ` +
    'because they find a small body sooner, not because an element winds. The option `quadrature` sets them.'
  );
};
