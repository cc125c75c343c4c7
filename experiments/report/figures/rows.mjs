// Parts of charts that have a row for each name.
import { log_channel } from './common.mjs';

const letter = 6.6; // pixels of a label's letter

// y: a row for each of `domain`, its name on the left.
export const row_channel = (field, domain, axis = {}) => ({
  field,
  type: 'nominal',
  title: null,
  scale: { domain },
  axis: { labelLimit: 0, domain: false, ticks: false, labelPadding: 6, grid: true, ...axis },
});

// Pixels that remain for x between the names of the rows and `right` pixels of other texts.
export const row_width = (width, names, right = 0) =>
  Math.round(
    Math.max(90, width - letter * Math.max(...names.map((name) => name.length)) - right - 28),
  );

const scale_time = [
  [1, 's'],
  [1e-3, 'ms'],
  [1e-6, 'µs'],
];

// Log axis of a time in ms whose ticks carry their unit: 100 µs, 1 ms, 10 s.
export function time_channel(field, title, extent, axis = {}) {
  const tick = scale_time
    .map(
      ([unit, name]) =>
        `datum.value >= ${0.999e3 * unit} ? format(datum.value / ${1e3 * unit}, '~g') + ' ${name}'`,
    )
    .join(' : ');
  return log_channel(field, title, extent, {
    labelExpr: `${tick} : format(1e6 * datum.value, '~g') + ' ns'`,
    ...axis,
  });
}

export const percent_axis = { labelExpr: "format(datum.value, '~g') + ' %'" };

// One text to the right of each row, at the end of the plot.
export const row_text = (values, y, field, mark = {}) => ({
  data: { values },
  mark: { type: 'text', align: 'left', x: 'width', dx: 8, fontSize: 11, ...mark },
  encoding: { y, text: { field } },
});
