// Statements about one hair, tested on a family of hairs.
import { distinct, is_number } from '../../src/tables.mjs';
import { number, percent, row_of, rows_of, table } from '../markdown.mjs';

const parameter = {
  gravito_bending: 'the gravito-bending number ρ A g L³/(E I)',
  winding_rad: 'the winding of the natural shape (rad)',
  damping_time_s: 'the damping time (s)',
  drag_kg_m_s: 'the drag of air (kg/(m s))',
  ellipticity: 'the ellipticity of the section',
  length_m: 'the length (m)',
  radius_m: 'the radius (m)',
  youngs_modulus_pa: "Young's modulus (Pa)",
  drive_level: 'the strength of the drive',
  frequency_hz: 'the frequency of the drive (Hz)',
  natural_curvature_1_m: 'natural curvature (1/m)',
};
const name_of = (column) => parameter[column] ?? column.replaceAll('_', ' ');

const ranges = ['below 10', '10 to 100', '100 to 1000', 'above 1000'];

// The row over all gravito-bending numbers, unless a range is named.
const claim_row = (tables, claim, family = 'hair', range = 'all') =>
  row_of(tables, 'family_summary', { claim, family, range });

const size_of = (tables, family) =>
  String(distinct(rows_of(tables, 'family', { family }).map((row) => row.hair)).length);

export const hairs = (tables) => size_of(tables, 'hair');
export const rods = (tables) => size_of(tables, 'rods');

const members = { hair: 'hairs', rods: 'rods' };

const share = (row) => (row.hairs > 0 ? percent(row.holds_share, 2) : 'none');

const held = (row) => `${share(row)} of ${row.hairs} ${members[row.family]}`;

const silent = (row) => (row.no_answer > 0 ? `; ${row.no_answer} gave no answer` : '');

// Nobody cares how much less than a thousandth of a per cent.
const change = (x) => (x < 1e-5 ? 'less than 0.001 %' : percent(x));

const spread = (row, as = number) =>
  `median ${as(row.median)}, deciles ${as(row.decile_1)} and ${as(row.decile_9)}${silent(row)}`;

// For which of them, where a threshold tells more than saying the same of all.
const rule = (row) => {
  if (!row.decided_by) return '';
  const above = row.share_above > row.share_below;
  const [low, high] = [percent(row.share_below), percent(row.share_above)];
  const of = members[row.family];
  if (row.decided_by.startsWith('drive is ')) {
    const drive = row.decided_by.slice('drive is '.length).replaceAll('_', ' ');
    return `the drive: the statement is true for ${high} of the ${of} with ${drive} and for ${low} of the others`;
  }
  return (
    `${name_of(row.decided_by)}: the statement is true for ${above ? high : low} of the ${of} ` +
    `${above ? 'above' : 'below'} ${number(row.threshold)} and for ${above ? low : high} ` +
    `${above ? 'below' : 'above'}`
  );
};

// The statement for hair, its best predictor, and the share of the other rods.
const sentence = (tables, text, row) => {
  const decided = rule(row);
  const other = claim_row(tables, row.claim, 'rods');
  return (
    `${text}${decided === '' ? '' : `. The best predictor is ${decided}`}. ` +
    `It is true for ${held(other)} of other materials`
  );
};

const statements = (tables, family) =>
  rows_of(tables, 'family_summary', { family, range: 'all' }).filter(
    (row) => row.study !== 'tolerance',
  );

// One row per claim.
const summary_of = (tables, family) =>
  table(
    ['statement', 'true for', 'decile, median, decile', 'value', 'strongest rank correlation'],
    statements(tables, family).map((row) => [
      row.statement,
      `${held(row)}${row.no_answer > 0 ? `; no answer: ${row.reasons}` : ''}`,
      row.hairs > 0 ? [row.decile_1, row.median, row.decile_9].map((x) => number(x)).join(', ') : '',
      row.value,
      is_number(row.rank_correlation)
        ? `${name_of(row.correlated_with)} (${number(row.rank_correlation)})`
        : '',
    ]),
  );

export const summary = (tables) => summary_of(tables, 'hair');
export const summary_rods = (tables) => summary_of(tables, 'rods');

// One row per claim, one column per range of the gravito-bending number.
const by_range = (tables, family) =>
  table(
    ['statement', ...ranges],
    statements(tables, family).map(({ claim, statement }) => [
      statement,
      ...ranges.map((range) => {
        const row = claim_row(tables, claim, family, range);
        if (row.hairs === 0) return row.no_answer > 0 ? `no answer from ${row.no_answer}` : '';
        const missing = row.no_answer > 0 ? `; ${row.no_answer} without answer` : '';
        return `${share(row)} of ${row.hairs}${missing}`;
      }),
    ]),
  );

