// Parts every figure shares: theme, log axes, panels laid out for the width at hand,
// legends.
import { is_positive } from '../src/tables.mjs';
import { series_style } from './palette.mjs';

// Of a figure as a file, in pixels.
export const paper_width = 1000;

// Of a figure as a file where the reader prefers dark; the page's style sheet has the same.
export const dark_theme = {
  text: '#e7eaee',
  muted: '#a3abb6',
  grid: '#2a3038',
  axis: '#6f7883',
  background: '#191d23',
  bad: '#4a515b',
};
// The browser passes CSS variables, so light, dark and print need no redraw.
export const paper_theme = {
  text: '#1d2127',
  muted: '#5c6470',
  grid: '#e3e6ea',
  axis: '#8b939e',
  background: '#ffffff',
  bad: '#c2c7ce',
};
export const page_theme = {
  text: 'var(--text)',
  muted: 'var(--muted)',
  grid: 'var(--grid)',
  axis: 'var(--axis)',
  background: 'var(--card)',
  bad: 'var(--bad)',
};

const font = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif';

export const vega_config = (theme) => ({
  background: theme.background,
  font,
  view: { stroke: null },
  title: { color: theme.text, fontSize: 13, fontWeight: 600, anchor: 'start', offset: 8 },
  axis: {
    labelColor: theme.muted,
    titleColor: theme.text,
    gridColor: theme.grid,
    domainColor: theme.axis,
    tickColor: theme.axis,
    labelFontSize: 11,
    titleFontSize: 12,
    titleFontWeight: 500,
    titlePadding: 8,
    labelLimit: 0,
  },
  legend: {
    labelColor: theme.text,
    titleColor: theme.text,
    labelFontSize: 12,
    titleFontSize: 12,
    titleFontWeight: 600,
    labelLimit: 0,
    rowPadding: 3,
    symbolSize: 70,
    symbolOpacity: 1,
    symbolStrokeWidth: 1.8,
    titleLimit: 0,
    layout: {
      bottom: { anchor: 'start', direction: 'vertical', margin: 14 },
      top: { anchor: 'start', direction: 'vertical', margin: 14 },
    },
  },
  text: { color: theme.text, font },
});

// Powers of ten that a padded domain stays within, so that doubles hold its ends.
const far_decades = 300;
const within_far = (e) => Math.max(-far_decades, Math.min(far_decades, e));

// Decade ticks (1-2-5 below one decade) and a padded domain for positive `values`.
export function log_extent(values, max_ticks = 7) {
  const positive = values.filter(is_positive);
  if (positive.length === 0) return { domain: [0.1, 10], ticks: [0.1, 1, 10] };
  const low = within_far(Math.log10(Math.min(...positive)));
  const high = within_far(Math.log10(Math.max(...positive)));
  const pad = Math.max(0.06 * (high - low), 0.08);
  const domain = [10 ** (low - pad), 10 ** (high + pad)];
  const first = Math.ceil(low - pad);
  const last = Math.floor(high + pad);
  if (last - first < 1) {
    const ticks = [];
    for (let e = Math.floor(low - pad); e <= high + pad; ++e) {
      for (const m of [1, 2, 5]) ticks.push(Number(`${m}e${e}`));
    }
    return { domain, ticks: ticks.filter((t) => t >= domain[0] && t <= domain[1]) };
  }
  const stride = Math.ceil((last - first + 1) / max_ticks);
  const ticks = [];
  for (let e = first; e <= last; e += stride) ticks.push(Number(`1e${e}`));
  return { domain, ticks };
}

const label_expression =
  'datum.value == 0 || (abs(datum.value) >= 0.01 && abs(datum.value) < 10000) ' +
  "? format(datum.value, '~g') : replace(format(datum.value, '.0e'), '+', '')";

export function log_channel(field, title, { domain, ticks }, axis = {}) {
  return {
    field,
    type: 'quantitative',
    title,
    scale: { type: 'log', domain, nice: false },
    axis: { values: ticks, labelExpr: label_expression, ...axis },
  };
}

// Six digits, and no more of them than differ: never 1.000000000005.
export const plain_label = "format(datum.value, '.6~g')";

export function linear_channel(field, title, axis = {}) {
  return {
    field,
    type: 'quantitative',
    title,
    axis: { tickCount: 5, labelExpr: plain_label, ...axis },
  };
}

const axis_room = 64;
const panel_gap = 28;
const legend_from = 720;

// How many panels of what width fit, and where the legend goes: `above` when its labels
// are long or the panels many, else on the right, else below.
export function layout(
  width,
  panel_count,
  { labels = [], columns_max = 3, above = false, least = 250 } = {},
) {
  const on_right = width >= legend_from && !above;
  const longest = Math.max(12, ...labels.map((label) => label.length));
  const room = width - (on_right ? 56 + 7.2 * longest : 0) - 12;
  const fit = Math.max(1, Math.floor((room + panel_gap) / (least + axis_room + panel_gap)));
  const columns = Math.min(panel_count, columns_max, fit);
  const panel_width = Math.floor(
    (room - (columns - 1) * panel_gap) / columns - axis_room,
  );
  const legend_columns = Math.max(
    1,
    Math.floor((width - axis_room) / (30 + 7.2 * longest)),
  );
  return {
    columns,
    panel_width: Math.max(200, Math.min(panel_width, 760)),
    legend: on_right
      ? { orient: 'right', offset: 16 }
      : {
          orient: above ? 'top' : 'bottom',
          columns: legend_columns,
          offset: 14,
        },
  };
}

