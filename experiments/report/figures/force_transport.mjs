// Figure 12: what moving the rest of a strand rigidly does to its tip.
import { distinct, group_by, is_positive, minimum_by, succeeded } from '../src/tables.mjs';
import { format_number } from '../src/format.mjs';
import { spaced } from '../src/strand.mjs';
import {
  dimmed_unless,
  layout,
  legend_selection,
  linear_channel,
  log_channel,
  log_extent,
  marked_line,
  panels,
  series_channels,
  tooltips,
  with_parameters,
} from './common.mjs';
import { name_style } from './palette.mjs';

const shown_time = 0.1; // s, before the undamped model becomes unstable
const shown_elements = 10; // the source's strands

const rows_of = (tables) =>
  (tables.force_transport ?? [])
    .filter(
      (row) =>
        row.comparison === 'dynamics' &&
        succeeded(row) &&
        is_positive(row.rod_difference_rel) &&
        (row.t_s === shown_time || row.elements === shown_elements),
    )
    .map((row) => ({ ...row, method: spaced(row.model) }));

function panel(rows, title, x, { panel_width, legend, style, y }) {
  return {
    title,
    width: panel_width,
    height: 260,
    layer: marked_line(rows, {
      x,
      y,
      series: series_channels('method', 'model', style, legend),
      opacity: dimmed_unless(['pick_method']),
      tooltip: tooltips([
        ['method', 'model'],
        ['elements', 'elements'],
        ['t_s', 'time (s)'],
        ['rod_difference_rel', "off the rod's tip, over the length", '.3g'],
      ]),
    }),
  };
}

// How far the tip is off by elements, and how fast small oscillations grow.
export function transport_findings({ force_transport: rows = [] }) {
  const ours = rows.filter((row) => row.model === 'force_transport' && succeeded(row));
  const listed = (members, field) =>
    [...members]
      .sort((a, b) => a.elements - b.elements)
      .map((row) => `${format_number(row[field])} at ${row.elements}`)
      .join(', ');
  const sentence = (members, text) => (members.length > 0 ? [text(members)] : []);
  const of = (comparison, scene, field) =>
    ours.filter(
      (row) =>
        row.comparison === comparison && row.scene === scene && is_positive(row[field]),
    );
  return [
    ...sentence(
      of('dynamics', 'straight', 'rod_difference_rel').filter(
        (row) => row.t_s === shown_time,
      ),
      (members) =>
        `Distance of the tip from that of the rod over the length, for a straight strand ${shown_time} s after ` +
        `its release: ${listed(members, 'rod_difference_rel')} elements.`,
    ),
    ...sentence(
      of('modes', 'weightless', 'slowest_ratio'),
      (members) =>
        'Frequency of the slowest oscillation without gravity over that of `articulated_chain`: ' +
        `${listed(members, 'slowest_ratio')} elements.`,
    ),
    ...sentence(
      of('transient', 'weightless', 'energy_growth'),
      (members) =>
        'Growth of the energy of small random motions without gravity within 0.1 s, as a factor: ' +
        `${listed(members, 'energy_growth')} elements.`,
    ),
    ...[...group_by(of('modes', 'hanging', 'growth_per_s'), (row) => row.youngs_modulus_pa)]
      .sort(([a], [b]) => a - b)
      .map(
        ([modulus, members]) =>
          `Growth rate of small oscillations around the hanging shape at ${format_number(modulus / 1e6)} MPa ` +
          `(1/s): ${listed(members, 'growth_per_s')} elements.`,
      ),
  ];
}

export const force_transport = {
  id: 'force_transport',
  title: 'Letting the rest of the strand move rigidly',
  table: 'force_transport',
  headline(tables) {
    const rows = rows_of(tables).filter((row) => row.t_s === shown_time);
    const scene = rows[0]?.scene;
    const at = (model, pick) =>
      minimum_by(
        rows.filter((row) => row.scene === scene && row.model === model),
        (row) => pick * row.elements,
      );
    const said = ['force_transport', ...distinct(rows.map((row) => row.model))]
      .filter((model, i, all) => all.indexOf(model) === i && at(model, 1) !== undefined)
      .slice(0, 2)
      .map((model) => {
        const [few, many] = [at(model, 1), at(model, -1)];
        return (
          `${spaced(model)} is ${format_number(100 * few.rod_difference_rel, 2)} % off with ${few.elements} elements and ` +
          `${format_number(100 * many.rod_difference_rel, 2)} % with ${many.elements}`
        );
      });
    return said.length > 0 ? said.join('; ') : 'Distance from the rod';
  },
  reading: `Distance of the tip from the tip of the rod, over the length, after the release of a clamped strand without
    damping; lower is better. A model that converges falls with the number of elements.`,
  caption: `Distance of the tip from the tip of the rod (80 elements of super_helix), over
    the length, after the release of a clamped strand without damping; down is better.
    Left: ${shown_time} s after the release, against the number of elements. Right: against
    time, ${shown_elements} elements, up to where a run becomes unstable. force_transport is our
    reconstruction of a model of the source (each joint leaves out the accelerations of the
    joints beyond it); corde and articulated_chain tend to the rod, it does not. Made from
    force_transport.csv.`,

  rows: rows_of,

  spec(tables, { width }) {
    const rows = rows_of(tables);
    const style = name_style(rows.map((row) => row.method));
    const scenes = [...group_by(rows, (row) => row.scene)];
    const { columns, panel_width, legend } = layout(width, 2 * scenes.length, {
      columns_max: 2,
      labels: style.domain,
      above: true,
    });
    const y = log_channel(
      'rod_difference_rel',
      'off the rod / length',
      log_extent(
        rows.map((row) => row.rod_difference_rel),
        6,
      ),
    );
    const elements = log_channel('elements', 'elements', {
      domain: [4, 50],
      ticks: distinct(rows.map((row) => row.elements)).sort((a, b) => a - b),
    });
    const time = linear_channel('t_s', 'time (s)');
    const shared = { panel_width, legend, style, y };
    const list = scenes.flatMap(([scene, members]) =>
      [
        [(row) => row.t_s === shown_time, `at ${shown_time} s`, elements],
        [(row) => row.elements === shown_elements, `${shown_elements} elements`, time],
      ].flatMap(([is_shown, what, x]) => {
        const drawn = members.filter(is_shown);
        return drawn.length > 0 ? [panel(drawn, `${spaced(scene)}: ${what}`, x, shared)] : [];
      }),
    );
    return panels(
      with_parameters(list, [legend_selection('pick_method', 'method')]),
      columns,
    );
  },

  describe(tables) {
    const rows = rows_of(tables);
    return `Distance of the tip from the rod's over the length, log scale, against elements
      and against time, for ${distinct(rows.map((row) => row.model)).length} models and
      ${distinct(rows.map((row) => row.scene)).length} shapes.`;
  },
};