export const ranges_of_hair = (tables) => by_range(tables, 'hair');
export const ranges_of_rods = (tables) => by_range(tables, 'rods');

export const exact_step = (tables) => {
  const twisted = claim_row(tables, 'exact_step_100ms');
  const bent = claim_row(tables, 'exact_step_100ms_bend');
  const ms = (x) => `${number(1e3 * x)} ms`;
  return sentence(
    tables,
    `stable at every step tried up to 100 ms for ${held(twisted)} (${spread(twisted, ms)}), ` +
      `and without twist for ${share(bent)} (median ${ms(bent.median)})`,
    twisted,
  );
};

export const model_steps = (tables) => {
  const row = claim_row(tables, 'super_helix_step_longer');
  return sentence(
    tables,
    `\`super_helix\` is stable at steps at least as long as \`der\` for ${held(row)} ` +
      `(ratio of the largest steps: ${spread(row)})`,
    row,
  );
};

export const twist_straight = (tables) => {
  const row = claim_row(tables, 'twist_straight_negligible');
  return sentence(
    tables,
    `moves the tip of a straight hair by less than 1 % of its length for ${held(row)} ` +
      `(${spread(row, change)})`,
    row,
  );
};

export const twist_curly = (tables) => {
  const row = claim_row(tables, 'twist_curly_matters');
  return `with its curls, by more than that for ${held(row)} (${spread(row, change)})`;
};

export const bdf = (tables) => {
  const [two, three, four] = ['1e-2', '1e-3', '1e-4'].map((error) =>
    claim_row(tables, `bdf_order2_at_${error}`),
  );
  return (
    `order 2 at most needs no more work than order 5 for ${share(two)}, ${share(three)} and ` +
    `${share(four)} of ${hairs(tables)} hairs at tip errors of 1e-2, 1e-3 and 1e-4 of the length ` +
    `(work of order 5 over that of order 2: median ` +
    `${[two, three, four].map((row) => number(row.median)).join(', ')})`
  );
};

export const esdirk = (tables) => {
  const steps = claim_row(tables, 'esdirk_steps_at_1e-3');
  const work = claim_row(tables, 'esdirk_work_at_1e-3');
  return (
    `ESDIRK takes no more steps than BDF for ${share(steps)} of the hairs at 1e-3, and no more ` +
    `calls of the model for ${share(work)}`
  );
};

export const equal = (tables) => {
  const row = claim_row(tables, 'reduced_cheaper');
  return sentence(
    tables,
    `\`super_helix\` needs less time for 1 % than \`der\` for ${held(row)} (time of \`der\` over ` +
      `that of \`super_helix\`: ${spread(row)}; 100 and 0.01 where one of them never gets there)`,
    row,
  );
};

// "Of the 4 coily hairs in the wind it is true for 1"
export const equal_curly_wind = (tables) => {
  const rows = rows_of(tables, 'family', {
    claim: 'reduced_cheaper',
    family: 'hair',
    kind: 'coily',
    drive: 'wind',
    status: 'ok',
  });
  const held_of = rows.filter((row) => row.holds === 'true').length;
  return `Of the ${rows.length} coily hairs in the wind it is true for ${held_of}`;
};

const middle = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  const at = (part) => number(sorted[Math.round(part * (sorted.length - 1))]);
  return `${at(0.05)} (5 %), ${at(0.5)} (50 %) and ${at(0.95)} (95 %)`;
};

// Percentiles over the hairs.
export const gravito_bending = (tables) =>
  middle(
    rows_of(tables, 'family', { family: 'hair', claim: 'exact_step_100ms' }).map(
      (row) => row.gravito_bending,
    ),
  );

// Claims about runs by tolerance are made of every model and integrator; the whole family
// has tables of its own, which --quick does not make.
const tolerance_rows = (tables, claim) =>
  rows_of(tables, 'family_tolerance_summary', { claim, range: 'all' });

const same_runs = (row) => ({ claim: row.claim, model: row.model, integrator: row.integrator });

// Hairs of one model and integrator: all, within the tolerance, without a solution.
const solved = (tables, row) => {
  const rows = rows_of(tables, 'family_tolerance', same_runs(row));
  return {
    all: rows.length,
    within: rows.filter((hair) => hair.holds === 'true').length,
    unsolved: rows.filter((hair) => hair.holds === 'false' && hair.failure).length,
    sensitive: rows.filter((hair) => hair.status === 'sensitive').length,
    silent: rows.filter((hair) => !['ok', 'sensitive'].includes(hair.status)).length,
  };
};