// Text broken at spaces, not at no-break ones, into lines of at most `width` pixels, at about 6.4 pixels a letter.
export function lines_of(text, width, letter = 6.4) {
  const lines = [];
  for (const word of text.split(/[ \n]+/)) {
    const longer = lines.length > 0 ? `${lines.at(-1)} ${word}` : word;
    if (lines.length > 0 && longer.length * letter <= width)
      lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

// A number and its unit stay on one line.
const unbroken = (text) => text.replace(/(\d) (?=(?:%|ms|µs|ns|s|m)(?![\w/]))/g, '$1\u00a0');

// The finding, and below it how to read the figure.
export const figure_title = (headline, reading, { width, theme }) => ({
  text: lines_of(unbroken(headline), width - 24, 9.4),
  subtitle: lines_of(unbroken(reading.replace(/\s+/g, ' ').trim()), width - 24, 6.9),
  fontSize: 15,
  lineHeight: 19,
  subtitleFontSize: 12,
  subtitleLineHeight: 16,
  subtitlePadding: 5,
  subtitleColor: theme.muted,
  anchor: 'start',
  offset: 16,
});

// Places in [0, end] at least `gap` apart and near the wanted ones, in the same order.
export function spread(wanted, gap, end) {
  const order = wanted.map((_, i) => i).sort((a, b) => wanted[a] - wanted[b]);
  const placed = new Array(wanted.length);
  let next = 0;
  for (const i of order) {
    placed[i] = Math.max(next, wanted[i]);
    next = placed[i] + gap;
  }
  let last = end;
  for (const i of order.reverse()) {
    placed[i] = Math.min(last, placed[i]);
    last = placed[i] - gap;
  }
  return placed;
}

// Selection by legend: a legend click keeps one entry and dims the rest (shift-click
// adds).
export const legend_selection = (name, field) => ({
  name,
  select: { type: 'point', fields: [field] },
  bind: 'legend',
});

export const dimmed_unless = (names, value = 1, dim = 0.08) => ({
  condition: { test: { and: names.map((param) => ({ param })) }, value },
  value: dim,
});

// Colour and shape of one series field share a legend; dashes only support them.
export function series_channels(field, title, style, legend) {
  const scale = (range) => ({ domain: style.domain, range });
  const shared = { field, type: 'nominal', title };
  return {
    color: { ...shared, scale: scale(style.colours), legend },
    shape: { ...shared, scale: scale(style.shapes), legend },
    strokeDash: { ...shared, scale: scale(style.dashes), legend: null },
  };
}

// Panels side by side, wrapped to the width. Selection parameters must sit in the first
// layer of the first panel: on a layered chart's top level they collide, in later layers
// clicks are lost.
export function panels(list, columns, { dashes = 'independent' } = {}) {
  return {
    concat: list,
    columns,
    spacing: panel_gap,
    resolve: {
      scale: { color: 'shared', shape: 'shared', strokeDash: dashes },
      legend: { color: 'shared', shape: 'shared', strokeDash: dashes },
    },
  };
}

export const with_parameters = (list, parameters) =>
  list.map((panel, i) =>
    i > 0
      ? panel
      : {
          ...panel,
          layer: panel.layer.map((layer, k) =>
            k > 0 ? layer : { ...layer, params: parameters },
          ),
        },
  );

export const tooltips = (fields) =>
  fields.map(([field, title, format]) => ({
    field,
    title,
    ...(format ? { type: 'quantitative', format } : { type: 'nominal' }),
  }));

// Two layers: a line, and its points with their tooltips.
export function marked_line(rows, { x, y, series, opacity, tooltip }) {
  return [
    {
      data: { values: rows },
      mark: { type: 'line', strokeWidth: 1.8 },
      encoding: { x, y, ...series, shape: undefined, opacity },
    },
    {
      data: { values: rows },
      mark: { type: 'point', filled: true, size: 65 },
      encoding: { x, y, ...series, strokeDash: undefined, opacity, tooltip },
    },
  ];
}

// Panels of `groups` ([title, rows] each) with a marked line for each series of a panel, all
// on the same axes, whose legend picks series. `series`: the field and what it is called;
// x, y: field, title.
export function line_panels(groups, { id, width, series, x, y, tooltip }) {
  const rows = groups.flatMap(([, members]) => members);
  const [field, name] = series;
  const style = series_style(rows.map((row) => row[field]));
  const { columns, panel_width, legend } = layout(width, groups.length, {
    columns_max: 2,
    labels: style.domain,
    above: true,
  });
  const axis = ([of, title]) =>
    log_channel(of, title, log_extent(rows.map((row) => row[of])));
  const pick = `pick_${id}`;
  const channels = {
    x: axis(x),
    y: axis(y),
    series: series_channels(field, name, style, legend),
    opacity: dimmed_unless([pick]),
    tooltip: tooltips(tooltip),
  };
  return panels(
    with_parameters(
      groups.map(([title, members]) => ({
        title,
        width: panel_width,
        height: 240,
        layer: marked_line(members, channels),
      })),
      [legend_selection(pick, field)],
    ),
    columns,
  );
}
