// Figure 1: largest constraint violation against wall time, formulation x integrator.
import { distinct, group_by, is_number, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  log_channel,
  log_extent,
  panels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { family_name, family_style, formulation_style } from './palette.mjs';

// Exact zeros have no place on a log axis: they are drawn on a marked floor.
const floor = 1e-19;

export const drift_cost = {
  id: 'drift_cost',
  title: 'Constraint drift, and the cost of stopping it',
  table: 'constraint_drift',
  headline(tables) {
    const groups = [...group_by(this.rows(tables), (row) => row.formulation)].map(([name, runs]) => ({
      name,
      most: Math.max(...runs.map((row) => row.g_max)),
    }));
    const moving = groups.filter(({ most }) => most > 0);
    const worst = minimum_by(moving, ({ most }) => -most);
    const best = minimum_by(moving, ({ most }) => most);
    const text = ({ name, most }) => `${spaced(name)} by up to ${format_number(most, 2)} m`;
    return moving.length > 0
      ? `Constraints drift: ${distinct([worst, best]).map(text).join(', ')}`
      : 'No constraint drifts';
  },
  reading: `Each mark is one run: its largest constraint violation |g| against its wall time. Lower left is better. Colour:
    formulation; shape: family of the integrator.`,
  caption: `Each mark is one run: largest constraint violation max |g| over the whole run
    against the wall time it took. Lower is less drift, further left is cheaper. Colour is
    the formulation, shape the family of the integrator, which a mark's tooltip names. Systems whose coordinates satisfy the constraint exactly are left out; other exact zeros are on the line at the bottom.
    Click a legend entry to keep it and dim the others; shift-click adds entries. Made
    from the rows of constraint_drift.csv whose study is "formulation"; runs that failed
    are in the table only.`,

  rows: (tables) =>
    (tables.constraint_drift ?? [])
      .filter(
        (row, _, all) =>
          row.study === 'formulation' &&
          all.some((other) => other.system === row.system && other.g_max > 0) &&
          succeeded(row) &&
          is_number(row.g_max) &&
          is_positive(row.wall_s),
      )
      .map((row) => ({
        ...row,
        family: family_name(row.integrator),
        g_drawn: row.g_max > 0 ? Math.max(row.g_max, floor) : floor,
      })),

  spec(tables, { width, theme }) {
    const rows = this.rows(tables);
    const groups = [...group_by(rows, (row) => row.system)];
    const formulations = formulation_style(rows.map((row) => row.formulation));
    const families = family_style(rows.map((row) => row.family));
    const { columns, panel_width, legend } = layout(width, groups.length, {
      columns_max: 2,
      labels: [...formulations.domain, ...families.domain],
    });
    const list = groups.map(([system, members]) => ({
      title: system.replaceAll('_', ' '),
      width: panel_width,
      height: 330,
      data: { values: members },
      layer: [
        {
          mark: {
            type: 'point',
            size: 85,
            strokeWidth: 1.9,
            fillOpacity: 0.15,
            filled: false,
          },
          encoding: {
            x: log_channel(
              'wall_s',
              'wall time (s)',
              log_extent(
                members.map((r) => r.wall_s),
                5,
              ),
            ),
            y: log_channel(
              'g_drawn',
              'largest violation max |g| (m)',
              log_extent([...rows.map((row) => row.g_drawn), 1e-2]),
            ),
            color: {
              field: 'formulation',
              type: 'nominal',
              title: 'formulation',
              legend,
              scale: { domain: formulations.domain, range: formulations.colours },
            },
            shape: {
              field: 'family',
              type: 'nominal',
              title: 'integrator',
              legend,
              scale: { domain: families.domain, range: families.shapes },
            },
            opacity: dimmed_unless(['pick_formulation', 'pick_family']),
            tooltip: tooltips([
              ['formulation', 'formulation'],
              ['integrator', 'integrator'],
              ['g_max', 'max |g| (m)', '.3e'],
              ['energy_drift_rel', 'energy drift (rel)', '.3e'],
              ['wall_s', 'wall time (s)', '.3e'],
              ['dt_s', 'dt (s)', '.2e'],
              ['alpha', 'alpha'],
              ['beta', 'beta'],
              ['steps', 'steps'],
              ['suppress_algebraic', 'algebraic out of error test'],
            ]),
          },
        },
        ...(members.some((row) => row.g_max === 0)
          ? [
              {
                data: { values: [{ g: floor, text: 'exactly zero' }] },
                mark: { type: 'rule', strokeDash: [4, 4], color: theme.axis },
                encoding: { y: { field: 'g', type: 'quantitative' } },
              },
              {
                data: { values: [{ g: floor, text: 'exactly zero' }] },
                mark: {
                  type: 'text',
                  align: 'left',
                  x: 4,
                  dy: -8,
                  fontSize: 11,
                  color: theme.muted,
                },
                encoding: {
                  y: { field: 'g', type: 'quantitative' },
                  text: { field: 'text' },
                },
              },
            ]
          : []),
      ],
    }));
    return panels(
      with_parameters(list, [
        legend_selection('pick_formulation', 'formulation'),
        legend_selection('pick_family', 'family'),
      ]),
      columns,
    );
  },

  describe(tables) {
    const rows = this.rows(tables);
    return `Log-log scatter chart of the largest constraint violation in metres against
      wall time in seconds: ${rows.length} runs,
      ${distinct(rows.map((r) => r.formulation)).length} formulations,
      ${distinct(rows.map((r) => r.integrator)).length} integrators.`;
  },
};