const not_stored = 'The stored tables hold no runs by tolerance yet';

export const tolerance_table = (tables) => {
  const met = tolerance_rows(tables, 'tolerance_met');
  if (met.length === 0) return `${not_stored}.`;
  const spread_of = (claim, row) => {
    const found = rows_of(tables, 'family_tolerance_summary', { ...same_runs(row), claim, range: 'all' })[0];
    return found?.hairs > 0
      ? [found.decile_1, found.median, found.decile_9].map((x) => number(x)).join(', ')
      : '';
  };
  return table(
    [
      'model, method',
      'within the tolerance',
      'no solution',
      'error: decile, median, decile',
      'work, as accurate',
      'work, as asked',
      'best predictor',
    ],
    met.map((row) => {
      const count = solved(tables, row);
      return [
        `${row.model}, ${row.integrator}`,
        `${count.within} of ${count.all}` +
          `${count.sensitive > 0 ? `, ${count.sensitive} sensitive` : ''}` +
          `${count.silent > 0 ? `, ${count.silent} unknown` : ''}`,
        `${count.unsolved} of ${count.all}`,
        [row.decile_1, row.median, row.decile_9].map((x) => number(x)).join(', '),
        spread_of('tolerance_cheaper_at_error', row),
        spread_of('tolerance_cheaper_as_asked', row),
        rule(row),
      ];
    }),
  );
};

// Errors at one tolerance against those at ten times it.
export const tolerances = (tables) => {
  const rows = rows_of(tables, 'family_tolerances', { study: 'tolerances' });
  if (rows.length === 0) return `${not_stored}.`;
  const count = (key) => distinct(rows.map((row) => row[key])).length;
  const held = rows.filter((row) => row.holds === 'true');
  const warned = rows.filter((row) => row.warned === 'true');
  const most = Math.max(...rows.filter((row) => row.warned !== 'true').map((row) => row.value));
  return (
    `${held.length} of ${rows.length} pairs of runs hold (${count('hair')} hairs, ${count('model')} models, ` +
    `${count('integrator')} methods, ${count('tolerance')} tolerances), ` +
    `${warned.length} by a warning. The largest ratio without a warning is ${number(most)}.`
  );
};

// "Sensitive are hair 28 by super_helix (growth 11) ..."
export const sensitive = (tables) => {
  const rows = rows_of(tables, 'family_tolerance', { claim: 'tolerance_met', status: 'sensitive' });
  if (rows.length === 0) return 'None is among the stored hairs.';
  const named = (row) =>
    `hair ${row.hair} by \`${row.model}\`, \`${row.integrator}\` (growth ${number(row.growth)}, ` +
    `error ${number(row.value / row.tolerance)} of the tolerance)`;
  return `Sensitive: ${rows.map(named).join('; ')}.`;
};

// Hairs that neither method solves, by model.
export const unsolved = (tables) => {
  const rows = rows_of(tables, 'family_tolerance', { claim: 'tolerance_met' });
  if (rows.length === 0) return not_stored;
  const of_model = (model) => {
    const own = rows.filter((row) => row.model === model);
    const hairs = distinct(own.map((row) => row.hair));
    const lost = hairs.filter((hair) =>
      own.filter((row) => row.hair === hair).every((row) => row.holds === 'false' && row.failure),
    );
    const named = lost.length > 0 ? ` (${lost.sort((a, b) => a - b).join(', ')})` : '';
    return `${lost.length}${named} of ${hairs.length} with \`${model}\``;
  };
  return `Hairs that neither method solves: ${distinct(rows.map((row) => row.model)).map(of_model).join(', ')}`;
};

// "within that for 31 of 48 hairs with super_helix (2 without a solution, ..."
export const tolerance = (tables) => {
  const rows = tolerance_rows(tables, 'tolerance_met').filter(
    (row) => row.integrator === 'tr_bdf2',
  );
  if (rows.length === 0) return not_stored;
  const asked = distinct(
    rows_of(tables, 'family_tolerance', { claim: 'tolerance_met' }).map((row) => row.tolerance),
  );
  const of_model = (row) => {
    const { within, all, unsolved: lost, silent: unknown } = solved(tables, row);
    return (
      `${within} of ${all} hairs with \`${row.model}\` (${lost} without a solution, ` +
      `${unknown} without an answer)`
    );
  };
  return (
    `\`tr_bdf2\`, asked for ${asked.map((x) => percent(x)).join(', ')} of the length, stays ` +
    `within that for ${rows.map(of_model).join(', ')}`
  );
};
