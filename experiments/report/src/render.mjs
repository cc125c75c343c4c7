// Figures as SVG text in Node, from the same specs the page draws.
import * as vega from 'vega';
import * as vega_lite from 'vega-lite';
import { expressionInterpreter } from 'vega-interpreter';
import { figures, figure_spec } from '../figures/all.mjs';
import { paper_theme, paper_width, vega_config } from '../figures/common.mjs';

export const sources = TRESS_SOURCES;

// Vega reports what fails while it draws to a logger and goes on.
class Errors {
  first = undefined;
  error(...args) {
    this.first ??= args.find((arg) => arg instanceof Error) ?? new Error(args.join(' '));
    return this;
  }
  warn = () => this;
  info = () => this;
  debug = () => this;
  level = () => this;
}

// The figure as SVG text, undefined when the tables hold nothing to draw.
async function render(figure, tables) {
  const spec = figure_spec(figure, tables, { width: paper_width, theme: paper_theme });
  if (spec === undefined) return undefined;
  const logger = new Errors();
  const config = vega_config(paper_theme);
  const compiled = vega_lite.compile(spec, { config, logger }).spec;
  const view = new vega.View(vega.parse(compiled, null, { ast: true }), {
    renderer: 'none',
    expr: expressionInterpreter,
    logger,
  });
  const svg = await view.toSVG();
  view.finalize();
  if (logger.first !== undefined) throw logger.first;
  return `${svg}\n`;
}

// [{id, svg}] for every figure the tables can fill; another one is a warning.
export async function render_figures(tables, warnings) {
  const out = [];
  for (const figure of figures) {
    try {
      const svg = await render(figure, tables);
      if (svg !== undefined) out.push({ id: figure.id, svg });
    } catch (error) {
      warnings.failed(`${figure.table}.csv`, `figure ${figure.id}`, error);
    }
  }
  return out;
}
