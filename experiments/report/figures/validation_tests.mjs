// Test by test: what models measure beside the continuous rod.
import { distinct, group_by, is_number } from '../src/tables.mjs';
import { spaced } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  linear_channel,
  lines_of,
  log_channel,
  log_extent,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { model_style } from './palette.mjs';
import { answered, named } from './validation.mjs';

const curve_rows = (tables) => {
  const rows = named(tables).filter((row) => answered(row) && is_number(row.parameter));
  const finest = new Map(
    [...group_by(rows, (row) => `${row.test}|${row.name}`)].map(([key, members]) => [
      key,
      Math.max(...members.map((row) => row.elements)),
    ]),
  );
  return rows
    .filter((row) => row.elements === finest.get(`${row.test}|${row.name}`))
    .map((row) => ({ ...row, error_pct: 100 * row.error_rel }));
};

// Differences of less than this part of the values are not drawn apart: their ticks could
// not be told apart either.
const least_range = 1e-4;
const few = 4; // so many parameters have a tick each

// Ticks at powers of ten on both sides of zero, 0 among them, that enclose low < 0 < high.
function symlog_ticks(low, high) {
  const decades = (end) =>
    Array.from(
      { length: Math.max(1, Math.ceil(Math.log10(end))) },
      (_, k) => 10 ** (k + 1),
    );
  return [...decades(-low).map((t) => -t), 0, ...decades(high)];
}

// Log axes where the values span decades, also on both sides of zero; one value has a tick
// of its own.
function axis(field, title, values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  if (low === high) {
    const room = Math.max(1, Math.abs(low)) / 2;
    return {
      ...linear_channel(field, title, { values: [low] }),
      scale: { domain: [low - room, low + room] },
    };
  }
  if (low < 0 && high > 100) {
    const ticks = symlog_ticks(low, high);
    return {
      ...linear_channel(field, title, { values: ticks }),
      scale: { type: 'symlog', domain: [ticks[0], ticks.at(-1)], nice: false },
    };
  }
  if (low > 0 && high / low > 20) return log_channel(field, title, log_extent(values, 5));
  const size = least_range * Math.max(Math.abs(low), Math.abs(high));
  const scale =
    high - low > size
      ? { zero: false, nice: true, padding: 12 }
      : { domain: [low - size, high + size], nice: false };
  return { ...linear_channel(field, title), scale };
}

function test_panel(test, members, gloss, { panel_width, legend, style }) {
  const texts = gloss[test] ?? {};
  const x = axis(
    'parameter',
    lines_of(texts.parameter ?? 'parameter', panel_width),
    members.map((row) => row.parameter),
  );
  const parameters = distinct(members.map((row) => row.parameter));
  if (x.scale.type === undefined && parameters.length <= few) x.axis.values = parameters;
  const y = axis(
    'measured',
    lines_of(texts.quantity ?? 'measured', 190),
    members.flatMap((row) => [row.measured, row.reference]),
  );
  const reference = [
    ...new Map(members.map((row) => [row.parameter, row.reference])),
  ].map(([parameter, measured]) => ({ parameter, measured }));
  return {
    title: spaced(test),
    width: panel_width - 34,
    height: 190,
    layer: [
      {
        data: { values: members },
        mark: { type: 'point', filled: true, size: 60, opacity: 0.8 },
        encoding: {
          x,
          y,
          ...series_channels('name', 'model', style, legend),
          strokeDash: undefined,
          opacity: dimmed_unless(['pick_model'], 0.85),
          tooltip: tooltips([
            ['name', 'model'],
            ['elements', 'elements'],
            ['parameter', texts.parameter ?? 'parameter', '.4g'],
            ['measured', 'measured', '.6g'],
            ['reference', 'continuous rod', '.6g'],
            ['error_pct', 'error (%)', '.2g'],
          ]),
        },
      },
      reference.length > 1
        ? {
            data: { values: reference },
            mark: { type: 'line', strokeWidth: 1.4, color: '#7A7F87' },
            encoding: { x, y },
          }
        : {
            data: { values: reference },
            mark: { type: 'rule', strokeWidth: 1.4, color: '#7A7F87' },
            encoding: { y },
          },
    ],
  };
}

export const validation_tests = {
  id: 'validation_tests',
  title: 'Test by test',
  table: 'validation',
  caption: `One panel per test: what is measured against the parameter of the test. The grey line is
    the continuous rod, points are models at their largest number of elements. A click on a name
    in the legend keeps one model. Made from validation.csv.`,

  rows: curve_rows,

  spec(tables, { width }) {
    const rows = curve_rows(tables);
    const style = model_style(rows.map((row) => row.name));
    const tests = [...group_by(rows, (row) => row.test)];
    const shared = layout(width, tests.length, {
      columns_max: 3,
      labels: style.domain,
      above: true,
    });
    const gloss = tables.glossary?.validation?.test ?? {};
    const list = tests.map(([test, members]) =>
      test_panel(test, members, gloss, { ...shared, style }),
    );
    return panels(
      with_parameters(list, [legend_selection('pick_model', 'name')]),
      shared.columns,
    );
  },

  describe(tables) {
    const rows = curve_rows(tables);
    return `${distinct(rows.map((row) => row.test)).length} panels, one per test: measured values of
      ${distinct(rows.map((row) => row.name)).length} models and the line of the continuous rod.`;
  },
};
