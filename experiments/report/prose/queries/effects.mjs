// What each effect of a scene changes.
import { group_by } from '../../src/tables.mjs';
import { number, percent, rows_of, table } from '../markdown.mjs';

const left_out = {
  body: 'contact with the head',
};

export const audit_table = (tables) =>
  table(
    ['scene', 'left out', 'change', 'discretisation', 'load / weight', 'verdict'],
    rows_of(tables, 'effect_audit')
      .filter((row) => row.effect !== 'none' && row.verdict)
      .map((row) => [
        row.scene,
        left_out[row.effect] ?? row.effect.replace(/^mode /, '').replaceAll('_', ' '),
        row.status === 'ok' ? percent(row.error_without_rel) : 'does not run without it',
        percent(row.discretisation_rel),
        number(row.load_over_weight),
        row.verdict,
      ]),
  );

export const scenes = (tables) =>
  String(new Set(rows_of(tables, 'effect_audit').map((row) => row.scene)).size);

// "15 keep, 5 drop, ...": the kinds of verdict, without their reasons.
export const verdicts = (tables) =>
  [
    ...group_by(
      rows_of(tables, 'effect_audit').filter((row) => row.effect !== 'none' && row.verdict),
      (row) => row.verdict.split(':')[0],
    ),
  ]
    .map(([verdict, members]) => `${members.length} ${verdict}`)
    .join(', ');
