// Published tests of slender rods.
import { validation_cells } from '../../figures/validation.mjs';
import { distinct, group_by } from '../../src/tables.mjs';
import { number, table } from '../markdown.mjs';

const shown = ({ outcome, error_pct, lost }) => {
  if (outcome === 'does not apply') return '';
  if (outcome === 'no answer') return '**no answer**';
  const text = error_pct < 1e-3 ? '< 0.001' : number(error_pct);
  if (lost) return `**${text}, a run lost**`;
  return outcome === 'outside' ? `**${text}**` : text;
};

export const tests = (tables) =>
  String(distinct(validation_cells(tables).map((cell) => cell.test)).length);

// Tests down, models across: largest error of the judged rows in per cent.
export function matrix(tables) {
  const cells = validation_cells(tables);
  const names = distinct(cells.map((cell) => cell.name));
  const rows = [...group_by(cells, (cell) => cell.test)].map(([test, members]) => {
    const tolerance = members.find((cell) => cell.tolerance_pct !== undefined);
    const by_name = new Map(members.map((cell) => [cell.name, cell]));
    return [
      test,
      number(tolerance?.tolerance_pct),
      ...names.map((name) => (by_name.has(name) ? shown(by_name.get(name)) : '')),
    ];
  });
  return table(['test', 'accepted', ...names], rows);
}

// "super helix 26 of 28, der 27 of 28": who meets how many of the tests it can be put to.
export function scores(tables) {
  const judged = validation_cells(tables).filter(
    (cell) => !['does not apply', 'not judged'].includes(cell.outcome),
  );
  return [...group_by(judged, (cell) => cell.name)]
    .map(([name, members]) => {
      const met = members.filter((cell) => cell.outcome === 'within').length;
      return { text: `${name} ${met} of ${members.length}`, share: met / members.length };
    })
    .sort((a, b) => b.share - a.share)
    .map(({ text }) => text)
    .join('; ');
}
