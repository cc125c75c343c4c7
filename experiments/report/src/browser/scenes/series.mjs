// One small plot for every column of a scene's time series, with a line at the time shown.
import embed from 'vega-embed';
import { expressionInterpreter } from 'vega-interpreter';
import { page_theme, vega_config } from '../../../figures/common.mjs';
import { describe_picture } from '../described.mjs';

const units = {
  m: 'm', mm: 'mm', s: 's', ms: 'ms', us: 'µs', j: 'J', n: 'N', kg: 'kg', rad: 'rad',
  rel: 'relative', m_s: 'm/s', rad_s: 'rad/s', per_m: '1/m', per_s: '1/s',
}; // prettier-ignore

// 'tip_x_m' -> 'tip x (m)'; the longest ending that is a unit.
export function column_title(name) {
  const words = name.split('_');
  for (const length of [2, 1]) {
    const unit = units[words.slice(-length).join('_').toLowerCase()];
    if (unit !== undefined && words.length > length)
      return `${words.slice(0, -length).join(' ')} (${unit})`;
  }
  return words.join(' ');
}

function spec_of(title, values, time) {
  const x = {
    type: 'quantitative',
    title: 'time (s)',
    axis: { tickCount: 5 },
    scale: { domain: [values[0].t, values.at(-1).t], nice: false },
  };
  const y = {
    field: 'v',
    type: 'quantitative',
    title: null,
    scale: { zero: false },
    axis: { tickCount: 4, format: '.6~g' },
  };
  return {
    $schema: 'https://vega.github.io/schema/vega-lite/v6.json',
    description: `${title} against time, ${values.length} moments`,
    title,
    width: 'container',
    height: 170,
    padding: 4,
    autosize: { type: 'fit', contains: 'padding' },
    params: [{ name: 'now', value: time }],
    layer: [
      {
        data: { values },
        mark: { type: 'line', strokeWidth: 1.6, color: 'var(--accent)' },
        encoding: { x: { ...x, field: 't' }, y },
      },
      {
        data: { values: [{}] },
        mark: { type: 'rule', strokeWidth: 1.2, color: page_theme.text },
        encoding: { x: { ...x, datum: { expr: 'now' } } },
      },
    ],
  };
}

export class Series {
  #views = [];
  #busy = false;
  #wanted = undefined;

  // `seek(t_s)` is called when a plot is clicked.
  constructor(place, seek) {
    this.place = place;
    this.seek = seek;
  }

  // Plots of the scene's columns at the width of the place.
  async draw({ series: { columns, rows } }, time) {
    this.#views.forEach((view) => view.finalize());
    this.#views = [];
    const boxes = columns.slice(1).map(() => document.createElement('div'));
    this.place.replaceChildren(
      ...boxes.map((box) => {
        const card = document.createElement('div');
        card.className = 'small-plot';
        card.append(box);
        return card;
      }),
    );
    const drawn = await Promise.all(
      boxes.map(async (box, i) => {
        const values = rows.map((row) => ({ t: row[0], v: row[i + 1] }));
        if (!values.some(({ v }) => v !== null)) {
          box.textContent = `${column_title(columns[i + 1])}: no value`;
          return [];
        }
        const spec = spec_of(column_title(columns[i + 1]), values, time);
        const { view } = await embed(box, spec, {
          mode: 'vega-lite',
          renderer: 'svg',
          actions: false,
          ast: true,
          expr: expressionInterpreter,
          config: vega_config(page_theme),
        });
        describe_picture(box, spec.description);
        view.addEventListener('click', (event) => {
          const left = view.origin()[0] + view.padding().left;
          const at = event.clientX - box.getBoundingClientRect().left - left;
          this.seek(view.scale('x').invert(at));
        });
        return [view];
      }),
    );
    this.#views = drawn.flat();
    if (this.#wanted !== undefined) this.mark(this.#wanted);
  }

  // Moves the line; while the plots are at work only the last time asked for is kept.
  async mark(time) {
    this.#wanted = time;
    if (this.#busy || this.#views.length === 0) return;
    this.#busy = true;
    while (this.#wanted !== undefined) {
      const now = this.#wanted;
      this.#wanted = undefined;
      await Promise.all(this.#views.map((view) => view.signal('now', now).runAsync()));
    }
    this.#busy = false;
  }
}
